"""Drives that move several joints: a delta of six rods on three carriages, compared with own kinematics (NumPy)."""

import os
import re
from pathlib import Path

import h5py
import numpy as np

from poesy_program import ProgramTest, main
from six_rods import PLACES, heights, machines

DATA = Path(os.environ["POESY_DATA"])
SIGMA, LIMIT = 1e-4, np.radians(0.1)

STUDY = f"""\
format = "poesy-study"
version = 1
mechanism.file = "delta6.toml"
poses = {{ select = "file", file = "places.csv" }}
errors.linear = {{ distribution = "normal", sigma = "{SIGMA} m" }}
"""
RODS = [f"rod_{k}" for k in range(1, 7)]
YIELD = 'kind = "monte-carlo"\ndraws = "per machine"\nsamples = 4000\nlimits = { rotation = "0.1 deg" }\n'


class SharedDrives(ProgramTest):
    def setUp(self):
        super().setUp()
        self.text = (DATA / "mechanisms/delta6.toml").read_text()
        self.write("delta6.toml", self.text)
        self.write("places.csv", "x [m],y [m],z [m]\n" + "".join(",".join(map(repr, row)) + "\n" for row in PLACES.tolist()))

    def run_study(self, analysis, output, study=STUDY):
        self.write("study.toml", study + f"[analysis]\nfactors = {RODS}\n" + analysis)
        self.succeeds("run", "study.toml", "-o", output, "--quiet")
        return h5py.File(self.folder / output)

    def test_yield_of_three_motors(self):
        """They cannot turn the effector, so calibration leaves the yield as it is."""
        rods = np.random.default_rng(3).normal(0.0, SIGMA, (4000, 6))
        turned_by = machines(rods).correct().rotation().reshape(-1, len(PLACES))
        own = float(np.mean(turned_by.max(axis=1) <= LIMIT))
        self.assertLess(own, 0.05)
        with self.run_study(YIELD + "calibrated = true\n", "calibrated.h5") as file:
            found = file["yield/value"][()]
        with self.run_study(YIELD, "plain.h5") as file:
            plain = file["yield/value"][()]
        self.assertEqual(found, plain)
        # Both shares are of 4000 machines. 4 standard errors: one false alarm in 16 000 runs.
        self.assertLess(abs(found - own), 4.0 * np.sqrt(2.0 * own * (1.0 - own) / 4000))

    def test_yield_of_six_motors(self):
        """Where each rod has a motor of its own, the best correction takes all away."""
        six = self.text.replace('"motor_*"', "true").replace('["x", "y", "z"]', '["x", "y", "z", "rx", "ry", "rz"]')
        six = six.replace('"100 mm"] }', '"100 mm"], ' + ", ".join(f'{r} = ["-1 deg", "1 deg"]' for r in ("rx", "ry", "rz")) + " }")
        self.write("delta6.toml", six)
        table = (self.folder / "places.csv").read_text().splitlines()
        self.write("places.csv", "\n".join([table[0] + ",rx,ry,rz"] + [row + ",0,0,0" for row in table[1:]]))
        with self.run_study(YIELD + "calibrated = true\n", "six.h5") as file:
            self.assertEqual(file["yield/value"][()], 1.0)

    def test_single_machines(self):
        """Of the same errors what an exact search for the three carriages leaves; the program's is to first order."""
        self.run_study(YIELD + "calibrated = true\n", "out.h5").close()
        for sample, pose in ((0, 0), (7, 2), (1234, 5), (3999, 6)):
            text = self.succeeds("replay", "out.h5", "all", pose, sample)
            value = dict(re.findall(r"^  (\S+) +(\S+)", text, re.MULTILINE))
            own = machines(np.array([[float(value[rod]) for rod in RODS]])).correct()
            self.assertGreater(own.rotation()[pose], 1e-4)
            self.assertAlmostEqual(float(value["rotation"]), own.rotation()[pose], delta=3e-6)
            self.assertAlmostEqual(float(value["position"]), np.linalg.norm(own.moved().mean(axis=1)[pose]), delta=1e-7)

    def test_removable_shares(self):
        """Of each rod alone: what its effect has beside the directions of three motors."""
        step = 1e-7
        effects, residuals = [], []
        for rod in range(6):
            error = np.zeros((1, 6))
            error[0, rod] = step
            one = machines(error)
            moved = one.moved().reshape(-1, 18) / step
            A = one.by_motors()
            left = [x - a @ np.linalg.lstsq(a, x, rcond=None)[0] for a, x in zip(A, moved)]
            effects.append(np.sqrt(np.mean(np.square(moved))))
            residuals.append(np.sqrt(np.mean(np.square(left))))
        with self.run_study('kind = "sensitivity"\nsamples = 50\n', "sens.h5") as file:
            self.assertEqual(list(file["factors/name"].asstr()), RODS)
            found = file["separation/removable"][:]
            together = file["separation/removable_together"][()]
        own = 1.0 - np.array(residuals) / np.array(effects)
        np.testing.assert_allclose(found, own, atol=1e-6)
        self.assertLess(found.max(), 0.9)
        self.assertAlmostEqual(together, 1.0 - np.linalg.norm(residuals) / np.linalg.norm(effects), delta=1e-6)

    def test_poses_by_motors(self):
        """A column for each motor, by its name."""
        home = heights(np.zeros((1, 3)))
        lifts = heights(PLACES) - home
        rows = "".join(",".join(map(repr, row)) + "\n" for row in (1e3 * lifts).tolist())
        self.write("places.csv", "motor_1 [mm],motor_2 [mm],motor_3 [mm]\n" + rows)
        with self.run_study('kind = "monte-carlo"\ndraws = "per pose"\nsamples = 50\n', "out.h5") as file:
            found = np.array([file["poses"][axis][:] for axis in "xyz"]).T
        np.testing.assert_allclose(found, PLACES, atol=1e-12)

    def test_what_is_said(self):
        told = self.succeeds("models", "delta6.toml", "-o", "delta6.svg")
        for words in ("42 joints (6 actuated by 3 drives), rank 30 of 30 loop equations: 9 freedoms, 0 over-constraints",
                      "the platform has 3 freedoms, of which 0 rotate; 6 idle freedoms",
                      "Drive motor_2 moves joint q of limb 2 and joint q of limb 5, all by the same displacement from home.",
                      "motor_3                 m displacement of joint q of limb 3 and joint q of limb 6 from home"):
            self.assertIn(words, told)
        picture = (self.folder / "delta6.svg").read_text()
        for words in ("q, driven by motor_1</title>", ">motor_3</text>"):
            self.assertIn(words, picture)
        self.run_study(YIELD + "calibrated = true\n", "out.h5").close()
        bound = "for another point, such as the tool, a calibration can be better"
        self.assertIn(bound, re.sub(r"\s+", " ", self.succeeds("show", "out.h5")))
        self.succeeds("report", "out.h5")
        self.assertIn(bound, (self.folder / "out.html").read_text())
        self.assertIn(bound, self.poesy("run", "study.toml", "-o", "again.h5").stderr.decode())
        self.assertIn(bound, self.succeeds("check", "study.toml"))


if __name__ == "__main__":
    main()
