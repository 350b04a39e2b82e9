"""results/2upr-rpu-paper/COMPARISON.md is what its command writes, and its numbers are as expected.

usage: paper_test.py PROGRAM

Words must be the same. Numbers of converged solves may differ by 1 %, because last digits differ between processors.
Numbers of the published procedure depend on single solves that did not converge, and so does its ranking; there any
number is accepted.
"""

import sys
import unittest

from regenerated import NUMBER, RESULTS, cells, figures_of, regenerated, rows_under

FOLDER = RESULTS / "2upr-rpu-paper"


class Paper(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.written, cls.figures = regenerated("2upr-rpu-paper", PROGRAM)
        cls.kept = (FOLDER / "COMPARISON.md").read_text(encoding="utf-8")

    def compare(self, ours, theirs, exact):
        self.assertEqual(NUMBER.sub("#", ours), NUMBER.sub("#", theirs))
        if not exact:
            return
        for a, b in zip(map(float, NUMBER.findall(ours)), map(float, NUMBER.findall(theirs))):
            # A printed difference in per cent changes by up to 1 if its number changes by 1 %.
            self.assertAlmostEqual(a, b, delta=max(0.01 * abs(b), 1.0 if "%" in theirs else 1e-3), msg=theirs)

    def test_is_what_the_command_writes(self):
        self.assertEqual(len(self.written.splitlines()), len(self.kept.splitlines()))
        header = []
        for ours, theirs in zip(self.written.splitlines(), self.kept.splitlines()):
            if not theirs.startswith("|"):
                header = []
                self.compare(ours, theirs, exact="procedure" not in theirs)
                continue
            header = header or cells(theirs)
            for n, (a, b) in enumerate(zip(cells(ours), cells(theirs))):
                after = any("procedure" in name for name in header[:n + 1])
                self.compare(a, b, exact=not after and not ("rank" in header[0] and n == 2))

    def test_figures_are_what_the_command_writes(self):
        kept = figures_of(FOLDER)
        self.assertEqual(set(self.figures), set(kept))
        for name, text in self.figures.items():
            with self.subTest(name):
                ours, theirs = ([line.split(",") for line in each.splitlines()] for each in (text, kept[name]))
                self.assertEqual(ours[0], theirs[0])
                self.assertEqual([row[0] for row in ours], [row[0] for row in theirs])
                if "figure7" in name:  # only rounding errors, which differ between processors
                    continue
                for a, b in zip(ours[1:], theirs[1:]):
                    for x, y in zip(map(float, a[1:]), map(float, b[1:])):
                        self.assertAlmostEqual(x, y, delta=max(0.01 * abs(y), 1e-9), msg=b)

    def rows(self, heading):
        return rows_under(self.written, heading)

    def test_tables_6_and_7_are_exact(self):
        for row in self.rows("## Tables 6 and 7"):
            self.assertEqual([row[2], row[4], row[6]], [row[3], "none", "none"], row)

    def test_table_9(self):
        rows = self.rows("## Table 9")
        for row in rows:
            self.assertLess(abs(float(row[3]) / float(row[2]) - 1.0), 0.03, row)
        for what in ("maximum", "mean"):
            self.assertEqual(len({row[3] for row in rows if row[1] == what}), 1, rows)

    def test_angular_figures_of_table_11(self):
        for row in self.rows("## Table 11"):
            if row[1] == "printed in Table 10" and row[2].startswith("angular"):
                self.assertLess(abs(float(row[4]) / float(row[3]) - 1.0), 0.03, row)

    def test_absorbed_errors_leave_rounding(self):
        for row in self.rows("## Section 5.2"):
            self.assertLess(float(row[2]), 1e-14, row)
            self.assertGreaterEqual(int(row[3]), 1738, row)

    def test_the_limit_holds(self):
        for row in self.rows("## Tolerances for a mean"):
            self.assertEqual(row[4], "holds", row)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
