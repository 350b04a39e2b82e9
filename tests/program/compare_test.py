"""`poesy show A B ...` and `report A B ...`: which design is better, by how much, and whether this is certain."""

import json
import os
import re
from pathlib import Path

from poesy_program import ProgramTest, main

STUDY = """\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
[solver]
metric = "platform"
[poses]
count = 6
[errors]
linear = { distribution = "normal", sigma = "0.02 mm" }
angular = { distribution = "normal", sigma = "0.01 deg" }
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = "deforming-all"
samples = 2000
limits = { gap = "0.04 mm" }
"""

PRINTER = """\
format = "poesy-study"
version = 1
mechanism.file = "FILE"
poses = { count = 3 }
errors.linear = { distribution = "normal", sigma = "0.05 mm" }
errors.angular = { distribution = "normal", sigma = "0.05 deg" }
analysis = { kind = "sensitivity", factors = "all", samples = 100 }
"""


class Compare(ProgramTest):
    def setUp(self):
        super().setUp()
        self.results = []
        for name, linear, angular in (("a", "0.02 mm", "0.01 deg"), ("b", "0.02 mm", "0.005 deg"), ("c", "0.0201 mm", "0.01 deg")):
            self.write(f"{name}.toml", STUDY.replace("0.02 mm", linear).replace("0.01 deg", angular))
            self.succeeds("run", f"{name}.toml", "--quiet")
            self.results.append(f"{name}.h5")

    def test_yields_of_three(self):
        both = json.loads(self.succeeds("show", *self.results, "--json"))
        table = both["tables"][0]
        self.assertEqual(table["name"], "merits")
        rows = [row for row in table["rows"] if row["quantity"] == "yield"]
        self.assertEqual([row["result"] for row in rows], ["A", "B", "C"])
        self.assertEqual([row["verdict"] for row in rows[1:]], ["better", "not told apart"])
        self.assertLess(rows[0]["value"] + 10, rows[1]["value"])
        self.assertEqual(rows[1]["change"], rows[1]["value"] - rows[0]["value"])
        low = rows[1]["change"] - ((rows[1]["value"] - rows[1]["low"]) ** 2 + (rows[0]["high"] - rows[0]["value"]) ** 2) ** 0.5
        self.assertAlmostEqual(rows[1]["change_low"], low, places=10)
        settings = [table for table in both["tables"] if table["name"] == "settings"]
        self.assertEqual([row["setting"] for row in settings[0]["rows"]], ["errors.angular"])

    def test_two_as_text_and_as_a_report(self):
        text = " ".join(self.succeeds("show", "a.h5", "b.h5").split())
        for words in ("Which is better: B against A", "better", "Settings that differ", "0.005 deg", "root mean square of gap"):
            self.assertIn(words, text)
        self.succeeds("report", "a.h5", "b.h5", "-o", "two.html")
        page = (self.folder / "two.html").read_text()
        self.assertIn("B is better: the yield is ", page)
        self.assertIn("A and B differ in keys of one study (errors.angular): 'poesy sweep' judges the same machines", text)
        self.succeeds("report", *self.results, "-o", "three.html")
        page = (self.folder / "three.html").read_text()
        self.assertIn("A and C are not told apart: the yield is ", page)

    def test_no_verdict_under_other_limits_or_poses(self):
        study = (self.folder / "a.toml").read_text()
        self.write("wider.toml", study.replace('"0.04 mm"', '"0.05 mm"'))
        self.write("edge.toml", study.replace("count = 6", 'count = 6\nselect = "boundary"'))
        for name in ("wider", "edge"):
            self.succeeds("run", f"{name}.toml", "--quiet")
        merits = json.loads(self.succeeds("show", "a.h5", "wider.h5", "edge.h5", "--json"))["tables"][0]["rows"]
        self.assertEqual([row["verdict"] for row in merits if row["quantity"] == "yield"], ["-", "other limits", "other poses"])
        self.succeeds("report", "a.h5", "wider.h5", "-o", "two.html")
        page = (self.folder / "two.html").read_text()
        self.assertIn("No verdict, because the limits differ (analysis.limits.gap: 0.04 mm in A, 0.05 mm in B): the yield is ", page)
        self.assertIn("No change: ", page)
        for words in ("B is better: ", "A is better: ", "Largest change", "'poesy sweep' judges"):
            self.assertNotIn(words, page)

    def test_each_of_several_limits(self):
        """The share within each limit has a verdict of its own, also if another limit differs."""
        for name, angle in (("a", "0.08 deg"), ("b", "0.08 deg"), ("c", "0.07 deg")):
            study = (self.folder / f"{name}.toml").read_text()
            self.write(f"{name}.toml", study.replace('gap = "0.04 mm"', f'gap = "0.04 mm", angular_deformation = "{angle}"'))
            self.succeeds("run", f"{name}.toml", "--quiet")
        shown = json.loads(self.succeeds("show", "a.h5", "b.h5", "c.h5", "--json"))["tables"][0]["rows"]
        gap = [row for row in shown if row["quantity"] == "share within the limit of gap"]
        angle = [row for row in shown if row["quantity"] == "share within the limit of angular_deformation"]
        self.assertEqual([row["verdict"] for row in gap], ["-", "better", "not told apart"])
        self.assertEqual([row["verdict"] for row in angle[1:]], ["better", "other limits"])
        for row, file in zip(gap, "abc"):
            yields = json.loads(self.succeeds("show", f"{file}.h5", "--json"))["tables"][0]["rows"]
            of_gap = next(one for one in yields if one["limit_of"] == "gap")
            for end, key in (("value", "yield"), ("low", "low"), ("high", "high")):
                self.assertAlmostEqual(row[end], of_gap[key], places=9)
        self.succeeds("report", "a.h5", "b.h5", "-o", "two.html")
        self.assertIn("B is better: the share within the limit of gap is ", (self.folder / "two.html").read_text())

    def test_equal_warnings_are_one(self):
        for name in ("a", "b"):
            study = (self.folder / f"{name}.toml").read_text()
            self.write(f"{name}.toml", study.replace('model = "2upr-rpu"', 'model = "2upr-rpu"\nfidelity = "first-order"'))
            self.succeeds("run", f"{name}.toml", "--quiet")
        self.succeeds("report", "a.h5", "b.h5", "-o", "two.html")
        page = (self.folder / "two.html").read_text()
        self.assertEqual(page.count("The model was solved to first order in the errors."), 1)
        self.assertIn("A and B: The model was solved to first order in the errors.", page)

    def test_mechanisms_of_two_names(self):
        printer = (Path(os.environ["POESY_DATA"]) / "mechanisms/delta6.toml").read_text()
        for other in ("one", "two"):
            self.write(f"{other}.toml", re.sub('^name +=.*', f'name = "{other}"', printer, count=1, flags=re.MULTILINE))
            self.write(f"study_{other}.toml", PRINTER.replace("FILE", f"{other}.toml"))
            self.succeeds("run", f"study_{other}.toml", "-o", f"{other}.h5", "--quiet")
        merits = json.loads(self.succeeds("show", "one.h5", "two.h5", "--json"))["tables"][0]
        self.assertEqual([row["change"] for row in merits["rows"] if row["result"] == "B"], [0.0])
        self.succeeds("report", "one.h5", "two.h5", "-o", "both.html")
        page = (self.folder / "both.html").read_text()
        self.assertTrue("A: one.h5 of one; B: two.h5 of two" in page)


if __name__ == "__main__":
    main()
