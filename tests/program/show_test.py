"""How `poesy show` prints a result: for the available width, in the requested order, or as JSON."""

import fcntl
import json
import os
import pty
import struct
import subprocess
import termios
import unittest

import h5py
from poesy_program import PROGRAM, STUDY, ProgramTest, main

BY_PLATFORM = STUDY.replace("[solver]\n", '[solver]\nmetric = "platform"\n')
MONTE_CARLO = STUDY.replace('"sensitivity"', '"monte-carlo"\ndraws = "per pose"')


def rankings(both):
    """The table of the two rankings, among those of a comparison."""
    return next(table for table in both["tables"] if table["name"] == "rankings")


class Show(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("study.toml", STUDY)
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")

    def tables(self, *options):
        return json.loads(self.succeeds("show", "out.h5", "--json", *options))["tables"]

    def errors(self, *options):
        """The errors of the ranked table, from above."""
        return [row["error"] for row in self.tables(*options)[0]["rows"]]

    def refused(self, *arguments):
        done = self.poesy("show", "out.h5", *arguments)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stdout, b"")
        return done.stderr.decode()

    def on_terminal(self, columns, environment):
        """What a terminal of so many columns (0: it does not say) gets."""
        leader, follower = pty.openpty()
        fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        program = subprocess.Popen([PROGRAM, "show", "out.h5"], cwd=self.folder, stdout=follower,
                                   env={**os.environ, **environment})
        os.close(follower)
        text = b""
        try:
            while piece := os.read(leader, 4096):
                text += piece
        except OSError:  # the terminal's other end is closed
            pass
        os.close(leader)
        self.assertEqual(program.wait(timeout=60), 0)
        self.assertNotIn(b"\x1b", text)
        return text.decode().replace("\r\n", "\n")

    def table_width(self, text):
        """Of the tables' lines: what stands above names files and commands, which are never broken."""
        return max(map(len, text[text.index("Effect of"):].splitlines()))

    def test_a_pipe_gets_every_column(self):
        text = self.succeeds("show", "out.h5")
        self.assertIn("angular_deformation", text)
        self.assertNotIn("(no room for", text)

    def test_a_terminal_gets_what_it_has_room_for(self):
        wide = self.succeeds("show", "out.h5")
        self.assertEqual(self.on_terminal(250, {}), wide)
        narrow = self.on_terminal(80, {"COLUMNS": "250"})
        self.assertEqual(narrow, self.succeeds("show", "out.h5", "--width", "80"))
        self.assertLessEqual(self.table_width(narrow), 80)
        self.assertRegex(narrow, r"\(no room for .*angular_deformation, published: [^)]*--response\s+NAME[^)]*--json\s+shows\s+more\)")
        self.assertEqual(self.on_terminal(0, {"COLUMNS": "250"}), wide)
        self.assertEqual(self.on_terminal(0, {"COLUMNS": ""}), narrow)

    def test_width_wins_in_a_pipe(self):
        for width in (72, 90, 110):
            self.assertLessEqual(self.table_width(self.succeeds("show", "out.h5", "--width", width)), width)

    def test_sort(self):
        with h5py.File(self.folder / "out.h5") as file:
            names = list(file["factor"].asstr())
        self.assertEqual(self.errors("--sort", "order"), names)
        self.assertEqual(self.errors("--sort", "name"), sorted(names))
        for key, column in (("effect", "effect"), ("index", "index"), ("not-converged", "not_converged")):
            values = [row[column] for row in self.tables("--sort", key)[0]["rows"]]
            self.assertEqual(values, sorted(values, reverse=True), key)
        self.assertEqual(self.errors(), self.errors("--sort", "effect"))

    def test_top(self):
        self.assertEqual(self.errors("--top", 2), self.errors()[:2])
        self.assertIn("2 of 3 rows shown", self.succeeds("show", "out.h5", "--top", 2))
        self.assertNotIn("rows shown", self.succeeds("show", "out.h5", "--top", 3))
        self.assertEqual(self.errors("--sort", "name", "--top", 1), sorted(self.errors())[:1])

    def test_json_has_the_values_and_the_texts(self):
        done = json.loads(self.succeeds("show", "out.h5", "--json"))
        with h5py.File(self.folder / "out.h5") as file:
            self.assertEqual(done["content_sha256"], file.attrs["content_sha256"])
            names = list(file["factor"].asstr())
            responses = list(file["response"].asstr())
            at = responses.index("linear_deformation")
            index = dict(zip(names, file["sensitivity/global_corrected"][at]))
        self.assertEqual((done["kind"], done["model"], done["seed"], done["poses"]), ("sensitivity", "2upr-rpu", 5, 6))
        self.assertEqual(done["solves"]["total"], 3 * 6 * 1500)
        self.assertEqual(sum(done["solves"]["by_status"].values()), done["solves"]["total"])
        table = done["tables"][0]
        units = {column["name"]: column["unit"] for column in table["columns"]}
        self.assertEqual((units["effect"], units["index"], units["not_converged"]), ("mm", "mm/unit", "%"))
        text = self.succeeds("show", "out.h5")
        for row, shown in zip(table["rows"], table["shown"]):
            per_unit = {"mm": 1.0, "deg": 1000.0 * 3.141592653589793 / 180.0}[row["unit"]]
            self.assertAlmostEqual(row["index"] / (index[row["error"]] * per_unit), 1.0, places=14)
            self.assertAlmostEqual(row["effect"], row["index"] * row["sigma"], places=12)
            line = next(line for line in text.splitlines() if line.split()[1:2] == [row["error"]])
            self.assertEqual(line.split(), shown)

    def test_json_of_every_kind_is_json_alone(self):
        for kind in ("monte-carlo", "identification", "evaluate"):
            template = self.succeeds("template", "2upr-rpu", kind, "--full").replace("count = 158", "count = 3")
            self.write("kind.toml", "\n".join("samples = 200" if line.startswith("samples = ") else line
                                              for line in template.splitlines()) + "\n")
            self.succeeds("run", "kind.toml", "-o", "kind.h5", "--quiet")
            done = json.loads(self.succeeds("show", "kind.h5", "--json"))
            self.assertEqual(done["kind"], kind)
            self.assertTrue(done["tables"][0]["rows"], kind)

    def test_wrong_words_name_the_known_ones(self):
        message = self.refused("--sort", "speed")
        for word in ("--sort", "speed", "effect", "index", "name", "order", "not-converged"):
            self.assertIn(word, message)
        self.assertIn("--top", self.refused("--top", "0"))
        self.assertIn("--width", self.refused("--width", "wide"))
        self.assertIn("linear_deformation", self.refused("--response", "liniar"))
        self.assertIn("did you mean 'linear_deformation'?", self.refused("--response", "linear"))

    def test_what_is_not_ranked_is_not_sorted(self):
        self.write("all.toml", MONTE_CARLO)
        self.succeeds("run", "all.toml", "-o", "out.h5", "--quiet")
        for word in ("--sort", "monte-carlo"):
            self.assertIn(word, self.refused("--sort", "name"))
        first = [table for table in json.loads(self.succeeds("show", "out.h5", "--json", "--top", 3))["tables"]
                 if table["name"] == "first_order"]
        self.assertEqual(len(first[0]["rows"]), 3)
        self.succeeds("show", "out.h5", "--width", 80)

    def test_a_result_is_no_study(self):
        for command, what in (("run", "study"), ("models", "mechanism")):
            done = self.poesy(command, "out.h5")
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"is an HDF5 file, such as a result of poesy, not a {what}; give the {what} itself", done.stderr.decode())

    def test_failures_of_both_fidelities(self):
        template = self.succeeds("template", "3-prs", "--full").replace('fidelity = "exact"', 'fidelity = "both"', 1)
        self.write("both.toml", template.replace("count = 158", "count = 2").replace("samples = 1000", "samples = 200"))
        self.succeeds("run", "both.toml", "-o", "both.h5", "--quiet")
        text = self.succeeds("show", "both.h5")
        self.assertRegex(text, r"40 800 samples, 20 400 at each of two fidelities, in")
        self.assertIn('0 of 40 800 samples (0 %) did not converge: 0 at fidelity "exact", 0 at "first-order"', text)

    def test_failures_are_said_once(self):
        self.write("study.toml", STUDY.replace("[solver]\n", "[solver]\nmax_iterations = 4\n"))
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        text = self.succeeds("show", "out.h5", "--width", 80)
        self.assertLessEqual(max(len(line) for line in text.splitlines() if not line.startswith("replay it: ")), 80)
        self.assertEqual(text.count("did not converge"), 1)
        self.assertNotIn("failed", text)
        self.assertIn("replay it: poesy replay out.h5", text)


class Metric(ProgramTest):
    """A result says by what its mechanism weighs angles against lengths, and file, terminal, JSON and report agree."""

    PUBLISHED = "published, radians against metres at the base's origin"
    PLATFORM = "platform, by displacement of {} points"

    def words(self, study):
        self.write("study.toml", study)
        self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
        self.succeeds("report", "r.h5", "-o", "r.html")
        shown = self.succeeds("show", "r.h5")
        words = next(line for line in shown.splitlines() if line.startswith("metric: ")).removeprefix("metric: ")
        summary = json.loads(self.succeeds("show", "r.h5", "--json"))
        self.assertEqual(summary["metric"], words.split(",")[0])
        self.assertEqual((self.folder / "r.html").read_text().replace("&#39;", "'").count(words), 2)
        with h5py.File(self.folder / "r.h5") as file:
            points = file["metric/points"][:].tolist() if "points" in file["metric"] else []
            self.assertEqual(file["metric"].attrs["name"], summary["metric"])
            self.assertEqual(points, summary["metric_points"] or [])
        return words, points

    def test_published(self):
        self.assertEqual(self.words(STUDY), (self.PUBLISHED, []))

    def test_platform(self):
        words, points = self.words(BY_PLATFORM)
        self.assertEqual(words, self.PLATFORM.format(3))
        self.assertEqual(sorted(points), [[-0.06, 0, 0], [0, 0.06, 0], [0.06, 0, 0]])

    def test_points_of_the_study_in_every_kind(self):
        own = [[0.1, 0, 0], [0, 0.1, 0], [-0.1, 0, 0], [0, 0, 0.02]]
        text = ", ".join("[" + ", ".join(f'"{x} m"' for x in point) + "]" for point in own)
        for kind in ("sensitivity", "monte-carlo"):
            study = BY_PLATFORM.replace("[run]", f"points = [{text}]\n[run]").replace('"sensitivity"', f'"{kind}"')
            self.assertEqual(self.words(study), (self.PLATFORM.format(4), own))

    def test_models_that_weigh_nothing_have_none(self):
        template = self.succeeds("template", "3-prs", "--full").replace("count = 158", "count = 2")
        self.write("study.toml", template.replace("samples = 1000", "samples = 100"))
        self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
        self.assertNotIn("metric:", self.succeeds("show", "r.h5"))
        self.assertIsNone(json.loads(self.succeeds("show", "r.h5", "--json"))["metric"])
        with h5py.File(self.folder / "r.h5") as file:
            self.assertNotIn("metric", file)


class TwoRankings(ProgramTest):
    """`poesy show A B`: what both files say, beside each other."""

    ERRORS = '["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y", "epsilon_3_3_x", "epsilon_1_4_x", "delta_1_0_z"]'

    def setUp(self):
        super().setUp()
        for name, study in (("published", STUDY), ("platform", BY_PLATFORM)):
            study = study.replace('["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]', self.ERRORS)
            self.write(f"{name}.toml", study.replace('"gauss-newton"', '"newton"'))
            self.succeeds("run", f"{name}.toml", "--quiet")

    def effects(self, name, response):
        """By error, in the unit shown; below rounding there is none."""
        with h5py.File(self.folder / f"{name}.h5") as file:
            at = list(file["response"].asstr()).index(response)
            unit = {"m": 1e-3, "rad": 3.141592653589793 / 180.0, "1": 1.0}[file["responses/unit"].asstr()[at]]
            index = file["sensitivity/global_corrected"][at]
            effects = [float(one * sigma / unit) if one > 1e-10 else 0.0 for one, sigma in zip(index, file["factors/sigma"])]
            return dict(zip(file["factor"].asstr(), effects))

    def compare(self, response_a, response_b, *options):
        both = json.loads(self.succeeds("show", "published.h5", "platform.h5", "--json", *options))
        self.assertEqual([one["response"] for one in both["results"]], [response_a, response_b])
        a, b = self.effects("published", response_a), self.effects("platform", response_b)
        rows = rankings(both)["rows"]
        self.assertEqual({row["error"] for row in rows}, set(a))
        for row in rows:
            for key, effects in (("a", a), ("b", b)):
                effect = effects[row["error"]]
                self.assertAlmostEqual(row[f"effect_{key}"], effect, delta=1e-12)
                self.assertEqual(row[f"rank_{key}"], 1 + sum(other > effect for other in effects.values()))
        pairs = [(one, other) for one in a for other in a if one < other]

        def sign(effects, pair):
            one, other = (effects[error] for error in pair)
            return (one > other) - (one < other)

        agree = sum(sign(a, pair) * sign(b, pair) for pair in pairs)
        ordered = [sum(abs(sign(effects, pair)) for pair in pairs) for effects in (a, b)]
        self.assertAlmostEqual(both["kendall_tau"], agree / (ordered[0] * ordered[1]) ** 0.5, places=12)
        return both

    def test_each_by_its_own_response(self):
        both = self.compare("linear_deformation", "gap")
        self.assertLess(both["kendall_tau"], 0.9)
        self.assertEqual(both["results"][0]["metric"], "published")
        self.assertEqual(rankings(both)["rows"][-1]["error"], "epsilon_3_3_x")  # no effect with the published metric
        text = self.succeeds("show", "published.h5", "platform.h5")
        for words in ("A: ", "A: published.h5; metric: published, radians", "B: platform.h5; metric: platform, by",
                      f"Kendall's tau of the two rankings is {both['kendall_tau']:.2g}, over 6 errors", "unit of length"):
            self.assertIn(words, " ".join(text.split()))
        lines = [line.split() for line in text.splitlines()]
        for shown in rankings(both)["shown"]:
            self.assertIn(shown, lines)
        self.succeeds("report", "published.h5", "platform.h5", "-o", "both.html")
        page = (self.folder / "both.html").read_text().replace("&#39;", "'")
        self.assertIn(both["remarks"][0], page)

    def test_by_responses_asked_for(self):
        self.compare("angular_deformation", "angular_deformation", "--response", "angular_deformation")
        self.compare("deformation_max", "linear_deformation", "--response", "deformation_max,linear_deformation")
        self.compare("linear_deformation", "angular_deformation", "--response", ",angular_deformation")

    def test_order_and_number_of_rows(self):
        options = ("--sort", "name", "--top", "2")
        both = json.loads(self.succeeds("show", "published.h5", "platform.h5", "--json", *options))
        self.assertEqual([row["error"] for row in rankings(both)["rows"]], ["delta_1_0_z", "delta_1_1_y"])
        whole = json.loads(self.succeeds("show", "published.h5", "platform.h5", "--json"))
        self.assertEqual(both["kendall_tau"], whole["kendall_tau"])  # tau is of all errors, shown or not

    def refused(self, *arguments):
        done = self.poesy("show", *arguments)
        self.assertEqual((done.returncode, done.stdout), (2, b""))
        return done.stderr.decode()

    def test_what_cannot_be_compared(self):
        message = self.refused("published.h5", "platform.h5", "--response", "gap")
        self.assertIn("published.h5", message)
        self.assertIn("it has angular_deformation, linear_deformation, deformation_max", message)
        self.write("mc.toml", MONTE_CARLO)
        self.succeeds("run", "mc.toml", "--quiet")
        self.assertIn("'monte-carlo'", self.refused("published.h5", "mc.h5"))
        template = self.succeeds("template", "3-prs", "--full").replace("count = 158", "count = 2")
        self.write("3prs.toml", template.replace("samples = 1000", "samples = 100"))
        self.succeeds("run", "3prs.toml", "--quiet")
        self.assertIn("has no response in common with", self.refused("published.h5", "3prs.h5"))
        self.assertIn("3 names for 2 results", self.refused("published.h5", "platform.h5", "--response", "x,y,z"))


if __name__ == "__main__":
    main()
