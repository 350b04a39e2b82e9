"""Reports in headless Chromium: drawn, readable, self-contained, usable by keyboard, and faultless to axe-core."""

import os
import subprocess
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

PROGRAM = os.environ["POESY_PROGRAM"]
ROOT = Path(__file__).resolve().parents[2]
WEB = Path(os.environ["POESY_WEB"])
SHOTS = Path(os.environ["POESY_SCREENSHOTS"])
WIDTHS = (1400, 400)
MOST_BYTES = 3_000_000
MOST_SECONDS = 30  # ten times what is asked for: a busy machine is no reason to fail


class PageTest(unittest.TestCase):
    """A browser, and everything that holds for any report."""

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


class Figures(PageTest):
    def test_every_type_of_figure(self):
        page = self.folder / "figures.html"
        page.write_text(figures_page(WEB))
        self.check_page(page)

    def test_faults_are_found(self):
        """The checks themselves: a page with one fault of each kind."""
        page = self.folder / "faults.html"
        whole = figures_page(WEB)
        figure = '<figure data-figure="{}"><div class="plot"></div>'
        faults = {
            figure.format("ranking"): figure.format("ranking").replace("plot", "plot\" style=\"display:none"),
            "<h1>Figures</h1>": '<h1 style="color:#eee">Figures</h1><img src="https://example.org/a.png">',
            "<footer>": '<footer style="width:3000px">',
        }
        for sound, faulty in faults.items():
            self.assertIn(sound, whole)
            whole = whole.replace(sound, faulty)
        page.write_text(whole)
        self.browser.open(page, 400)
        checks = FigureChecks(self, self.browser)
        found = " ".join(self.browser.violations())
        self.assertIn("color-contrast", found)
        self.assertIn("image-alt", found)
        for check in (checks.not_empty, lambda: self.check_fits(400), lambda: self.check_silent(page)):
            with self.assertRaises(AssertionError):
                check()


class Reports(PageTest):
    def poesy(self, *arguments):
        command = [PROGRAM, *map(str, arguments)]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, timeout=600, check=False)
        self.assertEqual(done.returncode, 0, done.stderr.decode(errors="replace"))
        return done.stdout.decode()

    def result(self, name, study):
        """The result of a study, a file or its text."""
        if isinstance(study, str):
            text, study = study, self.folder / f"{name}.toml"
            study.write_text(text)
        self.poesy("run", study, "-o", f"{name}.h5", "--quiet")
        return f"{name}.h5"

    def report(self, name, *results):
        begin = time.monotonic()
        self.poesy("report", *results, "-o", f"{name}.html")
        seconds = time.monotonic() - begin
        page = self.folder / f"{name}.html"
        print(f"{name}: {page.stat().st_size / 1e6:.2f} MB in {seconds:.2f} s")
        self.assertLess(page.stat().st_size, MOST_BYTES)
        self.assertLess(seconds, MOST_SECONDS)
        return page

    def test_published_sensitivity_study(self):
        study = ROOT / "results" / "2upr-rpu-sensitivity" / "study.toml"
        self.check_page(self.report("sensitivity", self.result("sensitivity", study)))

    def test_coupled_errors_along_a_trajectory(self):
        study = ROOT / "results" / "3prs-paper" / "studies" / "trajectory.toml"
        self.check_page(self.report("coupling", self.result("coupling", study)))

    def test_identification(self):
        study = ROOT / "results" / "2upr-rpu-paper" / "studies" / "identification.toml"
        self.check_page(self.report("identification", self.result("identification", study)))

    def test_monte_carlo(self):
        template = self.poesy("template", "3-prs", "monte-carlo")
        self.check_page(self.report("monte-carlo", self.result("monte-carlo", template)))

    def test_comparison(self):
        template = self.poesy("template", "2upr-rpu")
        smaller = template.replace('sigma = "1 mm"', 'sigma = "0.5 mm"')
        self.check_page(self.report("comparison", self.result("before", template), self.result("after", smaller)))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
