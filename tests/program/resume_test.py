"""Which runs are resumed and which are refused, and which files stay if a checkpoint is damaged or the disk is full."""

import os
import resource
import shlex
import signal
import subprocess
import time

import h5py

from poesy_program import PROGRAM, main
from resumption import CASES, DESIGNED, FIDELITIES, GIVEN, MONTE_CARLO, SENSITIVITY, STUDIES, ResumptionTest


class Resume(ResumptionTest):
    def test_every_kind(self):
        for kind, study in STUDIES.items():
            with self.subTest(kind):
                expected = self.undisturbed(study)
                self.stop_early("--threads", 2)
                seconds = 0.3
                while (done := self.resume("--max-wall", f"{seconds} s", "--threads", 1)).returncode == 4:
                    seconds *= 2.0
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(self.content_hash(), expected)

    def test_solves_are_of_all_parts(self):
        self.undisturbed(SENSITIVITY)
        self.write("study.toml", SENSITIVITY.replace("12300", "49300"))
        self.stop_early()
        seconds = 0.1
        while (status := self.resume("--max-wall", f"{seconds} s").returncode) == 4:
            seconds *= 1.5
        self.assertEqual(status, 0)
        with h5py.File(self.folder / "undisturbed.h5") as whole, h5py.File(self.folder / "out.h5") as parts:
            self.assertEqual(parts["run/solves"][()] * 12300, whole["run/solves"][()] * 49300)

    def test_printed_command(self):
        expected = self.undisturbed(SENSITIVITY)
        self.write("my study.toml", SENSITIVITY)
        for seconds in (0.4, 0.3, 0.2, 0.1):
            code, messages = self.run_for(seconds, "--seed", 5, number=signal.SIGINT, study="my study.toml")
            if code != 0:
                break
        self.assertEqual(code, 4, messages)
        command = messages.split("continue with: ")[1]
        self.assertIn("--resume", shlex.split(command))
        done = subprocess.run(command, shell=True, cwd=self.folder, capture_output=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.content_hash(), expected)

    def test_second_interrupt_stops_at_once(self):
        self.write("study.toml", SENSITIVITY.replace("12300", "100000000"))
        command = [PROGRAM, "run", "study.toml", "-o", "out.h5", "--yes"]
        for first in (signal.SIGINT, signal.SIGTERM):
            # Either both signals are pending when the program is scheduled next, or the first one ends it in time.
            with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE) as run:
                with self.assertRaises(subprocess.TimeoutExpired):
                    run.communicate(timeout=1.0)
                run.send_signal(first)
                run.send_signal(signal.SIGINT)
                run.communicate(timeout=60)
            self.assertIn(run.returncode, (4, -signal.SIGINT))
            for path in self.folder.glob("out.h5*"):
                path.unlink()

    def test_one_run_of_a_result_at_a_time(self):
        self.write("study.toml", SENSITIVITY.replace("12300", "100000000"))
        command = [PROGRAM, "run", "study.toml", "-o", "out.h5", "--quiet", "--checkpoint-every", "0.01 s", "--yes"]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE) as run:
            while not self.newer.exists():
                time.sleep(0.01)
            for options in ((), ("--resume",)):
                second = self.poesy("run", "study.toml", "-o", "out.h5", *options)
                self.assertEqual(second.returncode, 2)
                self.assertIn(b"out.h5: another run is computing this result", second.stderr)
            run.send_signal(signal.SIGHUP)
            _, messages = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 4, messages)
        self.assertFalse((self.folder / "out.h5.lock").exists())
        shown = self.poesy("show", "out.h5.part")
        self.assertEqual(shown.returncode, 3)
        self.assertIn(b"is a checkpoint of a run that has not ended", shown.stderr)

    def test_output_that_does_not_arrive(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, "template", "2upr-rpu"], stdout=full, stderr=subprocess.PIPE, check=False)
        self.assertEqual(done.returncode, 3)
        self.assertIn(b"cannot be written", done.stderr)

    def test_changed_result(self):
        self.write("study.toml", SENSITIVITY.replace("12300", "300"))
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        with h5py.File(self.folder / "out.h5", "r+") as result:
            result["sensitivity/global"][0, 0] *= 2
        for command in (("show",), ("export", "-d", "tables")):
            done = self.poesy(*command, "out.h5")
            self.assertEqual(done.returncode, 0)
            self.assertIn(b"out.h5 was changed since it was written", done.stderr)

    def test_more_samples(self):
        """Units have 1000 samples, so that the last one grows, or others follow it whether it was full or not."""
        for study in (SENSITIVITY, MONTE_CARLO, FIDELITIES, DESIGNED):
            for old, new in (("2300", "3000"), ("2000", "2300"), ("300", "2300"), ("1000", "2001")):
                with self.subTest(study=study, old=old, new=new):
                    expected = self.undisturbed(study.replace("12300", new))
                    self.write("study.toml", study.replace("12300", old))
                    self.succeeds("run", "study.toml", "-o", "out.h5", "--keep-checkpoint", "--quiet")
                    self.write("study.toml", study.replace("12300", new))
                    self.assertEqual(self.resume_to_end(), expected)

    def test_more_of_the_given_machines(self):
        few = GIVEN.replace("samples = 9200", "samples = 1100")
        expected = self.undisturbed(GIVEN)
        self.write("study.toml", few)
        self.succeeds("run", "study.toml", "-o", "out.h5", "--keep-checkpoint", "--quiet")
        self.write("study.toml", GIVEN)
        self.assertEqual(self.resume_to_end(), expected)

    def test_more_samples_of_an_unfinished_run(self):
        for study in (SENSITIVITY, MONTE_CARLO, FIDELITIES, DESIGNED):
            with self.subTest(study=study):
                study = study.replace("12300", "5300")
                longest = study.replace("5300", "7600")
                expected = self.undisturbed(longest)
                self.write("study.toml", study)
                self.stop_early("--threads", 1)  # one thread has solved only few units when it stops
                for samples in ("6500", "7600"):
                    self.write("study.toml", study.replace("5300", samples))
                    self.stop_early("--resume", "--threads", 1)
                self.assertEqual(self.resume_to_end(), expected)

    def test_extending_solves_only_what_is_new(self):
        for study in (SENSITIVITY, MONTE_CARLO):
            with self.subTest(study=study):
                self.undisturbed(study.replace("12300", "2999"))
                self.write("study.toml", study.replace("12300", "2300"))
                self.succeeds("run", "study.toml", "-o", "out.h5", "--keep-checkpoint", "--quiet")
                self.write("study.toml", study.replace("12300", "2999"))
                done = self.poesy("run", "study.toml", "-o", "out.h5", "--resume")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(b"continuing from out.h5.part", done.stderr)
                with h5py.File(self.folder / "undisturbed.h5") as whole, h5py.File(self.folder / "out.h5") as parts:
                    self.assertEqual(parts["run/solves"][()], whole["run/solves"][()])

    def refused(self, *words, code=2):
        before = self.generations()
        done = self.resume()
        message = done.stderr.decode()
        self.assertEqual(done.returncode, code, message)
        for word in words:
            self.assertIn(word, message)
        self.assertEqual(self.generations(), before)
        self.assertFalse((self.folder / "out.h5").exists())

    def test_resuming_what_never_began_begins_it(self):
        """As of a job that was killed before its first checkpoint, and is started again by the same command."""
        expected = self.undisturbed(SENSITIVITY)
        done = self.resume()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"there is no checkpoint out.h5.part to resume from: starting from the beginning", done.stderr)
        self.assertEqual(self.content_hash(), expected)
        done = self.resume()
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"out.h5 is there: that run is complete; leave --resume out", done.stderr)

    def test_refusals(self):
        self.write("study.toml", SENSITIVITY)
        self.stop_early()
        for old, new, words in [
            ("seed = 5", "seed = 6", ["seed 5", "6"]),
            ("0.2 deg", "0.3 deg", ["angular", "another study", '"0.2 deg"', '"0.3 deg"']),
            ("samples = 12300", "samples = 300", ["12300", "300"]),
            ('"delta_1_1_y", ', "", ["delta_1_1_y"]),
            ('kind = "sensitivity"', 'kind = "monte-carlo"\ndraws = "per pose"', ["sensitivity", "monte-carlo"]),
            ("gauss-newton", "newton", ["gauss-newton"]),
            ("[solver]", '[solver]\nmetric = "platform"', ["metric", "published", "platform"]),
        ]:
            with self.subTest(new):
                self.write("study.toml", SENSITIVITY.replace(old, new))
                self.refused("out.h5.part", *words)
        other = SENSITIVITY.replace("2upr-rpu", "3-prs").replace('"delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"', '"delta_1_1_x"')
        self.write("study.toml", other.replace('factors = ["delta_1_1_x"]', 'factors = "all"'))
        self.refused("2upr-rpu", "3-prs")

    def test_changed_pose_file(self):
        poses = "z,beta,gamma\n" + "".join(f"{-0.25 + 1e-6 * k},0.1,0.1\n" for k in range(4000))
        self.write("poses.csv", poses)
        self.write("study.toml", CASES.replace("count = 4000", 'select = "file"\nfile = "poses.csv"'))
        self.stop_early()
        self.write("poses.csv", poses.replace("0.1,0.1", "0.1,0.1000001"))
        self.refused("poses")
        self.write("poses.csv", poses)
        self.resume_to_end()

    def test_another_version(self):
        """A checkpoint whose version was changed, digest and all."""
        import hashlib
        self.write("study.toml", SENSITIVITY)
        self.stop_early()
        content = self.newer.read_bytes()[:-32]
        version = content[18:18 + content[17]]
        changed = content.replace(version, version[:-1] + b"x", 1)
        self.newer.write_bytes(changed + hashlib.sha256(changed).digest())
        self.refused(version.decode()[:-1] + "x")

    def test_forgotten_option(self):
        self.write("study.toml", SENSITIVITY)
        self.stop_early()
        before = self.generations()
        done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"--resume", done.stderr)
        self.assertEqual(self.generations(), before)
        self.older.unlink(missing_ok=True)
        done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet")
        self.assertIn(b"out.h5.part: holds an earlier run", done.stderr)
        self.assertNotIn(b"out.h5.part.1", done.stderr)  # only files that exist are named

    def test_bad_times(self):
        self.write("study.toml", SENSITIVITY)
        for option in ("--max-wall", "--checkpoint-every"):
            for value in ("5", "0 s", "-1 s", "nan s", "2 days", "s", ""):
                with self.subTest(option=option, value=value):
                    done = self.poesy("run", "study.toml", "-o", "out.h5", f"{option}={value}")
                    if (option, value) != ("--max-wall", ""):
                        self.assertEqual(done.returncode, 2, done.stderr)

    def test_damaged_newest(self):
        expected = self.undisturbed(SENSITIVITY)
        self.two_generations()
        sound = self.generations()
        newest = sound[self.newer.name]
        flipped = bytearray(newest)
        flipped[len(newest) // 2] ^= 4
        for name, damaged in {"cut": newest[:-1], "half": newest[:len(newest) // 2], "empty": b"", "flipped": bytes(flipped),
                              "rubbish": os.urandom(5000), "missing": None}.items():
            with self.subTest(name):
                for path, content in sound.items():
                    (self.folder / path).write_bytes(content)
                if damaged is None:
                    self.newer.unlink()
                else:
                    self.newer.write_bytes(damaged)
                done = self.resume("--max-wall", "0.1 s")
                self.assertEqual(done.returncode, 4, done.stderr)
                self.assertIn(b"out.h5.part.1", done.stderr)
                # The older, intact checkpoint is still there.
                self.assertEqual(self.older.read_bytes(), sound[self.older.name])
                self.assertEqual(self.resume_to_end(), expected)

    def test_both_broken(self):
        self.write("study.toml", SENSITIVITY)
        self.two_generations()
        for path in (self.newer, self.older):
            path.write_bytes(path.read_bytes()[:-40])
        self.refused("out.h5.part", "out.h5.part.1", code=3)

    def test_size_limit(self):
        expected = self.undisturbed(SENSITIVITY)
        self.stop_early()
        before = self.generations()
        done = subprocess.run(
            [PROGRAM, "run", "study.toml", "-o", "out.h5", "--resume", "--checkpoint-every", "0.01 s"], cwd=self.folder,
            capture_output=True, check=False, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100)))
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn(b"out.h5.part: cannot be written (File too large)", done.stderr)
        self.assertIn(b"--resume", done.stderr)
        self.assertEqual(self.generations(), before)
        self.assertEqual(self.resume_to_end(), expected)


if __name__ == "__main__":
    main()
