"""Studies with adaptive samples stop at the same number of samples and give the same bits however they are run."""

import h5py
import numpy

from poesy_program import main
from resumption import MACHINES, MONTE_CARLO, POSES, SENSITIVITY, ResumptionTest

ERROR = 0.01 * (16 / POSES) ** 0.5  # takes about the same number of samples for any number of poses
TABLE = f"samples = {{ min = 1000, max = 40000, relative_error = {ERROR:g} }}"
MILESTONES = [1000, 2000, 3000, 5000, 8000, 12000, 18000, 27000, 40000]
STUDIES = {"sensitivity": SENSITIVITY.replace("samples = 12300", TABLE),
           "monte-carlo": MONTE_CARLO.replace("samples = 12300", TABLE.replace(f"{ERROR:g}", f"{0.3 * ERROR:g}")),
           "machines": MACHINES.replace("samples = 12300", TABLE)}


class Adaptive(ResumptionTest):
    def test_threads(self):
        for kind, study in STUDIES.items():
            with self.subTest(kind):
                self.write("study.toml", study)
                hashes = set()
                for threads in (1, 2, 3):
                    self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet", "--threads", threads)
                    self.succeeds("verify", "out.h5")
                    hashes.add(self.content_hash())
                self.assertEqual(len(hashes), 1)
                with h5py.File(self.folder / "out.h5") as result:
                    group = result["convergence"]
                    milestones = list(result["milestone"][:])
                    self.assertEqual(milestones, MILESTONES[:len(milestones)])
                    samples = group["samples"][()]
                    self.assertLess(samples.max(), 40000)
                    self.assertGreater(samples.max(), 1000)
                    self.assertTrue(group["reached"][:].all())
                    self.assertTrue((group["relative_half_width"][:] <= group.attrs["relative_error"]).all())
                    self.assertEqual(group.attrs["max"], 40000)
                    self.assertEqual(group["half_width"].dims[group["half_width"].ndim - 1].keys(), ["milestone"])
                    if kind == "sensitivity":
                        self.assertEqual(result["run/solves"][()], POSES * samples.sum())
                        numpy.testing.assert_array_equal(result["sensitivity/count"][0, :, 0], samples)
                self.assertIn(" within +-", self.succeeds("show", "out.h5"))
                self.succeeds("export", "out.h5", "-d", "tables")
                self.assertTrue((self.folder / "tables" / "convergence.csv").exists())

    def test_killed_and_resumed(self):
        for kind, study in STUDIES.items():
            with self.subTest(kind):
                expected = self.undisturbed(study)
                seconds, code, options = 0.1, None, []
                while code != 0:
                    code, messages = self.run_for(seconds, "--threads", 1, *options)
                    self.assertIn(code, (0, -9), messages)
                    options = ["--resume"] if self.newer.exists() else []  # else the run ended without a checkpoint
                    seconds *= 1.5
                self.assertEqual(self.content_hash(), expected)

    def test_a_larger_max_goes_on(self):
        for kind, study in STUDIES.items():
            with self.subTest(kind):
                expected = self.undisturbed(study)
                for shorter in ("1000", "2300", "3000"):
                    self.write("study.toml", study.replace("40000", shorter))
                    self.succeeds("run", "study.toml", "-o", "out.h5", "--keep-checkpoint", "--quiet")
                    self.assertIn("Raise max", self.succeeds("show", "out.h5"))
                    self.write("study.toml", study)
                    self.assertEqual(self.resume_to_end(), expected)

    def test_other_changes_are_refused(self):
        study = STUDIES["sensitivity"]
        self.write("study.toml", study.replace("40000", "3000"))
        self.succeeds("run", "study.toml", "-o", "out.h5", "--keep-checkpoint", "--quiet")
        for old, new, word in ((f"{ERROR:g} }}", "0.05 }", f"samples.relative_error = {ERROR:g}"),
                               ("min = 1000", "min = 500", "samples.min = 1000"),
                               (TABLE, "samples = 40000", "takes as many samples as it needs"), ("40000", "2000", "3000 samples")):
            self.write("study.toml", study.replace(old, new))
            done = self.resume()
            self.assertEqual(done.returncode, 2)
            self.assertIn(word, done.stderr.decode())

    def test_replay_knows_what_was_drawn(self):
        self.write("study.toml", STUDIES["sensitivity"])
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        with h5py.File(self.folder / "out.h5") as result:
            samples = int(result["convergence/samples"][0])
        self.succeeds("replay", "out.h5", "delta_1_1_y", 0, samples - 1)
        for beyond in (samples, -1):
            done = self.poesy("replay", "out.h5", "delta_1_1_y", 0, beyond)
            self.assertEqual(done.returncode, 2, done.stderr)

    def test_check_says_what_it_means(self):
        self.write("study.toml", STUDIES["sensitivity"])
        text = self.succeeds("check", "study.toml")
        self.assertIn(f"3 errors x {POSES} poses x 1000 to 40000 samples = at least {3000 * POSES} and at most "
                      f"{120000 * POSES} solves", text)
        self.assertIn("at most about", text)
        self.assertIn(f"samples.relative_error = {ERROR:g}", text)


if __name__ == "__main__":
    main()
