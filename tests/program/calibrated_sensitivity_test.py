"""Indices of the effects that remain of single errors after a calibration, compared with linear algebra on finite
differences of plain solves."""

import os
import shutil
from pathlib import Path

import h5py
import numpy as np

from poesy_program import GALLERY, ProgramTest, main

FILES = Path(os.environ["POESY_DATA"]) / "calibration"
NAMES = [f"{kind}_{limb}" for kinds in (("foot_x", "foot_y"), ("zero",), ("rod",)) for limb in (1, 2, 3) for kind in kinds]
FITS = {"zero_1": ["zero_1"], "zero_2": ["zero_2"], "zero_3": ["zero_3"], "radius": ["foot_x_1", "foot_x_2", "foot_x_3"]}
HEAD = """\
format = "poesy-study"
version = 1
mechanism.file = "delta-puu.toml"
poses = { select = "file", file = "delta-places.csv" }
"""
SIGMA = 0.01e-3
NOISE = 5e-6
PLAIN = HEAD + """\
errors.linear = { distribution = "normal", sigma = "0.01 mm" }
[analysis]
kind = "sensitivity"
factors = "all"
samples = 12
"""
CALIBRATION = """\
[analysis.calibration]
fit      = ["zero_*", "radius"]
measured = ["z"]
noise    = { z = "5 um" }
combinations.radius = { foot_x_1 = 1, foot_x_2 = 1, foot_x_3 = 1 }
"""


class CalibratedSensitivity(ProgramTest):
    def test_advice_is_to_calibrate_what_calibration_removes(self):
        self.ran(PLAIN)
        self.succeeds("report", "r.h5", "-o", "plain.html")
        page = (self.folder / "plain.html").read_text()
        self.assertIn("Calibrate rod_1/2/3, zero_1/2/3, foot_x_1/2/3 (9 errors, 100 % removable).", page)
        self.assertNotIn("to tight tolerances", page)
        self.ran(PLAIN + CALIBRATION)
        self.succeeds("report", "r.h5", "-o", "left.html")
        self.assertNotIn("% removable).", (self.folder / "left.html").read_text())

    def test_advice_does_not_choose_among_copies(self):
        """The six rods of a delta have nearly the same effect, and the cut at 80 % of the mean square lies among them."""
        self.write("rotary-delta.toml", (GALLERY / "rotary-delta/rotary-delta.toml").read_text())
        self.ran((GALLERY / "rotary-delta/study.toml").read_text())
        self.succeeds("report", "r.h5", "-o", "delta.html")
        page = (self.folder / "delta.html").read_text()
        self.assertIn("Hold rod_left_1/2/3, rod_right_1/2/3 (6 errors) to tight tolerances.", page)
        self.assertRegex(page, r"Calibrate zero_1/2/3, seat_\w+_1/2/3, \w+_1/2/3 \(9 errors, 100 % removable\)")

    def setUp(self):
        super().setUp()
        for path in FILES.iterdir():
            shutil.copyfile(path, self.folder / path.name)

    def ran(self, text, *options, output="r.h5", code=0):
        self.write("study.toml", text)
        done = self.poesy("run", "study.toml", "-o", output, "--quiet", *options)
        self.assertEqual(done.returncode, code, done.stderr.decode())
        return done

    def indices(self, text, *options):
        """The indices on x, y, z of each error at each place, [errors x places x 3]."""
        self.ran(text, *options)
        with h5py.File(self.folder / "r.h5") as file:
            responses = list(file["responses/name"].asstr())
            self.assertEqual(list(file["factors/name"].asstr()), NAMES)
            local = file["sensitivity/local"][:]
        return np.stack([local[responses.index(name)] for name in ("x", "y", "z")], axis=-1)

    def derivatives(self):
        """x, y, z at the places by each error, [errors x places x 3], from cases of 1 um."""
        text = HEAD + '[analysis]\nkind = "evaluate"\n'
        for name in NAMES:
            text += f'[[analysis.cases]]\nname = "{name}"\nerrors = {{ {name} = "0.001 mm" }}\n'
        self.ran(text, output="cases.h5")
        with h5py.File(self.folder / "cases.h5") as file:
            found = np.stack([file[f"evaluate/{name}"][:] for name in ("x", "y", "z")], axis=-1) * 1e6
        return found if len(found) == len(NAMES) else found.transpose(1, 0, 2)

    def left(self, by_error, prior):
        """What the fit of heights leaves of each error, per unit."""
        fitted = np.array([[float(name in fit) for name in NAMES] for fit in FITS.values()])
        numbers = np.tensordot(fitted, by_error, 1)  # [numbers x places x 3]
        seen = numbers[:, :, 2] / NOISE
        information = seen @ seen.T
        if prior:
            information += np.diag(fitted.sum(axis=1)) / SIGMA**2
        estimates = np.linalg.solve(information, seen @ by_error[:, :, 2].T / NOISE)  # [numbers x errors]
        return by_error - np.tensordot(estimates.T, numbers, 1)

    def test_indices_are_of_what_the_fit_leaves(self):
        by_error = self.derivatives()
        before = self.indices(PLAIN)
        for prior in (False, True):
            with self.subTest(prior=prior):
                after = self.indices(PLAIN + CALIBRATION + ('prior = "tolerances"\n' if prior else ""))
                left = self.left(by_error, prior)
                # Both studies have the same draws, so the standard deviations are in proportion to the derivatives.
                size = np.abs(by_error).max(axis=2, keepdims=True)
                scatter = np.where(size > 0.05, before.max(axis=2, keepdims=True) / size, np.nan)
                expected = np.abs(left) * scatter
                known = np.isfinite(expected)  # unknown if the error alone has no effect
                self.assertGreater(known.mean(), 0.85)
                np.testing.assert_allclose(after[known], expected[known], rtol=0, atol=2e-4)
                zero, rod = NAMES.index("zero_1"), NAMES.index("rod_1")
                if not prior:  # the fit finds an end stop, but explains a rod by other errors
                    self.assertLess(after[zero].max(), 2e-4)
                    self.assertGreater(before[zero].max(), 0.1)
                self.assertGreater(after[rod].max(), 0.1)

    def test_same_bits(self):
        text = PLAIN.replace('factors = "all"', 'factors = ["zero_1", "foot_x_1", "rod_2"]') + CALIBRATION
        hashes = set()

        def note(name):
            with h5py.File(self.folder / name) as file:
                hashes.add(file.attrs["content_sha256"])

        for threads in ("1", "2"):
            self.ran(text, "--threads", threads)
            note("r.h5")
        for shard in ("1/2", "2/2"):
            self.ran(text, "--shard", shard, output=f"shard{shard[0]}.h5")
        self.succeeds("merge", "shard1.h5", "shard2.h5", "-o", "merged.h5")
        note("merged.h5")
        self.ran(text, "--threads", "1", "--max-wall", "0.000001 s", output="stopped.h5", code=4)
        self.ran(text, "--resume", output="stopped.h5")
        note("stopped.h5")
        self.assertEqual(len(hashes), 1)

    def test_what_is_said_and_refused(self):
        text = PLAIN + CALIBRATION
        self.write("study.toml", text)
        self.assertIn("for each sample about 28 to fit 4 errors to 7 values at 7 poses", self.succeeds("check", "study.toml"))
        self.ran(text)
        self.assertIn("calibrated: zero_1, zero_2, zero_3, radius of each machine are fitted to measured z",
                      " ".join(self.succeeds("show", "r.h5").split()))
        done = self.poesy("tolerances", "r.h5", "--response", "z", "--limit", "0.1 mm")
        self.assertEqual(done.returncode, 2)
        self.assertIn("its indices describe what a calibration leaves", done.stderr.decode())
        self.assertIn("kind \"allocation\"", done.stderr.decode())
        for other, message in ((text.replace('measured = ["z"]\n', ""), "does not say what is measured"),
                               (text.replace('"delta-puu.toml"', '"delta-puu.toml"\nmechanism.fidelity = "both"'),
                                "a calibration solves at one fidelity"),
                               (text + 'frame = "height"\n', "the measurements do not tell them apart")):
            with self.subTest(message):
                self.assertIn(message, self.ran(other, code=2).stderr.decode())


if __name__ == "__main__":
    main()
