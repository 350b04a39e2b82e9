"""poesy.run: studies as dicts and files, exceptions with the program's message, progress, Ctrl-C and resuming."""

import copy
import gc
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import warnings
from pathlib import Path
from unittest import mock

from package import HOPELESS, PROGRAM, ROOT, STUDIES, FolderTest, main, poesy, result, study

RPS3 = (ROOT / "tests" / "data" / "mechanisms" / "rps3.toml").read_text()
LONG = study({"kind": "sensitivity", "samples": 10**7}, poses=50)  # takes hours, but less than a day
LONGER_THAN_A_DAY = study({"kind": "sensitivity", "samples": 10**13})


class Runs(FolderTest):
    def test_a_dict_is_the_same_as_the_file(self):
        poesy.run(STUDIES["sensitivity"], output="a.h5")
        Path("b.toml").write_text(poesy._toml.dumps({"format": "poesy-study", "version": 1, **STUDIES["sensitivity"]}))
        poesy.run("b.toml", output=Path("b.h5"), threads=1)
        hashes = {poesy.read(name).attrs["content_sha256"] for name in ("a.h5", "b.h5")}
        self.assertEqual(len(hashes), 1)
        self.assertEqual({path.name for path in self.folder.iterdir()}, {"a.h5", "b.toml", "b.h5"})

    def test_seed(self):
        self.assertEqual(poesy.run(STUDIES["sensitivity"], seed=7).study["run"]["seed"], 7)

    def test_machines_are_in_the_current_folder(self):
        Path("parts.csv").write_text("delta_1_4_x [mm]\n" + "".join(f"{n / 100}\n" for n in range(-6, 7)))
        asked = study({"kind": "monte-carlo", "draws": "per machine", "samples": 13, "limits": {"gap": "0.2 mm"}})
        asked["errors"] = {**asked["errors"], "machines": "parts.csv"}
        self.assertEqual(poesy.run(asked).study["errors"]["machines"]["columns"], ["delta_1_4_x"])

    def test_files_are_relative_to_the_current_folder(self):
        Path("robots").mkdir()
        Path("robots/rps3.toml").write_text(RPS3)
        Path("poses.csv").write_text("rx,ry,z\n0,0,0.6\n0.1,0,0.55\n")
        asked = study({"kind": "sensitivity", "samples": 50}, poses=2)
        asked |= {"mechanism": {"file": "robots/rps3.toml"}, "poses": {"select": "file", "file": "poses.csv"}, "solver": {}}
        found = poesy.run(asked)
        self.assertEqual(found.study["mechanism"]["file"], "robots/rps3.toml")  # not the path of a temporary folder
        self.assertEqual(found.to_xarray("poses")["z"].values.tolist(), [0.6, 0.55])
        Path("study.toml").write_text(poesy._toml.dumps({"format": "poesy-study", "version": 1, **asked}))
        self.assertEqual(found.attrs["content_sha256"], poesy.run("study.toml").attrs["content_sha256"])
        asked["mechanism"] = {"file": str(self.folder / "robots" / "rps3.toml")}
        self.assertEqual(poesy.run(asked).study["mechanism"]["file"], str(self.folder / "robots" / "rps3.toml"))
        os.chdir("robots")
        asked |= {"mechanism": {"file": "rps3.toml"}, "poses": {"select": "file", "file": "../poses.csv"}}
        self.assertEqual(poesy.run(asked).to_xarray("poses").sizes["pose"], 2)

    def test_the_temporary_folder_ends_with_the_result(self):
        found = poesy.run(STUDIES["sensitivity"])
        folder = found.path.parent
        self.assertTrue(folder.exists())
        found.plot.ranking()
        del found
        gc.collect()
        self.assertFalse(folder.exists())

    def test_the_study_given_is_not_changed(self):
        asked = copy.deepcopy(STUDIES["sensitivity"])
        poesy.run(asked)
        self.assertEqual(asked, STUDIES["sensitivity"])

    def test_messages(self):
        self.assertEqual(result("sensitivity").messages, ())
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            found = poesy.run(study({"kind": "sensitivity", "samples": 50}, solver=HOPELESS))
        self.assertTrue(any("did not converge" in str(one.message) and one.category is poesy.PoesyWarning for one in caught))
        self.assertEqual(found.kind, "sensitivity")

    def test_a_limit_that_is_not_kept_is_a_verdict(self):
        found = poesy.run(STUDIES["evaluate"])
        self.assertEqual(found.verdict, "not kept")
        self.assertRegex(found.messages[-1], "^gap is .* above its limit of 0.05 mm")  # no temporary file

    def test_warnings_point_at_the_call(self):
        asked = study({"kind": "monte-carlo", "draws": "per machine", "samples": 200, "yield": 0.5, "limits": {"gap": "0.06 mm"}})
        for kept in (0.06, 0.065, 0.07, 0.075, 0.08, 0.09):
            asked["analysis"]["limits"]["gap"] = f"{kept} mm"
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                found = poesy.run(asked)
            if found.verdict == "undecided":
                self.assertEqual([one.filename for one in caught], [__file__])
                self.assertRegex(str(caught[0].message), "^the yield is .* does not tell whether it is 50 %")
                return
        self.fail("no limit left it open")


class Errors(FolderTest):
    def test_wrong_studies(self):
        wrong = copy.deepcopy(STUDIES["sensitivity"])
        wrong["analysis"]["samples"] = 1
        with self.assertRaisesRegex(poesy.StudyError, r"^study, line \d+ \(samples = 1\): .*samples"):
            poesy.run(wrong)
        with self.assertRaisesRegex(poesy.StudyError, "did you mean 'analysis'|unknown|analyse"):
            poesy.run({"mechanism": {"model": "2upr-rpu"}, "analyse": {}})
        Path("wrong.toml").write_text('format = "poesy-study"\nversion = 1\nbogus = 1\n')
        with self.assertRaisesRegex(ValueError, r"^wrong.toml:3:1: "):
            poesy.run("wrong.toml")
        with self.assertRaisesRegex(poesy.StudyError, "--threads"):
            poesy.run(STUDIES["sensitivity"], threads=0)

    def test_files(self):
        with self.assertRaisesRegex(poesy.FileError, "absent.toml: cannot be read"):
            poesy.run("absent.toml")
        with self.assertRaisesRegex(OSError, "/proc/a.h5: cannot be created"):
            poesy.run(STUDIES["sensitivity"], output="/proc/a.h5")
        with self.assertRaisesRegex(poesy.StudyError, "nowhere/a.h5: its folder nowhere does not exist"):
            poesy.run(STUDIES["sensitivity"], output="nowhere/a.h5")

    def test_nothing_is_left_of_a_study_that_is_refused(self):
        with mock.patch.object(tempfile, "tempdir", str(self.folder)), self.assertRaises(poesy.StudyError):
            poesy.run({"mechanism": {"model": "absent"}})
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_all_are_errors_of_the_package(self):
        for name in ("StudyError", "FileError", "DamagedFile", "Interrupted", "InternalError", "ProgramNotFound", "NotInResult"):
            self.assertTrue(issubclass(getattr(poesy, name), poesy.Error))


class Programs(FolderTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(setattr, poesy, "program", None)

    def fake(self, script, name="poesy"):
        path = self.folder / name
        path.write_text(f"#!/bin/sh\n{script}\n")
        path.chmod(0o755)
        return path

    def test_where_it_is_looked_for(self):
        self.assertEqual(poesy._program.find(), str(Path(PROGRAM).absolute()))
        path = self.fake("exit 0")
        with mock.patch.dict(os.environ, {"PATH": str(self.folder)}):
            del os.environ["POESY"]
            self.assertEqual(poesy._program.find(), str(path))
            poesy.program = PROGRAM
            self.assertEqual(poesy._program.find(), str(Path(PROGRAM).absolute()))
            poesy.program = "/absent/poesy"
            with self.assertRaisesRegex(poesy.ProgramNotFound, "poesy.program is '/absent/poesy'"):
                poesy.run(STUDIES["sensitivity"])
            poesy.program = None
            os.environ["POESY"] = str(self.folder)
            with self.assertRaisesRegex(poesy.ProgramNotFound, "variable POESY is"):
                poesy.mechanism("2upr-rpu")
        with mock.patch.dict(os.environ, {"PATH": "/nowhere"}):
            del os.environ["POESY"]
            with self.assertRaisesRegex(poesy.ProgramNotFound, "not on PATH; .* poesy.program = "):
                poesy.evaluate("2upr-rpu", [[0, 0, 0]], {"delta_1_1_y": 1})

    def test_of_a_virtual_environment_comes_before_that_on_path(self):
        path = self.fake("exit 0")
        (self.folder / "bin").mkdir()
        in_environment = self.fake("exit 0", "bin/poesy")
        with mock.patch.dict(os.environ, {"PATH": str(self.folder)}), mock.patch.object(sys, "prefix", str(self.folder)):
            self.assertEqual(poesy._program.find(), str(Path(PROGRAM).absolute()))  # from the variable POESY
            del os.environ["POESY"]
            self.assertEqual(poesy._program.find(), str(in_environment))
            with mock.patch.object(sys, "base_prefix", str(self.folder)):  # not a virtual environment
                self.assertEqual(poesy._program.find(), str(path))
            in_environment.unlink()
            self.assertEqual(poesy._program.find(), str(path))

    def test_exit_codes(self):
        cases = {1: poesy.InternalError, 2: poesy.StudyError, 3: poesy.FileError, 4: poesy.Interrupted, 99: poesy.InternalError}
        for code, kind in cases.items():
            poesy.program = self.fake(f"echo 'poesy: note' >&2; echo 'poesy: what is wrong; what to do' >&2; exit {code}")
            with self.subTest(code), self.assertRaises(kind) as raised:
                poesy.run("study.toml")
            self.assertIs(type(raised.exception), kind)
            self.assertEqual(str(raised.exception), "what is wrong; what to do")
        poesy.program = self.fake("kill -SEGV $$")
        with self.assertRaisesRegex(poesy.InternalError, "ended by SIGSEGV"):
            poesy.run("study.toml")
        poesy.program = self.fake("exit 1")
        with self.assertRaisesRegex(poesy.InternalError, "exit code 1 and said nothing"):
            poesy.run("study.toml")

    def test_progress(self):
        lines = [
            "12.5 % done, 7.21 M samples/s, 0 not converged, 4 s left",
            "stage 2: 50.0 % done, 720 samples/s, 3 not converged (0.1 %), 1 min left",
            "validating designs: 3 of 10 done",
            "design 4 of 10: 50.0 % done, 720 samples/s, 3 not converged (0.1 %), 1 min left",
        ]
        said = "".join(f"echo '{line}' >&2; " for line in lines)
        poesy.program = self.fake(f"{said} echo 'poesy: warning: take care' >&2; cp {result('sensitivity').path} $4")
        heard = []
        with self.assertWarnsRegex(poesy.PoesyWarning, "^take care$"):
            found = poesy.run("study.toml", output=self.folder / "a.h5", progress=heard.append)
        self.assertEqual([(one.share, one.stage, str(one)) for one in heard], [(0.125, 1, lines[0]), (0.5, 2, lines[1]),
                          (0.0, 1, lines[2]), (0.5, 4, lines[3])])
        self.assertEqual(found.messages, ())
        with mock.patch("builtins.print") as printed, warnings.catch_warnings(record=True):
            poesy.run("study.toml", output=self.folder / "a.h5", progress=True)
        self.assertEqual(printed.call_count, len(lines))

    def test_much_output_does_not_block(self):
        poesy.program = self.fake("yes 0123456789 | head -c 3000000; yes 'poesy: note' | head -c 300000 >&2")
        self.assertEqual(len(poesy._program.call("models")), 3_000_000)

    def test_quiet_without_progress(self):
        poesy.program = self.fake('echo "poesy: $*" >&2; exit 1')
        for progress, quiet in ((None, True), (False, True), (True, False), (print, False)):
            with self.assertRaises(poesy.InternalError) as raised:
                poesy.run("study.toml", progress=progress)
            self.assertEqual(str(raised.exception).endswith("--quiet"), quiet)

    def test_version(self):
        self.assertRegex(poesy.program_version()["version"], r"^\d+\.\d+\.\d+$")


INTERRUPTED = """\
import json, sys
import poesy
try:
    poesy.run(json.loads(sys.argv[1]), output=sys.argv[2])
except KeyboardInterrupt as error:
    print("\\n".join(error.__notes__))
    sys.exit(9)
"""


class Interruption(FolderTest):
    def interrupted(self, asked, *, to_group):
        """Ctrl-C in a terminal goes to the whole group of processes in the foreground."""
        environment = os.environ | {"TMPDIR": str(self.folder)}  # the folder of the temporary study file
        command = [sys.executable, "-B", "-c", INTERRUPTED, json.dumps(asked), str(self.folder / "out.h5")]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment, start_new_session=True) as run:
            begun = self.folder / "out.h5.lock"
            end = time.monotonic() + 100
            while not begun.exists() and time.monotonic() < end:
                time.sleep(0.05)
            time.sleep(1)
            if to_group:
                os.killpg(run.pid, signal.SIGINT)
            else:
                run.send_signal(signal.SIGINT)
            said, _ = run.communicate(timeout=120)
        self.assertEqual(run.returncode, 9)
        return said

    def test_ctrl_c_keeps_the_checkpoint(self):
        for to_group in (False, True):
            with self.subTest(to_group=to_group):
                said = self.interrupted(LONG, to_group=to_group)
                self.assertRegex(said, "interrupted")
                self.assertIn("--resume", said)
                self.assertTrue((self.folder / "out.h5.part").exists())
                self.assertFalse((self.folder / "out.h5").exists())
                (self.folder / "out.h5.part").unlink()

    def test_resume(self):
        asked = study({"kind": "sensitivity", "samples": 60_000}, poses=20)
        whole = poesy.run(asked, output="whole.h5")
        script = [PROGRAM, "run", "study.toml", "-o", "part.h5", "--threads", "1", "--max-wall", "0.3 s", "--quiet"]
        Path("study.toml").write_text(poesy._toml.dumps({"format": "poesy-study", "version": 1, **asked}))
        done = subprocess.run(script, capture_output=True, check=False)
        self.assertEqual(done.returncode, 4, done.stderr)
        with self.assertRaisesRegex(poesy.StudyError, "earlier run of this result"):
            poesy.run(asked, output="part.h5")
        resumed = poesy.run(asked, output="part.h5", resume=True)
        self.assertEqual(resumed.attrs["content_sha256"], whole.attrs["content_sha256"])

    def test_progress_of_a_long_run(self):
        """The program's own line, after five seconds. The callback stops the run."""
        heard = []

        def listen(progress):
            heard.append(progress)
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough") as raised:
            poesy.run(LONG, output="out.h5", progress=listen, yes=True)
        self.assertEqual(len(heard), 1)
        self.assertTrue(0.0 <= heard[0].share < 0.5 and heard[0].stage == 1, heard)
        self.assertRegex(str(heard[0]), r"^[\d.]+ % done, (.* samples/s, )?\d+ not converged.*, .* left$")
        self.assertTrue(Path("out.h5.part").exists())
        self.assertIn("--resume", raised.exception.__notes__[0])

    def test_a_run_of_more_than_a_day_wants_a_yes(self):
        with self.assertRaisesRegex(poesy.StudyError, "this run takes about .* d.*--yes"):
            poesy.run(LONGER_THAN_A_DAY)

        def enough(_):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            poesy.run(LONGER_THAN_A_DAY, output="out.h5", progress=enough, yes=True)
        self.assertTrue(Path("out.h5.part").exists())

    def test_progress_of_a_search_for_poses(self):
        fake = self.folder / "poesy"
        fake.write_text("#!/bin/sh\necho 'looking for poses: 3 of 20 found, 34000 candidates' >&2\nexit 3\n")
        fake.chmod(0o755)
        self.addCleanup(setattr, poesy, "program", None)
        poesy.program = fake
        heard = []
        with self.assertRaisesRegex(poesy.FileError, "said nothing"):
            poesy.run("study.toml", progress=heard.append)
        self.assertEqual([(one.share, one.stage, str(one)) for one in heard],
                         [(0.0, 1, "looking for poses: 3 of 20 found, 34000 candidates")])

    def test_a_callback_that_fails_stops_the_program(self):
        fake = self.folder / "poesy"
        ends = "trap 'echo poesy: stopped >&2; exit 4' INT"
        fake.write_text(f"#!/bin/sh\n{ends}\necho '1.0 % done, x' >&2\nsleep 60 >&- 2>&- & wait $!\n")
        fake.chmod(0o755)
        self.addCleanup(setattr, poesy, "program", None)
        poesy.program = fake

        def fail(_):
            raise RuntimeError("enough")

        start = time.monotonic()
        with self.assertRaisesRegex(RuntimeError, "enough") as raised:
            poesy.run("study.toml", progress=fail)
        self.assertLess(time.monotonic() - start, 30)
        self.assertEqual(raised.exception.__notes__, ["poesy: stopped"])


class Evaluator(unittest.TestCase):
    def test_without_the_compiled_module_it_says_how_to_get_it(self):
        with mock.patch.dict(sys.modules, {"poesy_solver": None}), self.assertRaisesRegex(ImportError, "POESY_PYTHON_MODULE=ON"):
            poesy.Evaluator
        self.assertIn("Evaluator", dir(poesy))
        with self.assertRaises(AttributeError):
            poesy.absent

    def test_with_it_it_is_that_class(self):
        module = mock.MagicMock()
        with mock.patch.dict(sys.modules, {"poesy_solver": module}):
            self.assertIs(poesy.Evaluator, module.Evaluator)


if __name__ == "__main__":
    main()
