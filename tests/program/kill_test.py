"""Runs that are killed at random moments and resumed give the same results as undisturbed runs.

POESY_KILLS: number of kills (default 20). POESY_KILL_SEED selects the moments.
"""

import os
import random
import signal
import time

from poesy_program import main
from resumption import ADAPTIVE_STUDIES, FROM_FILE, STUDIES, ResumptionTest

KILLS = int(os.environ.get("POESY_KILLS", "20"))
TERMINATIONS = max(4, KILLS // 5)
KILLED = ADAPTIVE_STUDIES | {"from a file": FROM_FILE} | STUDIES
MOST = 4  # the most kills, relative to the wanted number, if too few runs have a checkpoint


class Kill(ResumptionTest):
    def setUp(self):
        super().setUp()
        self.random = random.Random(int(os.environ.get("POESY_KILL_SEED", "20240707")))
        self.expected = {}
        self.seconds = {}

    def begin(self, runs):
        """The kind of the run of this number. Its study is in its file, and what an undisturbed run gives is known."""
        kind = list(KILLED)[runs % len(KILLED)]
        if kind not in self.expected:
            start = time.monotonic()
            self.expected[kind] = self.undisturbed(KILLED[kind])
            self.seconds[kind] = time.monotonic() - start
        self.write("study.toml", KILLED[kind])
        return kind

    def run_and_stop(self, kind, number, *options, longest=1.0):
        """A run on one to three threads that a signal stops at a random moment, up to so many times an undisturbed run."""
        moment = self.random.uniform(0.0, longest * self.seconds[kind])
        return self.run_for(moment, "--threads", self.random.randint(1, 3), *options, number=number)

    def test_sigkill(self):
        runs = killed = resumed = 0
        while killed < KILLS or runs < len(KILLED) or (resumed < KILLS // 3 and killed < MOST * KILLS):
            runs += 1
            kind = self.begin(runs)
            with self.subTest(runs=runs, kind=kind):
                code, messages = self.run_and_stop(kind, signal.SIGKILL)
                self.assertIn(code, (0, -signal.SIGKILL), messages)
                while code != 0:
                    killed += 1
                    taken_up = self.newer.exists() or self.older.exists()
                    resumed += taken_up
                    # A resumed run may be killed again.
                    code, messages = self.run_and_stop(kind, signal.SIGKILL, *["--resume"] * taken_up, longest=2.0)
                    self.assertIn(code, (0, -signal.SIGKILL), messages)
                self.assertEqual(self.content_hash(), self.expected[kind])
                beside = {path.name for path in self.folder.glob("*_certificate*.toml")}
                self.assertEqual({path.name for path in self.folder.iterdir()} - beside,
                                 {"study.toml", "undisturbed.h5", "out.h5"})
                for path in self.folder.glob("out.h5*"):
                    path.unlink()
        print(f"{killed} kills of {runs} runs of {len(KILLED)} studies, {resumed} times resumed from a checkpoint")
        self.assertGreaterEqual(resumed, KILLS // 3)

    def test_sigterm(self):
        n = stopped = 0
        while n < TERMINATIONS or (stopped < TERMINATIONS // 2 and n < MOST * TERMINATIONS):
            n += 1
            kind = self.begin(n)
            with self.subTest(n=n, kind=kind):
                # A signal that comes before the program handles signals ends it; nothing is lost.
                code, messages = self.run_and_stop(kind, signal.SIGTERM)
                self.assertIn(code, (0, 4, -signal.SIGTERM), messages)
                has_checkpoint = self.newer.exists()
                stopped += has_checkpoint
                if code == 4:
                    self.assertIn("interrupted", messages)
                    # A run that is still searching for poses has no checkpoint.
                    self.assertNotEqual(has_checkpoint, "before anything was solved" in messages, messages)
                if code != 0:
                    code, messages = self.run_for(120, *["--resume"] * has_checkpoint)
                    self.assertEqual(code, 0, messages)
                self.assertEqual(self.content_hash(), self.expected[kind])
                (self.folder / "out.h5").unlink()
        print(f"{n} runs terminated, {stopped} left a checkpoint")
        self.assertGreaterEqual(stopped, TERMINATIONS // 2)


if __name__ == "__main__":
    main()
