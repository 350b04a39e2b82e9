"""What a paper uses of a result: tables in LaTeX, and a description of the method."""

import json
import re
import shutil
import subprocess
import unittest

from poesy_program import EACH_A_PART, GALLERY, MECHANISMS, ProgramTest, main

MACHINES = """\
format = "poesy-study"
version = 1
mechanism = { model = "2upr-rpu" }
solver = { metric = "platform" }
poses = { count = 3 }
errors.linear = { distribution = "normal", sigma = "0.02 mm" }
errors.angular = { distribution = "normal", sigma = "0.01 deg" }
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = "deforming-all"
samples = 1500
limits = { gap = "0.04 mm" }
"""
MACROS = {"textbackslash{}": "\\", "textasciitilde{}": "~", "textasciicircum{}": "^", "textless{}": "<", "textgreater{}": ">",
          "textbar{}": "|", "char34{}": '"'}
DRAWING = """\
format = "poesy-study"
version = 1
mechanism.file = "linear-delta-drawing.toml"
poses.count = 3
errors.zones = { distribution = "normal", sigmas = 3 }
[analysis]
kind = "allocation"
limits = { tip_position = "0.15 mm" }
yield = 0.95
samples = 600
[[analysis.parts]]
zones = "all"
identical_limbs = [1, 2, 3]
each = true
cost = { law = "reciprocal", b = 1, unit = "mm" }
"""
# The commands that tables may use: those of LaTeX without packages, the rules of booktabs, and one command of array.
COMMANDS = {"begin", "end", "centering", "caption", "label", "toprule", "midrule", "bottomrule", "par", "footnotesize",
            "begingroup", "endgroup", "setlength", "tabcolsep", "endhead", "endfoot", "times", "textbar", "textless",
            "textgreater", "textbackslash", "char", "O", "pm", "mu", "infty", "fontsize", "selectfont", "raggedright", "arraybackslash",
            "LTcapwidth", "linewidth"}


def plain(cell):
    """A cell of LaTeX as `poesy show --json` has it."""
    if cell == "--":
        return "-"
    if re.fullmatch(r"\$[^$]*\$", cell) and "\\times$" not in cell:
        number = cell[1:-1].replace("\\,", " ").replace("\\infty", "inf")
        times = re.fullmatch(r"(.*)\\times10\^\{(-?)(\d+)\}", number)
        return number if times is None else f"{times[1]}e{times[2] or '+'}{int(times[3]):02d}"
    for macro, sign in MACROS.items():
        cell = cell.replace("\\" + macro, sign)
    return re.sub(r"\\([&%$#_{}])", r"\1", cell)


def rows_of(text):
    """The cells of all rows between the rules."""
    body = text.split("\\midrule\n")[1].split("\\bottomrule\n")[0 if "longtable" not in text else 1].replace("\\endfoot\n", "")
    body = body.split("\\end{")[0]
    return [[cell for cell in line.removesuffix(" \\\\").split(" & ")] for line in body.splitlines() if line]


def printed(table, text):
    """The positions of the columns that a file has, by its headings."""
    lines = text.split("\\toprule\n")[1].split("\\midrule\n")[0].removesuffix(" \\\\\n").split(" \\\\\n")
    parts = zip(*([plain(cell.removeprefix("{}").strip()) for cell in re.split(r"(?:^| )& ?", line)] for line in lines))
    headings = [" ".join(part for part in column if part) for column in parts]
    kept = []
    for position, column in enumerate(table["columns"]):
        heading = column["heading"] or column["name"]
        if len(kept) < len(headings) and re.sub(r" ?\[[^]]*\]$", "", headings[len(kept)]) == heading:
            kept.append(position)
    assert len(kept) == len(headings), (headings, table["columns"])
    return kept


def short(cell):
    """A number without zeros at its end, because a column of a paper has as many digits in all rows."""
    number = re.fullmatch(r"([+-]?\d+\.\d*?)0+(e.*)?", cell)
    return cell if number is None else number[1].removesuffix(".") + (number[2] or "")


class Paper(ProgramTest):
    def check_columns(self, table, kept, rows):
        """All numbers with a decimal point in a column have as many digits, except those that rounding left with fewer."""
        for column, position in enumerate(kept):
            cells = [plain(row[column]) for row in rows]
            values = [row[table["columns"][position]["name"]] for row in table["rows"]]
            if table["columns"][position]["kind"] != "number" or not any("." in cell for cell in cells):
                continue
            most = max(self.digits(cell) for cell in cells if "." in cell)
            for cell, value in zip(cells, values):
                if isinstance(value, float) and value != 0.0 and float(f"{value:.{most}g}") == float(cell.replace(" ", "")):
                    self.assertGreaterEqual(self.digits(cell), most, (table["name"], cells))

    @staticmethod
    def digits(cell):
        return len(re.sub(r"^0+", "", re.sub(r"\D", "", cell.split("e")[0])))

    def check_rows(self, text):
        """All rows, also that of the headings, have as many cells as the table has columns."""
        preamble = re.search(r"\\begin\{(?:tabular|longtable)\}\{@\{\}(.*)@\{\}\}", text)[1]
        columns = len(re.sub(r">\{[^}]*\}p\{[0-9]+pt\}", "p", preamble))
        rows = [line for line in text.splitlines() if line.endswith(" \\\\") and not line.startswith("\\caption")]
        self.assertGreater(len(rows), 0)
        for row in rows:
            self.assertEqual(len(re.findall(r"(?<!\\)&", row)), columns - 1, row)

    def test_a_ranking_fits_in_one_column(self):
        self.write("study.toml", MACHINES.replace('"monte-carlo"\ndraws = "per machine"', '"sensitivity"').replace("1500", "60")
                   .replace('limits = { gap = "0.04 mm" }\n', ""))
        self.succeeds("run", "study.toml", "--quiet")
        self.succeeds("export", "study.h5", "-d", "tables", "--latex", "--top", "5", "--response", "angular_deformation")
        text = (self.folder / "tables/ranked.tex").read_text()
        self.assertEqual(len(rows_of(text)), 5)
        self.check_rows(text)
        self.assertIn("Effect of each error on angular\\_deformation", text)
        self.assertIn("index $\\times$ sigma", text)
        self.assertIn("not converged, published\n", text.split("\\begin{table}")[0])
        self.assertNotIn("published", text.split("\\begin{table}")[1])  # neither as a column nor in a note
        self.assertIn("low, high: its 95 \\% interval", text)
        whole = json.loads(self.succeeds("show", "study.h5", "--json"))["tables"]
        self.assertTrue(any("published: " in note for table in whole for note in table["notes"]))
        self.assertLessEqual(set(re.findall(r"\\([A-Za-z]+)", text.split("\n", 1)[1])), COMMANDS)
        done = self.poesy("export", "study.h5", "-d", "other", "--top", "5")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"--latex", done.stderr)

    def run_machines(self):
        self.write("study.toml", MACHINES)
        self.assertIn(self.poesy("run", "study.toml", "--quiet").returncode, (0, 6))

    def test_tables_have_the_cells_that_are_shown(self):
        self.run_machines()
        shown = json.loads(self.succeeds("show", "study.h5", "--json"))["tables"]
        written = self.succeeds("export", "study.h5", "-d", "tables", "--latex").split()
        self.assertEqual(written, [f"tables/{table['name']}.tex" for table in shown] +
                         [f"tables/{name}.tex" for name in ("coordinates", "errors", "responses")])
        for table in shown:
            text = (self.folder / f"tables/{table['name']}.tex").read_text()
            rows = rows_of(text)
            kept = printed(table, text)
            self.assertEqual([[short(plain(cell)) for cell in row] for row in rows],
                             [[short(row[c]) for c in kept] for row in table["shown"]], table["name"])
            self.check_columns(table, kept, rows)
            self.check_rows(text)
            self.assertIn(f"\\label{{tab:{table['name']}}}", text)
            for environment in re.findall(r"\\begin\{(\w+)\}", text):
                self.assertEqual(text.count(f"\\end{{{environment}}}"), 1)
        errors = (self.folder / "tables/errors.tex").read_text()
        self.assertIn("delta\\_1\\_1\\_y & mm & ", errors)
        self.assertIn("\\begin{longtable}{@{}ll", errors)

    def test_a_drawing_compiles_without_further_packages(self):
        self.write("linear-delta-drawing.toml", (MECHANISMS / "linear-delta-drawing.toml").read_text())
        self.write("study.toml", DRAWING)
        self.assertIn(self.poesy("run", "study.toml", "--quiet").returncode, (0, 6))
        self.succeeds("export", "study.h5", "-d", "tables", "--latex")
        for path in (self.folder / "tables").glob("*.tex"):
            text = path.read_text(encoding="utf-8")
            self.assertTrue(text.isascii(), path.name)
            self.assertRegex(text.split("\n")[0], r"^% needs \\usepackage\{(array,)?booktabs(,longtable)?\}$")
            code = "\n".join(text.split("\n")[1:])
            self.assertLessEqual(set(re.findall(r"\\([A-Za-z]+)", code)), COMMANDS, path.name)
            self.assertEqual(code.count("{"), code.count("}") , path.name)
        drawing = (self.folder / "tables/drawing.tex").read_text()
        table = next(one for one in json.loads(self.succeeds("show", "study.h5", "--json"))["tables"] if one["name"] == "drawing")
        self.assertGreaterEqual(len(table["columns"]), 15)
        self.assertEqual([table["columns"][c]["name"] for c in printed(table, drawing)],
                         ["feature", "symbol", "zone", "datums", "cost"])
        rail = next(line for line in drawing.split("\n") if line.startswith("1-3 rail & "))
        self.assertRegex(rail, r"^1-3 rail & position & \\O\{\}0\.\d+ mm & A\\textbar\{\}B & \$\d+\.\d+\$ ")
        self.assertIn("$\\pm$", drawing)
        self.compile()

    def test_own_names_and_descriptions(self):
        """Signs of LaTeX in the words of a mechanism's file change nothing but the words."""
        mechanism = (GALLERY / "tricept/tricept.toml").read_text()
        mechanism = mechanism.replace('"length of a leg"', "'a $leg_{1}$ & 100 % of \\\\it#~^'")
        self.assertIn("$leg_", mechanism)
        self.write("tricept.toml", mechanism)
        study = (GALLERY / "tricept/study.toml").read_text().replace("samples = 1000", "samples = 20").replace("count = 20", "count = 2")
        self.write("study.toml", study)
        self.succeeds("run", "study.toml", "--quiet")
        self.succeeds("export", "study.h5", "-d", "tables", "--latex")
        errors = (self.folder / "tables/errors.tex").read_text()
        self.assertIn("a \\$leg\\_\\{1\\}\\$ \\& 100 \\% of \\textbackslash{}\\textbackslash{}it\\#\\textasciitilde{}\\textasciicircum{}", errors)
        self.compile()

    def compile(self, size=85):
        """Compiles all tables where there is a LaTeX. No line is wider than the page."""
        if shutil.which("pdflatex") is None:
            return
        tables = "".join(f"\\input{{{path}}}\\clearpage\n" for path in sorted((self.folder / "tables").glob("*.tex")))
        self.write("paper.tex", "\\documentclass{article}\n\\usepackage{array,booktabs,longtable}\n"
                                f"\\setlength{{\\textwidth}}{{{size}mm}}\n\\begin{{document}}\n{tables}\\end{{document}}\n")
        done = subprocess.run(["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "paper.tex"], cwd=self.folder,
                              capture_output=True, timeout=300, check=False)
        said = done.stdout.decode(errors="replace")
        self.assertEqual(done.returncode, 0, said[-2000:])
        self.assertEqual([too for too in re.findall(r"Overfull \\hbox \(([\d.]+)pt too wide", said) if float(too) > 1.0], [], said)

    def small_results(self):
        """One result of each kind."""
        for kind in ("sensitivity", "identification", "evaluate", "monte-carlo", "sobol", "allocation", "coupling"):
            text = self.succeeds("template", "3-prs" if kind == "coupling" else "2upr-rpu", kind)
            text = re.sub(r"^samples = \d+", "samples = 100", re.sub(r"^count = \d+", "count = 3", text, flags=re.M), flags=re.M)
            self.write("study.toml", text)
            self.assertIn(self.poesy("run", "study.toml", "-o", f"{kind}.h5", "--quiet").returncode, (0, 5, 6), kind)
            yield f"{kind}.h5"
        self.write("study.toml", MACHINES)
        self.succeeds("sweep", "study.toml", "--set", "errors.linear.sigma=0.01,0.02mm", "-o", "sweep.h5", "--quiet")
        yield "sweep.h5"
        for path in (MECHANISMS.parent / "calibration").iterdir():
            shutil.copyfile(path, self.folder / path.name)
        self.succeeds("calibrate", "delta-measured.toml", "--measured", "delta-heights.csv", "-o", "calibration.h5")
        yield "calibration.h5"

    @unittest.skipUnless(shutil.which("pdflatex"), "pdflatex is not installed")
    def test_tables_of_every_kind_fit_in_their_width(self):
        for result in self.small_results():
            for size in (85, 170):
                with self.subTest(result=result, size=size):
                    shutil.rmtree(self.folder / "tables", ignore_errors=True)
                    self.succeeds("export", result, "-d", "tables", "--latex", "--size", f"{size}mm")
                    self.compile(size)

    def test_a_yield_has_its_limit(self):
        self.run_machines()
        self.succeeds("export", "study.h5", "-d", "tables", "--latex")
        text = (self.folder / "tables/yield.tex").read_text()
        self.assertRegex(text, r"gap & .*\$0\.04\$ & mm \\\\")
        for size, said in (("30mm", b"40 to 400 mm"), ("wide", b"e.g. 85mm or 170mm"), ("2deg", b"e.g. 85mm or 170mm")):
            done = self.poesy("export", "study.h5", "-d", "tables", "--latex", "--size", size)
            self.assertEqual(done.returncode, 2)
            self.assertIn(said, done.stderr)

    def test_tables_are_kept_beside_csv_of_the_same_result(self):
        self.run_machines()
        self.succeeds("export", "study.h5", "-d", "tables")
        before = {path.name for path in (self.folder / "tables").iterdir()}
        self.succeeds("export", "study.h5", "-d", "tables", "--latex")
        after = {path.name for path in (self.folder / "tables").iterdir()}
        self.assertLess(before, after)
        self.compile()

    def test_the_method_has_the_numbers_of_the_study(self):
        self.run_machines()
        text = self.succeeds("show", "study.h5", "--method", "--width", "1000")
        words = " ".join(text.split())
        result = json.loads(self.succeeds("show", "study.h5", "--json"))
        for said in ("kind monte-carlo of the mechanism 2upr-rpu", f"poesy {result['poesy_version']} ({result['git_commit']})",
                     "41 geometric errors were drawn (linear: ", "0.02 mm", "0.01 deg", "solved at 3 poses (selected: interior; z -270 mm to -210 mm, ",
                     "for 1500 machines", "platform", "All 4 500 solves converged", "gap (0.04 mm)", "The yield is ",
                     "the seed 1", "begins with " + result["content_sha256"][:12], "@misc{poesy,"):
            self.assertIn(said, words)
        released = re.search(r'^date-released: "(\d+)-', (GALLERY.parents[1] / "CITATION.cff").read_text(), re.M)
        self.assertIn(f"year = {{{released[1]}}}", words)
        self.assertIn("doi = {10.1093/biomet/26.4.404}", words)
        self.assertNotIn("relative: ", words)  # the study has no relative errors
        done = self.poesy("show", "study.h5", "study.h5", "--method")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"--method describes one result", done.stderr)
        done = self.poesy("show", "study.h5", "--method", "--json")
        self.assertEqual(done.returncode, 2)

    def method_of(self, result):
        """The paragraph and the names of the BibTeX entries."""
        text = self.succeeds("show", result, "--method", "--width", "1000")
        return " ".join(text.split()), re.findall(r"^@\w+\{(\w+),$", text, re.MULTILINE)

    def test_the_method_states_fidelity_geometry_and_sources(self):
        shutil.copyfile(GALLERY / "tricept" / "tricept.toml", self.folder / "tricept.toml")
        study = (GALLERY / "tricept" / "yield.toml").read_text().replace("samples = 5000", "samples = 200")
        self.write("study.toml", study)
        self.poesy("run", "study.toml", "--quiet")
        words, sources = self.method_of("study.h5")
        for said in ("The equations of the mechanism were solved to first order in the errors.", "All errors vary together.",
                     "No metric weighs angles against lengths, because the mechanism needs none."):
            self.assertIn(said, words)
        self.assertNotIn("The geometry differs", words)
        self.assertEqual(sources, ["poesy", "clopper1934"])
        self.poesy("sweep", "study.toml", "--set", "geometry.a=150:250:50mm", "-o", "sweep.h5", "--quiet")
        words, sources = self.method_of("sweep.h5")
        for said in ("The geometry differs from that of the mechanism's file: a = 150 mm (there 250 mm).",
                     "3 designs of the kind monte-carlo were compared, with these values: mechanism.geometry.a = 150, 200, 250 mm.",
                     "Limits: tip_position (0.2 mm).", "(Agresti and Min)", "those of Clopper and Pearson."):
            self.assertIn(said, words)
        self.assertEqual(sources, ["poesy", "clopper1934", "agresti2005"])
        self.write("exact.toml", (GALLERY / "tricept" / "study.toml").read_text().replace("samples = 1000", "samples = 20")
                   .replace("first-order", "exact"))
        self.succeeds("run", "exact.toml", "--quiet")
        words, sources = self.method_of("exact.h5")
        self.assertIn("The index of an error is the standard deviation of the response over that of the error", words)
        self.assertIn("The equations of the mechanism were solved exactly.", words)
        self.assertEqual(sources, ["poesy", "du2022", "zou2008"])
        for_latex = self.succeeds("show", "exact.h5", "--method", "--latex")
        self.assertEqual(for_latex.replace("\\", "").split("@misc")[0].split(), self.succeeds("show", "exact.h5", "--method")
                         .split("@misc")[0].split())
        self.assertNotIn("_", for_latex.split("@misc")[0].replace("\\_", ""))

    def test_the_method_states_a_calibration(self):
        for path in (MECHANISMS.parent / "calibration").iterdir():
            shutil.copyfile(path, self.folder / path.name)
        self.succeeds("calibrate", "delta-measured.toml", "--measured", "delta-heights.csv", "-o", "machine.h5")
        words, sources = self.method_of("machine.h5")
        for said in ("7 numbers were fitted to 12 deviation_z, 3 distances that were measured at 13 poses.",
                     "Residual 0.828 of the noise; chi-square 10.3 of 8 (p = 0.25)", "noise of z: 0.01 mm",
                     "noise of distance: 0.05 mm", "frame: known", "What the calibration leaves was predicted at 7 poses"):
            self.assertIn(said, words)
        self.assertNotIn("were given values", words)
        self.assertEqual(sources, ["poesy"])

    def test_the_method_states_what_overrides_and_parts_draw(self):
        study = (GALLERY / "tricept" / "yield.toml").read_text()
        shutil.copyfile(GALLERY / "tricept" / "tricept.toml", self.folder / "tricept.toml")
        self.write("parts.csv", "leg_1 [mm]\n" + "".join(f"{0.01 * k}\n" for k in range(-5, 6)))
        changed = study.replace("samples = 5000", "samples = 200").replace("[analysis]", """[errors.override]
leg_1 = { distribution = "measured", file = "parts.csv", column = "leg_1" }
leg_2 = { distribution = "uniform", half_width = "0.03 mm" }

[analysis]""")
        self.write("study.toml", changed)
        self.poesy("run", "study.toml", "-o", "study.h5")
        words = " ".join(self.succeeds("show", "study.h5", "--method").split())
        for said in ("1 measured with a standard deviation of 0.03317 mm", "1 uniform with a standard deviation of 0.01732 mm",
                     "normal with a standard deviation of 0.02 mm", "normal with a standard deviation of 0.01 deg"):
            self.assertIn(said, words)
        self.assertNotIn("linear: ", words)

    def test_the_method_states_correlated_errors(self):
        study = (GALLERY / "tricept" / "yield.toml").read_text().replace("samples = 5000", "samples = 200")
        shutil.copyfile(GALLERY / "tricept" / "tricept.toml", self.folder / "tricept.toml")
        self.write("study.toml", study + """
[[errors.correlated]]
factors = ["leg_1", "leg_2"]
correlation = [[1, 0.5], [0.5, 1]]
""")
        self.poesy("run", "study.toml", "-o", "study.h5")
        words = " ".join(self.succeeds("show", "study.h5", "--method").split())
        self.assertIn("Correlated errors, by their normal scores: [leg_1, leg_2] with [[1, 0.5], [0.5, 1]].", words)

    def test_the_method_states_means_background_and_wanted_yield(self):
        study = (GALLERY / "tricept" / "yield.toml").read_text()
        shutil.copyfile(GALLERY / "tricept" / "tricept.toml", self.folder / "tricept.toml")
        self.write("parts.csv", "leg_1 [mm]\n" + "".join(f"{0.01 * k}\n" for k in range(-3, 8)))
        self.write("study.toml", study.replace("samples = 5000", "samples = 200\nyield = 0.5").replace('factors = "all"', """\
factors = ["leg_1", "leg_2", "leg_3"]
background = { factors = ["skew_x", "offset_x"], angular = "0.02 deg" }""").replace("[analysis]", """[errors.override]
leg_1 = { distribution = "measured", file = "parts.csv", column = "leg_1" }
leg_2 = { distribution = "uniform", half_width = "0.03 mm", mean = "-0.05 mm" }

[analysis]"""))
        self.poesy("run", "study.toml", "-o", "study.h5")
        words = " ".join(self.succeeds("show", "study.h5", "--method").split())
        for said in ("Measured errors: leg_1 (11 parts, mean 0.02 mm).", "Means that the study states: leg_2 -0.05 mm.",
                     "Background, the same in all machines: 2 errors, linear = 0.02 mm, angular = 0.02 deg.",
                     "The wanted yield is 50 %. The yield is "):
            self.assertIn(said, words)

    def test_the_method_states_zones_and_sigmas(self):
        self.write("linear-delta-drawing.toml", (MECHANISMS / "linear-delta-drawing.toml").read_text())
        self.write("study.toml", DRAWING)
        self.assertIn(self.poesy("run", "study.toml", "--quiet").returncode, (0, 6))
        shown = " ".join(self.succeeds("show", "study.h5").split())
        self.assertIn("margin: chance may make these machines look better than all are, so at least 9", shown)
        self.succeeds("export", "study.h5", "-d", "csv")
        self.assertRegex((self.folder / "csv/factors.csv").read_text(), r"^factor,start_sigma")
        words = " ".join(self.succeeds("show", "study.h5", "--method").split())
        for said in ("Features of the drawing scatter in their zones (distribution = normal, sigmas = 3).",
                     "The wanted yield is 95 %."):
            self.assertIn(said, words)
        self.write("parts.toml", MACHINES.replace("monte-carlo", "allocation").replace('draws = "per machine"\n', "sigmas = 4\n")
                   .replace("1500", "600\nyield = 0.95") + EACH_A_PART)
        self.assertIn(self.poesy("run", "parts.toml", "--quiet").returncode, (0, 6))
        words = " ".join(self.succeeds("show", "parts.h5", "--method").split())
        self.assertIn("Tolerances are multiples of the standard deviation of an error (sigmas = 4).", words)


if __name__ == "__main__":
    main()
