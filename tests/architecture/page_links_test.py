#!/usr/bin/env python3
"""Plants links that lead nowhere: page_links.py must find each, and nothing in right pages."""

import tempfile
import unittest
from pathlib import Path

import page_links

RIGHT = "# Start here: a *page*\n[itself](#start-here-a-page) [other](engine/THEORY.md#the-theory) [web](https://example.org)\n"


class PageLinksTest(unittest.TestCase):
    def found(self, page=RIGHT, theory="# The theory\n`stats/moments.h`\n"):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "engine/stats").mkdir(parents=True)
            (root / "engine/stats/moments.h").touch()
            (root / "engine/THEORY.md").write_text(theory)
            (root / "README.md").write_text(page)
            return list(page_links.problems(root))

    def test_right_pages_have_no_problem(self):
        self.assertEqual(self.found(), [])

    def test_missing_file(self):
        self.assertEqual(self.found(RIGHT + "[gone](gone.md)"), ["README.md: there is no gone.md"])

    def test_missing_heading(self):
        self.assertEqual(self.found(RIGHT + "[gone](#gone)"), ["README.md: no heading for #gone"])

    def test_missing_header(self):
        problem = "engine/THEORY.md: there is no header run/gone.h"
        self.assertEqual(self.found(theory="# The theory\n`run/gone.h`"), [problem])


if __name__ == "__main__":
    unittest.main()
