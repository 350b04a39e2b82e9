"""Limits of a study: PASS or FAIL and exit code 6, for all ways to run a study and to show its result."""

import csv
import json

import h5py
from poesy_program import STUDY, ProgramTest, main

MONTE_CARLO = STUDY.replace('"sensitivity"', '"monte-carlo"\ndraws = "per pose"')
RESPONSE = "linear_deformation"


def limited(limit, judge=""):
    """The study with a limit in mm."""
    before, after = MONTE_CARLO.split("[analysis]\n")
    return f'{before}[analysis]\n{judge}limits.{RESPONSE} = "{limit:.17g} mm"\n{after}'


CASES = """
[mechanism]
model = "2upr-rpu"
[poses]
count = 5
[analysis]
kind = "evaluate"
limits.linear_deformation = "%s mm"
[[analysis.cases]]
name = "small"
errors = { delta_1_1_y = "0.1 mm" }
[[analysis.cases]]
name = "large"
errors = { delta_1_1_y = "0.2 mm" }
"""


class Limits(ProgramTest):
    def run_with(self, limit, judge="", *, code):
        self.write("study.toml", limited(limit, judge))
        done = self.poesy("run", "study.toml", "-o", "study.h5", "--quiet")
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def value(self, name="study"):
        """What was judged, in mm."""
        with h5py.File(self.folder / f"{name}.h5") as file:
            return file["limits/value"][0] * 1e3

    def table(self, name="study", which="limits"):
        tables = json.loads(self.succeeds("show", f"{name}.h5", "--json"))["tables"]
        return next(table for table in tables if table["name"] == which)

    def check_both_sides(self, judge):
        """A limit at the value that is found is kept, and one just below is not."""
        self.run_with(1e6, judge, code=0)
        found = self.value()
        done = self.run_with(found * (1 + 1e-9), judge, code=0)
        self.assertIn(b"PASS", done.stdout)
        done = self.run_with(found * (1 - 1e-9), judge, code=6)
        self.assertIn(b"FAIL", done.stdout)
        for words in ("study.toml", RESPONSE, "above its limit"):
            self.assertIn(words, done.stderr.decode())
        return found

    def test_the_advice_names_what_the_study_lacks(self):
        """To judge machines: the key of the yield, if they are drawn already."""
        machines = MONTE_CARLO.replace("per pose", "per machine")
        for study, key in ((MONTE_CARLO, "draws"), (machines, "judge")):
            limit = '[analysis]\njudge = "rms"\nlimits.linear_deformation = "1 m"\n'
            self.write("study.toml", study.replace("[analysis]\n", limit))
            self.succeeds("run", "study.toml", "-o", "study.h5", "--quiet")
            self.succeeds("report", "study.h5", "-o", "study.html")
            self.assertIn(f"ask for a yield ({key} = ", (self.folder / "study.html").read_text())

    def test_digits(self):
        """Estimates are shown with four digits; JSON and CSV have all of them."""
        self.run_with(1.0, code=0)
        tables = json.loads(self.succeeds("show", "study.h5", "--json"))["tables"]
        checked = 0
        for table in tables:
            if table["name"] not in ("limits", "overall", "poses"):
                continue
            for shown, row in zip(table["shown"], table["rows"]):
                for text, column in zip(shown, table["columns"]):
                    value = row[column["name"]]
                    if isinstance(value, float) and not column["unit"] == "%" and column["name"] != "limit":
                        self.assertEqual(text, f"{value:.4g}")
                        checked += text != repr(value)
        self.assertGreater(checked, 20)
        overall = next(table for table in tables if table["name"] == "overall")
        self.succeeds("export", "study.h5", "-d", "tables")
        with h5py.File(self.folder / "study.h5") as file:
            row = list(file["responses/name"].asstr()).index(RESPONSE)
            mean = file["monte_carlo/overall_mean"][row]
        shown = next(one["mean"] for one in overall["rows"] if one["response"] == RESPONSE)
        self.assertAlmostEqual(shown, 1e3 * mean, delta=1e-14 * shown)
        with open(self.folder / "tables/overall.csv", newline="") as file:
            exported = next(one for one in csv.DictReader(file) if one["response"] == RESPONSE)
        self.assertEqual(float(exported["mean"]), mean)

    def test_root_mean_square(self):
        found = self.check_both_sides("")
        with h5py.File(self.folder / "study.h5") as file:
            row = list(file["responses/name"].asstr()).index(RESPONSE)
            self.assertAlmostEqual(file["monte_carlo/overall_rms"][row] * 1e3, found, delta=1e-12 * found)
            self.assertEqual(file["limits"].attrs["judge"], "rms")

    def test_share(self):
        found = self.check_both_sides('judge = "share"\nshare = 0.9\n')
        with h5py.File(self.folder / "study.h5") as file:
            row = list(file["responses/name"].asstr()).index(RESPONSE)
            self.assertEqual(file["monte_carlo/share_magnitude"][row].max() * 1e3, found)
            self.assertEqual(file["limits"].attrs["share"], 0.9)
            self.assertEqual(file["limits/pose"][0], file["monte_carlo/share_magnitude"][row].argmax())

    def test_show_and_export_say_the_same(self):
        done = self.run_with(1e-3, code=6)
        self.succeeds("export", "study.h5", "-d", "tables")
        with open(self.folder / "tables/limits.csv", newline="", encoding="utf-8") as file:
            exported, = csv.DictReader(file)
        row, = self.table()["rows"]
        self.assertEqual((row["verdict"], row["response"], row["unit"]), ("FAIL", RESPONSE, "mm"))
        self.assertEqual((exported["response"], exported["passed"], exported["unit"]), (RESPONSE, "0", "m"))
        for found in (row["value"], float(exported["value"]) * 1e3):
            self.assertAlmostEqual(found, self.value(), delta=1e-12 * found)
        self.assertAlmostEqual(row["limit"], 1e-3, delta=1e-15)
        line = next(line for line in done.stdout.decode().splitlines() if line.startswith("FAIL  "))
        self.assertIn(line, self.succeeds("show", "study.h5"))  # `show` ends with 0 in spite of the FAIL

    def test_too_many_failures_go_first(self):
        study = limited(1e-3).replace("[run]", "max_iterations = 1\nmax_not_converged = 0\n[run]")
        self.write("study.toml", study)
        done = self.poesy("run", "study.toml", "-o", "study.h5", "--quiet")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertIn(b"FAIL", done.stdout)

    def test_shards_are_judged_when_they_are_merged(self):
        self.run_with(1e-3, code=6)
        for shard in ("1/2", "2/2"):
            done = self.poesy("run", "study.toml", "--shard", shard, "-o", f"shard{shard[0]}.h5", "--quiet")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn(b"FAIL", done.stdout)
        done = self.poesy("merge", "shard1.h5", "shard2.h5", "-o", "all.h5")
        self.assertEqual(done.returncode, 6, done.stderr)
        self.assertIn(b"FAIL", done.stdout)
        self.assertEqual(self.value("all"), self.value())

    def test_a_run_may_go_on_under_another_limit(self):
        self.write("study.toml", limited(1e-3))
        done = self.poesy("run", "study.toml", "-o", "study.h5", "--quiet", "--max-wall", "0.000001 s")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.write("study.toml", limited(1e6))
        done = self.poesy("run", "study.toml", "-o", "study.h5", "--quiet", "--resume")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"PASS", done.stdout)

    def test_cases_are_judged_one_by_one(self):
        self.write("cases.toml", 'format = "poesy-study"\nversion = 1\n' + CASES % "1e6")
        self.succeeds("run", "cases.toml", "-o", "cases.h5", "--quiet")
        with h5py.File(self.folder / "cases.h5") as file:
            small, large = file["evaluate/linear_deformation"][:].max(axis=1) * 1e3
        self.assertLess(small, large)
        self.write("cases.toml", 'format = "poesy-study"\nversion = 1\n' + CASES % f"{0.5 * (small + large):.17g}")
        done = self.poesy("run", "cases.toml", "-o", "cases.h5", "--quiet")
        self.assertEqual(done.returncode, 6, done.stderr)
        row, = self.table("cases")["rows"]
        self.assertEqual((row["verdict"], row["within"]), ("FAIL", 50.0))
        self.assertTrue(row["place"].startswith("large, pose "))

    def test_rows_are_judged_one_by_one(self):
        self.write("cases.toml", 'format = "poesy-study"\nversion = 1\n' + CASES % "1e-3")
        self.write("errors.csv", "delta_1_1_y\n0\n0.0001\n0.0002\n")
        self.write("poses.csv", "z,beta,gamma\n-0.22,0.1,0.2\n-0.21,-0.1,0.1\n")
        done = self.poesy("evaluate", "cases.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "rows.h5", "--quiet")
        self.assertEqual(done.returncode, 6, done.stderr)
        row, = self.table("rows")["rows"]
        self.assertAlmostEqual(row["within"], 100.0 / 3.0)
        self.assertTrue(row["place"].startswith("line 4 (sample 2), pose "))
        self.assertIn(b"1 of 3 rows are within the limit", done.stdout)
        self.assertIn(b"fail: lines 3, 4 of the table of errors; a column 'part' whose cells all differ names its rows", done.stdout)

    def test_errors_without_a_column_are_told(self):
        """They are zero, in what `evaluate` prints, in tables, in the report and in the method."""
        self.write("cases.toml", 'format = "poesy-study"\nversion = 1\n' + CASES % "1e-3")
        self.write("poses.csv", "z,beta,gamma\n-0.22,0.1,0.2\n")
        self.write("errors.csv", "part,delta_1_1_y\na,0\n")
        files = ("--poses", "poses.csv", "--errors", "errors.csv")
        said = self.succeeds("evaluate", "cases.toml", *files, "-o", "rows.h5", "--quiet")
        with h5py.File(self.folder / "rows.h5") as file:
            zero = [name.decode() for name in file["zero_error"][:]]
        self.assertNotIn("delta_1_1_y", zero)
        told = f"{len(zero)} of {len(zero) + 1} errors have no column and are zero ({zero[0]}, {zero[1]}, "
        self.succeeds("report", "rows.h5", "-o", "rows.html")
        report = (self.folder / "rows.html").read_text()
        self.assertNotIn("nothing here is up to chance", report)
        self.assertIn("so real machines deviate more. A Monte Carlo study with errors.machines draws them.", report)
        for text in (said, self.succeeds("show", "rows.h5"), report):
            text = " ".join(text.split())
            self.assertIn(told, text)
            self.assertIn("errors.machines in a Monte Carlo study draws them", text)
        method = " ".join(self.succeeds("show", "rows.h5", "--method").split())
        self.assertIn("1 geometric error was given values.", method)
        self.assertIn(f"{len(zero)} other errors were zero.", method)
        with h5py.File(self.folder / "rows.h5", "r+") as file:
            file["zero_error"][0] = "../a"
        done = self.poesy("show", "rows.h5")
        self.assertEqual(done.returncode, 3, done.stderr)

    def test_places_have_no_exponents(self):
        self.write("cases.toml", 'format = "poesy-study"\nversion = 1\n' + CASES % "1e-3")
        self.write("errors.csv", "delta_1_1_y\n0.0001\n")
        self.write("poses.csv", "z [mm],beta,gamma\n-1000,0.1,0.1\n")
        done = self.poesy("evaluate", "cases.toml", "--poses", "poses.csv", "--errors", "errors.csv", "--quiet")
        self.assertIn(b"pose 0 (z -1000 mm, beta 5.73 deg", done.stdout)

    def test_parts_are_judged_one_by_one(self):
        """Each part passes or fails by itself, whatever the title of the column with its name is."""
        self.write("cases.toml", 'format = "poesy-study"\nversion = 1\n' + CASES % "1e-3")
        self.write("poses.csv", "z,beta,gamma\n-0.22,0.1,0.2\n-0.21,-0.1,0.1\n")
        for title, names in (("part", ("SN1", "SN2", "SN3")), ("Serial", ("17", "18", "0019"))):
            self.write("errors.csv", f"{title},delta_1_1_y\n{names[0]},0.0001\n{names[1]},0\n{names[2]},0.0002\n")
            done = self.poesy("evaluate", "cases.toml", "--poses", "poses.csv", "--errors", "errors.csv", "-o", "rows.h5", "--quiet")
            self.assertEqual(done.returncode, 6, done.stderr)
            self.assertIn(f"fail: {names[0]}, {names[2]}\n", done.stdout.decode())
            self.assertIn("1 of 3 rows are within the limit", self.succeeds("show", "rows.h5"))
            parts = self.table("rows", "parts")["rows"]
            self.assertEqual([(row["label"], row["kept"]) for row in parts], list(zip(names, ("FAIL", "PASS", "FAIL"))))
            self.succeeds("export", "rows.h5", "-d", "tables")
            lines = (self.folder / "tables" / "parts.csv").read_text().splitlines()
            self.assertTrue(lines[0].startswith("part,poses,kept,"), lines[0])
            self.assertEqual([line.split(",")[:3] for line in lines[1:]], [[name, "2", kept] for name, kept in zip(names, "010")])
            self.succeeds("report", "rows.h5", "-o", "rows.html")
            self.assertIn(f"fail: {names[0]}, {names[2]}", (self.folder / "rows.html").read_text())


if __name__ == "__main__":
    main()
