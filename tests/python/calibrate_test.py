"""Compares poesy.calibrate, called with arrays, with the program's command and with known errors."""

import shutil
import unittest
import warnings
from pathlib import Path

import numpy as np
from package import ROOT, FolderTest, main, poesy

FILES = ROOT / "tests" / "data" / "calibration"
FIT = {"zero_1": 3e-4, "zero_2": -2e-4, "zero_3": 1e-4, "radius": 4e-4}


class Calibrate(FolderTest):
    def setUp(self):
        super().setUp()
        for path in FILES.iterdir():
            shutil.copyfile(path, path.name)
        feet = {f"foot_x_{limb}": 1 for limb in (1, 2, 3)}
        self.study = {
            "mechanism": {"file": "delta-puu.toml"},
            "poses": {"select": "file", "file": "delta-places.csv"},
            "errors": {"linear": {"distribution": "normal", "sigma": "0.3 mm"}},
            "analysis": {
                "calibration": {
                    "fit": list(FIT),
                    "noise": {"z": "0.001 um"},
                    "combinations": {"radius": feet},
                    "controller": {"delta_radius": "R - r + radius"},
                }
            },
        }
        self.poses = np.genfromtxt("delta-places.csv", delimiter=",", skip_header=1) / 1e3

    def measured(self):
        errors = {name: FIT[name] for name in ("zero_1", "zero_2", "zero_3")}
        errors |= {f"foot_x_{limb}": FIT["radius"] for limb in (1, 2, 3)}
        z = poesy.evaluate("delta-puu.toml", self.poses, {name: [value] for name, value in errors.items()})["z"][:, 0]
        return {"x": self.poses[:, 0], "y": self.poses[:, 1], "z": self.poses[:, 2], "deviation_z": z}

    def test_errors_that_are_known_are_found(self):
        found = poesy.calibrate(self.study, self.measured())
        self.assertTrue(found.converged)
        self.assertEqual(list(found), list(FIT))
        for name, value in FIT.items():
            self.assertAlmostEqual(found[name], value, delta=1e-11)
            self.assertLess(found.low[name], found.high[name])
        self.assertAlmostEqual(found.typed["delta_radius"], 95e-3 + FIT["radius"], delta=1e-11)
        self.assertEqual(found.covariance.shape, (4, 4))
        self.assertEqual((found.dof, len(found.measured)), (3, 7))
        self.assertLess(np.abs(found.residual).max(), 1e-12)
        self.assertLess(np.abs(found.left["z"]).max(), 1e-4)
        self.assertEqual(found.left_sd["tip_z"].shape, (7,))

    def test_numbers_are_those_of_the_command(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", poesy.PoesyWarning)
            found = poesy.calibrate("delta-measured.toml", "delta-heights.csv")
        table = np.genfromtxt("delta-heights.csv", delimiter=",", dtype=str)
        columns = {title.split(" [")[0]: list(table[1:, at]) for at, title in enumerate(table[0])}
        unit = {title.split(" [")[0]: 1e-6 if "[um]" in title else 1e-3 for title in table[0]}
        arrays = {
            name: column if name in ("name", "to") else [float(cell) * unit[name] if cell else np.nan for cell in column]
            for name, column in columns.items()
        }
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", poesy.PoesyWarning)
            again = poesy.calibrate("delta-measured.toml", arrays, threads=2)
        for name, value in found.items():
            self.assertAlmostEqual(again[name], value, delta=1e-9 * found.sd[name])

    def test_wrong_tables(self):
        measured = self.measured()
        for change, message in (({"deviation_z": [0.0]}, "columns differ in length"),
                                ({"deviation_q": measured["deviation_z"]}, "column 'deviation_q'"),
                                ({"deviation_z": np.zeros((7, 2))}, "has shape")):
            with self.subTest(message), self.assertRaisesRegex(poesy.StudyError, message):
                poesy.calibrate(self.study, measured | change)
        with self.assertRaisesRegex(poesy.StudyError, "columns differ in length"):
            poesy.calibrate(self.study, {})


if __name__ == "__main__":
    main()
