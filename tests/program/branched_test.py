"""Mechanisms from files with bodies, compared with independent kinematics: a delta printer with rods that share
carriages, and an arm with a bell crank at its elbow. First the answers to users' questions, then random errors, then
yields."""

import os
from pathlib import Path

import h5py
import numpy as np

from own_kinematics import BellCrank, SixRods
from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"]) / "mechanisms"
# Poses (x, y, z in m): the middle of the bed, and six places on a circle.
ROUND = np.radians(range(0, 360, 60))
PLACES = np.array([(0.0, 0.0, 0.0)] + [(0.05 * np.cos(a), 0.05 * np.sin(a), 0.0) for a in ROUND])
PLACE_OF = {"middle": 0, "tower A": 1, "left of A": 2, "right of A": 6}
DISPLACEMENT = ("x", "y", "z", "theta_x", "theta_y", "theta_z")


def table(columns):
    """CSV of columns by name, to the last bit."""
    rows = zip(*(np.asarray(column).tolist() for column in columns.values()))
    return ",".join(columns) + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows)


class Branched(ProgramTest):
    def evaluated(self, file, poses, errors):
        """The platform's displacement, and the gap if there is one, for every pose and row of errors: [M x N x 6 or 7]."""
        self.write(file, (DATA / file).read_text())
        self.write("poses.csv", table(poses))
        self.write("errors.csv", table(errors))
        self.write("study.toml", f'format = "poesy-study"\nversion = 1\nmechanism.file = "{file}"\n'
                                 'analysis.kind = "evaluate"\n')
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "out.h5",
                      "--quiet")
        with h5py.File(self.folder / "out.h5") as result:
            group = result["evaluate"]
            self.assertLessEqual(group["status"][:].max(), 1)  # converged, or stagnated at rounding
            names = [*DISPLACEMENT, *(["gap"] if "gap" in group else [])]
            return np.stack([group[name][:] for name in names], -1)

    def assert_same(self, found, own):
        """To 1e-9 of each displacement and of each rotation; 1e-13 m and rad are rounding."""
        for part in (slice(0, 3), slice(3, 6)):
            off = np.linalg.norm(found[..., part] - own[..., part], axis=-1)
            size = np.linalg.norm(own[..., part], axis=-1)
            self.assertLessEqual((off - 1e-9 * size).max(), 1e-13)


def columns(points, names):
    return dict(zip(names, points.T))


class Printer(Branched):
    """Rods of 217 mm that reach 95 mm, balls of the effector on a radius of 30 mm, 46 mm between the rods of a pair."""

    FILE = "printer.toml"

    def displacement(self, errors):
        return self.evaluated(self.FILE, columns(PLACES, "xyz"), errors)

    def rows(self, *cases):
        """Of errors in m and rad by name; the others are zero."""
        names = sorted({name for case in cases for name in case})
        return {name: np.array([case.get(name, 0.0) for case in cases]) for name in names}

    def test_file_is_short(self):
        self.assertLessEqual(len((DATA / self.FILE).read_text().splitlines()), 45)

    def test_answers(self):
        """How far is the nozzle off, and how is the effector tilted? To the digits of the answers."""
        found = self.displacement(self.rows(
            {"rod_left_1": 0.1e-3}, {"rod_left_1": 0.5e-3, "rod_right_1": 0.5e-3}, {"tower_y_1": 1e-3},
            {"endstop_1": 0.5e-3}, {"lean_y_1": np.radians(0.3)}))
        rise = 1e6 * found[..., 2]
        tilted = np.degrees(np.hypot(found[..., 3], found[..., 4]))
        for row, values, place, expected, digits in (
                (0, tilted, "middle", 0.092, 3), (0, tilted, "tower A", 0.110, 3),    # one rod 0.1 mm too long
                (1, rise, "middle", -184, 0), (1, rise, "tower A", -369, 0),          # both rods of a pair 0.5 mm too long
                (2, rise, "left of A", -108, 0), (2, rise, "right of A", 111, 0)):    # tower A 1 mm to the left
            self.assertEqual(round(values[PLACE_OF[place], row], digits), expected, (row, place))
        # Errors that are equal for both rods of a pair do not tilt the effector, because the rods stay parallel.
        self.assertLess(tilted[:, 1:4].max(), 1e-12)

    def test_any_errors(self):
        """All 39 at once: carriages move both of their rods."""
        generator = np.random.default_rng(2)
        names = SixRods.names
        sizes = np.where([name.startswith("lean") for name in names], 5e-3, 0.5e-3)
        errors = dict(zip(names, sizes[:, None] * generator.standard_normal((len(names), 60))))
        self.assert_same(self.displacement(errors), SixRods().displacement(errors, PLACES))

    def test_each_error_alone(self):
        """A ball of the effector that is off its place across its rod acts by its square: with 0.5 mm the effector rises
        by 0.1 um in the middle. On the left of tower A it is not across, and the effector tilts by 0.107 deg."""
        names = SixRods.names
        sizes = np.where([name.startswith("lean") for name in names], 5e-3, 0.5e-3)
        errors = dict(zip(names, np.diag(sizes)))
        found = self.displacement(errors)
        self.assert_same(found, SixRods().displacement(errors, PLACES))
        tilted = np.degrees(np.hypot(found[..., 3], found[..., 4]))
        self.assertEqual(round(tilted[PLACE_OF["left of A"], names.index("ball_left_y_1")], 3), 0.107)

    def test_carriages(self):
        """They go where tower, lean and end stop put them, whatever the rods do."""
        generator = np.random.default_rng(4)
        errors = {name: 1e-3 * generator.standard_normal(20) for name in SixRods.names}
        self.displacement(errors)
        origins, turns = SixRods().carriages(errors, PLACES)
        with h5py.File(self.folder / "out.h5") as result:
            for k in (1, 2, 3):
                found = [result[f"evaluate/carriage_{k}_{name}"][:] for name in DISPLACEMENT]
                self.assertLess(np.abs(np.stack(found[:3], -1) - origins[:, :, k - 1]).max(), 1e-14)
                self.assertLess(np.abs(np.stack(found[3:], -1) - turns[:, k - 1]).max(), 1e-14)

    def run_yield(self, sizes, limits, file=FILE, samples=20000, calibrated=False):
        """Share of the machines within the limits at all places, and its interval."""
        self.write(file, (DATA / file).read_text())
        self.write("places.csv", table(columns(PLACES, "xyz")))
        override = "".join(f'{name} = {{ distribution = "normal", sigma = "{size}" }}\n'
                           for name, size in sizes.items())
        self.write("study.toml", f"""\
format = "poesy-study"
version = 1
mechanism.file = "{file}"
poses = {{ select = "file", file = "places.csv" }}
[errors.override]
{override}[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = {list(sizes)}
samples = {samples}
calibrated = {str(calibrated).lower()}
limits = {{ {", ".join(f'{name} = "{limit}"' for name, limit in limits.items())} }}
""")
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        with h5py.File(self.folder / "out.h5") as result:
            return result["yield/value"][()]

    def own_yield(self, sizes, within, count=40000):
        """Of machines drawn here, `sizes` in m and rad."""
        generator = np.random.default_rng(17)
        good = 0
        for _ in range(10):
            errors = {name: size * generator.standard_normal(count // 10) for name, size in sizes.items()}
            good += np.all(within(SixRods().displacement(errors, PLACES)), axis=0).sum()
        return good / count

    def assert_yield(self, found, own, samples=20000, count=40000):
        """Within 4.5 standard errors: a right program fails in one of 150 000 runs with other seeds."""
        error = np.sqrt(own * (1.0 - own) * (1.0 / samples + 1.0 / count))
        self.assertLess(abs(found - own), 4.5 * error, (found, own))

    def test_yield_of_end_stops(self):
        """An end stop lifts both rods of its carriage. Six end stops, one for each rod, would look better than three are."""
        own = self.own_yield({f"endstop_{k}": 5e-5 for k in (1, 2, 3)}, lambda moved: np.abs(moved[..., 2]) <= 1e-4)
        self.assertAlmostEqual(own, 0.9733, delta=0.0015)
        self.assert_yield(self.run_yield({f"endstop_{k}": "0.05 mm" for k in (1, 2, 3)}, {"z": "0.1 mm"}), own)
        six = self.run_yield({f"stop_{k}": "0.05 mm" for k in range(1, 7)}, {"z": "0.1 mm"}, "delta6.toml")
        self.assertGreater(six, own + 0.008)

    def test_yield_of_rods(self):
        """Three motors cannot turn the effector, so calibration does not help either."""
        rods = [f"rod_{side}_{k}" for side in ("left", "right") for k in (1, 2, 3)]
        own = self.own_yield(dict.fromkeys(rods, 1e-4),
                             lambda moved: np.linalg.norm(moved[..., 3:], axis=-1) <= np.radians(0.1))
        self.assertAlmostEqual(own, 0.0324, delta=0.002)
        for calibrated in (False, True):
            found = self.run_yield(dict.fromkeys(rods, "0.1 mm"), {"rotation": "0.1 deg"}, calibrated=calibrated)
            self.assert_yield(found, own)

    def test_yield_of_all_errors(self):
        """Two limits at once."""
        sizes = {name: np.radians(0.03) if name.startswith("lean") else 3e-5 for name in SixRods.names}

        def within(moved):
            turned = np.linalg.norm(moved[..., 3:], axis=-1) <= np.radians(0.2)
            return turned & (np.linalg.norm(moved[..., :3], axis=-1) <= 3e-4)

        own = self.own_yield(sizes, within)
        self.assertTrue(0.2 < own < 0.8, own)
        words = {name: "0.03 deg" if name.startswith("lean") else "0.03 mm" for name in sizes}
        self.assert_yield(self.run_yield(words, {"rotation": "0.2 deg", "position": "0.3 mm"}), own)


class UniversalJoints(Branched):
    """One rod with universal joints is no pair of rods: it holds the effector against turning about the rod itself, and a
    pair about what is square to the rods and to the line between their balls."""

    FILE = "printer-universal.toml"

    def displacements(self, **errors):
        """Of the effector on rods with universal joints, and on pairs, whose rods have the same errors."""
        pairs = {}
        for name, value in errors.items():
            for twin in ((f"rod_left_{name[-1]}", f"rod_right_{name[-1]}") if name.startswith("rod") else (name,)):
                pairs[twin] = value
        places = columns(PLACES, "xyz")
        return self.evaluated(self.FILE, places, errors), self.evaluated(Printer.FILE, places, pairs)

    def test_matched_pairs(self):
        """Where no carriage is turned, both move alike, and tilt nothing."""
        generator = np.random.default_rng(8)
        names = [f"{name}_{k}" for name in ("tower_x", "tower_y", "endstop", "rod") for k in (1, 2, 3)]
        universal, pairs = self.displacements(**{name: 0.5e-3 * generator.standard_normal(20) for name in names})
        self.assert_same(universal, pairs)
        self.assertLess(np.abs(pairs[..., 3:]).max(), 1e-13)
        self.assertGreater(np.abs(pairs[..., :3]).min(), 1e-7)

    def test_turned_carriages(self):
        """To first order: of the turning of each carriage the effector takes over what its rods hold."""
        size = 1e-5
        generator = np.random.default_rng(9)
        names = [f"lean_{axis}_{k}" for k in (1, 2, 3) for axis in "xy"]
        leans = size * generator.standard_normal((20, 6))
        universal, pairs = self.displacements(**dict(zip(names, leans.T)))
        rods = SixRods()
        for place, point in enumerate(PLACES):
            legs = (rods.down + point)[:3] - np.concatenate([rods.up[:3, :2], rods.heights(point[None]).T], axis=1)
            bars = rods.up[:3] - rods.up[3:]
            across = np.cross(bars, legs)
            for found, held in ((universal, np.cross(across, bars)), (pairs, across)):
                turned_by = np.concatenate([leans.reshape(20, 3, 2), np.zeros((20, 3, 1))], -1)
                expected = np.linalg.solve(held, np.sum(held * turned_by, -1).T).T
                self.assertLess(np.abs(found[place, :, 3:] - expected).max(), 100.0 * size ** 2)
        self.assertGreater(np.abs(universal - pairs)[..., 3:].max(), size)


class Crank(Branched):
    """A loop that holds the crank on the arm, and one that holds the effector on the crank."""

    FILE = "bell-crank.toml"
    ANGLES = np.radians([(100, 45), (120, 60), (95, 30), (80, 40)])  # poses: angles of arm and forearm

    def displacement(self, errors):
        return self.evaluated(self.FILE, columns(BellCrank().wrist(self.ANGLES), "xy"), errors)

    def test_answers(self):
        """By how much is the effector turned where a rod is 0.1 mm too long?"""
        found = self.displacement({"lower_rod": np.array([1e-4, 0.0]), "upper_rod": np.array([0.0, 1e-4])})
        turned = np.degrees(found[..., 5])
        for pose, row, expected in ((0, 0, -0.575), (0, 1, -1.163), (1, 0, -0.594), (1, 1, -2.367)):
            self.assertEqual(round(turned[pose, row], 3), expected)
        # The rods only rotate the effector about the wrist; the wrist is held by arm and forearm.
        self.assertLess(np.abs(found[..., :5]).max(), 1e-13)

    def test_any_errors(self):
        """All at once. They lie in the plane, where nothing is over-constrained: the loops close."""
        names = BellCrank.names
        generator = np.random.default_rng(6)
        errors = dict(zip(names, 1e-4 * generator.standard_normal((len(names), 60))))
        found = self.displacement(errors)
        self.assert_same(found[..., :6], BellCrank().displacement(errors, self.ANGLES))
        self.assertLess(found[..., 6].max(), 1e-13)

    def test_each_error_alone(self):
        """An error across a rod acts by its square: the rod is a little longer, and turns. No gap stays, at any size."""
        names = BellCrank.names
        for size in (1e-5, 1e-4, 3e-4):
            errors = dict(zip(names, size * np.eye(len(names))))
            found = self.displacement(errors)
            self.assertLess(found[..., 6].max(), 1e-13)
            self.assert_same(found[..., :6], BellCrank().displacement(errors, self.ANGLES))

    def test_what_is_understood(self):
        told = self.poesy("models", DATA / self.FILE).stdout.decode()
        for words in ("8 joints (2 actuated), rank 6 of 12 loop equations: 2 freedoms, 6 over-constraints",
                      "the platform has 2 freedoms, of which 0 rotate; 0 idle freedoms",
                      "Limb 4, lower-rod, leads from base to crank.",
                      "Limb 5, upper-rod, leads from crank to platform."):
            self.assertIn(words, told)


if __name__ == "__main__":
    main()
