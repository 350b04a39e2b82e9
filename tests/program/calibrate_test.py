"""`poesy calibrate` against numbers that another program computed (tests/data/calibration.json)."""

import json
import os
import shutil
from pathlib import Path

import h5py
import numpy as np

from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
FILES = DATA / "calibration"
EXPECTED = json.loads((DATA / "calibration.json").read_text())
DELTA = EXPECTED["delta"]
HEXAPOD = EXPECTED["hexapod"]
LENGTHS = slice(3, 6)  # of the components of a displacement


def numbers(values):
    """A list of the file, in which null stands for what is not determined."""
    return np.array(values, dtype=float)


class Calibrate(ProgramTest):
    def setUp(self):
        super().setUp()
        for path in FILES.iterdir():
            shutil.copyfile(path, self.folder / path.name)

    def calibrated(self, study, measured, change=()):
        """The result for a study of which these texts are replaced."""
        text = (self.folder / study).read_text()
        for old, new in change:
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.write("study.toml", text)
        done = self.succeeds("calibrate", "study.toml", "--measured", measured, "-o", "r.h5")
        with h5py.File(self.folder / "r.h5") as file:
            names = [name.decode() for name in file["fitted"][:]]
            found = {path: value[()] for path, value in self.datasets(file["calibration"])}
        (self.folder / "r.h5").unlink()
        return names, found, done

    @staticmethod
    def datasets(group):
        list_of = []
        group.visititems(lambda path, value: list_of.append((path, value)) if isinstance(value, h5py.Dataset) else None)
        return list_of

    def compare(self, names, found, expected, *, of_estimate, of_sd=1e-6):
        """All numbers of one case. of_estimate: m or rad. of_sd: relative."""
        self.assertEqual(names, expected["names"])
        np.testing.assert_allclose(found["estimate"], numbers(expected["theta"]), rtol=0, atol=of_estimate)
        np.testing.assert_allclose(found["frame"], numbers(expected["frame"]), rtol=0, atol=3 * of_estimate)
        np.testing.assert_allclose(found["sd"], numbers(expected["sd"]), rtol=of_sd)
        for key in ("low", "high"):
            np.testing.assert_allclose(found[key], numbers(expected[key]), rtol=of_sd, atol=2 * of_estimate)
        for key in ("rank", "frame_rank", "dof", "below_noise"):
            self.assertEqual(found[key], expected[key], key)
        seen = int(expected["rank"])
        np.testing.assert_allclose(found["singular_values"][:seen], expected["singular_values"][:seen], rtol=of_sd)
        np.testing.assert_allclose(found["residual"], expected["residual"], rtol=0, atol=3 * of_estimate)
        np.testing.assert_allclose(found["leverage"], expected["leverage"], rtol=0, atol=of_sd)
        for key, name in (("chi2", "chi_square"), ("rms", "rms"), ("p", "p")):
            np.testing.assert_allclose(found[name], expected[key], rtol=1e-5, atol=1e-9, err_msg=key)
        for key, value in expected["indices"].items():
            np.testing.assert_allclose(found[key], value, rtol=of_sd, err_msg=key)
        if "correlation" in expected:
            known = ~np.isnan(numbers(expected["sd"]))
            np.testing.assert_allclose(found["correlation"][np.ix_(known, known)],
                                       numbers(expected["correlation"])[np.ix_(known, known)], rtol=0, atol=of_sd)

    def compare_prediction(self, found, expected):
        """What is left, the controller and the next poses of a case of the printer."""
        np.testing.assert_allclose(found["left/drive_shift"], expected["drive_shift"], rtol=0, atol=1e-11)
        np.testing.assert_allclose(found["left/mean"][:, LENGTHS], expected["left"]["mean"], rtol=0, atol=1e-11)
        np.testing.assert_allclose(found["left/sd"][:, LENGTHS], expected["left"]["sd"], rtol=1e-5)
        np.testing.assert_allclose(found["controller/value"], expected["controller"]["value"], rtol=1e-9, atol=1e-11)
        np.testing.assert_allclose(found["controller/sd"], expected["controller"]["sd"], rtol=1e-5)
        np.testing.assert_array_equal(found["next/candidate"], expected["next"]["candidate"])
        np.testing.assert_allclose(found["next/gain"], expected["next"]["gain_bits"], rtol=1e-5)

    def test_printer_by_least_squares(self):
        expected = DELTA["measured"]["cases"]["least squares"]
        names, found, done = self.calibrated("delta-measured.toml", "delta-heights.csv")
        self.compare(names, found, expected, of_estimate=1e-11)
        np.testing.assert_allclose(found["standardised"], expected["standardised"], rtol=1e-5)
        np.testing.assert_allclose(found["outlier_limit"], expected["outlier_limit"], rtol=1e-10)
        self.compare_prediction(found, expected)
        self.assertEqual(done.stderr, b"")

    def test_printer_with_estimated_noise(self):
        expected = DELTA["measured"]["cases"]["least squares, sd estimated"]
        names, found, _ = self.calibrated("delta-measured.toml", "delta-heights.csv", [("next  ", 'sd = "estimated"\nnext  ')])
        self.compare(names, found, expected, of_estimate=1e-11)
        np.testing.assert_allclose(found["standardised"], expected["standardised"], rtol=1e-5)

    def test_printer_with_prior(self):
        expected = DELTA["measured"]["cases"]["tolerances as prior"]
        names, found, _ = self.calibrated("delta-measured.toml", "delta-heights.csv",
                                          [("next  ", 'prior = "tolerances"\nnext  ')])
        self.compare(names, found, expected, of_estimate=1e-11)
        np.testing.assert_allclose(found["standardised"], expected["standardised"], rtol=1e-5)
        self.compare_prediction(found, expected)

    def test_outlier(self):
        expected = DELTA["measured"]["cases"]["least squares, the sixth height 80 um too high"]
        text = (self.folder / "delta-heights.csv").read_text()
        self.write("wrong.csv", text.replace("-51.962,0,-72.8,", "-51.962,0,7.2,"))
        names, found, done = self.calibrated("delta-measured.toml", "wrong.csv")
        self.compare(names, found, expected, of_estimate=1e-11)
        self.compare_prediction(found, expected)
        self.assertEqual(list(np.flatnonzero(found["outlier"])), [4, 5])
        self.assertIn("residual 1.46 of the noise, p = 1e-04: deviation_z of p5 is 4.6 standard deviations off",
                      done.stderr.decode())


if __name__ == "__main__":
    main()
