"""Tests results/read_results.py: numbers of the file and of exported tables, order of `poesy show`, figures, errors.

usage: read_results_test.py POESY EXAMPLES; EXAMPLES is the folder to which write_examples wrote
"""

import contextlib
import csv
import io
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import h5py

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "results" / "read_results.py"
sys.path.insert(0, str(SCRIPT.parent))
import read_results  # noqa: E402

POESY, EXAMPLES = sys.argv[1], Path(sys.argv[2])
DEGREE = math.pi / 180


def poesy(*arguments, folder):
    return subprocess.run([POESY, *map(str, arguments)], cwd=folder, check=True, capture_output=True, text=True).stdout


def script(*arguments):
    """Runs the script as a command, in this process: libraries take long to load."""
    printed, said = io.StringIO(), io.StringIO()
    status = 0
    with mock.patch.object(sys, "argv", [str(SCRIPT), *map(str, arguments)]), \
            contextlib.redirect_stdout(printed), contextlib.redirect_stderr(said):
        try:
            read_results.main()
        except SystemExit as end:
            status = 1 if isinstance(end.code, str) else end.code
            said.write(end.code if isinstance(end.code, str) else "")
    return SimpleNamespace(returncode=status, stdout=printed.getvalue(), stderr=said.getvalue())


class Examples(unittest.TestCase):
    def test_every_kind_is_read_with_names_and_units(self):
        kinds = {"sensitivity": ("sensitivity", "global"), "monte_carlo": ("monte_carlo", "mean"),
                 "coupling": ("coupling", "effect"), "allocation": ("allocation", "tolerance"),
                 "evaluate": ("evaluate", "linear_deformation")}
        for kind, (group, variable) in kinds.items():
            with self.subTest(kind), h5py.File(EXAMPLES / f"{kind}.h5") as file:
                result = read_results.read_result(EXAMPLES / f"{kind}.h5")
                self.assertEqual(result.kind, kind.replace("_", "-"))
                self.assertEqual(set(result.groups), {name for name in file if isinstance(file[name], h5py.Group)})
                read = result.groups[group][variable]
                self.assertEqual(read.attrs["unit"], file[group][variable].attrs["unit"])
                self.assertTrue(((read.values == file[group][variable][...]) | (read.values != read.values)).all())
                self.assertEqual(result.units("response"), {"angular_deformation": "rad", "linear_deformation": "m"})

    def test_numbers_are_those_of_the_tables(self):
        result = read_results.read_result(EXAMPLES / "sensitivity.h5")
        with (EXAMPLES / "sensitivity" / "global.csv").open(newline="") as file:
            indices = {row["factor"]: row for row in csv.DictReader(file)}
        with (EXAMPLES / "sensitivity" / "factors.csv").open(newline="") as file:
            sigmas = {row["factor"]: row for row in csv.DictReader(file)}
        ends = ("", "_ci_low", "_ci_high")
        for response, unit in {"angular_deformation": "deg", "linear_deformation": "mm"}.items():
            ranked = read_results.ranked_errors(result, response)
            self.assertEqual([error.factor for error in ranked], ["epsilon_1", "delta_1"])
            for error in ranked:
                sigma = float(sigmas[error.factor]["sigma [deg or mm]"])
                self.assertAlmostEqual(error.sigma / sigma, 1.0, places=14)
                self.assertEqual(error.effect_unit, unit)
                self.assertEqual(error.index_unit, f"{unit}/{error.sigma_unit}")
                for k, end in enumerate(ends):
                    index = float(indices[error.factor][f"{response}_corrected{end} [{unit} per deg or mm]"])
                    if math.isnan(index):
                        self.assertTrue(math.isnan(error.index[k]) and math.isnan(error.effect[k]))
                        continue
                    self.assertAlmostEqual(error.index[k] / index, 1.0, places=14)
                    self.assertAlmostEqual(error.effect[k] / (index * sigma), 1.0, places=14)

    def test_effects_of_the_example(self):
        result = read_results.read_result(EXAMPLES / "sensitivity.h5")
        first = read_results.ranked_errors(result, "angular_deformation")[0]
        for found, expected in zip(first.effect, (11000, 12000, 13000)):
            self.assertAlmostEqual(found / (expected * 0.5 / math.sqrt(3) / DEGREE), 1.0, places=14)

    def test_figures(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, start in {"ranked.svg": b"<?xml", "ranked.png": b"\x89PNG"}.items():
                path = Path(folder) / name
                done = script(EXAMPLES / "sensitivity.h5", "--response", "angular_deformation", "-o", path)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                drawn = path.read_bytes()
                self.assertTrue(drawn.startswith(start))
                self.assertGreater(len(drawn), 5000)
            self.assertIn(b"epsilon_1", (Path(folder) / "ranked.svg").read_bytes())  # in the comment of an outline

    def test_what_is_refused(self):
        cases = {
            ("absent.h5",): "cannot be read as HDF5",
            ("sensitivity/global.csv",): "cannot be read as HDF5",
            ("monte_carlo.h5",): "of kind monte-carlo, which has no indices",
            ("evaluate.h5",): "of kind evaluate, which has no indices",
            ("newer.h5",): "version 2.0, this reads 1.x",
            ("older.h5",): "version 0.9, this reads 1.x",
            ("stranger.h5",): "not a result of poesy (attribute filetype: something-else)",
            ("nameless.h5",): "not a result of poesy (attribute filetype: none)",
            ("sensitivity.h5", "--response", "absent"): "it has angular_deformation, linear_deformation",
            ("sensitivity.h5", "--top", "0"): "--top must be at least 1",
            ("sensitivity.h5", "-o", "ranked.bmp"): "the name must end in",
        }
        for (name, *rest), words in cases.items():
            with self.subTest(words):
                done = script(EXAMPLES / name, *rest)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(words, done.stderr)
                self.assertEqual(done.stdout, "")

    def test_as_a_command(self):
        command = [sys.executable, "-B", str(SCRIPT)]
        done = subprocess.run([*command, EXAMPLES / "absent.h5"], capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertTrue(done.stderr.startswith("read_results.py: "), done.stderr)

    def test_missing_package_is_named_for_each_way_to_install(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "h5netcdf.py").write_text("raise ImportError(\"No module named 'h5netcdf'\")\n")
            done = subprocess.run([sys.executable, "-B", str(SCRIPT), "r.h5"], capture_output=True, text=True, timeout=120,
                                  check=False, env={**os.environ, "PYTHONPATH": folder})
        self.assertEqual(done.returncode, 1)
        for words in ("No module named 'h5netcdf'", "pip install h5py h5netcdf", "conda install", "python3-h5netcdf"):
            self.assertIn(words, done.stderr)


class Studies(unittest.TestCase):
    """Results of the program itself."""

    def check_order(self, model, *response):
        with tempfile.TemporaryDirectory() as folder:
            template = poesy("template", model, "--full", folder=folder)
            quick = re.sub(r"(?m)^samples = \d+", "samples = 200", re.sub(r"(?m)^count = \d+", "count = 4", template))
            (Path(folder) / "study.toml").write_text(quick)
            poesy("run", "study.toml", "--quiet", folder=folder)
            shown = poesy("show", "study.h5", *response, folder=folder)
            printed = script(Path(folder) / "study.h5", *response)
            self.assertEqual(printed.returncode, 0, printed.stderr)
            names = read_results.read_result(Path(folder) / "study.h5").units("factor")

        def order(text):
            found = re.findall(r"(?m)^ *\d+  (\w+) ", text)
            return list(dict.fromkeys(name for name in found if name in names))

        self.assertEqual(len(order(printed.stdout)), len(names))
        self.assertEqual(order(printed.stdout), order(shown))

    def test_order_is_that_of_show(self):
        self.check_order("2upr-rpu")
        self.check_order("2upr-rpu", "--response", "angular_deformation")

    def test_response_is_that_of_show(self):
        self.check_order("3-prs")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
