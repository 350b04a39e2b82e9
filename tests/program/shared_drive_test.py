"""Drives that move several joints: a delta of six rods on three carriages, held against kinematics of its own (NumPy)."""

import os
import re
from pathlib import Path

import h5py
import numpy as np

from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
ROD, REACH, RADIUS, HALF = 0.217, 0.095, 0.030, 0.023
SIGMA, LIMIT = 1e-4, np.radians(0.1)
PLACES = np.array([(0, 0, 0)] + [(0.05 * np.cos(a), 0.05 * np.sin(a), 0) for a in np.radians(range(0, 360, 60))])


def turned(points, k):
    c, s = np.cos(2 * np.pi * k / 3), np.sin(2 * np.pi * k / 3)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ points


# Of rods 1 to 6: those of carriage k are k and k + 3.
CARRIAGE = np.array([0, 1, 2, 0, 1, 2])
UP = np.array([turned([REACH + RADIUS, side * HALF, 0], k) for side in (1, -1) for k in range(3)])
DOWN = np.array([turned([RADIUS, side * HALF, 0], k) for side in (1, -1) for k in range(3)])


def rotations(vectors):
    """Of rotation vectors [N x 3]."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    x, y, z = vectors.T
    zero = np.zeros_like(x)
    hat = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)
    half = np.sinc(angle / (2 * np.pi)) ** 2 / 2
    return np.eye(3) + np.sinc(angle / np.pi) * hat + half * hat @ hat


def heights(places):
    """Of the carriages without errors, [M x 3]."""
    across = np.linalg.norm((UP - DOWN - places[:, None])[:, :, :2], axis=2)
    return (places[:, 2:] + np.sqrt(ROD**2 - across**2))[:, :3]


class Machines:
    """Platforms [N] on rods of these lengths [N x 6], carriages at these heights [N x 3], by Newton's method."""

    def __init__(self, lengths, carriages, places):
        self.lengths, self.carriages, self.places = lengths, carriages.copy(), places
        self.R, self.p = np.tile(np.eye(3), (len(places), 1, 1)), places.copy()
        self.settle()

    def arms(self):
        return np.einsum("nij,kj->nki", self.R, DOWN)

    def legs(self):
        ends = np.repeat(UP[None], len(self.places), axis=0)
        ends[:, :, 2] = self.carriages[:, CARRIAGE]
        return self.arms() + self.p[:, None] - ends

    def jacobian(self):
        """Of the rods' lengths by the platform's twist [turn, displacement]: [N x 6 x 6]."""
        legs = self.legs()
        along = legs / np.linalg.norm(legs, axis=2)[:, :, None]
        return np.concatenate([np.cross(self.arms(), along), along], axis=2)

    def settle(self):
        for _ in range(8):
            open_by = self.lengths - np.linalg.norm(self.legs(), axis=2)
            step = np.linalg.solve(self.jacobian(), open_by[:, :, None])[:, :, 0]
            self.R, self.p = rotations(step[:, :3]) @ self.R, self.p + step[:, 3:]
        assert np.abs(self.lengths - np.linalg.norm(self.legs(), axis=2)).max() < 1e-14

    def moved(self):
        """The points that the rods hold, from where they should be: [N x 6 x 3]."""
        return self.arms() + self.p[:, None] - (DOWN + self.places[:, None])

    def by_motors(self):
        """Their displacement by each motor, [N x 18 x 3]: a motor lifts both rods of its carriage."""
        J = self.jacobian()
        lifts = J[:, :, 5, None] * np.eye(3)[CARRIAGE]
        twists = np.linalg.solve(J, lifts)
        turns = np.cross(twists[:, None, :3], self.arms()[:, :, :, None], axisa=2, axisb=2, axisc=2)
        return (turns + twists[:, None, 3:]).reshape(len(self.places), 18, 3)

    def correct(self):
        """Moves the motors to where the points' displacement is least: Gauss and Newton's method."""
        for _ in range(4):
            A, moved = self.by_motors(), self.moved().reshape(-1, 18)
            At = A.transpose(0, 2, 1)
            self.carriages -= np.linalg.solve(At @ A, At @ moved[:, :, None])[:, :, 0]
            self.settle()
        return self

    def rotation(self):
        return np.arccos(np.clip((np.trace(self.R, axis1=1, axis2=2) - 1) / 2, -1, 1))


def machines(rods):
    """Each machine with these errors of its rods [N x 6] at each place, place by place: N x 7 platforms."""
    lengths = np.repeat(ROD + rods, len(PLACES), axis=0)
    places = np.tile(PLACES, (len(rods), 1))
    return Machines(lengths, heights(places), places)


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
        # Two shares of 4000 machines each: 4 standard errors, a false alarm in 16 000 runs.
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
        with self.run_study('kind = "monte-carlo"\nsamples = 50\n', "out.h5") as file:
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
        bound = "no real calibration reaches that"
        self.assertIn(bound, re.sub(r"\s+", " ", self.succeeds("show", "out.h5")))
        self.succeeds("report", "out.h5")
        self.assertIn(bound, (self.folder / "out.html").read_text())
        self.assertIn(bound, self.poesy("run", "study.toml", "-o", "again.h5").stderr.decode())
        self.assertIn(bound, self.succeeds("check", "study.toml"))


if __name__ == "__main__":
    main()
