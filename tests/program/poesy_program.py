"""Shared by the tests of the program: running it, and a study that is quick to solve."""

import functools
import os
import re
import resource
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["POESY_PROGRAM"]
GALLERY = Path(__file__).resolve().parents[2] / "results/gallery"
MECHANISMS = Path(__file__).resolve().parents[1] / "data/mechanisms"
AN_OLDER_RESULT = "poesy-result: an older one"  # begins like a result, so poesy may replace it

EACH_A_PART = """\
[[analysis.parts]]
factors = "linear"
each = true
cost = { law = "reciprocal", b = 1, unit = "mm" }
[[analysis.parts]]
factors = "angular"
each = true
cost = { law = "reciprocal", b = 1, unit = "deg" }
"""
STUDY = """\
format = "poesy-study"
version = 1
[mechanism]
model = "2upr-rpu"
[poses]
count = 6
[errors]
linear = { distribution = "normal", sigma = "1 mm" }
angular = { distribution = "normal", sigma = "0.2 deg" }
[analysis]
kind = "sensitivity"
factors = ["delta_1_1_y", "epsilon_1_4_z", "epsilon_3_0_y"]
samples = 1500
background = { factors = "benign", linear = "1 mm", angular = "1 deg" }
[solver]
method = "gauss-newton"
[run]
seed = 5
"""


def with_memory(megabytes, *arguments, cwd=None):
    """How the program ends that may have so much address space."""
    limit = 1_000_000 * megabytes
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, capture_output=True, timeout=120, check=False,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))


@functools.cache
def least_to_start():
    """Megabytes from which on the program starts. With less the system's loader ends it with 127, or a library that it is
    linked to dies in its own start, before the program's."""
    return 2 + max(megabytes for megabytes in range(20, 200) if with_memory(megabytes, "--version").returncode != 0)


@functools.cache
def least_to_work():
    """Megabytes from which on the program begins to work, as it says with less."""
    said = with_memory(least_to_start(), "models", "3-prs").stderr.decode()
    found = re.search(r"this takes (\d+) MB of memory at least", said)
    assert found, f"with {least_to_start()} MB the program says: {said}"
    return int(found[1])


class ProgramTest(unittest.TestCase):
    """Runs the program in a folder of its own."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def write(self, name, content):
        path = self.folder / name
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content)
        return path

    def poesy(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, timeout=300, check=False)

    def succeeds(self, *arguments):
        done = self.poesy(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr.decode(errors="replace"))
        return done.stdout.decode()


def main():
    unittest.main(argv=[sys.argv[0], "-v"])
