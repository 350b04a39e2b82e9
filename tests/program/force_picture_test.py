"""Compares the pictures of forces in reports with the result: colours of the limbs and numbers in the caption."""

import html
import re
import shutil

import h5py
import numpy as np

from poesy_program import GALLERY, ProgramTest, main

STUDY = """\
format = "poesy-study"
version = 1
mechanism.file = "2upr-rpu-beams.toml"
mechanism.fidelity = "first-order"
poses = { select = "interior", count = 6 }
errors.linear = { distribution = "normal", sigma = "0.1 mm" }
errors.angular = { distribution = "normal", sigma = "0.05 deg" }
"""
ANALYSES = {"sensitivity": 'analysis = { kind = "sensitivity", factors = "deforming", samples = 100 }\n',
            "draws": 'mechanism.load.force = ["30 N", "-20 N", "50 N"]\n'
                     'analysis = { kind = "monte-carlo", draws = "per pose", factors = "deforming", samples = 100 }\n'}
DIGITS = 2e-3  # relative tolerance of the caption's numbers
NAMES = ("force_1", "force_2", "force_3")


def forces_in(path):
    """The root mean square of each limb's force at each pose, [limb, pose], in N, from the result's own numbers."""
    with h5py.File(path) as file:
        responses = [name.decode() for name in file["response"][()]]
        rows = [responses.index(name) for name in NAMES]
        if "monte_carlo" in file:
            return file["monte_carlo/rms"][()][rows]
        effects = file["sensitivity/local"][()][rows] * file["factors/sigma"][()][None, :, None]
        return np.sqrt((effects**2).sum(axis=1))


class ForcePicture(ProgramTest):
    def report(self, name):
        shutil.copy(GALLERY / "2upr-rpu-beams/2upr-rpu-beams.toml", self.folder)
        self.write("study.toml", STUDY + ANALYSES[name])
        self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
        self.succeeds("report", "r.h5", "-o", "r.html")
        return forces_in(self.folder / "r.h5"), (self.folder / "r.html").read_text()

    def expect_picture(self, name, drives):
        """drives: the number of drives whose forces are more than rounding."""
        expected, page = self.report(name)
        most, least = expected.max(axis=0).argmax(), expected.max(axis=0).argmin()
        caption = html.unescape(re.search(r"<figcaption>(The forces that the errors cause.*?)</figcaption>", page)[1])
        told = re.findall(r"pose (\d+) \([^)]*\): ((?:limb \d [^ ]+ k?N(?:, )?)+)", caption)
        self.assertEqual([int(pose) for pose, _ in told], [most, least])
        for pose, numbers in told:
            found = [float(number) * (1e3 if unit == "kN" else 1.0)
                     for number, unit in re.findall(r"limb \d ([^ ]+) (k?N)", numbers)]
            np.testing.assert_allclose(found, expected[:, int(pose)], rtol=DIGITS, atol=1e-9)
        for k, pose in enumerate((most, least)):
            picture = page[page.index(f'id="forces-{k}"'):].partition("</svg>")[0]
            for limb in range(3):
                shares = re.findall(rf'class="link[^"]*" data-limb="{limb + 1}" style="--share:(\d+)%"', picture)
                share = 100 * expected[limb, pose] / expected.max(axis=0)[[most, least]].max()
                self.assertTrue(shares and all(abs(float(one) - share) <= 0.51 for one in shares), (shares, share))
            self.assertEqual(picture.count('class="arrow"'), drives)

    def test_sensitivity(self):
        self.expect_picture("sensitivity", 0)

    def test_draws(self):
        """With a load, which the drives carry."""
        self.expect_picture("draws", 3)

    def test_no_forces(self):
        """Mismatch has no forces."""
        shutil.copy(GALLERY / "2upr-rpu-beams/2upr-rpu-beams.toml", self.folder)
        self.write("study.toml", STUDY + ANALYSES["sensitivity"] + 'solver.metric = "platform"\n')
        self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
        self.succeeds("report", "r.h5", "-o", "r.html")
        self.assertNotIn("force-pose", (self.folder / "r.html").read_text())


if __name__ == "__main__":
    main()
