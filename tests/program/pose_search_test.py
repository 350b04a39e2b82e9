"""A long search for poses: it shows its progress, obeys signals, leaves no files behind, and gives up in time."""

import json
import re
import signal
import subprocess

from poesy_program import GALLERY, PROGRAM, STUDY, ProgramTest, main

LINE = re.compile(r"looking for poses: 0 of 10000000 found, \d+ candidates")
# A search over ten million grid points, none of which keeps the limit. It is slow, because the mechanism is from a
# file.
NOWHERE = f"""\
format = "poesy-study"
version = 1
mechanism.file = "{GALLERY / "3-rrr/3-rrr.toml"}"
[poses]
select = "grid"
count = {{ x = 1000, y = 100, phi = 100 }}
limits = {{ q_1_1 = ["300 deg", "310 deg"] }}
[analysis]
factors = ["delta_1_1_x"]
samples = 10
"""
# A grid of nine points; four of them are out of reach.
REACH = f"""\
format = "poesy-study"
version = 1
mechanism.file = "{GALLERY / "3-rrr/3-rrr.toml"}"
poses = {{ select = "grid", count = {{ x = 3, y = 3, phi = 1 }}, workspace = {{ x = ["-0.1 m", "0.1 m"], y = ["-0.1 m", "0.1 m"], phi = ["-1 deg", "1 deg"] }} }}
errors.linear = {{ distribution = "normal", sigma = "1 mm" }}
analysis = {{ kind = "monte-carlo", factors = ["delta_1_1_x"], samples = 10 }}
"""
# A study with a limit that no pose keeps.
IN_VAIN = STUDY.replace("count = 6", 'select = "interior"\ncount = 20\nlimits = { q_1_3 = ["5 m", "6 m"] }')


class PoseSearch(ProgramTest):
    def stopped(self, number, *options):
        """What a run says that is stopped when it has said once how far it is."""
        command = [PROGRAM, "run", "study.toml", "-o", "out.h5", *options]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE, text=True) as run:
            first = run.stderr.readline()
            self.assertRegex(first, LINE)
            run.send_signal(number)
            _, messages = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 4, messages)
        return messages

    def test_signals_stop_it(self):
        self.write("study.toml", NOWHERE)
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number.name):
                messages = self.stopped(number)
                self.assertIn("interrupted before anything was solved, start again with: ", messages)
                self.assertEqual([path.name for path in self.folder.iterdir()], ["study.toml"])

    def test_the_command_that_starts_again_starts(self):
        self.write("study.toml", NOWHERE)
        command = self.stopped(signal.SIGINT).split("start again with: ")[1]
        self.write("study.toml", STUDY)
        done = subprocess.run(command, shell=True, cwd=self.folder, capture_output=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("--resume", command, "nothing was solved, so there is nothing to resume")

    def test_it_gives_up(self):
        for select in ("interior", "boundary", "grid"):
            self.write("study.toml", IN_VAIN.replace('"interior"', f'"{select}"'))
            for command in ("check", "run"):
                with self.subTest(select=select, command=command):
                    done = self.poesy(command, "study.toml")
                    message = done.stderr.decode().splitlines()[-1]
                    self.assertEqual(done.returncode, 2, message)
                    found = re.search(r"the workspace is empty \(q_1_3 below 5000 mm: (\d+) of (\d+) candidates\), or so small", message)
                    self.assertTrue(found, message)
                    self.assertLess(int(found[2]), 60000)

    def test_poses_out_of_reach_are_told(self):
        said = "4 of 9 poses examined in the workspace are not in this study: 4 out of reach"
        self.write("study.toml", REACH)
        done = self.poesy("run", "study.toml", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"poesy: warning: {said}\n", done.stderr.decode())
        self.assertIn(said, " ".join(self.succeeds("show", "study.h5").split()))
        summary = json.loads(self.succeeds("show", "study.h5", "--json"))
        self.assertEqual(summary["candidate_poses"], 9)
        self.assertEqual(sum(one["count"] for one in summary["rejected_poses"]), 4)
        self.succeeds("report", "study.h5", "-o", "study.html")
        self.assertIn(f"{said}.", (self.folder / "study.html").read_text(encoding="utf-8"))
        self.write("study.toml", REACH.replace("0.1 m", "0.02 m"))
        self.assertEqual(self.poesy("run", "study.toml", "--quiet").stderr, b"")
        self.assertNotIn("not in this study", self.succeeds("show", "study.h5"))

    def test_a_boundary_beyond_the_reach_is_told(self):
        said = "the mechanism does not reach all of the stated workspace"
        beyond = REACH.replace('"grid", count = { x = 3, y = 3, phi = 1 }', '"boundary", count = 40')
        self.write("study.toml", beyond)
        done = self.poesy("run", "study.toml", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"poesy: warning: {said}", done.stderr.decode())
        self.assertIn(said, " ".join(self.succeeds("show", "study.h5").split()))
        self.succeeds("report", "study.h5", "-o", "study.html")
        self.assertIn(said, (self.folder / "study.html").read_text(encoding="utf-8"))
        rejected = re.findall(r"# rejected: (\d+) candidate poses, (.*)", self.succeeds("check", "study.toml"))
        all_rejected = json.loads(self.succeeds("show", "study.h5", "--json"))["rejected_poses"]
        self.assertGreater(len(all_rejected), 9)
        self.assertEqual(len(rejected), 9)
        self.assertEqual(rejected[-1][1], f"for {len(all_rejected) - 8} further reasons")
        self.assertEqual(sum(int(count) for count, _ in rejected), sum(one["count"] for one in all_rejected))
        self.write("study.toml", beyond.replace("0.1 m", "0.02 m"))
        self.assertEqual(self.poesy("run", "study.toml", "--quiet").stderr, b"")
        self.assertNotIn(said, self.succeeds("show", "study.h5"))


main()
