"""Input that cannot be trusted: no escape sequence reaches a terminal, and no formula a spreadsheet; too little
memory is reported as such, and numbers that overflow are refused."""

import csv
import json
import os
import re
import shutil
import subprocess

import h5py
from poesy_program import GALLERY, STUDY, ProgramTest, least_to_start, least_to_work, main, with_memory

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
CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")
TURNED = "a\u202eb\u2028c"


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
        done = with_memory(megabytes, *arguments, cwd=self.folder)
        return done.returncode, done.stderr.decode()


    def check_little_memory(self, megabytes, *command):
        """That it works, or says how much memory it lacks."""
        code, said = self.with_memory(megabytes, *command)
        with self.subTest(command[0], megabytes=megabytes):
            self.assertIn(code, (0, 3), said)
            if code == 3:
                self.assertRegex(said, r"\d+ MB|threads cannot be started")
            self.assertNotIn("is damaged", said)
            self.assertNotIn("internal", said)
        return said


class Terminals(Untrusted):
    def test_verify_shows_a_stored_hash_without_escapes(self):
        self.run_study(mini())
        with h5py.File(self.folder / "r.h5", "r+") as file:
            file.attrs["content_sha256"] = ESCAPES
        self.assertIn("?]0;pwned", self.said(3, "verify", "r.h5"))

    def test_no_file_makes_the_program_say_a_line_of_its_own(self):
        self.run_study(mini())
        lie = "0\npoesy: r.h5 is verified\n"
        with h5py.File(self.folder / "r.h5", "r+") as file:
            for name in ("content_sha256", "model", "poesy_version", "git_commit"):
                file.attrs[name] = lie
        shutil.copy(self.folder / "r.h5", self.folder / lie)
        for file in ("r.h5", lie):
            for command in (("verify",), ("show",), ("tolerances",), ("report",), ("replay", "q_1", 0, 0)):
                said = self.poesy(command[0], file, *command[1:])
                self.assertNotIn("poesy: r.h5 is verified", (said.stdout + said.stderr).decode().split("\n"), command)

    def test_names_of_files_are_shown_without_escapes(self):
        for name in ("a\x1b[2Jb", "a" + C1 + "b", TURNED):
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
            file.attrs["title"] = TURNED + C1 + "\x7f\x1bz"
        done = self.poesy("show", "r.h5", "--json")
        self.assertIsNone(CONTROL.search(done.stdout.decode()))
        self.assertEqual(json.loads(done.stdout)["title"], TURNED + C1 + "\x7f\x1bz")

    def test_a_nul_cuts_no_message_and_names_no_other_file(self):
        self.write("a", "alpha,beta,z\n0,0,0.75\n")
        self.write("nul.toml", mini('select = "file"\nfile = "a\\u0000b"'))
        self.assertIn("NUL", self.said(2, "run", "nul.toml"))


class Spreadsheets(Untrusted):
    def test_names_in_studies_that_begin_a_formula_are_refused(self):
        for name in ("=1+1|cmd", "+1", "-1", "@sum", "a,b", "a;b", "a\\u001bb", "a\\nb", "", " =1", "\u00a0=1", "\u200b=1",
                     "\ufeff+1", "\uff1d1+1", "\uff0b1", "\uff0d1", "\uff20x", TURNED):
            with self.subTest(name):
                self.write("study.toml", mini(analysis=CASES.format(name)))
                self.assertIn("11:8", self.said(2, "run", "study.toml"))

    def test_cells_are_quoted_or_disarmed(self):
        self.run_study(mini(analysis=CASES.format("one") + CASES.format("two").replace('kind = "evaluate"', "")))
        with h5py.File(self.folder / "r.h5", "r+") as file:
            file["case"][:] = ["\u00a0\uff1d1+1|cmd", 'x\n9,9;"9"' + C1]
        self.said(0, "export", "r.h5", "-d", "out")
        with open(self.folder / "out" / "cases.csv", newline="") as file:
            lines = list(csv.reader(file))
        self.assertEqual([line[0] for line in lines[1:]], ["'\u00a0\uff1d1+1|cmd", 'x?9,9;"9"?2J'])
        self.assertEqual({len(line) for line in lines}, {len(lines[0])})


class Memory(Untrusted):
    def setUp(self):
        if os.environ.get("POESY_SANITIZE"):
            self.skipTest("a sanitizer takes all address space, and ends a process that lacks memory")
        super().setUp()

    def test_little_memory_is_no_damage(self):
        self.run_study(mini())
        least = least_to_start()
        for command in (("show", "r.h5"), ("report", "r.h5"), ("export", "r.h5", "-d", "out"), ("verify", "r.h5")):
            code, said = self.with_memory(least, *command)
            with self.subTest(command[0]):
                self.assertEqual(code, 3, said)
                self.assertIn("memory", said)
                self.assertNotIn("is damaged", said)
                self.assertNotIn("internal", said)

    def test_any_little_memory_is_said(self):
        """From where the program just starts to where it has enough, for every command."""
        least = least_to_start()
        self.run_study(mini())
        for k in (1, 2):
            self.succeeds("run", "study.toml", "--shard", f"{k}/2", "-o", f"{k}.h5", "--quiet")
        self.write_tables(1)
        commands = [("models", "3-prs"), ("models", "3-prs", "-o", "picture.svg"), ("template", "3-prs"),
                    ("tolerances", "r.h5", "--response", "tip_position"),
                    ("check", "study.toml"), ("run", "study.toml", "-o", "o.h5"), ("run", "study.toml", "-o", "o.h5", "--threads", 1),
                    ("evaluate", "study.toml", "--poses", "p.csv", "--errors", "e.csv", "-o", "v.h5"),
                    ("merge", "1.h5", "2.h5", "-o", "m.h5"), ("show", "r.h5"), ("export", "r.h5", "-d", "out"), ("verify", "r.h5"),
                    ("report", "r.h5"), ("replay", "r.h5", "q_1", 0, 0)]
        for command in commands:
            for megabytes in range(least, least_to_work() + 12, 3):
                self.check_little_memory(megabytes, *command)

    def write_tables(self, rows):
        """Of so many poses, and of errors."""
        self.write("p.csv", "alpha,beta,z\n" + "0,0,0.75\n" * rows)
        self.write("e.csv", "q_1,q_2,q_3\n" + "1e-4,1e-4,1e-4\n" * rows)

    def test_threads_that_cannot_be_started_are_said(self):
        self.write("study.toml", mini())
        own = least_to_work()
        for megabytes, threads in ((34, 64), (224, 64), (934, 256), (1934, 1024)):
            said = self.check_little_memory(own + megabytes, "run", "study.toml", "-o", "o.h5", "--threads", threads)
            self.assertIn(f"{threads} threads cannot be started", said)
            self.assertEqual(list(self.folder.glob("o.h5*")), [])

    def check_need(self, need, megabytes, work, *command):
        """That it lacks memory for this work with so much more than it takes to begin, and says how much that takes: `need`
        MB, about."""
        code, said = self.with_memory(least_to_work() + megabytes, *command)
        with self.subTest(work, megabytes=megabytes):
            self.assertEqual(code, 3, said)
            found = re.search(f"there is not enough memory for this {work}: it takes about (\\d+) MB", said)
            self.assertTrue(found, said)
            self.assertAlmostEqual(int(found[1]) / need, 1.0, delta=0.4)

    def test_an_evaluation_says_what_it_needs(self):
        self.write("study.toml", mini())
        self.write_tables(1000)
        for result in ((), ("-o", "v.h5")):
            for megabytes in (14, 54, 84):
                self.check_need(130, megabytes, "evaluation", "evaluate", "study.toml", "--poses", "p.csv", "--errors", "e.csv",
                                "--quiet", "--threads", 1, *result)
        self.assertEqual(list(self.folder.glob("v.h5*")), [])

    def test_a_merge_says_what_it_needs(self):
        self.write("study.toml", mini("count = 5000", 'factors = "all"\nsamples = 2'))
        for k in (1, 2):
            self.succeeds("run", "study.toml", "--shard", f"{k}/2", "-o", f"{k}.h5", "--quiet")
        self.check_need(255, 234, "merge", "merge", "1.h5", "2.h5", "-o", "m.h5")
        self.check_need(104, 134, "merge", "merge", "1.h5", "2.h5", "-o", "m.h5")
        code, said = self.with_memory(least_to_work() + 34, "merge", "1.h5", "2.h5", "-o", "m.h5")
        self.assertEqual(code, 3, said)
        self.assertRegex(said, r"h5: cannot be read for want of memory: \d+ MB are enough")
        self.assertEqual(list(self.folder.glob("m.h5*")), [])

    def test_a_run_says_what_it_needs(self):
        sizes = ", ".join(f'"{k + 1} um"' for k in range(20))
        self.write("large.toml", mini("count = 600", f'kind = "coupling"\nlinear = [{sizes}]'))
        for megabytes in (14, 54):
            code, said = self.with_memory(least_to_work() + megabytes, "run", "large.toml", "--quiet", "--threads", 1)
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

    def test_places_beyond_all_reach_of_other_mechanisms(self):
        own = 'model = "3-prs"\nfidelity = "first-order"'
        for mechanism, header, values in (('model = "xy-3-prs"', "alpha,beta,tip_x,tip_y,tip_z", "0,0,{},0,0.85"),
                                          ("3-rps", "rx,ry,tip_z", "0,0,{}"), ("3-rrr", "q_1_1,q_2_1,q_3_1", "{},0,0"),
                                          ("6-ups", "q_1_3,q_2_3,q_3_3,q_4_3,q_5_3,q_6_3", "1,1,1,1,1,{}"),
                                          ("tripteron", "x,y,z", "0,{},0")):
            given = mechanism if "model" in mechanism else f'file = "{GALLERY / mechanism / mechanism}.toml"'
            self.write("study.toml", mini('select = "file"\nfile = "p.csv"').replace(own, given))
            for size in ("1e7", "1.4e154", "1e300", "-1.7e308"):
                with self.subTest(mechanism, size=size):
                    self.write("p.csv", header + "\n" + values.format(size) + "\n")
                    self.assertIn("out of reach", self.said(2, "run", "study.toml"))

    def test_a_curve_that_begins_beyond_all_reach_is_refused(self):
        self.write("study.toml", mini('select = "trajectory"\ntrajectory = { curve = "helix", origin = ["1e300 m", "0 m", "1 m"] }'))
        self.said(2, "run", "study.toml")

    def test_a_workspace_beyond_all_reach_is_empty(self):
        for low, high in (("-1e300", "1e300"), ("-1e160", "-1e150"), ("-1e20", "-1e15")):
            with self.subTest(low):
                box = f'count = 3\nworkspace = {{ z = ["{low} m", "{high} m"], beta = ["0 deg", "1 deg"], gamma = ["0 deg", "1 deg"] }}'
                self.write("study.toml", STUDY.replace("count = 6", box))
                self.assertIn("the workspace is empty", self.said(2, "run", "study.toml"))


    def test_times_that_overflow_are_refused(self):
        self.write("tr.csv", "t,alpha,beta,z\n-1e308,0,0,0.7\n1e308,0,0,0.71\n")
        trajectory = 'select = "trajectory"\ntrajectory = {{ file = "tr.csv"{} }}'
        self.write("study.toml", mini(trajectory.format(', time = ["0 s", "1 s"], points = 3')))
        self.assertIn("tr.csv:2:1: t = -1e+308 s is more than 1e9 s from 0", self.said(2, "check", "study.toml"))
        self.write("tr.csv", "t,alpha,beta,z\n0,0,0,0.7\n1,0,0,0.71\n")
        self.write("study.toml", mini(trajectory.format(', time = ["0 s", "1e10 s"], points = 3')))
        self.assertIn("more than 1e9 s from 0", self.said(2, "check", "study.toml"))


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
