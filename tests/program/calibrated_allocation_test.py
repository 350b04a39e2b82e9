"""Tolerances of calibrated machines: the certificate is what its study finds and what linear algebra predicts, the
bits are the same however a study is run, and wrong studies are refused."""

import os
import shutil
from pathlib import Path

import h5py
import numpy as np

from poesy_program import main
from resumption import ResumptionTest

FILES = Path(os.environ["POESY_DATA"]) / "calibration"
NAMES = [f"{kind}_{limb}" for kinds in (("foot_x", "foot_y"), ("zero",), ("rod",)) for limb in (1, 2, 3) for kind in kinds]
FITS = {"zero_1": ["zero_1"], "zero_2": ["zero_2"], "zero_3": ["zero_3"], "radius": ["foot_x_1", "foot_x_2", "foot_x_3"]}
NOISE = 10e-6  # m
CALIBRATION = """\
[analysis.calibration]
fit      = ["zero_*", "radius"]
measured = ["z"]
noise    = { z = "10 um" }
combinations.radius = { foot_x_1 = 1, foot_x_2 = 1, foot_x_3 = 1 }
"""
# Number of machines for two work units: 40 and 5.
TWO_UNITS = 45
PLAIN = """\
format = "poesy-study"
version = 1
mechanism.file = "delta-puu.toml"
poses = { select = "file", file = "delta-places.csv" }
errors.linear = { distribution = "normal", sigma = "0.1 mm" }
[analysis]
kind = "allocation"
samples = 200
yield = 0.9
sigmas = 3
limits = { z = "0.1 mm", position = "0.4 mm" }
[[analysis.parts]]
factors = "linear"
each = true
cost = { law = "reciprocal", b = 1, unit = "mm" }
bounds = ["0.01 mm", "1.5 mm"]
"""
STUDY = PLAIN + CALIBRATION
SMALL = STUDY.replace("samples = 200", f"samples = {TWO_UNITS}").replace("yield = 0.9", "yield = 0.8")
# Bound of a comparison of two shares in standard errors: alpha = 1e-5.
SIGMAS = 4.5


class CalibratedAllocation(ResumptionTest):
    def setUp(self):
        super().setUp()
        for path in FILES.iterdir():
            shutil.copyfile(path, self.folder / path.name)

    def ran(self, text, *options, output="out.h5", code=0):
        self.write("study.toml", text)
        done = self.poesy("run", "study.toml", "-o", output, "--quiet", *options)
        self.assertEqual(done.returncode, code, done.stderr.decode())
        return done

    def found(self, name="out.h5"):
        """The tolerances by part (m), the certificate's yield and its number of machines, and the cost."""
        with h5py.File(self.folder / name) as file:
            tolerance = dict(zip(file["part"].asstr(), file["allocation/tolerance"][:]))
            certificate = file["allocation/certificate"]
            return (tolerance, certificate["yield"][()], int(certificate["machines"][()]),
                    file["allocation"].attrs["cost"])

    def same_as_its_study(self, certificate="out_certificate.toml"):
        self.succeeds("run", certificate, "-o", "again.h5", "--quiet")
        with h5py.File(self.folder / "out.h5") as found, h5py.File(self.folder / "again.h5") as again:
            group = found["allocation/certificate"]
            for name in ("rejects", "machines", "unsolved"):
                self.assertEqual(group[name][()], again["yield"][name][()], name)
            self.assertEqual(group["yield"][()], again["yield/value"][()])
            self.assertIn("calibration", again["yield"])

    def derivatives(self):
        """x, y, z at the places by each error, [places x 3 x errors], from cases of 1 um."""
        text = PLAIN.split("[analysis]")[0].replace("errors.linear", "# errors.linear") + '[analysis]\nkind = "evaluate"\n'
        for name in NAMES:
            text += f'[[analysis.cases]]\nname = "{name}"\nerrors = {{ {name} = "0.001 mm" }}\n'
        self.ran(text, output="cases.h5")
        with h5py.File(self.folder / "cases.h5") as file:
            return np.stack([file[f"evaluate/{name}"][:] for name in ("x", "y", "z")], axis=1).transpose(2, 1, 0) * 1e6

    def good_machines(self, tolerance, machines=200_000):
        """The share of machines within the limits, by the linear map of what is left of errors and noise."""
        by_error = self.derivatives()
        fitted = np.array([[float(name in fit) for fit in FITS.values()] for name in NAMES])
        heights = by_error[:, 2, :]
        gain = np.linalg.pinv(heights @ fitted)
        moved = by_error @ fitted @ gain  # [places x 3 x places] the correction per measured height
        random = np.random.default_rng(8)
        errors = random.normal(size=(machines, 12)) * np.array([tolerance[name] for name in NAMES]) / 3.0
        noise = random.normal(0.0, NOISE, (machines, len(heights)))
        left = errors @ (by_error - moved @ heights).transpose(0, 2, 1) - noise @ moved.transpose(0, 2, 1)
        is_good = (np.abs(left[:, :, 2]) < 0.1e-3).all(axis=0) & (np.linalg.norm(left, axis=2) < 0.4e-3).all(axis=0)
        return is_good.mean()

    def test_certificate_is_what_its_study_and_a_linear_map_find(self):
        self.ran(STUDY)
        tolerance, share, machines, cost = self.found()
        self.assertEqual(list(tolerance), NAMES)
        self.same_as_its_study()
        error = np.sqrt(share * (1.0 - share) / machines)
        # Second-order effects, which the linear map neglects, are about 1 % for errors of 1 mm.
        self.assertLess(abs(self.good_machines(tolerance) - share), SIGMAS * error + 0.01)
        # The tolerance of an error that the controller corrects is at its upper bound, and calibration lowers the cost.
        self.assertAlmostEqual(tolerance["zero_1"], 1.5e-3)
        self.ran(PLAIN, output="plain.h5")
        self.assertLess(cost, 0.7 * self.found("plain.h5")[3])
        shown = " ".join(self.succeeds("show", "out.h5").split())
        self.assertIn("calibrated: zero_1, zero_2, zero_3, radius of each machine are fitted to measured z", shown)

    def test_known_tolerances_and_own_places(self):
        """The certificate's controllers know the tolerances that were found; the places of measurement are written beside it."""
        self.write("heights.csv", "x [mm],y [mm],z [mm]\n" + "".join(
            f"{x},{y},0\n" for x, y in ((0, 0), (60, 0), (-30, 50), (-30, -50), (30, 20), (-50, 0))))
        text = SMALL.replace('["zero_*", "radius"]', '["zero_*", "radius", "rod_*", "foot_y_*"]') + (
            'prior = "tolerances"\nposes = { select = "file", file = "heights.csv" }\n')
        self.ran(text)
        self.assertIn('file = "out_certificate_measured.csv"', (self.folder / "out_certificate.toml").read_text())
        (self.folder / "heights.csv").unlink()
        self.same_as_its_study()
        tolerance, _, _, _ = self.found()
        self.assertGreater(tolerance["rod_1"], 0.5e-3)
        self.ran(PLAIN)  # a certificate without measured places
        self.assertFalse((self.folder / "out_certificate_measured.csv").exists())

    def test_same_bits(self):
        self.ran(SMALL, "--threads", "1")
        expected = self.content_hash()
        self.ran(SMALL, "--threads", "2", output="two.h5")
        self.assertEqual(self.content_hash("two.h5"), expected)
        self.write("study.toml", SMALL)
        (self.folder / "out.h5").unlink()
        self.stop_early("--threads", "1")
        self.assertEqual(self.resume_to_end("--threads", "2"), expected)
        self.ran(SMALL.replace("10 um", "11 um"), output="other.h5")
        self.assertNotEqual(self.content_hash("other.h5"), expected)

    def test_check_says_what_it_costs(self):
        self.write("study.toml", STUDY)
        said = self.succeeds("check", "study.toml")
        self.assertIn("for each machine about 28 to fit 4 errors to 7 values at 7 poses", said)
        self.assertIn("[analysis.calibration]", said)

    def test_refusals(self):
        refused = [
            (STUDY.replace('measured = ["z"]\n', ""), "does not say what is measured"),
            (STUDY + 'frame = "height"\n', "the measurements do not tell them apart"),
            (STUDY.replace("errors.linear", 'errors.override.rod_1 = { draws = "per pose" }\nerrors.linear').replace(
                'factors = "linear"', 'factors = ["zero_*", "rod_2"]'), "'rod_1' is drawn anew at each pose"),
            (STUDY.replace("sigmas = 3", "sigmas = 3\ncalibrated = true"), "is set beside calibrated = true"),
        ]
        for text, message in refused:
            for command in ("run", "check"):
                with self.subTest(f"{command}: {message}"):
                    self.write("study.toml", text)
                    done = self.poesy(command, "study.toml")
                    self.assertEqual(done.returncode, 2, done.stderr)
                    self.assertIn(message, done.stderr.decode())
        said = self.ran(STUDY.replace("10 um", "0.3 mm"), code=2).stderr.decode()
        self.assertIn("cannot be kept: the noise of the calibration, the background and the errors of no part alone give", said)
        self.assertIn("measure more or better", said)


if __name__ == "__main__":
    main()
