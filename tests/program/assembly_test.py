"""Machines that cannot be assembled: they are exactly those that independent kinematics cannot solve, for every solver,
metric and size of errors. They are rejects of a yield, and texts, tables and files say so."""

import json
import os
import re
from pathlib import Path

import h5py
import numpy as np

from own_kinematics import MECHANISMS, FiveBar, FiveBarWithArm, FlatDelta, ThreeRpr
from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"]) / "mechanisms"
CONVERGED, STAGNATED, CAP, NOT_ASSEMBLED = 0, 1, 2, 5
# Standard deviations of the errors (m) with which a few to 30 % of the machines cannot be assembled.
SIZES = {FiveBar: 5e-5, FiveBarWithArm: 5e-5, ThreeRpr: 1.2e-3, FlatDelta: 8e-5}

MONTE_CARLO = """\
format = "poesy-study"
version = 1
mechanism.file = "{file}"
poses = {{ select = "file", file = "pose.csv" }}
errors.linear = {{ distribution = "normal", sigma = "{sigma} m" }}
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = {factors}
samples = {samples}
limits = {{ position = "{limit} m" }}
[solver]
{solver}
[run]
seed = 11
"""


def drawn(mechanism, count, size, seed=3):
    """Lengths in the plane, or along it."""
    generator = np.random.default_rng(seed)
    return {name: size * generator.standard_normal(count) for name in mechanism.lengths}


class Assembly(ProgramTest):
    def prepare(self, mechanism):
        self.write(mechanism.file, (DATA / mechanism.file).read_text())
        self.write("pose.csv", ",".join(mechanism.pose) + "\n" + ",".join(map(repr, map(float, mechanism.pose.values()))))

    def evaluated(self, mechanism, errors, solver=""):
        """Status [N] and responses [N] by name."""
        self.prepare(mechanism)
        rows = np.column_stack(list(errors.values()))
        self.write("errors.csv", "\n".join([",".join(errors), *(",".join(map(repr, map(float, row))) for row in rows)]))
        self.write("s.toml", f'format = "poesy-study"\nversion = 1\nmechanism.file = "{mechanism.file}"\n'
                             f'[analysis]\nkind = "evaluate"\n[solver]\n{solver}\n')
        self.succeeds("evaluate", "s.toml", "--poses", "pose.csv", "--errors", "errors.csv", "-o", "e.h5", "--quiet")
        with h5py.File(self.folder / "e.h5") as file:
            group = file["evaluate"]
            return group["status"][0], {name: group[name][0] for name in ("x", "y")}, list(
                group["status"].attrs["status_names"])

    def check(self, mechanism, errors, solver=""):
        count = len(next(iter(errors.values())))
        margins = mechanism.margins(errors, count)
        status, _, _ = self.evaluated(mechanism, errors, solver)
        np.testing.assert_array_equal(status == NOT_ASSEMBLED, margins < 0.0, f"{mechanism.file} {solver}")
        return status, margins

    def test_rows_without_a_solution_are_those_of_own_kinematics(self):
        for mechanism in MECHANISMS:
            for solver in ('method = "newton"', 'method = "gauss-newton"'):
                status, margins = self.check(mechanism, drawn(mechanism, 3000, SIZES[type(mechanism)]), solver)
                self.assertGreater((margins < 0.0).sum(), 50)
                # Gauss-Newton may reach the iteration cap if limbs are almost stretched.
                if "gauss" not in solver:
                    self.assertLessEqual(set(status), {CONVERGED, STAGNATED, NOT_ASSEMBLED})

    def test_published_metric(self):
        for mechanism in (FiveBar(), ThreeRpr()):
            for method in ("newton", "gauss-newton"):
                self.check(mechanism, drawn(mechanism, 1500, SIZES[type(mechanism)]),
                           f'metric = "published"\nmethod = "{method}"')

    def test_no_jump_where_errors_grow(self):
        """The same draws at twelve sizes, from one at which every machine fits to one at which half of them do."""
        for mechanism in MECHANISMS:
            shares = []
            for scale in np.geomspace(0.1, 4.5, 12):
                status, _ = self.check(mechanism, drawn(mechanism, 400, scale * SIZES[type(mechanism)], seed=8))
                shares.append((status == NOT_ASSEMBLED).mean())
            self.assertEqual(shares[0], 0.0)
            self.assertGreater(shares[-1], 0.2)
            self.assertGreater(len(set(shares)), 6, shares)

    def test_at_the_border(self):
        """One error alone, from just possible to just not: 1e-9 of the reach on either side."""
        for mechanism, name in ((FiveBar(), "distal"), (FiveBarWithArm(), "distal"), (FlatDelta(), "rod_1"),
                                (ThreeRpr(), "leg_1")):
            low, high = 0.0, -0.05
            for _ in range(80):
                middle = 0.5 * (low + high)
                good = mechanism.margins({name: np.array([middle])}, 1)[0] > 0.0
                low, high = (middle, high) if good else (low, middle)
            steps = np.array([-1e-3, -1e-5, -1e-7, -1e-9, 1e-9, 1e-7, 1e-5, 1e-3])
            status, _, _ = self.evaluated(mechanism, {name: low + 0.1 * steps})
            np.testing.assert_array_equal(status == NOT_ASSEMBLED, steps < 0.0, mechanism.file)

    def check_out_of_the_plane(self, mechanism, limbs, axes, share, solvers):
        """Errors out of the plane leave a mismatch that no joint takes away, and move the border by their square alone."""
        size = share * SIZES[type(mechanism)]
        errors = drawn(mechanism, 2000, SIZES[type(mechanism)])
        generator = np.random.default_rng(9)
        for limb in limbs:
            errors[f"lift_{limb}"] = size * generator.standard_normal(2000)
            for axis in axes:
                errors[f"tilt_{axis}_{limb}"] = size / 0.1 * generator.standard_normal(2000)
        margins = mechanism.margins(errors, 2000)
        clear = np.abs(margins) > 60.0 * size ** 2 / 0.1
        self.assertGreater(clear.mean(), 0.8)
        self.assertGreater((margins[clear] < 0.0).sum(), 20)
        for solver in solvers:
            status, _, _ = self.evaluated(mechanism, errors, solver)
            np.testing.assert_array_equal((status == NOT_ASSEMBLED)[clear], margins[clear] < 0.0,
                                          f"{mechanism.file} {share} {solver}")

    def test_errors_out_of_the_plane(self):
        """However a solve weighs radians against metres."""
        solvers = ("", 'metric = "published"', 'metric = "published"\nmethod = "gauss-newton"')
        for share in (0.1, 1.0, 4.0):
            self.check_out_of_the_plane(FiveBar(), (1, 2), "xy", share, solvers)
        for share in (0.1, 0.3):
            self.check_out_of_the_plane(ThreeRpr(), (1, 2, 3), "xz", share, solvers)

    def test_bodies_between_limbs(self):
        """Where limbs deform each other through a body, by the platform's metric and with stiffness."""
        solvers = ('metric = "platform"', 'metric = "stiffness"')
        for solver in solvers:
            self.check(FiveBarWithArm(), drawn(FiveBarWithArm(), 2000, SIZES[FiveBarWithArm]), solver)
        for share in (0.1, 1.0, 4.0):
            self.check_out_of_the_plane(FiveBarWithArm(), (1, 2), "xy", share, solvers)

    def run_study(self, mechanism, samples=4000, limit=1.0, solver="", arguments=(), code=0):
        self.prepare(mechanism)
        self.write("mc.toml", MONTE_CARLO.format(
            file=mechanism.file, sigma=SIZES[type(mechanism)], factors=json.dumps(mechanism.lengths), samples=samples,
            limit=limit, solver=solver))
        done = self.poesy("run", "mc.toml", "--quiet", *arguments)
        self.assertEqual(done.returncode, code, done.stderr.decode())
        return done.stdout.decode() + done.stderr.decode()

    def test_they_are_rejects_of_the_yield(self):
        for mechanism in MECHANISMS:
            said = self.run_study(mechanism, samples=8000)
            truth = (mechanism.margins(drawn(mechanism, 200000, SIZES[type(mechanism)], seed=5), 200000) > 0.0).mean()
            with h5py.File(self.folder / "mc.h5") as file:
                found = file["yield/value"][()]
                names = [name.decode() if isinstance(name, bytes) else name for name in file["status"][:]]
                impossible = file["solver/solves_by_status"][names.index("not_assembled")].sum()
                self.assertEqual(impossible, 8000 - round(8000 * found))
                self.assertEqual(file["solver/not_converged"][:].sum(), impossible)
            # Five standard errors of 8000 machines: a correct program fails once in two million runs.
            self.assertLess(abs(found - truth), 5.0 * np.sqrt(truth * (1.0 - truth) / 8000), mechanism.file)
            self.assertIn("% of the samples are machines that cannot be assembled", said)
            self.assertIn("more iterations do not help", said)
            self.assertIn(f"0 not converged, {impossible} cannot be assembled", said)
            for wrong in ("max_iterations", "if that made"):
                self.assertNotIn(wrong, said)

    def test_the_last_iterate_never_counts(self):
        """not_converged = "include" counts unfinished solves, and no machine that does not exist."""
        self.run_study(FiveBar())
        with h5py.File(self.folder / "mc.h5") as file:
            excluded = file["yield/value"][()], file["monte_carlo/count"][:].tolist()
        self.run_study(FiveBar(), solver='not_converged = "include"')
        with h5py.File(self.folder / "mc.h5") as file:
            self.assertEqual((file["yield/value"][()], file["monte_carlo/count"][:].tolist()), excluded)

    def test_what_is_said(self):
        self.run_study(FiveBar())
        shown = self.succeeds("show", "mc.h5")
        self.assertIn("of the rejects cannot be assembled at some pose; elsewhere they are within all limits",
                      " ".join(shown.split()))
        self.assertIn("because the machine cannot be assembled", " ".join(shown.split()))
        self.assertNotIn("would be", shown)
        found = json.loads(self.succeeds("show", "mc.h5", "--json"))
        self.assertGreater(found["solves"]["by_status"]["not_assembled"], 0)
        self.succeeds("report", "mc.h5", "-o", "r.html")
        report = (self.folder / "r.html").read_text()
        self.assertIn("cannot be assembled: its loops do not close, or only past a singular pose", report)
        self.assertIn("larger clearance to singular poses", report)
        self.succeeds("export", "mc.h5", "-d", "csv")
        header, line = (self.folder / "csv/not_converged.csv").read_text().splitlines()
        values = dict(zip(header.split(","), line.split(",")))
        self.assertEqual(values["solves_not_assembled"], values["not_converged"])
        replay = re.search(r"poesy replay (\S+) (\S+) (\d+) (\d+)", shown).groups()
        said = self.succeeds("replay", *replay)
        self.assertIn("not_assembled after", said)
        self.assertIn("status: the same", said)

    def test_a_result_without_them_is_as_it_was(self):
        status, _, names = self.evaluated(FiveBar(), drawn(FiveBar(), 50, 1e-7))
        self.assertLessEqual(set(status), {CONVERGED, STAGNATED})
        self.assertEqual(names, ["converged", "stagnated", "iteration_cap", "singular", "non_finite"])
        _, _, names = self.evaluated(FiveBar(), {"distal": np.array([-1e-3])})
        self.assertEqual(names[5:], ["not_assembled"])


if __name__ == "__main__":
    main()
