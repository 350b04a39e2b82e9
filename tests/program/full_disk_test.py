"""A full disk while a checkpoint or the result is written: exit code 3, a message with the missing bytes, and older
files are kept.

The disks are small tmpfs in a mount namespace of the test, so they end with it. Without root, a user namespace gives
the right to mount. If neither is allowed, the test is skipped (exit code 77).
"""

import os
import re
import subprocess
import sys
import tempfile
import time

from poesy_program import AN_OLDER_RESULT, PROGRAM, main
from resumption import ALLOCATION, CASES, MONTE_CARLO, SENSITIVITY, ResumptionTest

IN_NAMESPACE = "POESY_IN_MOUNT_NAMESPACE"
NAMESPACE = ["unshare", "--mount", *(["--map-root-user"] if os.geteuid() != 0 else [])]
SKIPPED = 77
PAGE = os.sysconf("SC_PAGE_SIZE")
EVERY = "0.1 s"
MISSING = re.compile(r"cannot be written \(No space left on device; needs (\d+) bytes, (\d+) are free\); make room")
# These studies take about a second, so there is time for checkpoints.
LONG_SENSITIVITY = SENSITIVITY.replace("12300", "40300")
LONG_MONTE_CARLO = MONTE_CARLO.replace("12300", "40300")
LONG_ALLOCATION = ALLOCATION.replace("30000", "120000")
LONG_CASES = CASES.replace("count = 4000", "count = 12000")


def enter_namespace():
    """Starts this test again where it may mount. Returns only where that is not possible."""
    with tempfile.TemporaryDirectory() as folder:
        mounted = subprocess.run([*NAMESPACE, "mount", "-t", "tmpfs", "tmpfs", folder], capture_output=True,
                                 check=False)
    if mounted.returncode == 0:
        os.environ[IN_NAMESPACE] = "1"
        os.execvp(NAMESPACE[0], [*NAMESPACE, sys.executable, "-B", *sys.argv])
    print(f"skipped: a small file system cannot be mounted here: {mounted.stderr.decode(errors='replace').strip()}")


class FullDisk(ResumptionTest):
    def setUp(self):
        super().setUp()
        self.outside = self.folder
        self.folder = self.outside / "disk"
        self.newer = self.folder / "out.h5.part"
        self.older = self.folder / "out.h5.part.1"

    def mount(self, size):
        self.folder.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", self.folder], check=True)
        self.addCleanup(subprocess.run, ["umount", self.folder], check=True)

    def prepare(self, study, size):
        """An empty disk with the study and an older result; the content hash of an undisturbed run, done elsewhere."""
        disk, self.folder = self.folder, self.outside
        expected = self.undisturbed(study)
        self.folder = disk
        self.mount(size)
        self.write("study.toml", study)
        self.write("out.h5", AN_OLDER_RESULT)
        return expected

    def fill(self, leave=0):
        """Leaves as many bytes, in whole pages."""
        disk = os.statvfs(self.folder)
        room = disk.f_bavail * disk.f_frsize - leave // PAGE * PAGE
        with open(self.folder / "filler", "ab", buffering=0) as filler:
            while room > 0:
                try:
                    room -= filler.write(bytes(min(room, 16 * PAGE)))
                except OSError:  # the run has used some of the room meanwhile
                    return

    def make_room(self):
        (self.folder / "filler").unlink()

    def expect_full(self, code, messages, path):
        """The exit code, and a message with the path, what is needed and less than that free."""
        self.assertEqual(code, 3, messages)
        self.assertIn(f"poesy: {path}: cannot be written", messages)
        found = MISSING.search(messages)
        self.assertTrue(found, messages)
        self.assertLess(int(found.group(2)), -(-int(found.group(1)) // PAGE) * PAGE)
        self.assertEqual((self.folder / "out.h5").read_text(), AN_OLDER_RESULT)
        self.assertLessEqual({path.name for path in self.folder.iterdir()},
                             {"study.toml", "out.h5", "filler", self.newer.name, self.older.name})

    def resumes_from_each(self, expected):
        """Each generation on its own, elsewhere, leads to the result: it is whole."""
        elsewhere = self.outside / "elsewhere"
        for name, content in self.generations().items():
            with self.subTest(generation=name):
                elsewhere.mkdir()
                (elsewhere / "out.h5.part").write_bytes(content)
                study = self.folder / "study.toml"
                done = self.poesy("run", study, "-o", elsewhere / "out.h5", "--quiet", "--resume")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(self.content_hash(elsewhere / "out.h5"), expected)
                for path in elsewhere.iterdir():
                    path.unlink()
                elsewhere.rmdir()

    def resume_full(self, every):
        done = self.resume("--checkpoint-every", every)
        return done.returncode, done.stderr.decode()

    def checkpoint_does_not_fit(self, study):
        expected = self.prepare(study, "100m")
        self.two_generations()
        before = self.generations()
        self.fill(leave=len(before[self.newer.name]) // 2)
        code, messages = self.resume_full(EVERY)
        self.expect_full(code, messages, "out.h5.part")
        self.assertIn("--resume", messages)
        self.assertEqual(self.generations(), before)
        self.resumes_from_each(expected)
        self.make_room()
        self.assertEqual(self.resume_to_end(), expected)

    def test_checkpoint_of_a_sensitivity_study_does_not_fit(self):
        self.checkpoint_does_not_fit(LONG_SENSITIVITY)

    def test_checkpoint_of_a_monte_carlo_study_does_not_fit(self):
        self.checkpoint_does_not_fit(LONG_MONTE_CARLO)

    def test_checkpoint_of_tolerances_does_not_fit(self):
        self.checkpoint_does_not_fit(LONG_ALLOCATION)

    def test_checkpoint_of_cases_does_not_fit(self):
        self.checkpoint_does_not_fit(LONG_CASES)

    def test_first_checkpoint_does_not_fit(self):
        expected = self.prepare(LONG_SENSITIVITY, "1m")
        self.fill()
        done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet", "--checkpoint-every", EVERY)
        self.expect_full(done.returncode, done.stderr.decode(), "out.h5.part")
        self.assertEqual(self.generations(), {})
        self.make_room()
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--checkpoint-every", EVERY)
        self.assertEqual(self.content_hash(), expected)

    def test_disk_fills_up_under_way(self):
        """Another program takes the room between two checkpoints of a run."""
        expected = self.prepare(LONG_CASES, "100m")
        command = [PROGRAM, "run", "study.toml", "-o", "out.h5", "--quiet", "--checkpoint-every", "0.01 s"]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE) as run:
            while run.poll() is None and not self.newer.exists():
                time.sleep(0.001)
            self.fill()
            messages = run.communicate(timeout=120)[1].decode()
        # How far the run was decides which file found no room.
        self.expect_full(run.returncode, messages, "out.h5.part" if "out.h5.part: " in messages else "out.h5")
        self.assertTrue(self.newer.exists())
        self.resumes_from_each(expected)
        self.make_room()
        self.assertEqual(self.resume_to_end(), expected)

    def test_result_does_not_fit(self):
        """Nothing fits: the checkpoints stay as they were."""
        expected = self.prepare(LONG_SENSITIVITY, "1m")
        self.two_generations()
        before = self.generations()
        self.fill()
        code, messages = self.resume_full("1 h")
        self.expect_full(code, messages, "out.h5")
        self.assertIn("--resume", messages)
        self.assertEqual(self.generations(), before)
        self.resumes_from_each(expected)
        self.make_room()
        self.assertEqual(self.resume_to_end(), expected)

    def test_checkpoints_fit_but_the_result_does_not(self):
        """The last checkpoint then holds the whole run; the one before is there as well."""
        expected = self.prepare(LONG_SENSITIVITY, "1m")
        self.stop_early()
        self.fill(leave=(self.outside / "undisturbed.h5").stat().st_size - PAGE)
        code, messages = self.resume_full(EVERY)
        self.expect_full(code, messages, "out.h5")
        self.assertEqual(set(self.generations()), {self.newer.name, self.older.name})
        self.resumes_from_each(expected)
        self.make_room()
        self.assertEqual(self.resume_to_end(), expected)

    def test_export_says_what_is_in_the_folder(self):
        self.mount("4m")
        quick = SENSITIVITY.replace("samples = 12300", "samples = 100")
        larger = re.sub("factors = .*", 'factors = "deforming"', quick)  # its tables have the same names
        for name, study in (("a", quick), ("b", larger)):
            self.write("study.toml", study)
            self.succeeds("run", "study.toml", "-o", f"../{name}.h5", "--quiet")
        self.succeeds("export", "../a.h5", "-d", "t")
        before = {path.name: path.read_bytes() for path in (self.folder / "t").iterdir()}
        for room, said in ((0, "the files in t are as they were before"),
                           (4 * PAGE, r"\d+ of the \d+ files in t are new, any others are those of before: do not use them "
                                       "together")):
            self.fill(leave=room)
            done = self.poesy("export", "../b.h5", "-d", "t")
            self.assertEqual(done.returncode, 3)
            self.assertRegex(done.stderr.decode(), rf"cannot be (written|created).*; make room or choose another folder; {said}\n$")
            after = {path.name: path.read_bytes() for path in (self.folder / "t").iterdir()}
            self.assertEqual(after.keys(), before.keys())
            if room == 0:
                self.assertEqual(after, before)
            self.make_room()
        self.succeeds("export", "../b.h5", "-d", "t")
        self.succeeds("export", "../b.h5", "-d", "u")
        self.assertEqual(*({path.name: path.read_bytes() for path in (self.folder / name).iterdir()} for name in "tu"))


if __name__ == "__main__":
    if IN_NAMESPACE not in os.environ:
        enter_namespace()
        sys.exit(SKIPPED)
    main()
