"""Machines, i.e. sets of errors that are the same at all poses: the yield is the share counted from the same errors;
same bits however a study is run; verdicts and exit codes."""

import json
import statistics

import h5py
import numpy

from poesy_program import main
from resumption import MACHINES, UNIFORM, ResumptionTest

ALL_ERRORS = """\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
[poses]
count = 158
[errors]
linear = { distribution = "normal", sigma = "0.1 mm" }
angular = { distribution = "normal", sigma = "0.1 deg" }
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = "all"
samples = 60
limits = { linear_deformation = "1.2 mm", angular_deformation = "0.4 deg" }
"""


UNIFORM_ERRORS = """\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
[solver]
metric = "platform"
[poses]
count = 40
[errors]
linear = { distribution = "uniform", half_width = "0.05 mm" }
angular = { distribution = "uniform", half_width = "0.02 deg" }
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = "deforming-all"
samples = 10000
limits = { gap = "0.07 mm" }
"""


class Machines(ResumptionTest):
    def run_study(self, study, code=0, output="out.h5"):
        self.write("study.toml", study)
        done = self.poesy("run", "study.toml", "-o", output, "--quiet")
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def test_yield_is_what_evaluate_counts(self):
        machines = 60
        self.run_study(ALL_ERRORS)
        rows = [self.errors_of(s, 0) for s in range(machines)]
        self.assertEqual(len(rows[0]), 71)
        self.assertEqual(self.errors_of(17, 93), rows[17])
        names = list(rows[0])
        self.write("errors.csv", "\n".join([",".join(names)] + [",".join(row[name] for name in names) for row in rows]))
        with h5py.File(self.folder / "out.h5") as file:
            axes = sorted(file["poses"], key=lambda name: ["z", "beta", "gamma"].index(name)
                          if name in ("z", "beta", "gamma") else 9)[:3]
            poses = numpy.array([file["poses"][axis][:] for axis in axes]).T
            responses = list(file["responses/name"].asstr())
            limits = dict(zip(file["limits/response"].asstr(), file["limits/limit"][:]))
            found = {name: file["yield"][name][()] for name in
                     ("value", "rejects", "machines", "by_response", "worst_pose_share", "unsolved")}
            largest = file["machines/largest/max"][:]
        self.write("poses.csv", "\n".join([",".join(axes)] + [",".join(map(repr, map(float, pose))) for pose in poses]))
        done = self.poesy("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "rows.h5", "--quiet")
        self.assertIn(done.returncode, (0, 6), done.stderr)
        with h5py.File(self.folder / "rows.h5") as file:
            solved = file["evaluate/status"][:] <= 1
            good = {name: solved & (numpy.abs(file[f"evaluate/{name}"][:]) <= most) for name, most in limits.items()}
            values = {name: numpy.abs(file[f"evaluate/{name}"][:]) for name in limits}
        self.assertEqual(solved.shape, (158, machines))
        passes = numpy.logical_and.reduce([g.all(axis=0) for g in good.values()])
        self.assertGreater(passes.sum(), 5)
        self.assertLess(passes.sum(), machines - 5)
        self.assertEqual(found["machines"], machines)
        self.assertEqual(found["rejects"], machines - passes.sum())
        self.assertEqual(found["value"], passes.sum() / machines)
        self.assertEqual(found["unsolved"], (~solved.all(axis=0)).sum())
        for name, kept in good.items():
            r = responses.index(name)
            self.assertEqual(found["by_response"][r], kept.all(axis=0).sum() / machines)
            numpy.testing.assert_array_equal(found["worst_pose_share"][r], (~kept).sum(axis=1) / machines)
            self.assertEqual(largest[r], values[name][:, solved.all(axis=0)].max())

    def test_threads(self):
        for study in (MACHINES, UNIFORM):
            hashes = set()
            for threads in (1, 2, 3):
                self.write("study.toml", study.replace("12300", "3210"))
                self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--threads", threads)
                self.succeeds("verify", "out.h5")
                hashes.add(self.content_hash())
            self.assertEqual(len(hashes), 1)

    def test_what_the_yield_depends_on(self):
        """Of uniform errors in README's setting: shares of the mean square against single errors that `evaluate` solves,
        changes of the yield against runs whose one error is a tenth larger, on the same uniforms."""
        study = UNIFORM_ERRORS
        self.run_study(study)
        tables = json.loads(self.succeeds("show", "out.h5", "--json"))["tables"]
        self.assertEqual([table["name"] for table in tables[:3]], ["yield", "mean_square_shares", "yield_gradient"])
        shares, changes = tables[1]["rows"], tables[2]["rows"]
        text = self.succeeds("show", "out.h5", "--width", 200)
        self.assertLess(text.index("shares of the scatter of gap"), text.index("What the yield changes by"))
        with h5py.File(self.folder / "out.h5") as file:
            names = list(file["factors/name"].asstr())
            sigma = file["factors/sigma"][:]
            row = list(file["responses/name"].asstr()).index("gap")
            found = {name: file[f"yield/{name}"][()] for name in
                     ("value", "rejects", "change", "change_ci_low", "change_ci_high", "gradient", "machines")}
            ends = [file[f"yield/mean_square_share{end}"][row] for end in ("", "_ci_low", "_ci_high")]
            linear = file["yield/linear_share"][row]
            axes = [axis for axis in ("z", "beta", "gamma")]
            poses = numpy.array([file[f"poses/{axis}"][:] for axis in axes]).T
        self.assertGreater(linear, 0.99)
        self.assertEqual([row["error"] for row in shares], [names[p] for p in numpy.argsort(-ends[0], kind="stable")])
        # The mean squares of independent errors add up, so each error is solved alone at every pose, at a thousandth of
        # sigma.
        self.write("poses.csv", "\n".join([",".join(axes)] + [",".join(map(repr, map(float, pose))) for pose in poses]))
        alone = numpy.diag(1e-3 * sigma)
        self.write("errors.csv", "\n".join([",".join(names)] + [",".join(map(repr, map(float, row))) for row in alone]))
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "rows.h5", "--quiet")
        with h5py.File(self.folder / "rows.h5") as file:
            squares = (file["evaluate/gap"][:] ** 2).sum(axis=0)
        truth = squares / squares.sum()
        numpy.testing.assert_allclose(ends[0], truth, atol=2e-3)
        self.assertTrue(((ends[1] <= truth + 1e-3) & (truth - 1e-3 <= ends[2])).all())
        # The changes that are certain for all errors together (Holm's test; Student's quantiles are close to normal
        # ones) are shown, and all others are one line.
        told = (found["change_ci_low"] > 0) | (found["change_ci_high"] < 0)
        self.assertGreater(found["rejects"], 200)
        distance = numpy.abs(found["change"]) / (0.5 * (found["change_ci_high"] - found["change_ci_low"]))
        tested = ends[0] > 0
        strict = statistics.NormalDist().inv_cdf(1 - 0.025 / tested.sum()) / statistics.NormalDist().inv_cdf(0.975)
        shown = {row["error"] for row in changes[:-1]}
        self.assertLessEqual({names[p] for p in numpy.flatnonzero(tested & (distance > 1.1 * strict))}, shown)
        self.assertLessEqual(shown, {names[p] for p in numpy.flatnonzero(tested & told)})
        rest = len(names) - len(shown)
        self.assertEqual(changes[-1]["error"], f"{rest} errors whose effects are not certain")
        self.assertIn(f"certain at 95 % for all {tested.sum()} together", text)
        self.assertIsNone(changes[-1]["change"])
        self.assertTrue((found["change_ci_low"] >= -found["value"]).all())
        # At most twice as wide as the interval of a likelihood-ratio estimate for normal errors, whose weights are (z^2
        # - 1)/10.
        half = 0.5 * (found["change_ci_high"] - found["change_ci_low"])
        rejected = found["rejects"] / found["machines"]
        self.assertLess(half.max(), 2 * 1.96 * 0.1 * numpy.sqrt(2 * rejected / found["machines"]))
        largest = numpy.argsort(-truth)[:3]
        for p in largest:
            self.assertTrue(told[p], names[p])
            unit = ("mm", 1e-3) if "delta" in names[p] else ("deg", numpy.pi / 180)
            width = 1.1 * sigma[p] * numpy.sqrt(3) / unit[1]
            override = f'[errors.override]\n{names[p]} = {{ distribution = "uniform", half_width = "{width:.12g} {unit[0]}" }}\n'
            self.run_study(study.replace("[analysis]", override + "[analysis]"), output="grown.h5")
            with h5py.File(self.folder / "grown.h5") as file:
                change = file["yield/value"][()] - found["value"]
            # The runs have the same draws, so they differ by the machines that cross the limit, mostly in one
            # direction. alpha = 1e-3 for three comparisons.
            noise = numpy.hypot(half[p] / 1.96, numpy.sqrt(2 * abs(change) / found["machines"]))
            self.assertAlmostEqual(found["change"][p], change, delta=3.6 * noise, msg=names[p])
        self.succeeds("export", "out.h5", "-d", "tables")
        with open(self.folder / "tables/mean_square_share.csv", encoding="utf-8") as file:
            rows = [line.strip().split(",") for line in file]
        self.assertEqual(rows[0], ["factor", "share_gap", "share_ci_low_gap", "share_ci_high_gap"])
        self.assertEqual([float(row[1]) for row in rows[1:]], list(ends[0]))

    def test_more_machines_go_on_from_fewer(self):
        for fewer, more in ((1000, 2000), (1300, 2700)):
            expected = self.undisturbed(MACHINES.replace("12300", str(more)))
            self.write("study.toml", MACHINES.replace("12300", str(fewer)))
            self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--keep-checkpoint")
            with h5py.File(self.folder / "out.h5") as file:
                self.assertEqual(file["yield/machines"][()], fewer)
            self.write("study.toml", MACHINES.replace("12300", str(more)))
            self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--resume")
            self.assertEqual(self.content_hash(), expected)
            for path in self.folder.glob("out.h5*"):
                path.unlink()

    def judged(self, share, machines=1500):
        """The study with a limit within which this share of the machines is, and what asks for a yield."""
        self.run_study(MACHINES.replace("12300", str(machines)))
        with h5py.File(self.folder / "out.h5") as file:
            row = list(file["responses/name"].asstr()).index("linear_deformation")
            edges = file["machines/largest/histogram_edges"][row]
            counts = file["machines/largest/histogram_counts"][row]
        at = numpy.searchsorted(numpy.cumsum(counts), share * machines)
        return MACHINES.replace("12300", str(machines)).replace("0.5 mm", f"{edges[at + 1] * 1e3:.6g} mm")

    def test_verdicts(self):
        study = self.judged(0.9)
        for asked, code, word in (("0.8", 0, "PASS"), ("0.98", 6, "FAIL"), ("0.9", 0, "UNDECIDED")):
            done = self.run_study(study + f"yield = {asked}\n", code)
            self.assertIn(word, done.stdout.decode())
            if word != "PASS":
                self.assertIn("the yield is", done.stderr.decode())
            tables = json.loads(self.succeeds("show", "out.h5", "--json"))["tables"]
            self.assertEqual(tables[0]["name"], "yield")
            self.assertIn(word, tables[0]["caption"])
            self.assertEqual([row["limit_of"] for row in tables[0]["rows"]], ["all responses", "linear_deformation"])
        with h5py.File(self.folder / "out.h5") as file:
            self.assertEqual(file["limits"].attrs["judge"], "yield")
            self.assertEqual(file["limits"].attrs["yield"], 0.9)
            self.assertEqual(file["yield/gradient"].shape, file["factors/sigma"].shape)
            self.assertLessEqual(file["yield/ci_low"][()], file["yield/value"][()])
        self.succeeds("report", "out.h5", "-o", "report.html")
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertLess(page.index("UNDECIDED"), page.rindex("What the yield depends on"))
        self.succeeds("export", "out.h5", "-d", "tables")
        for name in ("yield", "yield_by_response", "yield_gradient", "rejects", "machines_largest", "machines_rms", "S1",
                     "main_effect_linear_deformation"):
            self.assertTrue((self.folder / f"tables/{name}.csv").exists(), name)

    def test_refusals(self):
        def refused(study, *words):
            done = self.run_study(study, 2)
            for word in words:
                self.assertIn(word, done.stderr.decode())
        refused(MACHINES.replace("12300", "1108") + "yield = 0.9973\n", "1108 machines cannot show", "take 1109 samples")
        refused(MACHINES.replace('draws = "per machine"', 'draws = "per pose"') + "yield = 0.9\n", "analysis.yield is set")
        refused(MACHINES.replace('draws = "per machine"', 'draws = "per pose"\njudge = "yield"'), "there are no machines", "per machine")
        refused(MACHINES.replace('"per machine"', '"per robot"'), "analysis.draws is 'per robot'")
        refused(MACHINES.replace('limits.linear_deformation = "0.5 mm"\n', "yield = 0.9\n"), "states no limit")

    def test_another_limit_is_another_study(self):
        self.write("study.toml", MACHINES)
        self.stop_early()
        self.write("study.toml", MACHINES.replace("0.5 mm", "0.6 mm"))
        done = self.resume()
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(b"another study", done.stderr)


if __name__ == "__main__":
    main()
