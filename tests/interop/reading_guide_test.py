"""The code in results/README.md runs on a result of the program. That for MATLAB runs in Octave, see interop/matlab.

usage: reading_guide_test.py POESY OCTAVE
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
POESY, OCTAVE = sys.argv[1:3]
# Figures are drawn but not shown, because there may be no display.
OCTAVE_START = f"warning('off', 'all'); set(0, 'defaultfigurevisible', 'off'); addpath('{ROOT}/results'); "
MATLAB_START = f"addpath('{ROOT}/tests/interop/matlab'); "


def blocks(language):
    text = (ROOT / "results" / "README.md").read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)


class ReadingGuide(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.folder = holder.name
        template = cls.succeeds(POESY, "template", "2upr-rpu", "--full")
        quick = re.sub(r"(?m)^samples = \d+", "samples = 100", re.sub(r"(?m)^count = \d+", "count = 3", template))
        (Path(cls.folder) / "study.toml").write_text(quick)
        cls.succeeds(POESY, "run", "study.toml", "--quiet")
        cls.succeeds(POESY, "export", "study.h5", "-d", "tables")

    @classmethod
    def succeeds(cls, *command):
        done = subprocess.run(command, cwd=cls.folder, capture_output=True, text=True, timeout=280, check=False,
                              env={**os.environ, "POESY_PYTHON": sys.executable, "POESY": POESY})
        if done.returncode != 0:
            raise AssertionError(f"{command}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def octave(self, code):
        return self.succeeds(ROOT / "tests/interop/octave", OCTAVE, "--no-init-file", "--quiet", "--eval", OCTAVE_START + code)

    def test_python(self):
        h5py_lines, xarray_lines = blocks("python")
        self.assertIn("SI: response unit / factor unit", self.succeeds(sys.executable, "-c", h5py_lines))
        self.assertIn("epsilon_3_4_z", self.succeeds(sys.executable, "-c", xarray_lines))

    def test_octave(self):
        package, tables = blocks("octave")
        self.octave(package + "assert(numel(result.ranked.names), 25); assert(exist('ranked.svg'), 2);")
        self.octave(tables + "assert([numel(t.rowheaders), rows(t.data), numel(result.sensitivity.factors)], [25 25 25]);")

    def test_matlab(self):
        (lines,) = blocks("matlab")
        check = "assert(size(indices), [25 3]); assert(numel(errors), 25); assert(isequaln(result.index, indices));"
        self.octave(MATLAB_START + lines + check)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
