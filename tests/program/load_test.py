"""Loads in a study that replace those of the mechanism's file: forces agree with statics computed here, and two
studies with different loads differ as the loads do. A linear Delta: six rods with ball joints, three carriages on
rails."""

import os
import re
from pathlib import Path

import h5py
import numpy as np

from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"]) / "mechanisms"
RAILS, RADIUS, HALF, RISE, HEIGHT = 0.220, 0.060, 0.035, 0.300, 0.200  # m
EFFECTOR, CARRIAGE, GRAVITY = 0.4, 0.25, 9.81  # kg, m/s^2
TOOL = np.array([0.0, 0.0, -0.070])
POSES = np.array([(0.0, 0.0, HEIGHT), (0.05, -0.03, 0.21), (-0.06, 0.04, 0.16)])
RODS = [(side, k) for side in ("left", "right") for k in (1, 2, 3)]

# Cross-section of a rod (m^2), and compliances of a ball (m/N) and of a rail along (m/N) and about its axes (rad/(N
# m)).
AREA = np.pi / 4.0 * (0.008 ** 2 - 0.006 ** 2)
BALL = 1.0 / 20e6
RAIL = np.array([1.0 / 40e6, 1.0 / 40e6, 1.0 / 2e6, 1.0 / 15000.0, 1.0 / 15000.0, 1.0 / 9000.0])

FULL = ("gravity = [0, 0, '-9.81 m/s^2']", "force = ['12 N', '-7 N', '-30 N']",
        "moment = ['0.3 N m', '-0.2 N m', '0.5 N m']")
ERRORS = ["foot_x_1", "tilt_y_2", "zero_3", "rod_left_1", "ball_left_z_2"]


def turned(points, k):
    angle = 2.0 * np.pi * (k - 1) / 3.0
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ points


class Statics:
    """Of the perfect machine at a place of the effector."""

    def __init__(self, place):
        ends = np.array([turned([RAILS, HALF if side == "left" else -HALF, 0.0], k) for side, k in RODS])
        self.arms = np.array([turned([RADIUS, HALF if side == "left" else -HALF, 0.0], k) for side, k in RODS])
        down = place + self.arms
        rod = np.hypot(RAILS - RADIUS, RISE)
        ends[:, 2] = down[:, 2] + np.sqrt(rod ** 2 - np.sum((ends - down)[:, :2] ** 2, axis=1))
        self.ends, self.rod = ends, rod
        self.along = (down - ends) / rod
        self.wrenches = np.vstack([self.along.T, np.cross(self.arms, self.along).T])  # [6 x rods]

    def rods(self, force, moment):
        """How hard each rod pushes the effector, under this force and moment at its origin."""
        return np.linalg.solve(self.wrenches, -np.concatenate([force, moment]))

    def rails(self, pushes, weight, own=(0, np.zeros(3))):
        """Wrench of each rail on its carriage at the place of the carriage at home, in the axes of the rail [3 x 6]. `own`:
        the number of a carriage and a force on its origin."""
        found = []
        for k in (1, 2, 3):
            home = turned(np.array([RAILS, 0.0, HEIGHT + RISE]), k)
            origin = home + [0.0, 0.0, self.ends[k - 1, 2] - home[2]]
            forces = [(-pushes[i] * self.along[i], self.ends[i]) for i, (_, tower) in enumerate(RODS) if tower == k]
            forces.append((np.array([0.0, 0.0, -weight]) + (own[1] if own[0] == k else 0.0), origin))
            total = sum(force for force, _ in forces)
            about = sum(np.cross(point - home, force) for force, point in forces)
            back = np.array([turned(axis, k) for axis in np.eye(3)])
            found.append(np.concatenate([back @ -total, back @ -about]))
        return np.array(found)

    def deflection(self, force, moment, weight):
        """Of the effector's origin by the principle of virtual forces: the joints' and rods' own compliances."""
        rod = 2.0 * BALL + self.rod / (130e9 * AREA)
        pushes = self.rods(force, moment)
        rails = self.rails(pushes, weight)
        found = []
        for axis in np.eye(3):
            virtual = self.rods(axis, np.zeros(3))
            found.append(rod * pushes @ virtual + np.sum(RAIL * rails * self.rails(virtual, 0.0)))
        return np.array(found)


class Loads(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("linear-delta.toml", (DATA / "linear-delta.toml").read_text())
        self.write("poses.csv", "x,y,z\n" + "".join(",".join(map(repr, pose)) + "\n" for pose in POSES.tolist()))
        self.write("errors.csv", "rod_left_1\n0\n")

    def study(self, load, analysis='kind = "evaluate"', fidelity="first-order"):
        table = "" if load is None else "[mechanism.load]\n" + "".join(line + "\n" for line in load)
        self.write("study.toml", f"""\
format = "poesy-study"
version = 1
mechanism.file = "linear-delta.toml"
mechanism.fidelity = "{fidelity}"
poses = {{ select = "file", file = "poses.csv" }}
errors.linear = {{ distribution = "normal", sigma = "0.1 mm" }}
errors.angular = {{ distribution = "normal", sigma = "0.02 deg" }}
{table}[analysis]
{analysis}
""")

    def evaluated(self, load, fidelity="first-order", errors="errors.csv"):
        """Responses [poses] by name, of the machine without errors."""
        self.study(load, fidelity=fidelity)
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", errors, "-o", "out.h5", "--quiet")
        with h5py.File(self.folder / "out.h5") as file:
            self.assertLessEqual(file["evaluate/status"][:].max(), 1)
            return {name: file["evaluate"][name][:, 0] for name in file["evaluate"] if file["evaluate"][name].ndim == 2}

    def assert_follows(self, found, pose, force, moment, weight, tolerance, own=(0, np.zeros(3))):
        """Rods, drives and rails under this force and moment at the effector's origin, and this weight of a carriage."""
        statics = Statics(POSES[pose])
        pushes = statics.rods(force, moment)
        size = tolerance * np.linalg.norm(np.concatenate([force, [weight], own[1]]))
        for (side, k), push in zip(RODS, pushes):
            # A rod carries only a force along its axis, which is the z axis of its lower ball.
            for axis, expected in (("x", 0.0), ("y", 0.0), ("z", push)):
                self.assertAlmostEqual(found[f"reaction_C_{side}_{k}_f{axis}"][pose], expected, delta=size)
            self.assertAlmostEqual(found[f"force_{side}_{k}"][pose], abs(push), delta=size)
        rails = statics.rails(pushes, weight, own)
        for k, rail in enumerate(rails, 1):
            self.assertAlmostEqual(found[f"actuator_q_rail_{k}"][pose], rail[2], delta=size)
            self.assertAlmostEqual(found[f"force_rail_{k}"][pose], np.linalg.norm(rail[:3]), delta=size)
            for name, value in zip(("fx", "fy", "fz", "mx", "my", "mz"), rail):
                self.assertAlmostEqual(found[f"reaction_q_rail_{k}_{name}"][pose], value, delta=size)
        # Sums of forces, which can be checked without the statics of single rods.
        lifts = [found[f"reaction_C_{side}_{k}_fz"][pose] * along[2] for (side, k), along in zip(RODS, statics.along)]
        self.assertAlmostEqual(sum(lifts), -force[2], delta=6.0 * size)
        drives = sum(found[f"actuator_q_rail_{k}"][pose] for k in (1, 2, 3))
        self.assertAlmostEqual(drives, 3.0 * weight - force[2] - own[1][2], delta=6.0 * size)

    def test_load_of_the_study(self):
        """It goes in the place of the file's, which pushes the tool by (3, -2, 5) N besides gravity."""
        weight = np.array([0.0, 0.0, -EFFECTOR * GRAVITY])
        at_tool = {None: np.array([3.0, -2.0, 5.0]), FULL: np.array([12.0, -7.0, -30.0])}
        for load, push in at_tool.items():
            moment = np.cross(TOOL, push) + (np.array([0.3, -0.2, 0.5]) if load else 0.0)
            found = self.evaluated(load)
            rough = self.evaluated(load, "exact")
            for pose in range(len(POSES)):
                self.assert_follows(found, pose, push + weight, moment, CARRIAGE * GRAVITY, 1e-9)
                # With exact solves the parts give way by some micrometres, while the statics here are of the nominal
                # places.
                self.assert_follows(rough, pose, push + weight, moment, CARRIAGE * GRAVITY, 3e-3)

    def test_gravity_and_force_apart(self):
        """What the study's load does not say is not taken from the file's."""
        found = self.evaluated(["force = [0, 0, '-20 N']", "at = ['10 mm', 0, 0]"])
        down = np.array([0.0, 0.0, -20.0])
        for pose in range(len(POSES)):
            self.assert_follows(found, pose, down, np.cross([0.01, 0.0, 0.0], down), 0.0, 1e-9)
        # The gravity of the moon.
        found = self.evaluated(["gravity = [0, 0, '-1.62 m/s^2']"])
        for pose in range(len(POSES)):
            self.assert_follows(found, pose, np.array([0.0, 0.0, -EFFECTOR * 1.62]), np.zeros(3), CARRIAGE * 1.62, 1e-9)
        found = self.evaluated([])
        self.assertEqual(max(np.abs(value).max() for name, value in found.items()
                             if name.startswith(("force", "actuator", "reaction", "moment", "strain"))), 0.0)

    def test_load_on_another_body(self):
        """A force on a carriage goes into its rail and into no rod."""
        force = np.array([4.0, 1.0, -15.0])
        found = self.evaluated(["body = 'carriage_2'", "force = ['4 N', '1 N', '-15 N']"])
        for pose in range(len(POSES)):
            self.assert_follows(found, pose, np.zeros(3), np.zeros(3), 0.0, 1e-9, (2, force))

    def test_deflection(self):
        """By how much parts give way: by virtual forces, from the compliances of the file."""
        found = self.evaluated(FULL)
        exact = self.evaluated(FULL, "exact")
        push = np.array([12.0, -7.0, -30.0])
        for pose, place in enumerate(POSES):
            expected = Statics(place).deflection(
                push + [0.0, 0.0, -EFFECTOR * GRAVITY], np.cross(TOOL, push) + [0.3, -0.2, 0.5], CARRIAGE * GRAVITY)
            self.assertGreater(np.linalg.norm(expected), 5e-6)
            for values, tolerance in ((found, 1e-9), (exact, 1e-2)):
                moved = np.array([values[axis][pose] for axis in "xyz"])
                self.assertLess(np.linalg.norm(moved - expected), tolerance * np.linalg.norm(expected))

    def test_two_studies_differ_as_their_loads(self):
        """Machines with the same errors, run under two loads: to first order each signed response differs by what the
        difference of the loads does to a machine without errors. Of the exact solution the means do, to a few per cent."""
        signed = ["x", "y", "z", "theta_x", "theta_y", "theta_z", *(f"actuator_q_rail_{k}" for k in (1, 2, 3)),
                  *(f"reaction_C_{side}_{k}_fz" for side, k in RODS)]
        first = ["gravity = [0, 0, '-9.81 m/s^2']", "force = ['5 N', 0, '-10 N']"]
        second = ["gravity = [0, 0, '-9.81 m/s^2']", "force = [0, '8 N', '-40 N']"]
        alone = self.evaluated(["force = ['-5 N', '8 N', '-30 N']"])
        analysis = f'kind = "monte-carlo"\ndraws = "per machine"\nfactors = {ERRORS}\nsamples = 400'
        for fidelity, tolerance in (("first-order", 1e-9), ("exact", 0.03)):
            means, deviations = [], []
            for load in (first, second):
                self.study(load, analysis, fidelity)
                self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
                with h5py.File(self.folder / "out.h5") as file:
                    names = list(file["responses/name"].asstr())
                    rows = [names.index(name) for name in signed]
                    means.append(dict(zip(signed, file["monte_carlo/mean"][:][rows])))
                    deviations.append(dict(zip(signed, file["monte_carlo/std"][:][rows])))
            for name in signed:
                expected = alone[name]
                size = np.abs(expected).max()
                np.testing.assert_allclose(means[1][name] - means[0][name], expected, rtol=0.0, atol=tolerance * size,
                                           err_msg=f"{fidelity} {name}")
                if fidelity == "first-order":
                    # The scatter is caused by the errors alone, so the load does not change it.
                    np.testing.assert_allclose(deviations[1][name], deviations[0][name], rtol=1e-9, atol=1e-9 * size)

    def test_the_load_is_part_of_the_result(self):
        """Resolved studies say it, and a sample is replayed under it."""
        self.study(FULL, f'kind = "monte-carlo"\ndraws = "per pose"\nfactors = {ERRORS}\nsamples = 20', "exact")
        told = self.succeeds("check", "study.toml")
        self.assertRegex(told, r'\[mechanism\.load\]\n(.*\n)?gravity = \[.*-9\.81 m/s\^2"?\]')
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        self.study(["force = [0, 0, '500 N']"], 'kind = "evaluate"')  # the study in the folder now has another load
        told = self.succeeds("replay", "out.h5", "all", "1", "7")
        self.assertIn("status: the same", told)
        value = dict(re.findall(r"^  (\S+) +(\S+)", told, re.MULTILINE))
        drives = sum(float(value[f"actuator_q_rail_{k}"]) for k in (1, 2, 3))
        self.assertAlmostEqual(drives, 30.0 + (EFFECTOR + 3.0 * CARRIAGE) * GRAVITY, delta=0.1)


if __name__ == "__main__":
    main()
