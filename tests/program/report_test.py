"""Reports from the command line: file names, refusals, two results, and the same numbers as `poesy show --json`."""

import json
import os
import shutil
import signal
import subprocess
import time
from html.parser import HTMLParser

import h5py

from poesy_program import PROGRAM, STUDY, ProgramTest, main

MONTE_CARLO = STUDY.replace('kind = "sensitivity"', 'kind = "monte-carlo"\ndraws = "per pose"').split("background")[0] + "[run]\nseed = 5\n"


RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


def number(text):
    """The number that a page prints, or None: signs, groups and powers of ten as print has them."""
    plain = text.replace("\u2212", "-").replace("\u00a0×\u00a010", "e").translate(RAISED)
    try:
        return float(plain.replace(" ", ""))
    except ValueError:
        return None


def same(printed, shown):
    return printed == shown or (number(printed) is not None and number(printed) == number(shown))


class Page(HTMLParser):
    """Tables by name, each a list of rows of cells; ids of sections; keys of figures; the figures' data."""

    def __init__(self, text):
        super().__init__()
        self.tables, self.sections, self.figures, self.data = {}, [], [], ""
        self.rows = self.cell = None
        self.in_data = False
        self.feed(text)
        self.data = json.loads(self.data)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        if tag == "section":
            self.sections.append(given["id"])
        elif "data-table" in given:
            self.rows = self.tables.setdefault(given["data-table"], [])
        elif tag == "figure":
            self.figures.append(given["data-figure"])
        elif tag == "tr" and self.rows is not None:
            self.rows.append([])
        elif tag in ("td", "th") and self.rows is not None:
            self.cell = ""
        self.in_data = given.get("id") == "report-data"

    def handle_data(self, data):
        if self.cell is not None:
            self.cell += data
        if self.in_data:
            self.data += data

    def handle_endtag(self, tag):
        if tag in ("td", "th") and self.cell is not None:
            self.rows[-1].append(self.cell)
            self.cell = None
        self.in_data = False


class Report(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("study.toml", STUDY)
        self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")

    def page(self, name):
        return Page((self.folder / name).read_text())

    def refused(self, code, *arguments):
        done = self.poesy("report", *arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(done.stdout, b"")
        return done.stderr.decode()

    def test_stands_beside_the_result_and_is_named(self):
        self.assertEqual(self.succeeds("report", "r.h5"), "r.html\n")
        page = self.page("r.html")
        self.assertEqual(page.sections[0], "answer")
        self.assertEqual(page.sections[-2:], ["not-solved", "what-was-run"])
        self.assertIn("which-errors-matter", page.sections)
        self.assertEqual(sorted(page.figures), sorted(page.data["figures"]))
        self.assertEqual(self.succeeds("report", "r.h5", "-o", "other.html"), "other.html\n")
        self.assertEqual((self.folder / "r.html").read_bytes(), (self.folder / "other.html").read_bytes())

    def test_replaces_an_older_report_and_nothing_else(self):
        self.succeeds("report", "r.h5")
        fresh = (self.folder / "r.html").read_text()
        self.write("r.html", fresh.replace("What was run", "an older one"))
        self.succeeds("report", "r.h5")
        self.assertEqual((self.folder / "r.html").read_text(), fresh)
        self.write("empty.html", "")
        self.succeeds("report", "r.h5", "-o", "empty.html")
        self.write("foreign.html", "<!doctype html><title>foreign</title>")
        for name in ("study.toml", "foreign.html"):
            kept = (self.folder / name).read_bytes()
            self.assertIn("would be lost", self.refused(2, "r.h5", "-o", name))
            self.assertEqual((self.folder / name).read_bytes(), kept)

    def test_says_what_was_run_and_no_more(self):
        def facts():
            return {row[0]: row[1] for row in self.page("r.html").tables["what_was_run"]}

        self.succeeds("report", "r.h5")
        drawn = facts()
        self.assertEqual(drawn["seed"], "5")
        self.assertIn("linear: distribution = normal, sigma = 1 mm", drawn["sizes of the errors"])
        self.assertNotIn("on any machine", (self.folder / "r.html").read_text())
        self.write("own.toml", STUDY + '[errors.override]\ndelta_1_1_y = { distribution = "normal", sigma = "2 mm" }\n')
        self.succeeds("run", "own.toml", "-o", "r.h5", "--quiet")
        self.succeeds("report", "r.h5")
        self.assertEqual(facts()["sizes of the errors"],
                         "2 normal with a standard deviation of 0.2 deg; 1 normal with a standard deviation of 2 mm")
        self.write("p.csv", "z,beta,gamma\n-0.2,0.1,0.05\n")
        self.write("e.csv", "delta_1_1_y\n0.001\n")
        self.succeeds("evaluate", "study.toml", "--poses", "p.csv", "--errors", "e.csv", "-o", "r.h5", "--quiet")
        self.succeeds("report", "r.h5")
        table = facts()
        self.assertEqual(table["poses"], "1, from a table")
        self.assertEqual(table["samples at each pose"], "1 row of errors")
        self.assertEqual([table[name] for name in ("seed", "sizes of the errors")], ["-", "-"])
        self.assertIn("poses and errors came from tables", (self.folder / "r.html").read_text())

    def test_refuses_what_cannot_be(self):
        result = (self.folder / "r.h5").read_bytes()
        self.assertIn("also an input", self.refused(2, "r.h5", "-o", "r.h5"))
        self.assertEqual((self.folder / "r.h5").read_bytes(), result)
        self.assertIn("reports are HTML or PDF", self.refused(2, "r.h5", "-o", "r.docx"))
        self.assertFalse((self.folder / "r.docx").exists())
        self.assertIn("does not exist", self.refused(2, "r.h5", "-o", "missing/r.html"))
        self.refused(3, "missing.h5")
        self.refused(3, "study.toml")
        self.assertEqual(list(self.folder.glob("*.html")), [])

    def browser(self, script):
        """PATH with a browser that does this, and the tools it needs."""
        (self.folder / "bin").mkdir(exist_ok=True)
        path = self.write("bin/chromium", "#!/bin/sh\n" + script)
        path.chmod(0o755)
        return {"PATH": f"{path.parent}:/usr/bin:/bin"}

    def printed(self, environment, *arguments):
        return subprocess.run([PROGRAM, "report", *arguments], cwd=self.folder, capture_output=True, timeout=300,
                              check=False, env=os.environ | environment)

    def test_is_printed_where_there_is_a_browser(self):
        found = any(shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome"))
        if not found:
            self.skipTest("no Chromium")
        for _ in range(2):  # the second time it replaces its own PDF
            self.assertEqual(self.succeeds("report", "r.h5", "-o", "r.pdf"), "r.pdf\n")
            pdf = (self.folder / "r.pdf").read_bytes()
            self.assertTrue(pdf.startswith(b"%PDF-"))
            self.assertGreater(len(pdf), 20000)
        temporary = self.folder / "it's #1%20 $HOME"
        temporary.mkdir()
        done = self.printed({"TMPDIR": str(temporary)}, "r.h5", "-o", "r.pdf")
        self.assertEqual(done.returncode, 0, done.stderr)
        for foreign in (pdf.removesuffix(b"% poesy report\n"), b"my notes\n% poesy report\n"):
            self.write("foreign.pdf", foreign)
            self.assertIn("would be lost", self.refused(2, "r.h5", "-o", "foreign.pdf"))
            self.assertEqual((self.folder / "foreign.pdf").read_bytes(), foreign)

    def test_says_how_to_print_without_a_browser(self):
        done = self.printed({"PATH": str(self.folder)}, "r.h5", "-o", "r.pdf")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"open it in a browser and print it", done.stderr)
        self.assertFalse((self.folder / "r.pdf").exists())

    @staticmethod
    def printing(text):
        """A browser that prints this in place of a PDF."""
        return 'for a; do case $a in --print-to-pdf=*) echo "%s" > "${a#*=}";; esac; done' % text

    def test_is_not_written_where_the_browser_fails(self):
        temporary = self.folder / "tmp"
        temporary.mkdir()
        for script, said in (("echo no display >&2; exit 1", b"no display"), ("exit 0", b"said: nothing"),
                             ("echo one; echo two; kill -9 $$", b"said: two"),
                             (self.printing("%PDF-1.4"), b"was not"), (self.printing("an error, %%EOF"), b"was not")):
            with self.subTest(script):
                done = self.printed(self.browser(script) | {"TMPDIR": str(temporary)}, "r.h5", "-o", "r.pdf")
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertIn(said, done.stderr)
                self.assertFalse((self.folder / "r.pdf").exists())
                self.assertEqual(list(temporary.iterdir()), [])
        done = self.printed({"TMPDIR": str(self.folder / "nowhere")}, "r.h5", "-o", "r.pdf")
        self.assertEqual(done.returncode, 3)
        self.assertIn(b"r.pdf: was not printed: no temporary folder can be made; set TMPDIR", done.stderr)

    def test_ends_the_browser_when_interrupted(self):
        temporary = self.folder / "tmp"
        temporary.mkdir()
        environment = self.browser(f"echo $$ > {self.folder}/id; exec sleep 100") | {"TMPDIR": str(temporary)}
        started = subprocess.Popen([PROGRAM, "report", "r.h5", "-o", "r.pdf"], cwd=self.folder, stderr=subprocess.PIPE,
                                   env=os.environ | environment, start_new_session=True)
        while not (self.folder / "id").exists() or not (self.folder / "id").read_text().endswith("\n"):
            time.sleep(0.02)
        os.killpg(started.pid, signal.SIGINT)  # like Ctrl-C
        self.assertIn(b"is not written", started.communicate(timeout=60)[1])
        self.assertEqual(started.returncode, 4)
        with self.assertRaises(ProcessLookupError):
            os.kill(int((self.folder / "id").read_text()), 0)
        self.assertFalse((self.folder / "r.pdf").exists())
        self.assertEqual(list(temporary.iterdir()), [])

    def test_refuses_two_results_of_different_kinds(self):
        self.write("mc.toml", MONTE_CARLO)
        self.succeeds("run", "mc.toml", "-o", "mc.h5", "--quiet")
        self.assertIn("its kind is 'monte-carlo', not 'sensitivity'", self.refused(2, "r.h5", "mc.h5"))
        self.assertEqual(list(self.folder.glob("*.html")), [])

    def test_says_over_which_poses_indices_add_up(self):
        self.write("mc.toml", MONTE_CARLO)
        self.succeeds("run", "mc.toml", "-o", "mc.h5", "--quiet")
        self.succeeds("report", "mc.h5")
        self.assertIn("Variances are added up over 6 poses. ", (self.folder / "mc.html").read_text())

    def test_has_the_cells_of_show(self):
        self.succeeds("report", "r.h5")
        tables = self.page("r.html").tables
        shown = json.loads(self.succeeds("show", "r.h5", "--json"))["tables"]
        self.assertTrue(shown)
        for table in shown:
            with self.subTest(table["name"]):
                rows = tables[table["name"]][1:]
                self.assertEqual([len(row) for row in rows], [len(row) for row in table["shown"]])
                cells = [pair for row, others in zip(rows, table["shown"]) for pair in zip(row, others)]
                self.assertEqual([pair for pair in cells if not same(*pair)], [])

    def test_compares_two_results(self):
        self.succeeds("run", "study.toml", "-o", "s.h5", "--seed", "6", "--quiet")
        self.assertEqual(self.succeeds("report", "r.h5", "s.h5"), "r-s.html\n")
        page = self.page("r-s.html")
        self.assertEqual(page.data["figures"]["side-by-side"]["series"], ["A", "B"])
        facts = {row[0]: row[1:] for row in page.tables["what_was_run"]}
        self.assertEqual(facts["seed"], ["5", "6"])
        self.assertEqual(page.tables["settings"][1:], [["run.seed", "5", "6"]])
        sections = [section for section in page.sections if section not in ("answer", "warnings")]
        self.assertEqual(sections[:2], ["which-is-better", "studies"])
        self.assertNotIn("kind of study", facts)
        self.assertIn(["kind of study", "sensitivity", "sensitivity"], page.tables["what_was_run_alike"])
        self.assertEqual({row[-1] for row in page.tables["differences_1"][1:]}, {"overlap"})

    def test_warns_of_a_result_that_was_changed(self):
        with h5py.File(self.folder / "r.h5", "r+") as result:
            result["sensitivity/global"][0, 0] *= 2.0
        done = self.poesy("report", "r.h5")
        self.assertEqual(done.returncode, 0)
        self.assertIn(b"was changed", done.stderr)
        self.assertIn("was changed since it was written", (self.folder / "r.html").read_text())


if __name__ == "__main__":
    main()
