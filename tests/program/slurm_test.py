"""The scripts in results/slurm/ in a real Slurm that the test starts: results are those of a plain run.

Skipped (exit code 77) if Slurm or munge is not installed. The test of the time limit takes a minute or two.
"""

import pathlib
import subprocess
import sys
import time
import unittest

from poesy_program import PROGRAM, main
from resumption import MONTE_CARLO, SENSITIVITY, ResumptionTest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cluster"))
import slurm

SKIPPED = 77
ARRAY = ROOT / "results/slurm/array.sbatch"
MPI = ROOT / "results/slurm/mpi.sbatch"
SHARDS = 3
RANKS = 2
DONE = slurm.Ended("COMPLETED", 0)
BOTH_KINDS = {"sensitivity": SENSITIVITY, "monte-carlo": MONTE_CARLO}
# A study that takes seconds on one processor.
LONG = SENSITIVITY.replace("12300", "700300")
# A script that runs poesy but stops it in the first run of its job until a command has ended, so the run takes long on
# any processor. Signals wait until poesy continues.
STANDING = """\
#!/bin/bash
if ((${{SLURM_RESTART_COUNT:-0}} == 0)); then
  (sleep 1; kill -STOP $$; {until}; kill -CONT $$) &
fi
exec {program} "$@"
"""
# Ends when SIGTERM, whose bit is 0x4000, waits for the process $$; see proc_pid_status(5).
TERM_WAITS = "until ((0x$(awk '/^ShdPnd/ { print $2 }' /proc/$$/status) & 0x4000)); do sleep 0.2; done"


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


HAS_SHARDS = unittest.skipUnless("--shard" in output_of(PROGRAM, "run", "--help"), "this poesy has no shards")
HAS_MPI = unittest.skipUnless("libmpi" in output_of("ldd", PROGRAM), "this poesy is built without MPI")


class SlurmTest(ResumptionTest):
    @classmethod
    def setUpClass(cls):
        cls.slurm = cls.enterClassContext(slurm.Slurm())
        cls.slurm.environment.update(POESY=PROGRAM, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")

    def logs(self):
        return "\n".join(f"-- {path.name}\n{path.read_text()}" for path in self.folder.glob("*.log"))

    def submit(self, *arguments):
        return self.slurm.submit(*arguments, cwd=self.folder)

    def completes(self, job, count=1):
        ended = self.slurm.wait(job)
        self.assertEqual(list(ended.values()), [DONE] * count, f"{ended}\n{self.logs()}")

    def standing(self, until):
        """sbatch's option for a job whose program stands still until the command `until` has ended."""
        program = self.folder / "standing"
        program.write_text(STANDING.format(program=PROGRAM, until=until), encoding="utf-8")
        program.chmod(0o755)
        return f"--export=ALL,POESY={program}"

    def submit_shards(self, count, *options):
        return self.submit(f"--array=1-{count}", *options, ARRAY, "study.toml", "out.h5", count)

    def submit_merge(self, shards, count):
        merge = f"{PROGRAM} merge out.*-of-{count}.h5 -o out.h5"
        return self.submit(f"--dependency=afterok:{shards}", "--output=merge.log", "--wrap", merge)

    def test_array_over_seeds(self):
        self.write("study.toml", SENSITIVITY)
        command = f"{PROGRAM} run study.toml --seed $SLURM_ARRAY_TASK_ID -o out$SLURM_ARRAY_TASK_ID.h5 --threads 1"
        self.completes(self.submit("--array=1-3", "--output=%A_%a.log", "--wrap", command), 3)
        for seed in (1, 2, 3):
            self.succeeds("run", "study.toml", "--seed", seed, "-o", "undisturbed.h5", "--quiet")
            self.assertEqual(self.content_hash(f"out{seed}.h5"), self.content_hash("undisturbed.h5"))

    @HAS_SHARDS
    def test_shards(self):
        for kind, study in BOTH_KINDS.items():
            with self.subTest(kind):
                expected = self.undisturbed(study)
                shards = self.submit_shards(SHARDS)
                merge = self.submit_merge(shards, SHARDS)
                self.completes(shards, SHARDS)
                self.completes(merge)
                self.assertEqual(self.content_hash(), expected)
                for path in self.folder.glob("out.*"):
                    path.unlink()

    @HAS_SHARDS
    def test_time_limit(self):
        """A shard that takes longer than its job may goes back into the queue, until it is done; the merge waits."""
        expected = self.undisturbed(LONG)
        # Slurm checks every half minute, or later on a busy machine, which jobs to signal. The job's time must not end
        # before that.
        shards = self.submit_shards(1, "--time=2", "--signal=B:TERM@115", self.standing(TERM_WAITS))
        merge = self.submit_merge(shards, 1)
        self.completes(shards)
        self.completes(merge)
        self.assertEqual(self.content_hash(), expected)
        restarts = self.slurm.restarts(shards)
        self.assertGreaterEqual(restarts, 1)
        self.assertEqual(self.logs().count("interrupted"), restarts)

    @HAS_SHARDS
    def test_cancelled_job_stays_away(self):
        self.write("study.toml", LONG)
        shard = self.submit_shards(1)
        checkpoint = self.folder / "out.1-of-1.h5.part"
        self.slurm.wait_for(lambda: "RUNNING" in str(self.slurm.states(shard)), 60, "the job does not start")
        time.sleep(2)
        self.slurm.cancel(shard)
        ended = self.slurm.wait(shard)
        time.sleep(5)
        self.assertEqual([state for state, _ in self.slurm.states(shard).values()], ["CANCELLED"], ended)
        self.assertEqual(self.slurm.restarts(shard), 0)
        self.assertTrue(checkpoint.exists(), self.logs())

    @HAS_SHARDS
    def test_wrong_study(self):
        """Its exit code is the job's, and what depends on it never runs."""
        self.write("study.toml", SENSITIVITY.replace("12300", "-1"))
        shards = self.submit_shards(2)
        merge = self.submit_merge(shards, 2)
        ended = self.slurm.wait(shards)
        self.assertEqual(list(ended.values()), [slurm.Ended("FAILED", 2)] * 2, self.logs())
        self.assertEqual([state for state, _ in self.slurm.states(merge).values()], ["PENDING"])
        self.slurm.cancel(merge)

    @HAS_MPI
    def test_mpi(self):
        for launch in ("mpirun", "srun --mpi=pmix"):
            for kind, study in BOTH_KINDS.items():
                with self.subTest(launch=launch, kind=kind):
                    expected = self.undisturbed(study)
                    job = self.submit(f"--ntasks={RANKS}", f"--export=ALL,LAUNCH={launch}", MPI, "study.toml", "out.h5")
                    self.completes(job)
                    self.assertEqual(self.content_hash(), expected)
                    (self.folder / "out.h5").unlink()

    @HAS_MPI
    def test_mpi_time_limit(self):
        """With a minute's limit a run stops itself after ten seconds and goes back into the queue until it is done."""
        expected = self.undisturbed(LONG)
        job = self.submit(f"--ntasks={RANKS}", "--time=1", self.standing("sleep 12"), MPI, "study.toml", "out.h5")
        self.completes(job)
        self.assertEqual(self.content_hash(), expected)
        self.assertGreaterEqual(self.slurm.restarts(job), 1)


if __name__ == "__main__":
    reason = slurm.why_not()
    if reason:
        print(f"skipped: {reason}")
        sys.exit(SKIPPED)
    slurm.enter_namespace()
    main()
