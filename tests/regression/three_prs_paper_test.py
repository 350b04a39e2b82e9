"""results/3prs-paper/COMPARISON.md is what its command writes, and its verdicts are as expected.

usage: three_prs_paper_test.py PROGRAM

Words and verdicts must be the same, and numbers agree to 1 % or to the last digit that is shown.
"""

import sys
import unittest

from regenerated import NUMBER, RESULTS, figures_of, regenerated, rows_under

FOLDER = RESULTS / "3prs-paper"
# Reference values (mm), computed independently: largest |x|, |y|, |z| displacement of the tip on trajectory 1, first
# order.
ALL_LIMBS = {"FS": (0.0462, 0.0471, 0.0062), "T": (0.0, 0.0, 0.1), "R": (0.0231, 0.0236, 0.0793)}
LIMB_1 = {"FS": (0.0240, 0.0088, 0.0135), "T": (0.0873, 0.0028, 0.0509), "R": (0.0759, 0.0567, 0.0404)}


class ThreePrsPaper(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.written, cls.figures = regenerated("3prs-paper", PROGRAM)
        cls.kept = (FOLDER / "COMPARISON.md").read_text(encoding="utf-8")

    def test_is_what_the_command_writes(self):
        self.assertEqual(len(self.written.splitlines()), len(self.kept.splitlines()))
        for ours, theirs in zip(self.written.splitlines(), self.kept.splitlines()):
            self.assertEqual(NUMBER.sub("#", ours), NUMBER.sub("#", theirs))
            for a, b in zip(NUMBER.findall(ours), NUMBER.findall(theirs)):
                digits = len(b.partition(".")[2].partition("e")[0])
                delta = max(0.01 * abs(float(b)), 1.01 * 10.0 ** -digits if "e" not in b else 0.0)
                self.assertAlmostEqual(float(a), float(b), delta=delta, msg=theirs)

    def test_figures_are_what_the_command_writes(self):
        kept = figures_of(FOLDER)
        self.assertEqual(set(self.figures), set(kept))
        for name, text in self.figures.items():
            ours, theirs = ([line.split(",") for line in each.splitlines()] for each in (text, kept[name]))
            self.assertEqual(ours[0], theirs[0])
            self.assertEqual(len(ours), len(theirs))
            for a, b in zip(ours[1:], theirs[1:]):
                for x, y in zip(map(float, a), map(float, b)):
                    self.assertAlmostEqual(x, y, delta=max(1e-5 * abs(y), 1e-8), msg=name)

    def test_reference_maxima_of_the_first_trajectory(self):
        rows = rows_under(self.written, "## Figures 8-11: the largest errors")
        for source, axis, _, all_limbs, limb_1, *_ in rows:
            if source != "L":
                at = "xyz".index(axis)
                self.assertAlmostEqual(float(all_limbs), ALL_LIMBS[source][at], delta=1.5e-4)
                self.assertAlmostEqual(float(limb_1), LIMB_1[source][at], delta=1.5e-4)

    def test_says_that_the_maxima_are_not_reproduced(self):
        self.assertIn("**Not reproduced.**", self.written)

    def test_drives_remove_all_that_enters_their_equations_alone(self):
        for error, paper, drive, removable in rows_under(self.written, "## Section 4.2"):
            if not error.startswith("c_"):
                self.assertEqual(drive, "100.0 %" if paper == "compensable" else "0.0 %")
                self.assertEqual(removable == "100.0 %", paper == "compensable")

    def test_coupling_is_superposition(self):
        for row in rows_under(self.written, "## Figures 16-18"):
            self.assertEqual([row[3], row[6]], ["0", "0"])
            for cell in (row[1], row[4]):
                if cell != "0":
                    interaction, effect = map(float, cell.split(" of "))
                    self.assertLess(interaction, 2e-3 * effect)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
