"""Machines, each one set of errors at all poses: their yield is what a count of the same errors gives; same bits however
they are run; verdicts and exit codes."""

import json
import re

import h5py
import numpy

from poesy_program import main
from resumption import MACHINES, ResumptionTest

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


class Machines(ResumptionTest):
    def run_study(self, study, code=0, output="out.h5"):
        self.write("study.toml", study)
        done = self.poesy("run", "study.toml", "-o", output, "--quiet")
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def errors_of(self, sample, pose):
        """The errors of a machine by name, as replay has them."""
        text = self.succeeds("replay", "out.h5", "all", pose, sample)
        part = text[text.index("errors that vary\n"):text.index("solved as in the run")]
        return dict(re.findall(r"^  (\S+) +(\S+)", part, re.MULTILINE))

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
        study = MACHINES.replace("12300", "3210")
        hashes = set()
        for threads in (1, 2, 3):
            self.write("study.toml", study)
            self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--threads", threads)
            self.succeeds("verify", "out.h5")
            hashes.add(self.content_hash())
        self.assertEqual(len(hashes), 1)

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
        refused(MACHINES.replace('draws = "per machine"', 'judge = "yield"'), "there are no machines", "per machine")
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
