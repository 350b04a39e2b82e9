#!/usr/bin/env python3
"""Plants broken links and wrong pages of decisions: page_links.py must find each, and nothing in correct pages."""

import tempfile
import unittest
from pathlib import Path

import page_links

RIGHT = "# Start here: a *page*\n[itself](#start-here-a-page) [other](engine/docs/theory.md#the-theory) [web](https://example.org)\n"


class PageLinksTest(unittest.TestCase):
    def found(self, page=RIGHT, theory="# The theory\n`stats/moments.h`\n"):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "engine/stats").mkdir(parents=True)
            (root / "engine/stats/moments.h").touch()
            (root / "engine/docs").mkdir()
            (root / "engine/docs/theory.md").write_text(theory)
            (root / "README.md").write_text(page)
            return list(page_links.problems(root))

    def test_right_pages_have_no_problem(self):
        self.assertEqual(self.found(), [])

    def test_missing_file(self):
        self.assertEqual(self.found(RIGHT + "[gone](gone.md)"), ["README.md: there is no gone.md"])

    def test_missing_heading(self):
        self.assertEqual(self.found(RIGHT + "[gone](#gone)"), ["README.md: no heading for #gone"])

    def test_missing_header(self):
        problem = "engine/docs/theory.md: there is no header run/gone.h"
        self.assertEqual(self.found(theory="# The theory\n`run/gone.h`"), [problem])

    def found_in_decision(self, page, index="- [D7](0007-a.md) A title\n"):
        with tempfile.TemporaryDirectory() as folder:
            decisions = Path(folder) / page_links.DECISIONS
            decisions.mkdir(parents=True)
            (decisions / "README.md").write_text(index)
            (decisions / "0007-a.md").write_text(page)
            return [problem.split(": ", 1)[1] for problem in page_links.decision_problems(Path(folder))]

    def test_decisions(self):
        right = "# D7. A title\n\nStatus: accepted. Date: 2026-01-02. Concerns: the folder engine/kinds/sobol.\n\nText.\n"
        self.assertEqual(self.found_in_decision(right), [])
        self.assertEqual(self.found_in_decision(right.replace("accepted", "superseded by [D8](0008-b.md)")), [])
        self.assertEqual(self.found_in_decision(right, index=""), ["does not list 0007-a.md"])
        self.assertEqual(self.found_in_decision(right + 40 * "Text.\n"),
                         ["has more than 40 lines; move measurements to bench/README.md"])
        for wrong in ("D7.", "accepted", "2026-01-02", "the folder engine/kinds/sobol"):
            problems = self.found_in_decision(right.replace(wrong, ""))
            self.assertEqual(problems, ["begin with '# D7. TITLE' and 'Status: ... Date: ... Concerns: ...'"])


if __name__ == "__main__":
    unittest.main()
