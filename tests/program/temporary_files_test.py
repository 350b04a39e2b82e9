"""Files that a run writes next to its result: names that nobody can guess, planted links, links of the user,
permissions, and what a kill leaves behind."""

import fcntl
import os
import re
import signal
import stat
import subprocess
import time

from poesy_program import PROGRAM, main
from resumption import CASES, MONTE_CARLO, ResumptionTest

QUICK = """\
format = "poesy-study"
version = 1
mechanism = { model = "3-prs", fidelity = "first-order" }
poses = { count = 3 }
analysis = { samples = 10 }
"""
TEMPORARY = re.compile(r"\.tmp\.[0-9a-f]{12}$")
PRECIOUS = "precious\n"


class TemporaryFiles(ResumptionTest):
    def setUp(self):
        super().setUp()
        self.write("quick.toml", QUICK)
        self.victim = self.write("victim", PRECIOUS)

    def run_quick(self, *options, result="r.h5"):
        return self.poesy("run", "quick.toml", "-o", result, "--quiet", *options)

    def mode(self, name):
        return stat.S_IMODE((self.folder / name).stat().st_mode)

    def names(self):
        return {path.name for path in self.folder.iterdir()}

    def start(self, *options):
        """A run of seconds, once its first checkpoint is there."""
        self.write("study.toml", MONTE_CARLO.replace("12300", "400000"))
        run = subprocess.Popen([PROGRAM, "run", "study.toml", "--quiet", "--checkpoint-every", "0.01 s", *options],
                               cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        while run.poll() is None and not list(self.folder.rglob("*.part")):
            time.sleep(0.001)
        self.assertIsNone(run.poll())
        return run

    def test_guessable_names_are_not_used(self):
        """Links under names that can be guessed lead nowhere."""
        os.symlink("victim", self.folder / "r.h5.part.tmp")
        os.symlink("victim", self.folder / "r.h5.part.1.tmp")
        script = f'ln -s victim r.h5.tmp.$$; exec "{PROGRAM}" run quick.toml -o r.h5 --quiet --keep-checkpoint'
        done = subprocess.run(["sh", "-c", script], cwd=self.folder, capture_output=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.victim.read_text(), PRECIOUS)
        self.assertFalse((self.folder / "r.h5").is_symlink())
        self.assertTrue((self.folder / "r.h5.part").is_file())

    def test_output_that_is_a_link(self):
        """The result, its checkpoints and its lock are where the link leads."""
        disk = self.folder / "disk"
        disk.mkdir()
        os.symlink("disk/first.h5", self.folder / "r.h5")
        os.symlink("r.h5", self.folder / "again.h5")
        done = self.run_quick("--keep-checkpoint", result="again.h5")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.names(), {"quick.toml", "victim", "disk", "r.h5", "again.h5"})
        self.assertEqual({path.name for path in disk.iterdir()}, {"first.h5", "first.h5.part"})
        self.assertEqual(os.readlink(self.folder / "r.h5"), "disk/first.h5")
        done = self.run_quick("--resume")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual({path.name for path in disk.iterdir()}, {"first.h5"})

    def test_links_that_must_not_be_followed(self):
        os.symlink("victim", self.folder / "r.h5")
        done = self.run_quick()
        self.assertEqual(done.returncode, 2)
        self.assertIn("is not a result of poesy, and it would be lost", done.stderr.decode())
        self.assertEqual(self.victim.read_text(), PRECIOUS)
        os.symlink("b.h5", self.folder / "a.h5")
        os.symlink("a.h5", self.folder / "b.h5")
        done = self.run_quick(result="a.h5")
        self.assertEqual(done.returncode, 2)
        self.assertIn("in a circle", done.stderr.decode())
        os.symlink("absent/r.h5", self.folder / "c.h5")
        self.assertEqual(self.run_quick(result="c.h5").returncode, 2)

    def test_link_and_target_are_one_result(self):
        disk = self.folder / "disk"
        disk.mkdir()
        os.symlink("disk/out.h5", self.folder / "link.h5")
        run = self.start("-o", "link.h5")
        for name in ("link.h5", "disk/out.h5", "disk/../link.h5"):
            done = self.poesy("run", "study.toml", "-o", name, "--resume", "--quiet")
            self.assertEqual(done.returncode, 2)
            self.assertIn("another run is computing this result", done.stderr.decode())
        run.send_signal(signal.SIGTERM)
        self.assertEqual(run.wait(60), 4)
        self.assertTrue((disk / "out.h5.part").exists())

    def test_permissions_are_kept(self):
        old_mask = os.umask(0o022)
        self.addCleanup(os.umask, old_mask)
        self.assertEqual(self.run_quick().returncode, 0)
        self.assertEqual(self.mode("r.h5"), 0o644)
        again = []
        for mode in (0o600, 0o664, 0o640):
            (self.folder / "r.h5").chmod(mode)
            self.assertEqual(self.run_quick("--keep-checkpoint", *again).returncode, 0)
            self.assertEqual(self.mode("r.h5"), mode)
            self.assertEqual(self.mode("r.h5.part"), mode, "whatever the earlier checkpoint had")
            again = ["--resume"]
        (self.folder / "r.h5.part").unlink()
        self.succeeds("report", "r.h5", "-o", "r.html")
        (self.folder / "r.html").chmod(0o600)
        self.succeeds("report", "r.h5", "-o", "r.html")
        self.assertEqual(self.mode("r.html"), 0o600)

    def test_what_a_kill_left_is_removed(self):
        left = [f"r.h5{part}.tmp.0123456789ab" for part in ("", ".part", ".part.1")]
        others = ["r.h5.tmp", "r.h5.tmp.1", "r.h5.tmp.0123456789abc", "r.h5.tmp.0123456789aB", "other.h5.tmp.0123456789ab",
                  "r.h5.copy.tmp.0123456789ab"]
        for name in left + others:
            self.write(name, "left")
        os.symlink("victim", self.folder / "r.h5.tmp.ba9876543210")
        self.assertEqual(self.run_quick().returncode, 0)
        self.assertEqual(self.names(), {"quick.toml", "victim", "r.h5", *others})
        self.assertEqual(self.victim.read_text(), PRECIOUS)

    def commands_with_a_result(self):
        """merge and evaluate, each of which writes out.h5."""
        for shard in (1, 2):
            self.succeeds("run", "quick.toml", "--shard", f"{shard}/2", "-o", f"{shard}.h5", "--quiet")
        self.write("p.csv", "alpha,beta,z\n0,0,0.7\n")
        self.write("e.csv", "a_x_1\n0.0001\n")
        return [("merge", "1.h5", "2.h5", "-o", "out.h5"),
                ("evaluate", "quick.toml", "--poses", "p.csv", "--errors", "e.csv", "-o", "out.h5")]

    def test_merge_and_evaluate_remove_what_a_kill_left(self):
        for command in self.commands_with_a_result():
            with self.subTest(command[0]):
                self.write("out.h5.tmp.0123456789ab", "left")
                before = self.names()
                self.succeeds(*command)
                self.assertEqual(self.names(), before - {"out.h5.tmp.0123456789ab"} | {"out.h5"})

    def test_merge_and_evaluate_take_the_lock(self):
        for command in self.commands_with_a_result():
            with self.subTest(command[0]), (self.folder / "out.h5.lock").open("w") as lock:
                fcntl.flock(lock, fcntl.LOCK_EX)
                self.write("out.h5.tmp.0123456789ab", "being written")
                before = self.names()
                done = self.poesy(*command)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn("another run is computing this result", done.stderr.decode())
                self.assertEqual(self.names(), before)

    def test_killed_while_it_writes(self):
        """A large result: killed when its temporary file is seen; its checkpoint is there, and who goes on from that leaves
        nothing but the result."""
        self.write("study.toml", CASES.replace("count = 4000", "count = 40000"))
        command = [PROGRAM, "run", "study.toml", "-o", "out.h5", "--quiet", "--checkpoint-every", "1 h"]
        left = []
        for _ in range(20):  # sometimes the file already has its final name when the signal comes
            resume = ["--resume"] * self.newer.exists()
            seen = []
            with subprocess.Popen([*command, *resume], cwd=self.folder, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.PIPE) as run:
                while run.poll() is None and not seen:
                    seen = [path.name for path in self.folder.glob("out.h5.tmp.*")]
                run.kill()
                messages = run.stderr.read()
            self.assertIn(run.returncode, (0, -signal.SIGKILL), messages)
            self.assertTrue(all(TEMPORARY.search(name) for name in seen), seen)
            left = [path.name for path in self.folder.glob("out.h5.tmp.*")]
            if left:
                break
        self.assertEqual(len(left), 1, left)
        self.assertTrue(TEMPORARY.search(left[0]), left)
        self.assertTrue(self.newer.exists())
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--resume")
        self.assertEqual(self.names(), {"quick.toml", "study.toml", "victim", "out.h5"})


if __name__ == "__main__":
    main()
