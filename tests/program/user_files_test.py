"""Files of the user with the names of files that poesy writes or resumes: they are not changed, whatever they are,
and poesy does not wait for them."""

import os
import resource
import subprocess
import time

import h5py

from poesy_program import PROGRAM, ProgramTest, main

HEAD = """\
format = "poesy-study"
version = 1
mechanism = { model = "3-prs", fidelity = "first-order" }
"""
QUICK = HEAD + "poses = { count = 3 }\nanalysis = { samples = 10 }\n"
EVALUATION = HEAD + 'analysis = { kind = "evaluate" }\n'
ALLOCATION = HEAD + """\
poses = { count = 3 }
[errors]
linear = { distribution = "normal", sigma = "0.01 mm" }
angular = { distribution = "normal", sigma = "0.01 deg" }
[analysis]
kind = "allocation"
limits = { position = "0.5 mm" }
yield = 0.9
sigmas = 3
samples = 1000
[[analysis.parts]]
factors = "linear"
cost = { law = "reciprocal", b = 1, unit = "mm" }
"""
PRECIOUS = "precious\n"
SECONDS = 60.0  # timeout of a command; large, because sanitizers are slow


class UserFiles(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("quick.toml", QUICK)

    def ends(self, code, *arguments):
        """What the command says, which ends soon and with this exit code."""
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, timeout=SECONDS, check=False)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr.decode()

    def test_a_result_replaces_results_alone(self):
        self.write("evaluation.toml", EVALUATION)
        self.write("poses.csv", "alpha,beta,z\n0,0,0.7\n")
        self.write("errors.csv", "a_x_1\n0.001\n")
        for shard in ("1", "2"):
            self.succeeds("run", "quick.toml", "--shard", f"{shard}/2", "-o", f"{shard}.h5", "--quiet")
        commands = {"run": ("run", "quick.toml", "--quiet"), "merge": ("merge", "1.h5", "2.h5"),
                    "evaluate": ("evaluate", "evaluation.toml", "--poses", "poses.csv", "--errors", "errors.csv")}
        for name, command in commands.items():
            with self.subTest(command=name):
                self.write("r.h5", PRECIOUS)
                self.assertIn("exists and is not a result of poesy, and it would be lost", self.ends(2, *command, "-o", "r.h5"))
                self.assertEqual((self.folder / "r.h5").read_text(), PRECIOUS)
                for theirs in ("r.h5", "other.dat"):
                    (self.folder / theirs).unlink(missing_ok=True)
                    with h5py.File(self.folder / theirs, "w") as file:
                        file["mine"] = 1.0
                    before = (self.folder / theirs).read_bytes()
                    self.assertIn("would be lost", self.ends(2, *command, "-o", theirs))
                    self.assertEqual((self.folder / theirs).read_bytes(), before)
                self.write("r.h5", "")
                self.ends(0, *command, "-o", "r.h5")
                whole = (self.folder / "r.h5").read_bytes()
                self.write("r.h5", whole[:len(whole) // 2])  # a damaged result may be replaced too
                self.ends(0, *command, "-o", "r.h5")

    def test_a_file_in_the_place_of_the_lock(self):
        lock = self.write("r.h5.lock", PRECIOUS)
        self.assertIn("r.h5.lock: is not a lock of poesy", self.ends(3, "run", "quick.toml", "-o", "r.h5"))
        self.assertEqual(lock.read_text(), PRECIOUS)
        self.assertFalse((self.folder / "r.h5").exists())
        lock.unlink()
        os.mkfifo(lock)
        self.assertIn("r.h5.lock: is not a lock of poesy", self.ends(3, "run", "quick.toml", "-o", "r.h5"))
        lock.unlink()
        os.symlink("quick.toml", lock)
        self.assertIn("r.h5.lock: cannot be opened", self.ends(3, "run", "quick.toml", "-o", "r.h5"))
        self.assertTrue(lock.is_symlink())
        lock.unlink()
        self.write("r.h5.lock", "")
        self.ends(0, "run", "quick.toml", "-o", "r.h5", "--quiet")

    def test_a_large_file_in_the_place_of_a_checkpoint(self):
        """It is not read to its end, nor as a whole into memory."""
        with (self.folder / "r.h5.part").open("w") as file:
            file.truncate(20 * 2**30)
        self.assertIn("is not a checkpoint of poesy", self.ends(3, "run", "quick.toml", "-o", "r.h5", "--resume"))
        self.assertLess(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, 2**20)  # kB
        if os.environ.get("POESY_SANITIZE"):
            return  # sanitizers end a program that requests so much memory
        self.write("r.h5.part", "poesy-checkpoint")
        os.truncate(self.folder / "r.h5.part", 2**43)
        said = self.ends(3, "run", "quick.toml", "-o", "r.h5", "--resume")
        self.assertIn("r.h5.part", said)
        self.assertIn("MB of memory", said)

    def test_files_beside_a_certificate(self):
        self.write("a.toml", ALLOCATION)
        for make in (os.mkfifo, os.mkdir, lambda path: os.symlink("/dev/zero", path)):
            for name in ("a_certificate.toml", "a_certificate_poses.csv"):
                with self.subTest(name=name):
                    make(self.folder / name)
                    began = time.monotonic()
                    self.assertIn("exists and was not written with this result", self.ends(2, "run", "a.toml"))
                    self.assertLess(time.monotonic() - began, SECONDS / 2)
                    self.assertFalse((self.folder / "a.h5").exists())
                    (os.rmdir if make is os.mkdir else os.unlink)(self.folder / name)

    def test_poses_that_an_earlier_certificate_does_not_name(self):
        self.write("a.toml", ALLOCATION)
        self.ends(0, "run", "a.toml", "--quiet")
        theirs = self.write("a_certificate_poses.csv", PRECIOUS)
        self.write("poses.csv", "alpha,beta,z\n0,0,0.7\n0.1,0,0.7\n")
        self.write("a.toml", ALLOCATION.replace("poses = { count = 3 }", 'poses = { select = "file", file = "poses.csv" }'))
        for earlier in (None, ""):
            if earlier is not None:
                self.write("a_certificate.toml", earlier)
            with self.subTest(earlier=earlier):
                self.assertIn("a_certificate_poses.csv: exists and was not written with this result",
                              self.ends(2, "run", "a.toml"))
                self.assertEqual(theirs.read_text(), PRECIOUS)
        theirs.unlink()
        for _ in range(2):  # the second run replaces its own files
            self.ends(0, "run", "a.toml", "--quiet")
            self.assertTrue(theirs.exists())
        # The certificate is written before its poses, so a killed run never leaves poses that no study names.
        self.assertLessEqual((self.folder / "a_certificate.toml").stat().st_mtime_ns, theirs.stat().st_mtime_ns)
        theirs.unlink()
        self.ends(0, "run", "a.toml", "--quiet")
        self.assertTrue(theirs.exists())

    def test_names_that_are_too_long(self):
        """Looked at before anything is computed, with all that a run adds to the name of its result."""
        most = os.pathconf(self.folder, "PC_NAME_MAX")
        for study, added in ((QUICK, ".part.1"), (ALLOCATION, "_certificate_mechanism.toml")):
            end = ".h5" if added.startswith(".") else ""  # `added` of a certificate has its extension already
            longest = most - len(end + added + ".tmp.123456789012")
            self.write("study.toml", study)
            for length, code in ((longest + 1, 2), (longest + 30, 2), (longest, 0)):
                with self.subTest(added=added, length=length):
                    before = sorted(self.folder.iterdir())
                    said = self.ends(code, "run", "study.toml", "-o", length * "a" + ".h5", "--quiet")
                    if code == 2:
                        self.assertIn("has too long a name", said)
                        if length == longest + 1:
                            self.assertIn("give a name with -o that is shorter by 1", said)
                        self.assertEqual(sorted(self.folder.iterdir()), before)

    def test_few_open_files(self):
        self.write("study.toml", ALLOCATION)
        limit = resource.getrlimit(resource.RLIMIT_NOFILE)

        def run(files):
            return subprocess.run([PROGRAM, "run", "study.toml", "--quiet"], cwd=self.folder, capture_output=True,
                                  timeout=SECONDS, check=False,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (files, limit[1])))

        for files in (4, 8, 18):
            done = run(files)
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertIn(b"raise the limit on open files (ulimit -n)", done.stderr)
            self.assertEqual({path.name for path in self.folder.iterdir()}, {"quick.toml", "study.toml"})
        for files in range(19, 64):  # a run that starts must not fail later for want of open files
            done = run(files)
            if done.returncode == 0:
                break
            self.assertIn(b"raise the limit on open files (ulimit -n)", done.stderr)
            self.assertEqual({path.name for path in self.folder.iterdir()}, {"quick.toml", "study.toml"})
        self.assertEqual(done.returncode, 0, done.stderr)


main()
