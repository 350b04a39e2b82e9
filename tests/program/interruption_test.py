"""A run that is stopped keeps the older result."""

import signal
import subprocess
import time

from poesy_program import AN_OLDER_RESULT, PROGRAM, STUDY, ProgramTest, main

LONG_STUDY = STUDY.replace("samples = 1500", "samples = 100000000").replace("count = 6", "count = 50")


class Interruption(ProgramTest):
    def test_signals(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number.name):
                self.write("study.toml", LONG_STUDY)
                result = self.write("out.h5", AN_OLDER_RESULT)
                with subprocess.Popen([PROGRAM, "run", "study.toml", "-o", "out.h5", "--yes"], cwd=self.folder, stderr=subprocess.PIPE) as run:
                    time.sleep(1.0)
                    run.send_signal(number)
                    _, message = run.communicate(timeout=60)
                self.assertEqual(run.returncode, 4, message)
                self.assertIn(b"interrupted", message)
                self.assertEqual(result.read_text(), AN_OLDER_RESULT)
                self.assertEqual({path.name for path in self.folder.iterdir()}, {"study.toml", "out.h5", "out.h5.part"})
                (self.folder / "out.h5.part").unlink()

    def test_samples_that_fail(self):
        study = STUDY.replace('method = "gauss-newton"', 'method = "gauss-newton"\nmax_iterations = 1\nnot_converged = "fail"')
        self.write("study.toml", study)
        done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.succeeds("verify", "out.h5")


if __name__ == "__main__":
    main()
