"""Runs under mpirun give the result of one process, and end cleanly whatever happens to a rank.

POESY_RANK_KILLS: how often a rank is killed at a random moment (default 3). POESY_KILL_SEED selects the moments.
"""

import os
import random
import shutil
import signal
import subprocess
import time
import unittest
from contextlib import suppress
from pathlib import Path

import h5py

from poesy_program import PROGRAM, least_to_work, main
from resumption import ADAPTIVE_STUDIES, COUPLING, SENSITIVITY, STUDIES, ResumptionTest, with_few_units

MPIRUN = shutil.which("mpirun")
KILLS = int(os.environ.get("POESY_RANK_KILLS", "3"))
HAS_MPI = os.environ.get("POESY_HAS_MPI") == "ON"
ENVIRONMENT = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
# Without studies whose work units are like those of another study.
FEW_UNITS = {kind: with_few_units(study) for kind, study in STUDIES.items()
           if kind not in ("by series", "uniform errors", "repeated machines")} | ADAPTIVE_STUDIES


class RankTest(ResumptionTest):
    def start(self, ranks, *options, output="out.h5"):
        command = [MPIRUN, "--oversubscribe", "-n", str(ranks), PROGRAM, "run", "study.toml", "-o", output,
                   *map(str, options)]
        return subprocess.Popen(command, cwd=self.folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def mpirun_after(self, rank, before, ranks, *options):
        """How a run ends of which one rank does this before, in a shell. (Debian 13's mpirun crashes where it is given two
        commands with ":".)"""
        script = f'if [ "$OMPI_COMM_WORLD_RANK" = {rank} ]; then {before}; fi; exec "$@"'
        command = [MPIRUN, "--oversubscribe", "-n", str(ranks), "sh", "-c", script, "sh", PROGRAM, "run", "study.toml", "-o",
                   "out.h5", *options]
        return subprocess.run(command, cwd=self.folder, env=ENVIRONMENT, capture_output=True, timeout=120, check=False)

    def mpirun(self, ranks, *options, output="out.h5"):
        with self.start(ranks, *options, output=output) as run:
            out, messages = run.communicate(timeout=300)
        return run.returncode, out.decode(), messages.decode(errors="replace")

    def succeeds_on(self, ranks, *options):
        code, out, messages = self.mpirun(ranks, "--quiet", *options)
        self.assertEqual(code, 0, messages)
        return out

    @staticmethod
    def started_by(run):
        """(folder in /proc, state) of each process that the launcher has started."""
        for folder in Path("/proc").glob("[0-9]*"):
            with suppress(OSError):  # the process has ended
                state, parent = (folder / "stat").read_text().rsplit(")", 1)[1].split()[:2]
                if int(parent) == run.pid:
                    yield folder, state

    def rank_process(self, run, rank):
        """The process of a rank, as soon as it is there."""
        end = time.monotonic() + 60
        while time.monotonic() < end and run.poll() is None:
            for folder, _ in self.started_by(run):
                with suppress(OSError):
                    environment = (folder / "environ").read_bytes().split(b"\0")
                    program = (folder / "exe").resolve()
                    if f"OMPI_COMM_WORLD_RANK={rank}".encode() in environment and program == Path(PROGRAM).resolve():
                        return int(folder.name)
            time.sleep(0.01)
        return self.fail("the rank did not start")

    def wait_after_kill(self, run):
        """Open MPI's mpirun may lock itself up when its ranks have ended (in PMIx_server_finalize): then it is killed."""
        try:
            run.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            self.assertEqual([state for _, state in self.started_by(run) if state != "Z"], [])
            run.kill()
            run.communicate()

    def await_checkpoint(self, run):
        while not self.newer.exists() and run.poll() is None:
            time.sleep(0.01)


@unittest.skipUnless(MPIRUN, "there is no mpirun")
@unittest.skipUnless(HAS_MPI, "this poesy is built without MPI")
class Mpi(RankTest):
    def test_same_content_as_one_process(self):
        """One kind on one to four ranks; each of the others on two, three or four in turn: all divide units alike."""
        for number, (kind, study) in enumerate(FEW_UNITS.items()):
            expected = self.undisturbed(study)
            for ranks in (1, 2, 3, 4) if number == 0 else (2 + number % 3,):
                with self.subTest(kind=kind, ranks=ranks):
                    out = self.succeeds_on(ranks, "--threads", 1)
                    self.assertEqual(self.content_hash(), expected)
                    with h5py.File(self.folder / "out.h5") as result:
                        self.assertEqual(result["run/ranks"][()], ranks)
                        self.assertEqual(result["run/threads"][()], ranks)
                    if ranks > 1:
                        self.assertIn(f" on {ranks} threads of {ranks} ranks", out)
                    self.assertEqual(list(self.folder.glob("out.h5.*")), [])
                    (self.folder / "out.h5").unlink()

    of_long_study = None  # content hash of the result of long_study(), after the first run

    def long_study(self):
        study = SENSITIVITY.replace("samples = 12300", "samples = 82300")
        if Mpi.of_long_study is None:
            Mpi.of_long_study = self.undisturbed(study)
        self.write("study.toml", study)
        return Mpi.of_long_study

    def test_a_rank_that_is_killed(self):
        expected = self.long_study()
        for rank in (0, 1, 2):
            with self.subTest(rank=rank):
                with self.start(3, "--threads", 1, "--checkpoint-every", "0.05 s") as run:
                    process = self.rank_process(run, rank)
                    self.await_checkpoint(run)
                    os.kill(process, signal.SIGKILL)
                    self.wait_after_kill(run)
                self.assertNotEqual(run.returncode, 0)
                self.assertFalse((self.folder / "out.h5").exists())
                self.assertTrue(self.newer.exists())
                if rank == 1:
                    self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--resume")
                else:
                    self.succeeds_on(2, "--resume")
                self.assertEqual(self.content_hash(), expected)
                self.assertEqual(list(self.folder.glob("out.h5.part*")), [])
                (self.folder / "out.h5").unlink()

    def test_ranks_that_are_killed_at_any_moment(self):
        chooser = random.Random(int(os.environ.get("POESY_KILL_SEED", "20240707")))
        expected, seconds = {}, {}
        killed = resumed = 0
        while killed < KILLS:
            kind = chooser.choice(list(STUDIES))
            if kind not in expected:
                expected[kind] = self.undisturbed(STUDIES[kind])
                start = time.monotonic()
                self.succeeds_on(3, "--threads", 1)
                seconds[kind] = time.monotonic() - start
                (self.folder / "out.h5").unlink()
            rank = killed % 3
            with self.subTest(killed=killed, kind=kind, rank=rank):
                self.write("study.toml", STUDIES[kind])
                with self.start(3, "--threads", 1, "--checkpoint-every", "0.01 s") as run:
                    process = self.rank_process(run, rank)
                    time.sleep(chooser.uniform(0.0, seconds[kind]))
                    with suppress(ProcessLookupError):  # the rank may have ended
                        os.kill(process, signal.SIGKILL)
                        killed += 1
                    self.wait_after_kill(run)
                if (self.folder / "out.h5").exists():
                    self.assertEqual(self.content_hash(), expected[kind])
                if run.returncode != 0:
                    taken_up = self.newer.exists() or self.older.exists()
                    resumed += taken_up
                    self.succeeds_on(chooser.randint(1, 3), "--threads", 1, *["--resume"] * taken_up)
                self.assertEqual(self.content_hash(), expected[kind])
                self.assertEqual([path.name for path in self.folder.glob("out.h5?*")], [])
                (self.folder / "out.h5").unlink()
        print(f"{killed} ranks killed, {resumed} runs resumed from a checkpoint")

    def test_stopped_and_resumed(self):
        expected = self.long_study()
        code, _, messages = self.mpirun(3, "--quiet", "--threads", 1, "--max-wall", "0.1 s")
        self.assertEqual(code, 4, messages)
        self.assertIn("mpirun -n 3 ", messages)
        self.assertEqual(messages.count("interrupted"), 1, messages)
        self.succeeds_on(4, "--resume", "--threads", 1)
        self.assertEqual(self.content_hash(), expected)

    def test_sigterm(self):
        expected = self.long_study()
        for rank in ("mpirun", 0, 2):
            with self.subTest(rank=rank):
                with self.start(3, "--threads", 1, "--checkpoint-every", "0.05 s") as run:
                    process = run.pid if rank == "mpirun" else self.rank_process(run, rank)
                    self.await_checkpoint(run)
                    os.kill(process, signal.SIGTERM)
                    _, messages = run.communicate(timeout=60)
                self.assertNotEqual(run.returncode, 0, messages)
                if rank != "mpirun":
                    self.assertEqual(run.returncode, 4, messages)
                if rank == 2:
                    self.assertIn(b"poesy: rank 2 on ", messages)
                self.assertFalse((self.folder / "out.h5").exists())
                self.succeeds_on(3, "--resume", "--threads", 1)
                self.assertEqual(self.content_hash(), expected)
                (self.folder / "out.h5").unlink()

    def test_errors_are_said_once_and_end_all(self):
        self.write("study.toml", SENSITIVITY.replace("samples = 12300", "samples = 1"))
        code, _, messages = self.mpirun(3)
        self.assertEqual(code, 2, messages)
        self.assertEqual(messages.count("poesy: study.toml"), 1, messages)
        self.write("study.toml", SENSITIVITY)
        self.write("out.h5.part", "an earlier run")
        code, _, messages = self.mpirun(3)
        self.assertEqual(code, 2, messages)
        self.assertEqual(messages.count("holds an earlier run"), 1, messages)

    def test_full_disk(self):
        if os.geteuid() != 0:
            self.skipTest("mounting a small file system needs root")
        self.write("study.toml", SENSITIVITY.replace("count = 16", "count = 600").replace("samples = 12300", "samples = 2"))
        disk = self.folder / "disk"
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", disk], check=False).returncode != 0:
            self.skipTest("a small file system cannot be mounted here")
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        code, _, messages = self.mpirun(3, "--quiet", output="disk/out.h5")
        self.assertEqual(code, 3, messages)
        self.assertEqual(messages.count("No space left"), 1, messages)

    def test_too_little_memory(self):
        """On either rank, from one that cannot begin to one that has no room for what rank 0 found."""
        if os.environ.get("POESY_SANITIZE"):
            self.skipTest("a sanitizer takes all address space")
        self.write("study.toml", COUPLING.replace('model = "3-prs"', 'model = "3-prs", fidelity = "first-order"'))
        own = least_to_work()
        little = 0
        for rank, more in [(1, -6), (1, 26), (1, 67), (1, 78), (1, 88), (1, 98), (0, 47)]:
            with self.subTest(rank=rank, megabytes=own + more):
                limit = f"ulimit -v {(own + more) * 1_000_000 // 1024}"
                done = self.mpirun_after(rank, limit, 2, "--quiet", "--threads", "1")
                if done.returncode not in (0, 3):  # MPI failed to start and says so
                    self.assertIn(b"MPI", done.stderr)
                self.assertNotIn(b"poesy: internal", done.stderr)
                self.assertNotIn(b"damaged", done.stderr)
                if done.returncode == 3:
                    self.assertIn(b"memory", done.stderr)
                    little += 1
                for path in self.folder.glob("out.h5*"):
                    path.unlink()
        self.assertGreater(little, 0)

    def test_ranks_that_read_another_study(self):
        self.write("study.toml", SENSITIVITY)
        other = self.folder / "elsewhere"
        other.mkdir()
        (other / "study.toml").write_text(SENSITIVITY.replace("seed = 5", "seed = 6"))
        done = self.mpirun_after(2, "cd elsewhere", 3)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(b"poesy: rank 2 on ", done.stderr)
        self.assertIn(b"study.toml: is not the same here as on rank 0", done.stderr)

    def test_other_commands_are_done_once(self):
        command = [MPIRUN, "--oversubscribe", "-n", "3", PROGRAM, "models"]
        done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.decode(), self.succeeds("models"))


class WithoutMpi(RankTest):
    def test_a_launcher_that_is_not_of_this_mpi(self):
        """Without MPI, or where MPI finds no other rank: refused, lest each process write the same file."""
        if HAS_MPI:
            self.skipTest("this poesy has MPI")
        self.write("study.toml", SENSITIVITY)
        for rank in (0, 1):
            launched = os.environ | {"OMPI_COMM_WORLD_RANK": str(rank), "OMPI_COMM_WORLD_SIZE": "2"}
            done = subprocess.run([PROGRAM, "run", "study.toml"], cwd=self.folder, env=launched, capture_output=True,
                                  timeout=60, check=False)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertEqual(b"POESY_MPI" in done.stderr, rank == 0)


if __name__ == "__main__":
    main()
