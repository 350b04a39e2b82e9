"""Reports in headless Chromium: drawn, readable, self-contained, usable by keyboard, and faultless to axe-core."""

import os
import sys
import tempfile
import time
import unittest
from pathlib import Path

import browser

if browser.missing():
    print(f"skipped: {', '.join(browser.missing())} not installed")
    sys.exit(77)

from figure_checks import FigureChecks
from figures_page import figures_page

WEB = Path(os.environ["POESY_WEB"])
SHOTS = Path(os.environ["POESY_SCREENSHOTS"])
WIDTHS = (1400, 400)


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = browser.Browser(WEB / "node_modules" / "axe-core" / "axe.min.js")
        cls.addClassCleanup(cls.browser.quit)
        SHOTS.mkdir(parents=True, exist_ok=True)

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def check_page(self, page):
        """Everything that holds for any report."""
        for width in WIDTHS:
            with self.subTest(width=width):
                self.check_at(page, width)

    def check_at(self, page, width):
        checks = FigureChecks(self, self.browser)
        self.browser.open(page, width)
        self.check_silent(page)
        self.browser.screenshot(SHOTS / f"{page.stem}-{width}-light.png")
        checks.not_empty()
        checks.readable()
        checks.work_all_controls()
        self.browser.run("document.querySelectorAll('details').forEach((details) => (details.open = true))")
        self.browser.settle()
        checks.not_empty()
        self.check_fits(width)
        self.assertEqual(self.browser.violations(), [])
        self.browser.set_scheme("dark")
        self.assertEqual(self.browser.violations(browser.COLOUR_RULES), [])
        self.check_silent(page)
        self.browser.open(page, width, "dark")
        self.browser.screenshot(SHOTS / f"{page.stem}-{width}-dark.png")
        if width == max(WIDTHS):
            self.browser.print(SHOTS / f"{page.stem}.pdf")

    def check_silent(self, page):
        self.assertEqual(self.browser.console(), [])
        for url in self.browser.requests():
            self.assertTrue(url == page.as_uri() or url.startswith(("data:", "blob:")), url)

    def check_fits(self, width):
        self.assertLessEqual(self.browser.run("return document.scrollingElement.scrollWidth"), width)

    def test_every_type_of_figure(self):
        page = self.folder / "figures.html"
        page.write_text(figures_page(WEB))
        self.check_page(page)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
