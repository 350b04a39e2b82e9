"""How `poesy show` prints a result: to the room there is, in the order asked for, or as JSON."""

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

MONTE_CARLO = STUDY.replace('"sensitivity"', '"monte-carlo"')


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
        self.assertIn("2 of 3 errors shown", self.succeeds("show", "out.h5", "--top", 2))
        self.assertNotIn("errors shown", self.succeeds("show", "out.h5", "--top", 3))
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
            template = self.succeeds("template", "2upr-rpu", kind).replace("count = 158", "count = 3")
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

    def test_other_kinds_rank_nothing(self):
        self.write("all.toml", MONTE_CARLO)
        self.succeeds("run", "all.toml", "-o", "out.h5", "--quiet")
        for option, value in (("--sort", "name"), ("--top", 3)):
            message = self.refused(option, value)
            for word in (option, "monte-carlo", "sensitivity"):
                self.assertIn(word, message)
        self.succeeds("show", "out.h5", "--width", 80)

    def test_a_result_is_no_study(self):
        done = self.poesy("run", "out.h5")
        self.assertEqual(done.returncode, 2)
        self.assertIn("is an HDF5 file, such as a result of poesy, and no study; give its study", done.stderr.decode())

    def test_failures_of_both_fidelities(self):
        template = self.succeeds("template", "3-prs").replace('fidelity = "exact"', 'fidelity = "both"', 1)
        self.write("both.toml", template.replace("count = 158", "count = 2").replace("samples = 1000", "samples = 200"))
        self.succeeds("run", "both.toml", "-o", "both.h5", "--quiet")
        text = self.succeeds("show", "both.h5")
        self.assertRegex(text, r"40 800 solves, 20 400 at each of two fidelities, in")
        self.assertIn('0 of 40 800 solves (0 %) did not converge: 0 at fidelity "exact", 0 at "first-order"', text)

    def test_failures_are_said_once(self):
        self.write("study.toml", STUDY.replace("[solver]\n", "[solver]\nmax_iterations = 4\n"))
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        text = self.succeeds("show", "out.h5", "--width", 80)
        self.assertLessEqual(max(len(line) for line in text.splitlines() if not line.startswith("replay it: ")), 80)
        self.assertEqual(text.count("did not converge"), 1)
        self.assertNotIn("failed", text)
        self.assertIn("replay it: poesy replay out.h5", text)


if __name__ == "__main__":
    main()
