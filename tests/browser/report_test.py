"""Reports in headless Chromium are drawn, readable, self-contained, usable by keyboard, and without faults by axe-core.

POESY_SCREENSHOTS names a folder for screenshots of every page, also as printed. Without it, none are kept.
"""

import os
import re
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

from figure_checks import EMPTY, FEW_CLICKS, MOST_CLICKS, FigureChecks
from figures_page import (NO_EFFECT, add_apart, add_bars, add_extremes, add_lines, add_plane, add_small_fields, add_what_if,
                          figures_page)

PROGRAM = os.environ["POESY_PROGRAM"]
ROOT = Path(__file__).resolve().parents[2]
WEB = Path(os.environ["POESY_WEB"])
SHOTS = os.environ.get("POESY_SCREENSHOTS")
WIDTHS = (1400, 400)
PAPER = 680  # width of A4 without margins (CSS pixels)
MOST_BYTES = 2_000_000
MOST_SECONDS = 30  # ten times the required time, because the machine may be busy


class PageTest(unittest.TestCase):
    """A browser, and everything that holds for any report."""

    @classmethod
    def setUpClass(cls):
        cls.browser = browser.Browser(os.environ["POESY_AXE"])
        cls.addClassCleanup(cls.browser.quit)

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def check_page(self, page):
        for width in WIDTHS:
            with self.subTest(width=width):
                self.check_at(page, width)

    def check_at(self, page, width):
        checks = FigureChecks(self, self.browser, MOST_CLICKS if width == max(WIDTHS) else FEW_CLICKS)
        self.browser.open(page, width)
        self.check_silent(page)
        checks.not_empty()
        checks.readable()
        checks.work_all_controls()
        self.browser.run("document.querySelectorAll('details').forEach((details) => (details.open = true))")
        self.browser.settle()
        checks.not_empty()
        self.check_fits(width)
        self.assertEqual(self.sideways(), [])
        self.assertEqual(self.without_numbers(), [])
        self.assertEqual(self.browser.violations(), [])
        if width == max(WIDTHS):
            self.browser.set_scheme("dark")  # the colours are the same at all widths
            self.assertEqual(self.browser.violations(browser.COLOUR_RULES), [])
        self.check_silent(page)
        self.take_screenshots(page, width)
        if width == max(WIDTHS):
            self.check_printed(page)

    def take_screenshots(self, page, width):
        if SHOTS:
            Path(SHOTS).mkdir(parents=True, exist_ok=True)
            for scheme in ("light", "dark"):
                self.browser.open(page, width, scheme)
                self.browser.screenshot(Path(SHOTS) / f"{page.stem}-{width}-{scheme}.png")

    def check_printed(self, page):
        self.browser.open(page, max(WIDTHS), "dark")
        self.browser.print(Path(SHOTS or self.folder) / f"{page.stem}.pdf")
        self.browser.run("dispatchEvent(new Event('beforeprint'))")
        self.assertLessEqual(self.browser.printed_width(PAPER), PAPER)
        self.assertEqual(self.small_on_paper(), [])
        self.assertEqual(self.loose_notes(), [])
        self.assertEqual(self.lonely_rows(), [])
        for pictures, in_first_line in self.lines_of_pictures():
            self.assertEqual(in_first_line, min(pictures, 3))

    def check_silent(self, page):
        self.assertEqual(self.browser.console(), [])
        for url in self.browser.requests():
            self.assertTrue(url == page.as_uri() or url.startswith(("data:", "blob:")), url)

    def sideways(self):
        """The tables that scroll to the side."""
        return self.browser.run(
            """return [...document.querySelectorAll(".table-wrap")].filter((wrap) => wrap.scrollWidth > wrap.clientWidth + 1)
              .map((wrap) => wrap.dataset.table)""")

    def without_numbers(self):
        """The tables that do not show the names of their rows, or of two results not both, or none of their numbers."""
        return self.browser.run(
            """const seen = (cell) => {
              const box = cell.getBoundingClientRect();
              const frame = cell.closest(".table-wrap").getBoundingClientRect();
              return box.width > 0 && box.left >= 0 && box.right <= Math.min(innerWidth, frame.right + 1);
            };
            return [...document.querySelectorAll(".table-wrap")].filter((wrap) => {
              const cells = [...(wrap.querySelector("tbody tr")?.cells ?? [])];
              const numbers = cells.filter((cell) => cell.matches("td.n"));
              const needed = [...wrap.querySelectorAll("thead th")].filter((head) => /^[AB]$/.test(head.textContent));
              const names = cells.filter((cell) => cell.matches("th"));
              return ![...names, ...needed].every(seen) || (numbers.length > 0 && !numbers.some(seen));
            }).map((wrap) => wrap.dataset.table)""")

    def loose_notes(self):
        """Notes that a page break may separate from their table, where the page is printed."""
        return self.browser.run(
            """return [...document.querySelectorAll(".table-wrap ~ .note")]
              .filter((note) => getComputedStyle(note).breakBefore !== "avoid").map((note) => note.textContent)""")

    def lonely_rows(self):
        """The tables of which a page break may leave one or two rows, where the page is printed."""
        return self.browser.run(
            """return [...document.querySelectorAll(".table-wrap")].filter((wrap) => {
              const breaks = [...wrap.querySelectorAll("tbody tr")].map((row) => getComputedStyle(row).breakAfter);
              return [...breaks.slice(0, 2), ...breaks.slice(-3, -1)].some((one) => one !== "avoid");
            }).map((wrap) => wrap.dataset.table)""")

    def lines_of_pictures(self):
        """Of each figure of the mechanism the number of pictures, and of those in its first line, where it is printed."""
        return self.browser.run(
            """return [...document.querySelectorAll(".robot-poses")].map((figure) => {
              const tops = [...figure.querySelectorAll(":scope > .robot-pose")].map((one) => one.offsetTop);
              return [tops.length, tops.filter((top) => top === tops[0]).length];
            })""")

    def small_on_paper(self):
        """Texts below 8 points where the page is printed, but for the indices of names."""
        return self.browser.run(
            """const small = [];
            for (const e of document.querySelectorAll("body *")) {
              const own = [...e.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.textContent.trim());
              if (!own || !e.getBoundingClientRect().width || e.matches("tspan, .name > span, script, style")) continue;
              const scale = e instanceof SVGElement ? Math.abs(e.getScreenCTM().a) : 1;
              const points = 0.75 * scale * parseFloat(getComputedStyle(e).fontSize);
              if (points < 7.9) small.push(`${e.textContent}: ${points}`);
            }
            return small""")

    def check_fits(self, width):
        self.assertLessEqual(self.browser.run("return document.scrollingElement.scrollWidth"), width)


def table(name, caption, heads, row):
    """A table as a report has it, with one row. heads: the columns, each with its heading and its attributes."""
    cells = "".join(f'<td{" class=n" if "class=n" in attributes else ""}>{text}</td>'
                    for (_, attributes), text in zip(heads[1:], row[1:]))
    columns = "".join(f'<th scope="col" {attributes}>{heading}</th>' for heading, attributes in heads)
    return (f'<div class="table-wrap" tabindex="0" role="group" aria-label="{name}" data-table="{name}"><table>'
            f'<caption>{caption}</caption><thead><tr>{columns}</tr></thead>'
            f'<tbody><tr><th scope="row">{row[0]}</th>{cells}</tr></tbody></table></div>')


NUMBER = "class=n"
LONG_NAME = "lean_of_the_first_left_rail"
TABLES = {
    "behind": ([("feature", ""), ("zone", ""), ("effect [mm]", NUMBER), ("share [%]", NUMBER)],
               ["feature", "effect [mm]"], [LONG_NAME, "0.05 mm to the planes A, B", "0.01234", "12.3"]),
    "compared": ([("error", ""), ("A", NUMBER), ("B", NUMBER), ("unit", ""), ("change [%]", NUMBER)],
                 ["error", "A", "B", "unit"], [LONG_NAME, "0.0012345678", "0.0023456789", "mm", "12.3"]),
    "marked": ([("quantity", ""), ("in", "data-main"), ("change", NUMBER), ("value", f"{NUMBER} data-main"),
                ("unit", "")],
               ["quantity", "in", "value", "unit"], [LONG_NAME, "A", "0.0012345678", "0.0023456789", "mm"]),
    "ranked": ([("error", "data-spare=3"), ("effect [mm]", NUMBER), ("index [mm/unit]", NUMBER), ("sigma", NUMBER)],
               ["error", "effect [mm]"], [LONG_NAME, "0.0012345678", "0.0023456789", "0.0012345678"]),
}


class Figures(PageTest):
    def open_tables(self, width, style=""):
        """A page with TABLES, with a caption that has not enough room on one line."""
        caption = "The drawing: tolerances of 5 parts, each with the same share of the limit that it uses most"
        tables = "".join(table(name, caption, heads, row) for name, (heads, _, row) in TABLES.items())
        page = figures_page(WEB, add_bars).replace('<main id="main">', f'<main id="main"><section>{tables}</section>')
        self.open(page.replace("</style>", f"{style}</style>", 1), width)

    def shown(self):
        """The headings of TABLES that are seen."""
        return self.browser.run(
            """return Object.fromEntries(arguments[0].map((name) => [name,
              [...document.querySelectorAll(`[data-table=${name}] thead th`)]
                .filter((head) => head.getBoundingClientRect().width).map((head) => head.textContent)]))""",
            list(TABLES))

    def test_names_and_main_numbers_stay_on_a_narrow_page(self):
        self.open_tables(400)
        shown = self.shown()
        for name, (_, staying, _) in TABLES.items():
            with self.subTest(table=name):
                self.assertLessEqual(set(staying), set(shown[name]))
        self.assertEqual(self.sideways(), [])
        self.assertEqual(self.without_numbers(), [])

    def test_names_are_broken_behind_underscores_and_copied_whole(self):
        self.open_tables(400)
        cell = "document.querySelector('[data-table=compared] tbody th')"
        self.assertEqual(self.browser.run(f"return {cell}.textContent"), LONG_NAME)
        self.assertEqual(self.browser.run(f"return {cell}.querySelectorAll('wbr').length"), LONG_NAME.count("_"))

    def test_captions_do_not_widen_tables(self):
        self.open_tables(400, "main { padding: 0 25px }")
        self.assertEqual(self.sideways(), [])
        self.assertEqual(self.without_numbers(), [])

    def test_tables_fit_in_the_frame_that_shows_a_new_width(self):
        self.open_tables(500)
        self.browser.run(
            """addEventListener("resize", () => {
              const isWide = (wrap) => wrap.scrollWidth > wrap.clientWidth + 1;
              const wide = [...document.querySelectorAll(".table-wrap")].filter(isWide);
              window.wide = wide.map((wrap) => wrap.dataset.table);
            })""")
        self.browser.resize(400)
        self.assertEqual(self.browser.run("return window.wide"), [])

    def test_every_type_of_figure(self):
        page = self.folder / "figures.html"
        page.write_text(figures_page(WEB))
        self.check_page(page)

    def open(self, text, width=1000):
        page = self.folder / "page.html"
        page.write_text(text)
        self.browser.open(page, width)

    def test_figures_are_drawn_before_a_frame_is_shown(self):
        at_once = f"<script>window.empty = (function () {{{EMPTY}}})();</script></body>"
        self.open(figures_page(WEB).replace("</body>", at_once))
        self.assertEqual(self.browser.run("return empty"), [])

    def test_figures_out_of_sight_are_drawn_for_print(self):
        self.open(figures_page(WEB).replace("<main", '<main style="display:none"'))
        undrawn = "return [...document.querySelectorAll('.plot')].filter((plot) => !plot.querySelector('svg')).length"
        self.assertGreater(self.browser.run(undrawn), 0)
        self.assertEqual(self.browser.run("dispatchEvent(new Event('beforeprint'));" + undrawn), 0)

    def test_a_slice_of_the_workspace(self):
        self.open(figures_page(WEB, add_small_fields))
        shown = """const figure = document.querySelector("[data-figure=workspace_small]");
            const dots = [...figure.querySelector(".views svg").querySelectorAll("[data-mark=dot] circle")];
            return [dots.length, dots.filter((dot) => Number(dot.getAttribute("opacity") ?? 1) < 0.5).length,
              figure.querySelector("[type=range]").getAttribute("aria-valuetext")]"""
        count, faint, words = self.browser.run(shown)
        self.assertEqual(faint, 0)
        self.assertTrue(words.startswith("all "), words)
        self.browser.run("""const slider = document.querySelector("[data-figure=workspace_small] [type=range]");
            slider.value = 3; slider.dispatchEvent(new Event("input"));""")
        still, faint, words = self.browser.run(shown)
        self.assertRegex(words, r" from .* to ")
        self.assertEqual(still, count)
        self.assertTrue(0 < faint < count, (faint, count))

    def test_a_coordinate_that_does_not_vary_is_left_out(self):
        self.open(figures_page(WEB, add_plane))
        texts = self.browser.run("""const figure = document.querySelector("[data-figure=workspace_plane]");
            const views = [...figure.querySelectorAll(".views svg")];
            return [figure.querySelectorAll("[type=range]").length, ...views.map((svg) => svg.textContent)]""")
        self.assertEqual(len(texts), 2, "one view, without a slider")
        self.assertEqual(texts[0], 0)
        self.assertIn("z [mm]", texts[1])
        self.assertNotIn("alpha", texts[1])

    def test_what_is_0_everywhere_is_not_drawn_below_0(self):
        self.open(figures_page(WEB, add_small_fields, add_lines))
        legend, axis = self.browser.run(
            """const map = document.querySelector("[data-figure=map_small]");
            const select = map.querySelector("select");
            select.value = arguments[0];
            select.dispatchEvent(new Event("change"));
            const ticks = (svg) => [...svg.querySelectorAll("text")].map((text) => text.textContent).join(" ");
            return [map.querySelector(".legend svg"), document.querySelector("[data-figure=by_pose] svg")].map(ticks)""",
            NO_EFFECT)
        for text in (legend, axis):
            self.assertRegex(text, "[0-9]")
            self.assertNotRegex(text, "[-\u2212]")

    def test_bars_in_several_units_stand_in_the_order_of_a_quantity_in_one(self):
        self.open(figures_page(WEB, add_bars))
        names, said = self.browser.run(
            """const figure = document.querySelector("[data-figure=ranking]");
            const shown = () => [...figure.querySelectorAll("[data-mark='y-axis tick label'] text")].map((t) => t.textContent);
            const select = [...figure.querySelectorAll("select")].at(1);
            const first = shown();
            select.selectedIndex = 1;
            select.dispatchEvent(new Event("change"));
            return [[first, shown()], figure.querySelector(".plot svg").getAttribute("aria-label")]""")
        self.assertGreater(len(names[0]), 20)
        self.assertEqual(*names)
        self.assertNotIn("largest", said)

    def test_pose_numbers_are_not_joined_by_lines(self):
        self.open(figures_page(WEB, add_lines))
        count = "return document.querySelectorAll('[data-figure=by_pose] [data-mark={}]').length"
        self.assertEqual(self.browser.run(count.format("line")), 0)
        self.assertGreater(self.browser.run(count.format("dot")), 0)

    def test_names_of_lines_are_whole_at_any_width(self):
        for width in WIDTHS:
            self.open(figures_page(WEB, add_lines), width)
            panel = "return document.querySelector('[data-figure=trajectory] .panel').textContent"
            self.assertIn("FS+T+R, a set with quite a long name", self.browser.run(panel))

    def test_extremes(self):
        """A panel without series, and dots that are all negative."""
        self.open(figures_page(WEB, add_extremes))
        text = self.browser.run("return document.querySelector('[data-figure=nothing]').textContent")
        self.assertIn("Nothing to show here.", text)
        outside = self.browser.run(
            """const svg = document.querySelector("[data-figure=negative] svg");
            const frame = [56, svg.viewBox.baseVal.width - 16];
            return [...svg.querySelectorAll("[data-mark=dot] circle")].map((dot) => dot.cx.baseVal.value)
              .filter((x) => x <= frame[0] || x >= frame[1])""")
        self.assertEqual(outside, [])

    def test_what_is_a_hundredfold_apart_has_a_logarithmic_axis_until_the_reader_chooses(self):
        self.open(figures_page(WEB, add_apart))
        ticks, widths, linear = self.browser.run(
            """const bars = document.querySelector("[data-figure=bars]");
            const ticks = () => [...bars.querySelectorAll("[data-mark='x-axis tick label'] text")].map((t) => t.textContent);
            const widths = () => [...bars.querySelectorAll("[data-mark=rect] rect")].map((bar) => bar.width.baseVal.value);
            const first = [ticks(), widths()];
            const scale = [...bars.querySelectorAll("select")].at(-1);
            scale.selectedIndex = 0;
            scale.dispatchEvent(new Event("change"));
            return [...first, ticks()]""")
        self.assertIn("0.01", ticks)
        self.assertIn("1", ticks)
        self.assertNotIn("0.0", ticks)
        self.assertEqual(sum(width > 10 for width in widths), 7)  # all bars except that of the value 0
        self.assertIn("0.0", linear)
        dots = self.browser.run(
            """return [...document.querySelectorAll("[data-figure=dots] [data-mark=dot] circle")].map((dot) => dot.cy.baseVal.value)""")
        self.assertEqual(len(dots), 3)
        self.assertGreater(min(abs(a - b) for a, b in zip(dots, dots[1:])), 10)

    def test_maps_start_in_the_order_that_the_report_names(self):
        self.open(figures_page(WEB, add_apart))
        chosen, ticks, legend, said = self.browser.run(
            """const map = document.querySelector("[data-figure=map]");
            const texts = (where) => [...map.querySelectorAll(where)].map((text) => text.textContent);
            map.querySelector(".map").dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowRight"}));
            return [map.querySelector(".controls label:last-child select").value,
              texts("[data-mark='x-axis tick label'] text"), texts(".legend svg text"), map.querySelector(".readout").textContent]""")
        self.assertEqual(chosen, "|beta|")
        self.assertEqual(ticks, ["5", "10", "20", "30"])
        self.assertIn("a shift of the first hole", said)
        self.assertIn("pose 3", said)
        self.assertIn("4", " ".join(legend))
        self.assertIn("\u22124", " ".join(legend))  # symmetric about 0 although all values are negative

    def test_the_view_that_can_be_turned_has_numbers_and_is_reset(self):
        self.open(figures_page(WEB, add_small_fields))
        first, turned, back = self.browser.run(
            """const view = document.querySelector("[data-figure=workspace_small] .turning-view");
            const texts = () => [...view.querySelectorAll("svg text")].map((text) => text.textContent).join(" ");
            const where = () => view.querySelector("svg").getAttribute("aria-label");
            const first = [where(), texts()];
            view.querySelector(".turning").dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowLeft"}));
            const turned = where();
            const button = view.querySelector("button");
            button.click();
            return [first, turned, [where(), button.textContent]]""")
        self.assertRegex(first[1], r"\b550\b.*\b600\b.*\b650\b")
        self.assertNotEqual(first[0], turned)
        self.assertEqual(back, [first[0], "Reset view"])

    def test_sliders_of_sizes_change_yield_and_cost(self):
        self.open(figures_page(WEB, add_what_if))
        first, smaller, larger = self.browser.run(
            """const figure = document.querySelector("[data-figure=what-if]");
            const said = () => figure.querySelector("output").textContent;
            const move = (k) => figure.querySelectorAll("input").forEach((input) => {
              input.value = k;
              input.dispatchEvent(new Event("input"));
            });
            const first = said();
            move(0);
            const smaller = said();
            move(4);
            return [first, smaller, said()]""")
        predicted = lambda text: float(re.search(r"Predicted yield ([\d.]+)", text)[1])
        self.assertEqual(predicted(first), 80)
        self.assertIn("(78.0\u202f% to 82.0\u202f%)", first)
        self.assertGreater(predicted(smaller), 85)
        self.assertLess(predicted(larger), 70)
        for text, cost in ((first, "13"), (smaller, "16"), (larger, "11.5")):
            self.assertIn(f"Predicted cost {cost}; the study: 13.", text)

    def test_names_are_set_as_in_print_and_stay_plain_for_all_else(self):
        page = figures_page(WEB, add_bars).replace(
            "<h1>Figures</h1>", "<h1>Figures of epsilon_1_4_y, q_0.95 and beta</h1>"
            "<p id='plain'>tip_x, results/a_1.h5, alphabet, e.g. not_converged</p>")
        self.open(page)
        heading = self.browser.run(
            """const names = [...document.querySelectorAll("h1 .name")];
            const shown = (e, where) => getComputedStyle(e, where).content.split('"')[1];
            return [document.querySelector("h1").textContent, document.querySelector("#plain .name"),
              names.map((e) => [shown(e, "::before"), e.dataset.index, e.title])]""")
        self.assertEqual(heading[0], "Figures of epsilon_1_4_y, q_0.95 and beta")
        self.assertIsNone(heading[1])
        self.assertEqual([name[:2] for name in heading[2]], [["ε", "1,4,y"], ["q", "0.95"], ["β", ""]])
        self.assertTrue(heading[2][0][2].startswith("epsilon_1_4_y"))
        ticks = self.browser.run(
            """return [...document.querySelectorAll("[data-figure=ranking] [data-mark='y-axis tick label'] text")]
              .map((text) => text.textContent)""")
        self.assertTrue(all(tick.startswith("δ") for tick in ticks), ticks)

    def test_faults_are_found(self):
        """The checks themselves: a page with one fault of each kind."""
        page = self.folder / "faults.html"
        whole = figures_page(WEB, add_bars)
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


class ReportTest(PageTest):
    """Makes reports of studies."""

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
        self.check_answer(page)
        return page

    def check_answer(self, page):
        """A report says first what was found, in five lines at the most, the last of which is what to do."""
        self.browser.open(page, max(WIDTHS))
        first, words, texts = self.browser.run(
            """const section = document.querySelector("main section");
            const texts = (tag) => [...section.querySelectorAll(tag)].map((e) => e.textContent);
            return [section.id, texts("dt"), texts("dd")]""")
        self.assertEqual(first, "answer")
        self.assertLessEqual(len(words), 5)
        self.assertIn(words[0], ("Limits", "Answer"))
        self.assertIn("Answer", words)
        self.assertEqual(words[-1], "What to do")
        for text in texts:
            self.assertNotRegex(text, r"\bnan\b|\binf\b|  |\(\)")
            self.assertRegex(text, r"[.)]$")


class Reports(ReportTest):
    def test_published_sensitivity_study(self):
        study = ROOT / "results" / "2upr-rpu-sensitivity" / "study.toml"
        self.check_page(self.report("sensitivity", self.result("sensitivity", study)))

    def test_the_mechanism_is_turned_and_shown_at_its_poses(self):
        study = self.poesy("template", "3-prs", "--full").replace("samples = 1000", "samples = 20")
        page = self.report("mechanism", self.result("mechanism", study))
        self.browser.open(page, 1000)
        shown = """const figure = document.querySelector("[data-figure=robot]");
            const pictures = [...figure.querySelectorAll(".robot-pose")].filter((one) => one.getBoundingClientRect().width);
            return [pictures.map((one) => one.querySelector(".plot-title").textContent),
              figure.querySelector("[role=status]").textContent,
              pictures[0].querySelectorAll(".displaced path").length,
              pictures[0].querySelector(".joint").getAttribute("transform")]"""
        first = self.browser.run(shown)
        self.assertEqual(first[0], ["At home"])
        self.assertIn("limb ", first[1])
        self.assertIn("to first order", first[1])
        self.assertEqual(first[2], 1)
        slide = """const slider = document.querySelector("[data-figure=robot] [type=range]");
            slider.value = 1; slider.dispatchEvent(new Event("input"));"""
        self.browser.run(slide)
        worst = self.browser.run(shown)
        self.assertEqual(len(worst[0]), 1)
        self.assertIn("is largest", worst[0][0])
        name = self.browser.run(
            """const cell = [...document.querySelectorAll("[data-table=ranked] tbody th")].at(-1);
            cell.click(); return cell.textContent""")
        chosen = self.browser.run(shown)
        self.assertTrue(chosen[1].startswith(name), chosen[1])
        not_drawn = "return document.querySelector('[data-figure=robot] .marked text:last-of-type').textContent"
        self.assertTrue(self.browser.run(not_drawn))

    def test_columns_without_room_are_hidden_until_one_asks(self):
        study = self.poesy("template", "3-prs", "--full").replace("samples = 1000", "samples = 20")
        page = self.report("columns", self.result("columns", study))
        shown = """const wrap = document.querySelector("[data-table=ranked]");
            const seen = (tag) => [...wrap.querySelectorAll(tag)].filter((cell) => cell.getBoundingClientRect().width);
            const button = wrap.nextElementSibling;
            return [seen("thead th").length, seen("tbody tr:first-child > *").length, wrap.querySelectorAll("thead th").length,
              button.hidden ? "" : button.textContent]"""
        self.browser.open(page, 400)
        heads, cells, every, words = self.browser.run(shown)
        self.assertEqual(heads, cells)
        self.assertLess(heads, every)
        self.assertEqual(words, f"Show {every - heads} more columns")
        self.assertEqual(self.browser.run("return document.querySelector('[data-table=ranked] thead th').textContent"), "rank")
        self.browser.run("document.querySelector('[data-table=ranked]').nextElementSibling.click()")
        self.assertEqual(self.browser.run(shown), [every, every, every, "Fewer columns"])
        self.browser.open(page, 2400)
        self.assertEqual(self.browser.run(shown), [every, every, every, ""])
        self.browser.open(page, 400)
        self.browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        printed = self.browser.run(shown)[0]
        self.assertLess(printed, every)
        note = self.browser.run("return document.querySelector('[data-table=ranked] ~ .paper-note').textContent")
        self.assertTrue(note.startswith(f"{every - printed} more columns"), note)

    def test_coupled_errors_along_a_trajectory(self):
        study = ROOT / "results" / "3prs-paper" / "studies" / "trajectory.toml"
        self.check_page(self.report("coupling", self.result("coupling", study)))

    def test_identification(self):
        study = ROOT / "results" / "2upr-rpu-paper" / "studies" / "identification.toml"
        self.check_page(self.report("identification", self.result("identification", study)))

    def test_monte_carlo(self):
        template = self.poesy("template", "3-prs", "monte-carlo", "--full").replace('"per machine"', '"per pose"')
        limited = template.replace("[solver]", '[analysis.limits]\nposition = "30 mm"\nrotation = "8 deg"\n[solver]')
        self.check_page(self.report("monte-carlo", self.result("monte-carlo", limited)))
        marked = self.browser.run(
            """return [...document.querySelectorAll("[data-figure^=distribution] svg")].map((svg) =>
              [...svg.querySelectorAll("text")].filter((text) => /^limit [\\d.]+/.test(text.textContent)).length)""")
        self.assertEqual(sorted(marked), [0, 0, 1, 1, 1, 1])  # two panels per response; two of three have a limit
        shaded = self.browser.run(
            "return document.querySelectorAll('[data-figure^=distribution] svg rect[height]').length")
        self.assertEqual(shaded, 4)

    def test_comparison(self):
        template = self.poesy("template", "2upr-rpu", "--full")
        smaller = template.replace('sigma = "1 mm"', 'sigma = "0.5 mm"')
        self.check_page(self.report("comparison", self.result("before", template), self.result("after", smaller)))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
