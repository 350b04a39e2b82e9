"""Shards of a study that are run one by one and merged give the result of one run."""

import random
import shutil
import signal

import h5py

from poesy_program import main
from resumption import (ALLOCATION, COUPLING, IDENTIFICATION, MONTE_CARLO, POSES, SENSITIVITY, STUDIES, ZONES,
                        ResumptionTest, with_few_units)


class Shards(ResumptionTest):
    def run_shards(self, count, study="study.toml"):
        """Runs all shards, the last one first; their files."""
        names = []
        for k in range(count, 0, -1):
            names.append(f"s{k}.h5")
            said = self.succeeds("run", study, "--shard", f"{k}/{count}", "-o", names[-1], "--threads", 1 + k % 2,
                                 "--quiet")
            self.assertRegex(said, "solves|samples")
        return names

    def merge(self, names, result="all.h5"):
        return self.poesy("merge", *names, "-o", result)

    def refused(self, code, names, *words):
        done = self.merge(names)
        message = done.stderr.decode()
        self.assertEqual(done.returncode, code, message)
        for word in words:
            self.assertIn(word, message)
        self.assertFalse((self.folder / "all.h5").exists())

    def test_every_kind(self):
        """One kind as one shard, two and five; each of the others as two or five in turn: all divide units alike."""
        divided = [kind for kind, study in STUDIES.items() if study not in (ALLOCATION, ZONES, IDENTIFICATION)]
        for number, kind in enumerate(divided):
            expected = self.undisturbed(with_few_units(STUDIES[kind]))
            for count in (1, 2, 5) if number == 0 else (2 + 3 * (number % 2),):
                with self.subTest(kind=kind, shards=count):
                    names = self.run_shards(count)
                    random.Random(count).shuffle(names)
                    done = self.merge(names)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertEqual(self.content_hash("all.h5"), expected)
                    self.succeeds("show", "all.h5")
                    self.succeeds("verify", "all.h5")

    def test_facts_are_of_all_shards(self):
        self.undisturbed(SENSITIVITY)
        names = self.run_shards(2)
        self.merge(names)
        with h5py.File(self.folder / "all.h5") as merged, h5py.File(self.folder / "undisturbed.h5") as whole:
            self.assertEqual(merged["run/solves"][()], whole["run/solves"][()])
            parts = [h5py.File(self.folder / name)["run/wall_seconds"][()] for name in names]
            self.assertAlmostEqual(merged["run/wall_seconds"][()], sum(parts))

    def test_poses_of_a_file_travel_with_the_shards(self):
        self.write("poses.csv", "z,beta,gamma\n-0.2,0.1,0.2\n-0.22,0,0.1\n-0.25,-0.1,0\n")
        study = SENSITIVITY.replace(f"count = {POSES}", 'select = "file"\nfile = "poses.csv"').replace("12300", "300")
        expected = self.undisturbed(study)
        names = self.run_shards(2)
        (self.folder / "poses.csv").unlink()
        (self.folder / "study.toml").unlink()
        self.assertEqual(self.merge(names).returncode, 0)
        self.assertEqual(self.content_hash("all.h5"), expected)

    def test_a_stopped_shard_resumes(self):
        expected = self.undisturbed(MONTE_CARLO)
        names = self.run_shards(2)
        code, messages = self.run_for(0.25, "--shard", "1/2", number=signal.SIGTERM)
        if code == 4:
            self.assertIn("--shard 1/2", messages)
            wrong = self.resume("--shard", "2/2")
            self.assertEqual(wrong.returncode, 2)
            self.assertIn(b"is of shard 1/2, and this run is of shard 2/2", wrong.stderr)
            self.assertEqual(self.resume("--shard", "1/2").returncode, 0)
        shutil.copy(self.folder / "out.h5", self.folder / "s1.h5")
        self.assertEqual(self.merge(names).returncode, 0)
        self.assertEqual(self.content_hash("all.h5"), expected)

    def test_refusals(self):
        self.write("study.toml", SENSITIVITY.replace("12300", "300"))
        names = self.run_shards(3)
        self.refused(2, names[:2], "of 3 shards these are missing: 1")
        self.refused(2, names[1:2], "missing: 1, 3")
        shutil.copy(self.folder / "s2.h5", self.folder / "again.h5")
        self.refused(2, [*names, "again.h5"], "s2.h5", "again.h5", "both shard 2 of 3")
        self.succeeds("run", "study.toml", "--seed", 6, "--shard", "2/3", "-o", "other.h5", "--quiet")
        self.refused(2, ["s1.h5", "other.h5", "s3.h5"], "other.h5: is of another study", "'seed = 6' where s1.h5 has 'seed = 5'")
        self.succeeds("run", "study.toml", "--shard", "2/4", "-o", "other.h5", "--quiet")
        self.refused(2, ["s1.h5", "other.h5", "s3.h5"], "other.h5: is shard 2 of 4, and s1.h5 is shard 1 of 3")
        self.succeeds("run", "study.toml", "-o", "whole.h5", "--quiet")
        self.refused(3, ["whole.h5"], "whole.h5: is a whole result, not a shard")
        self.refused(3, ["nothing.h5"], "nothing.h5")
        for command in (("show",), ("export", "-d", "tables")):
            done = self.poesy(*command, "s1.h5")
            self.assertEqual(done.returncode, 3)
            self.assertIn(b"s1.h5: is a shard of a study", done.stderr)
        self.succeeds("verify", "s1.h5")

    def test_changed_shard(self):
        self.write("study.toml", SENSITIVITY.replace("12300", "300"))
        names = self.run_shards(2)
        with h5py.File(self.folder / "s1.h5", "r+") as shard:
            state = shard["shard/state_1"]
            state[len(state) // 2] ^= 1
        self.refused(3, names, "s1.h5", "was changed since it was written")

    def test_never_over_an_input(self):
        self.write("study.toml", SENSITIVITY.replace("12300", "300"))
        names = self.run_shards(2)
        for command in (("merge", *names, "-o", names[0]), ("run", "study.toml", "-o", "study.toml")):
            before = (self.folder / command[-1]).read_bytes()
            done = self.poesy(*command)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(b"is also an input", done.stderr)
            self.assertEqual((self.folder / command[-1]).read_bytes(), before)

    def test_bad_divisions(self):
        self.write("study.toml", SENSITIVITY)
        for text in ("0/2", "3/2", "2", "1/0", "a/b", "1/2/3", "-1/2", "1/99999999999999999999999"):
            done = self.poesy("run", "study.toml", "--shard", text)
            self.assertEqual(done.returncode, 2, text)
            self.assertIn(b"K/N", done.stderr)
        done = self.poesy("run", "study.toml", "--shard", f"1/{3 * POSES + 1}")
        self.assertEqual(done.returncode, 2)
        self.assertIn(f"divides into {3 * POSES} at most", done.stderr.decode())
        for kind, study in (("identification", IDENTIFICATION), ("allocation", ALLOCATION)):
            self.write("study.toml", study)
            done = self.poesy("run", "study.toml", "--shard", "1/2")
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"divides no study of kind {kind}", done.stderr.decode())

    def test_name_of_a_shard(self):
        self.write("study.toml", with_few_units(COUPLING))
        self.succeeds("run", "study.toml", "--shard", "1/2", "--quiet")
        self.assertTrue((self.folder / "study.1-of-2.h5").exists())


if __name__ == "__main__":
    main()
