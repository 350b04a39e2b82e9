"""The module poesy_solver: same bits as the program, no copies, other threads run during a call, what is refused, and
an optimiser that calls it.

usage: POESY_PROGRAM=... PYTHONPATH=build/release/python solver_test.py
"""

import csv
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tracemalloc
import unittest
import warnings
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np
from scipy.optimize import least_squares

import poesy_solver

PROGRAM = os.environ["POESY_PROGRAM"]
ROOT = pathlib.Path(__file__).resolve().parents[2]
GALLERY = ROOT / "results" / "gallery"
HOME = [-0.24, 0.1, 0.2]  # a pose of the 2upr-rpu (m, rad, rad)
SIZES = {"m": 1e-4, "rad": math.radians(0.1)}


def sampled(evaluator, shape, scale=1.0, seed=1):
    """Errors of 0.1 mm and 0.1 deg, times the scale, with their rows first."""
    sizes = np.array([SIZES[unit] for unit in evaluator.units["errors"]])
    draws = np.random.default_rng(seed).standard_normal((len(sizes), *shape))
    return scale * draws * sizes.reshape(-1, *(1 for _ in shape))


def bits(array):
    return np.ascontiguousarray(array).tobytes()


class Warnings(unittest.TestCase):
    """Numbers in mm or degrees are asked about, once."""

    def said(self, act):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            act()
        self.assertTrue(all(one.category is poesy_solver.PoesyWarning for one in caught), caught)
        return [str(one.message) for one in caught]

    def test_poses_in_mm(self):
        evaluator = poesy_solver.Evaluator(GALLERY / "3-rps" / "3-rps.toml")
        self.assertEqual(self.said(lambda: evaluator.at([0.0, 0.0, 0.75])), [], "just outside is no slip")
        for times, act in ((1, evaluator.at), (0, evaluator.at)):
            self.assertEqual(len(self.said(lambda: act([0.0, 0.0, 600.0]))), times)
        other = poesy_solver.Evaluator(GALLERY / "3-rps" / "3-rps.toml")
        said = self.said(lambda: other([[0.0, 0.0, 0.6], [0.0, 0.0, 600.0]], np.zeros(len(other.errors))))
        self.assertEqual(said, ["pose 2 has z = 600000 mm, outside the workspace from 500 mm to 700 mm; poses are in SI: metres and "
                                "radians"])

    def test_geometry_in_mm(self):
        path = GALLERY / "3-rps" / "3-rps.toml"
        self.assertEqual(self.said(lambda: poesy_solver.Evaluator(path, geometry={"a": 0.3})), [])
        said = self.said(lambda: poesy_solver.Evaluator(path, geometry={"a": 2.6}))
        self.assertEqual(said, ["a = 2600 mm; the mechanism's file has 250 mm; is that meant?"])


    def test_designs_of_an_optimiser(self):
        """A question that holds for many designs with other numbers is asked once, and other questions are still asked."""
        path = GALLERY / "tricept" / "tricept.toml"
        self.assertEqual(self.said(lambda: poesy_solver.Evaluator(path)), [])
        said = self.said(lambda: [poesy_solver.Evaluator(path, geometry={"h": h}) for h in (0.9, 0.91, 0.925)])
        self.assertEqual(said, ["home has z = -900 mm, outside the workspace from -800 mm to -600 mm (coordinates are absolute); "
                                "is that meant?"])
        said = self.said(lambda: [poesy_solver.Evaluator(path, geometry={"a": a}) for a in (2.6, 2.7)])
        self.assertEqual(said, ["a = 2600 mm; the mechanism's file has 250 mm; is that meant?"])


class Numbers(unittest.TestCase):
    """The program's own, bit by bit."""

    def by_program(self, mechanism, solver, evaluator, poses, errors):
        """Responses [M, R] and status [M] of `poesy evaluate --paired`; errors [M, P]."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "study.toml").write_text(
                f'format = "poesy-study"\nversion = 1\n[mechanism]\n{mechanism}\n[solver]\n{solver}\n')
            for path, names, rows in (("p.csv", evaluator.pose_coordinates, poses),
                                      ("e.csv", evaluator.errors, errors)):
                with open(folder / path, "w", newline="", encoding="utf-8") as file:
                    csv.writer(file).writerows([names, *([repr(float(value)) for value in row] for row in rows)])
            done = subprocess.run([PROGRAM, "evaluate", "study.toml", "--poses", "p.csv", "--errors", "e.csv",
                                   "--paired", "-o", "r.h5", "--quiet"], cwd=folder, capture_output=True, text=True,
                                  check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            with h5py.File(folder / "r.h5") as file:
                group = file["evaluate"]
                responses = np.stack([group[name][()].reshape(-1) for name in evaluator.responses], axis=1)
                return responses, group["status"][()].reshape(-1)

    def check_equal(self, mechanism, solver, evaluator, poses, scale=1.0):
        poses = np.asarray(poses)
        errors = np.ascontiguousarray(sampled(evaluator, (len(poses),), scale).T)
        expected, ends = self.by_program(mechanism, solver, evaluator, poses, errors)
        status = np.full(len(poses), 9, np.uint8)
        found = evaluator(poses, errors, status=status, paired=True)
        np.testing.assert_array_equal(status, ends)
        solved = status <= poesy_solver.Status.stagnated
        self.assertTrue(solved.any())
        self.assertEqual(bits(found[solved]), bits(expected[solved]))
        self.assertTrue(np.isnan(found[~solved]).all())
        return solved

    @staticmethod
    def poses(count=12, seed=2):
        return np.random.default_rng(seed).uniform([-0.30, -0.5, -0.6], [-0.18, 0.5, 0.6], (count, 3))

    def test_every_metric_and_fidelity_has_the_programs_bits(self):
        for metric in ("platform", "published"):
            for fidelity in ("exact", "first-order"):
                with self.subTest(metric=metric, fidelity=fidelity):
                    evaluator = poesy_solver.Evaluator("2upr-rpu", metric=metric, fidelity=fidelity)
                    self.check_equal(f'model = "2upr-rpu"\nfidelity = "{fidelity}"', f'metric = "{metric}"', evaluator,
                                     self.poses())

    def test_some_errors_in_an_order_of_ones_own(self):
        names = ["epsilon_3_0_y", "delta_1_1_y", "epsilon_1_4_z"]
        evaluator = poesy_solver.Evaluator("2upr-rpu", factors=names)
        self.assertEqual(list(evaluator.errors), names)
        self.assertEqual(evaluator.units["errors"], ("rad", "m", "rad"))
        self.check_equal('model = "2upr-rpu"', 'metric = "platform"', evaluator, self.poses())

    def test_the_other_mechanism_of_the_catalog(self):
        evaluator = poesy_solver.Evaluator("3-prs")
        self.assertEqual(evaluator.pose_coordinates, ("alpha", "beta", "z"))
        self.check_equal('model = "3-prs"', "", evaluator, [[0.0, 0.1, 0.7], [0.05, -0.1, 0.85]])

    def test_a_mechanism_of_ones_own(self):
        path = GALLERY / "3-rps" / "3-rps.toml"
        for given in (path, str(path)):
            evaluator = poesy_solver.Evaluator(given)
            self.assertEqual((evaluator.mechanism, len(evaluator.errors)), ("3-rps", 108))
            poses = np.random.default_rng(3).uniform([-0.3, -0.3, 0.55], [0.3, 0.3, 0.65], (8, 3))
            self.check_equal(f'file = "{path}"', "", evaluator, poses)

    def test_samples_without_a_solution_are_nan(self):
        solved = self.check_equal('model = "2upr-rpu"', 'metric = "published"',
                                  poesy_solver.Evaluator("2upr-rpu", metric="published"), self.poses(60), 100.0)
        self.assertFalse(solved.all())

    def test_calibrated_responses_are_smaller(self):
        names = ("3-prs", [0.05, 0.0, 0.8])
        plain, calibrated = (poesy_solver.Evaluator(names[0], calibrated=yes) for yes in (False, True))
        errors = sampled(plain, (200,))
        row = plain.responses.index("position")
        self.assertLess(np.mean(calibrated.at(names[1])(errors)[row]**2), np.mean(plain.at(names[1])(errors)[row]**2))

    def test_sets_are_the_models(self):
        deforming = poesy_solver.Evaluator("2upr-rpu", factors="deforming")
        self.assertEqual(len(deforming.errors), 25)
        everything = poesy_solver.Evaluator("2upr-rpu")
        self.assertEqual(everything.units["responses"], ("m", "rad", "m"))
        self.assertEqual(everything.units["pose_coordinates"], ("m", "rad", "rad"))
        errors = sampled(deforming, (40,))
        padded = np.zeros((71, 40))
        for name, row in zip(deforming.errors, errors):
            padded[everything.errors.index(name)] = row
        np.testing.assert_allclose(deforming.at(HOME)(errors), everything.at(HOME)(padded), rtol=1e-9, atol=1e-15)


class Layouts(unittest.TestCase):
    """The same bits in every layout and number of samples."""

    @classmethod
    def setUpClass(cls):
        cls.evaluator = poesy_solver.Evaluator("2upr-rpu")
        cls.at_home = cls.evaluator.at(HOME)

    def test_rows_columns_and_one_sample(self):
        errors = sampled(self.evaluator, (37,))
        rows = self.at_home(errors)
        self.assertEqual((rows.shape, rows.flags.c_contiguous), ((3, 37), True))
        columns = self.at_home(errors.T)
        self.assertEqual((columns.shape, columns.flags.f_contiguous), ((37, 3), True))
        self.assertEqual(bits(columns.T), bits(rows))
        one = self.at_home(np.ascontiguousarray(errors[:, 5]))
        self.assertEqual(one.shape, (3,))
        self.assertEqual(bits(one), bits(rows[:, 5]))

    def test_a_square_array_in_c_order_has_a_row_for_each_error(self):
        errors = sampled(self.evaluator, (71,))
        self.assertEqual(bits(self.at_home(errors)), bits(self.at_home(errors.T).T))

    def test_samples_do_not_depend_on_their_block(self):
        errors = sampled(self.evaluator, (3000,))
        status = np.full(3000, 9, np.uint8)
        found = self.at_home(errors, status=status)
        self.assertTrue((status <= 1).all())
        for first, end in ((0, 1), (1000, 1100), (1020, 1030), (2040, 3000)):
            part = np.ascontiguousarray(errors[:, first:end])
            self.assertEqual(bits(self.at_home(part)), bits(found[:, first:end]))

    def test_many_poses(self):
        poses = Numbers.poses(5)
        errors = sampled(self.evaluator, (1500,))
        status = np.full((5, 1500), 9, np.uint8)
        found = self.evaluator(poses, errors, status=status)
        self.assertEqual(found.shape, (5, 3, 1500))
        self.assertTrue((status <= 1).all())
        for pose, responses in zip(poses, found):
            self.assertEqual(bits(self.evaluator.at(pose)(errors)), bits(responses))
        one = np.ascontiguousarray(errors[:, 7])
        self.assertEqual(bits(self.evaluator(poses.tolist(), one)), bits(found[:, :, 7]))

    def test_nothing_to_solve(self):
        self.assertEqual(self.at_home(np.empty((71, 0))).shape, (3, 0))
        self.assertEqual(self.evaluator(np.empty((0, 3)), np.empty((71, 4))).shape, (0, 3, 4))

    def test_what_is_no_number_says_so(self):
        errors = sampled(self.evaluator, (9,))
        errors[3, 4] = np.nan
        status = np.zeros(9, np.uint8)
        found = self.at_home(errors, status=status)
        self.assertEqual(poesy_solver.Status(status[4]), poesy_solver.Status.non_finite)
        np.testing.assert_array_equal(np.isnan(found), [np.arange(9) == 4] * 3)


class Memory(unittest.TestCase):
    """Arrays are used where they stand."""

    @classmethod
    def setUpClass(cls):
        cls.evaluator = poesy_solver.Evaluator("2upr-rpu", fidelity="first-order")
        cls.at_home = cls.evaluator.at(HOME)

    def test_out_and_status_are_those_given(self):
        errors = sampled(self.evaluator, (500,))
        expected = self.at_home(errors)
        for given, shape, order in ((errors, (3, 500), "C"), (errors.T, (500, 3), "F")):
            out = np.full(shape, -1.0, order=order)
            address = out.__array_interface__["data"][0]
            self.assertIs(self.at_home(given, out), out)
            self.assertEqual(out.__array_interface__["data"][0], address)
            self.assertEqual(bits(out if order == "C" else out.T), bits(expected))
        out = np.empty((2, 3, 500))
        self.assertIs(self.evaluator([HOME, HOME], errors, out=out), out)
        self.assertEqual(bits(out[1]), bits(expected))

    def test_views_of_larger_arrays_are_written_through(self):
        errors = sampled(self.evaluator, (100,))
        large = np.full((5, 3, 100), -1.0)
        self.assertTrue(np.shares_memory(self.at_home(errors, large[2]), large))
        self.assertEqual(bits(large[2]), bits(self.at_home(errors)))
        self.assertTrue((large[[0, 1, 3, 4]] == -1.0).all())

    def test_numpy_allocates_nothing(self):
        errors, out, status = sampled(self.evaluator, (20000,)), np.empty((3, 20000)), np.empty(20000, np.uint8)
        self.at_home(errors, out, status)
        tracemalloc.start()
        self.addCleanup(tracemalloc.stop)
        self.at_home(errors, out, status)
        self.assertLess(tracemalloc.get_traced_memory()[1], 10000)

    @staticmethod
    def peak():
        """Bytes of memory that the process had at most."""
        status = pathlib.Path("/proc/self/status").read_text(encoding="ascii")
        return 1024 * int(re.search(r"VmHWM:\s+(\d+) kB", status)[1])

    def test_the_process_does_not_grow(self):
        errors, out = np.zeros((71, 400000)), np.zeros((3, 400000))
        errors += 1e-5
        self.at_home(np.ascontiguousarray(errors[:, :5000]))
        pathlib.Path("/proc/self/clear_refs").write_text("5")  # resets the peak to the memory in use
        before = self.peak()
        self.at_home(errors, out)
        self.assertLess(self.peak() - before, errors.nbytes / 8)

    def test_errors_stay_as_they_are(self):
        errors = sampled(self.evaluator, (3000,))
        errors.flags.writeable = False
        before = errors.copy()
        self.at_home(errors)
        self.assertEqual(bits(errors), bits(before))


class Threads(unittest.TestCase):
    def test_others_run_during_a_call(self):
        evaluator = poesy_solver.Evaluator("2upr-rpu")
        at_home, errors = evaluator.at(HOME), sampled(evaluator, (200000,))
        counted, stop = [0], threading.Event()

        def count():
            while not stop.is_set():
                counted[0] += 1
                time.sleep(0.0)  # releases the GIL; the switch interval below never does

        interval = sys.getswitchinterval()
        self.addCleanup(sys.setswitchinterval, interval)
        counter = threading.Thread(target=count)
        counter.start()
        sys.setswitchinterval(1000.0)  # so this thread keeps the GIL unless the call releases it
        before = counted[0]
        at_home(errors)
        after = counted[0]
        stop.set()
        sys.setswitchinterval(interval)
        counter.join()
        self.assertGreater(after, before + 1)

    def test_threads_share_an_evaluator(self):
        evaluator = poesy_solver.Evaluator("2upr-rpu")
        poses = Numbers.poses(8)
        errors = sampled(evaluator, (2000,))
        expected = evaluator(poses, errors)
        with ThreadPoolExecutor(4) as pool:
            for _ in range(3):
                found = list(pool.map(lambda pose: evaluator.at(pose)(errors), poses))
                self.assertEqual(bits(np.stack(found)), bits(expected))

    def test_a_signal_ends_a_call(self):
        class Alarm(Exception):
            pass

        def ring(*_):
            raise Alarm

        evaluator = poesy_solver.Evaluator("2upr-rpu")
        errors, out = sampled(evaluator, (20000,)), np.full((200, 3, 20000), -1.0)
        self.addCleanup(signal.signal, signal.SIGALRM, signal.signal(signal.SIGALRM, ring))
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with self.assertRaises(Alarm):
            evaluator(np.tile(HOME, (200, 1)), errors, out=out)
        self.assertEqual(out[-1, -1, -1], -1.0)
        self.assertTrue(np.isfinite(evaluator.at(HOME)(errors)).all())


class Refusals(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.evaluator = poesy_solver.Evaluator("2upr-rpu")
        cls.at_home = cls.evaluator.at(HOME)
        cls.errors = sampled(cls.evaluator, (10,))

    def refuses(self, kind, pattern, call, *arguments, **named):
        with self.assertRaisesRegex(kind, pattern):
            call(*arguments, **named)

    def test_errors_of_another_type_or_shape(self):
        rows = r"\(71, B\) in C order, a row for each error, \(B, 71\) in Fortran order"
        for given, kind, pattern in (
                ([[0.0] * 10] * 71, TypeError, "errors is of type list, but a NumPy array of float64"),
                (None, TypeError, "errors is of type NoneType"),
                (self.errors.astype(np.float32), TypeError, "errors is an array of float32"),
                (self.errors.astype(">f8"), TypeError, "errors is an array of >f8"),
                (np.zeros((71, 10), int), TypeError, "errors is an array of int64"),
                (self.errors[:70], ValueError, r"shape \(70, 10\) in C order; needed: " + rows),
                (np.ascontiguousarray(self.errors.T), ValueError, r"shape \(10, 71\) in C order; needed: " + rows),
                (self.errors[:, ::2], ValueError, r"shape \(71, 5\) in no contiguous order; needed: " + rows),
                (self.errors[None], ValueError, rows),
                (np.zeros(70), ValueError, rows),
                (np.frombuffer(bytes(71 * 8 + 1), np.uint8)[1:].view(np.float64), ValueError, "multiple")):
            self.refuses(kind, pattern, self.at_home, given)
            if not (isinstance(given, np.ndarray) and given.flags.f_contiguous):
                self.refuses(kind, "errors", self.evaluator, [HOME], given)
        self.refuses(ValueError, r"\(10, 71\) in Fortran order; needed: \(71, B\) in C order", self.evaluator, [HOME],
                     self.errors.T)
        self.refuses(ValueError, r"needed: \(1, 71\) in C order, row by row", self.evaluator, [HOME], self.errors,
                     paired=True)

    def test_out_and_status_of_another_type_or_shape(self):
        constant = np.zeros((3, 10))
        constant.flags.writeable = False
        for out, kind, pattern in ((np.zeros((3, 10), np.float32), TypeError, "out is an array of float32"),
                                   (np.zeros((3, 11)), ValueError, r"out has shape \(3, 11\)"),
                                   (np.zeros((10, 3)), ValueError, r"needed: \(3, 10\) in C order"),
                                   (np.zeros((10, 3)).T, ValueError, r"needed: \(3, 10\) in C order"),
                                   (constant, ValueError, "out cannot be written"),
                                   (self.errors[:3], ValueError, "errors and out share memory")):
            self.refuses(kind, pattern, self.at_home, self.errors, out)
        self.refuses(ValueError, r"needed: \(10, 3\) in Fortran order", self.at_home, self.errors.T, np.zeros((10, 3)))
        for status, kind, pattern in ((np.zeros(10, np.int8), TypeError, "status is an array of int8"),
                                      (np.zeros(9, np.uint8), ValueError, r"needed: \(10,\)"),
                                      (np.zeros(20, np.uint8)[::2], ValueError, "no contiguous order"),
                                      (self.errors.view(np.uint8)[0, :10], ValueError, "errors and status share")):
            self.refuses(kind, pattern, self.at_home, self.errors, None, status)

    def test_poses(self):
        self.refuses(ValueError, r"pose has shape \(2,\); needed: \(3,\): z \(m\), beta \(rad\)", self.evaluator.at,
                     [0, 0])
        self.refuses(ValueError, r"poses has shape \(3,\); needed: \(M, 3\)", self.evaluator, HOME, self.errors)
        self.refuses(TypeError, "pose must be numbers", self.evaluator.at, ["here", 0, 0])
        self.refuses(poesy_solver.InputError, "pose .z = 5 m.* is out of reach: z must be negative", self.evaluator.at,
                     [5, 0, 0])
        out = np.full((2, 3, 10), -1.0)
        self.refuses(poesy_solver.InputError, "pose 2 .*nan.* is not finite", self.evaluator,
                     [HOME, [math.nan, 0, 0]], self.errors, out=out)
        self.assertTrue((out == -1.0).all())

    def test_mechanisms_and_settings_in_the_programs_words(self):
        evaluator, refused = poesy_solver.Evaluator, poesy_solver.InputError
        self.refuses(refused, r"^mechanism\.model is '2upr-rpx', which is unknown; did you mean '2upr-rpu'\?$",
                     evaluator, "2upr-rpx")
        self.refuses(refused, r"^solver\.metric is 'x', which is unknown", evaluator, "2upr-rpu", metric="x")
        self.refuses(refused, "^mechanism.fidelity is .both., but an evaluator", evaluator, "2upr-rpu",
                     fidelity="both")
        self.refuses(refused, r"analysis\.factors is 'delta_1_0_x', which is a factor", evaluator, "2upr-rpu",
                     factors="delta_1_0_x")
        self.refuses(refused, r"analysis\.factors\[1\] names 'delta_1_0_x' a second time", evaluator, "2upr-rpu",
                     factors=["delta_1_0_x", "delta_1_0_x"])
        self.refuses(refused, "analysis.calibrated is true, but", evaluator, "2upr-rpu", calibrated=True)
        self.refuses(refused, "solver.metric does not belong", evaluator, "3-prs", metric="published")
        self.refuses(poesy_solver.FileError, "^mechanism.file names 'no/such.toml', which cannot be read: .*; check the "
                     "path and its permissions$", evaluator, "no/such.toml")
        self.assertTrue(issubclass(refused, ValueError) and issubclass(poesy_solver.FileError, OSError))

    def test_a_broken_mechanism_file_is_named_with_its_line(self):
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name) / "broken.toml"
            path.write_text('format = "poesy-mechanism"\nversion = 1\nnames = "x"\n')
            self.refuses(poesy_solver.InputError, "^" + re.escape(str(path)) + ":3:1: ", poesy_solver.Evaluator, path)


class Description(unittest.TestCase):
    def test_it_has_the_programs_version(self):
        said = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout
        self.assertIn(poesy_solver.__version__, said)

    def test_type_hints_name_what_there_is(self):
        stub = pathlib.Path(poesy_solver.__file__).with_name("poesy_solver.pyi").read_text(encoding="utf-8")
        compile(stub, "poesy_solver.pyi", "exec")
        for name, value in vars(poesy_solver).items():
            if name.startswith("__"):
                continue
            self.assertIn(f"class {name}", stub)
            self.assertTrue(value.__doc__, name)
            for member, attribute in vars(value).items():
                if not member.startswith("_"):
                    self.assertRegex(stub, rf"def {member}\(|    {member} = ")
                    self.assertTrue(attribute.__doc__, member)
        for status in poesy_solver.Status:
            self.assertIn(f"    {status.name} = {status.value}\n", stub)


class Guide(unittest.TestCase):
    def test_lines_of_the_guide_run(self):
        text = (ROOT / "engine" / "python" / "solver" / "README.md").read_text(encoding="utf-8")
        blocks = re.findall(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
        self.assertGreater(len(blocks), 1)
        names = {"print": lambda *_: None}
        for block in blocks:
            exec(compile(block, "README.md", "exec"), names)  # the code of the tutorial


class Designs(unittest.TestCase):
    """Parameters of the geometry."""

    POSE = [0.1, -0.1, -0.7]
    TRICEPT = GALLERY / "tricept" / "tricept.toml"

    def tool(self, **options):
        evaluator = poesy_solver.Evaluator(self.TRICEPT, metric="platform", fidelity="first-order", **options)
        return evaluator.at(self.POSE)(sampled(evaluator, (20,), scale=0.1))

    def test_geometry_is_that_of_a_file_with_other_numbers(self):
        text = self.TRICEPT.read_text()
        with tempfile.TemporaryDirectory() as name:
            other = pathlib.Path(name) / "other.toml"
            other.write_text(text.replace('value = "250 mm", description = "from the middle', 'value = "310 mm", description = "from the middle'))
            self.assertNotEqual(other.read_text(), text)
            evaluator = poesy_solver.Evaluator(other, metric="platform", fidelity="first-order")
            expected = evaluator.at(self.POSE)(sampled(evaluator, (20,), scale=0.1))
        for value in ("310 mm", "0.31 m", 0.31):
            self.assertEqual(bits(self.tool(geometry={"a": value})), bits(expected))
        self.assertNotEqual(bits(self.tool()), bits(expected))
        self.assertEqual(bits(self.tool(geometry={})), bits(self.tool()))

    def test_refusals(self):
        for geometry, said in (({"q": 0.1}, "q"), ({"a": "310"}, "a"), ({"a": "310 deg"}, "length"),
                               ({"a": math.nan}, "a")):
            with self.subTest(geometry), self.assertRaisesRegex(poesy_solver.InputError, said):
                poesy_solver.Evaluator(self.TRICEPT, geometry=geometry)

    def test_lines_of_the_page_run(self):
        """engine/docs/design-optimisation.md: the search finds a better design within its bounds, and the program agrees."""
        text = (ROOT / "engine" / "docs" / "design-optimisation.md").read_text(encoding="utf-8")
        blocks = re.findall(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
        self.assertEqual(len(blocks), 2)
        names = {"print": lambda *_: None}
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        self.addCleanup(sys.path.remove, str(ROOT / "engine" / "python"))
        sys.path.insert(0, str(ROOT / "engine" / "python"))
        os.environ["POESY"] = PROGRAM
        os.chdir(ROOT)
        for block in blocks:
            exec(compile(block, "design-optimisation.md", "exec"), names)
        found = names["found"]
        self.assertLess(found.fun, 0.7 * names["tool_error"]((0.25, 0.12, 0.25)))
        for value, (least, most) in zip(found.x, names["bounds"]):
            self.assertTrue(least <= value <= most)
        usual = names["poesy"].run(GALLERY / "tricept" / "yield.toml")  # the same study with the design of the file
        yields = [result.to_xarray("yield")["value"].item() for result in (usual, names["certificate"])]
        self.assertLess(*yields)


class Calibration(unittest.TestCase):
    def test_least_squares_finds_errors_that_give_what_was_measured(self):
        evaluator = poesy_solver.Evaluator(GALLERY / "3-rps" / "3-rps.toml",
                                           factors=["delta_1_0_x", "delta_2_0_y", "delta_3_0_z", "epsilon_1_0_x"])
        rows = [evaluator.responses.index(name) for name in ("x", "y", "z", "theta_x", "theta_y", "theta_z")]
        sizes = np.array([SIZES[unit] for unit in evaluator.units["errors"]])
        scale = np.array([SIZES[evaluator.units["responses"][row]] for row in rows])
        poses = np.random.default_rng(5).uniform([-0.3, -0.3, 0.55], [0.3, 0.3, 0.65], (10, 3))

        def responses(errors):
            return evaluator(poses, np.ascontiguousarray(errors))[:, rows]

        measured = responses(sizes * [1.0, -2.0, 0.5, 1.5])

        def residuals(unknown):
            return ((responses(sizes * unknown) - measured) / scale).ravel()

        def slopes(unknown, step=1e-4):
            """All differences in one call: column p of the errors has error p changed."""
            changed = sizes[:, None] * (unknown[:, None] + step * np.eye(len(unknown)))
            base = responses(sizes * unknown)
            return ((responses(changed) - base[..., None]) / (step * scale[:, None])).reshape(-1, len(unknown))

        found = least_squares(residuals, np.zeros(len(sizes)), jac=slopes, xtol=1e-14, ftol=1e-14, gtol=1e-14)
        self.assertGreater(np.abs(residuals(np.zeros(len(sizes)))).max(), 0.1)
        self.assertLess(np.abs(found.fun).max(), 1e-8)
        np.testing.assert_allclose(responses(sizes * found.x), measured, rtol=0, atol=1e-12)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
