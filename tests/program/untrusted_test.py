"""What comes from files that one does not trust: no escape sequence reaches a terminal and no formula a spreadsheet, little memory is
called little memory, and numbers that overflow are refused."""

import csv
import json
import os
import re
import resource
import subprocess

import h5py
from poesy_program import PROGRAM, STUDY, ProgramTest, main

MINI = """\
format = "poesy-study"
version = 1
[mechanism]
model = "3-prs"
fidelity = "first-order"
[poses]
{poses}
[analysis]
{analysis}
"""
ESCAPES = "\x1b]0;pwned\x07\x1b[2J"
C1 = "\x9b2J"
CASES = 'kind = "evaluate"\n[[analysis.cases]]\nname = "{}"\nerrors = {{ linear = "0.1 mm" }}'
CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f]")


def mini(poses="count = 3", analysis="samples = 10"):
    return MINI.format(poses=poses, analysis=analysis)


class Untrusted(ProgramTest):
    def run_study(self, text, result="r.h5"):
        self.write("study.toml", text)
        self.succeeds("run", "study.toml", "-o", result, "--quiet")

    def said(self, code, *arguments):
        """What the program says on both streams; it ends with this code, and says nothing that a terminal obeys."""
        done = self.poesy(*arguments)
        text = (done.stdout + done.stderr).decode()
        self.assertEqual(done.returncode, code, text)
        self.assertIsNone(CONTROL.search(text), repr(text))
        return text

    def with_memory(self, megabytes, *arguments):
        if os.environ.get("POESY_SANITIZE"):
            self.skipTest("a sanitizer takes all address space, and ends a process that lacks memory")
        limit = 1_000_000 * megabytes
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, timeout=120, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        return done.returncode, done.stderr.decode()


class Terminals(Untrusted):
    def test_verify_shows_a_stored_hash_without_escapes(self):
        self.run_study(mini())
        with h5py.File(self.folder / "r.h5", "r+") as file:
            file.attrs["content_sha256"] = ESCAPES
        self.assertIn("?]0;pwned", self.said(3, "verify", "r.h5"))

    def test_names_of_files_are_shown_without_escapes(self):
        for name in ("a\x1b[2Jb", "a" + C1 + "b"):
            with self.subTest(repr(name)):
                self.run_study(mini(), name + ".h5")
                for command in ("verify", "show", "tolerances"):
                    self.said(2 if command == "tolerances" else 0, command, name + ".h5")
                self.said(3, "show", name)
                self.said(3, "run", name + ".toml.", "-o", "no/such/" + name + ".h5")
                self.assertIn("?", self.said(0, "export", name + ".h5", "-d", name))
                self.said(0, "report", name + ".h5")

    def test_json_escapes_what_a_terminal_obeys(self):
        self.run_study(mini().replace("version = 1", 'version = 1\ntitle = "plain"'))
        with h5py.File(self.folder / "r.h5", "r+") as file:
            file.attrs["title"] = "a" + C1 + "\x7f\x1bz"
        done = self.poesy("show", "r.h5", "--json")
        self.assertIsNone(CONTROL.search(done.stdout.decode()))
        self.assertEqual(json.loads(done.stdout)["title"], "a" + C1 + "\x7f\x1bz")

    def test_a_nul_cuts_no_message_and_names_no_other_file(self):
        self.write("a", "alpha,beta,z\n0,0,0.75\n")
        self.write("nul.toml", mini('select = "file"\nfile = "a\\u0000b"'))
        self.assertIn("NUL", self.said(2, "run", "nul.toml"))


class Spreadsheets(Untrusted):
    def test_names_in_studies_that_begin_a_formula_are_refused(self):
        for name in ("=1+1|cmd", "+1", "-1", "@sum", "a,b", "a;b", "a\\u001bb", "a\\nb", ""):
            with self.subTest(name):
                self.write("study.toml", mini(analysis=CASES.format(name)))
                self.assertIn("11:8", self.said(2, "run", "study.toml"))

    def test_cells_are_quoted_or_disarmed(self):
        self.run_study(mini(analysis=CASES.format("one") + CASES.format("two").replace('kind = "evaluate"', "")))
        with h5py.File(self.folder / "r.h5", "r+") as file:
            file["case"][:] = ['=1+1|cmd', 'x\n9,9;"9"' + C1]
        self.said(0, "export", "r.h5", "-d", "out")
        with open(self.folder / "out" / "cases.csv", newline="") as file:
            lines = list(csv.reader(file))
        self.assertEqual([line[0] for line in lines[1:]], ["'=1+1|cmd", 'x?9,9;"9"?2J'])
        self.assertEqual({len(line) for line in lines}, {len(lines[0])})


class Memory(Untrusted):
    def test_little_memory_is_no_damage(self):
        self.run_study(mini())
        for command in (("show", "r.h5"), ("report", "r.h5"), ("export", "r.h5", "-d", "out"), ("verify", "r.h5")):
            code, said = self.with_memory(41, *command)
            with self.subTest(command[0]):
                self.assertEqual(code, 3, said)
                self.assertIn("memory", said)
                self.assertNotIn("is damaged", said)
                self.assertNotIn("internal", said)

    def test_a_run_says_what_it_needs(self):
        sizes = ", ".join(f'"{k + 1} um"' for k in range(20))
        self.write("large.toml", mini("count = 600", f'kind = "coupling"\nlinear = [{sizes}]'))
        for megabytes in (80, 120):
            code, said = self.with_memory(megabytes, "run", "large.toml", "--quiet", "--threads", 1)
            with self.subTest(megabytes):
                self.assertEqual(code, 3, said)
                self.assertRegex(said, r"not enough memory for this run: it takes about \d+ MB")
            for part in self.folder.glob("large.h5.*"):
                part.unlink()

    def test_evaluate_has_the_bound_of_run(self):
        self.write("study.toml", STUDY)
        self.write("p.csv", "z,beta,gamma\n" + "-0.2,0.1,0.05\n" * 4000)
        self.write("e.csv", "delta_1_1_y\n" + "0.001\n" * 4000)
        said = self.said(2, "evaluate", "study.toml", "--poses", "p.csv", "--errors", "e.csv", "--quiet")
        self.assertIn("16000000 solves", said)
        self.assertIn("at most 10000000", said)


class Overflow(Untrusted):
    def test_places_beyond_all_reach_are_no_poses(self):
        for header, values in (("tip_x,tip_y,tip_z", "{},0,0.85"), ("tip_x,tip_y,tip_z", "0,0,{}"), ("q_1,q_2,q_3", "{},0.1,0.1"),
                               ("alpha,beta,z", "0,0,{}")):
            for size in ("1e7", "1e154", "1.4e154", "1e300", "-1.7e308"):
                with self.subTest(header, size=size):
                    self.write("p.csv", header + "\n" + values.format(size) + "\n")
                    self.write("study.toml", mini('select = "file"\nfile = "p.csv"'))
                    self.said(2, "run", "study.toml")

    def test_a_curve_that_begins_beyond_all_reach_is_refused(self):
        self.write("study.toml", mini('select = "trajectory"\ntrajectory = { curve = "helix", origin = ["1e300 m", "0 m", "1 m"] }'))
        self.said(2, "run", "study.toml")

    def test_a_workspace_beyond_all_reach_is_empty(self):
        for low, high in (("-1e300", "1e300"), ("-1e160", "-1e150"), ("-1e20", "-1e15")):
            with self.subTest(low):
                box = f'count = 3\nworkspace = {{ z = ["{low} m", "{high} m"], beta = ["0 deg", "1 deg"], gamma = ["0 deg", "1 deg"] }}'
                self.write("study.toml", STUDY.replace("count = 6", box))
                self.assertIn("the workspace is empty", self.said(2, "run", "study.toml"))


class Words(Untrusted):
    def test_a_checkpoint_of_fixed_samples_says_so_to_an_adaptive_study(self):
        many = mini(analysis="samples = 500000")
        self.write("study.toml", many)
        self.assertEqual(self.poesy("run", "study.toml", "--quiet", "--max-wall", "0.2 s").returncode, 4)
        self.write("study.toml", many.replace("500000", "{ min = 1000, max = 500000, relative_error = 0.01 }"))
        said = self.said(2, "run", "study.toml", "--resume", "--quiet")
        self.assertIn("has a fixed number of samples, and this study takes as many as it needs", said)

    def test_tolerances_of_a_damaged_study_text_is_trouble_with_a_file(self):
        self.run_study(mini(analysis="samples = 50"))
        with h5py.File(self.folder / "r.h5", "r+") as file:
            del file["study/text"]
            file["study/text"] = "x = ["
        said = self.said(3, "tolerances", "r.h5", "--response", "tip_position", "--limit", "1 mm")
        self.assertIn("study that this program cannot read", said)


main()
