#!/usr/bin/env python3
"""Plants faults in what use_python.py inspects: it must find each fault, and none in correct input."""

import unittest
from pathlib import Path
from types import SimpleNamespace

import use_python

PLACES = {"package": "/usr/lib/python3/dist-packages/poesy", "module": "/usr/lib/python3/dist-packages/poesy_solver.so",
          "metadata": "/usr/lib/python3/dist-packages/poesy", "program": "/usr/bin/poesy"}


class UsePythonTest(unittest.TestCase):
    def expect_fault(self, words, function, *arguments):
        with self.assertRaises(use_python.Fault) as raised:
            function(*arguments)
        self.assertIn(words, str(raised.exception))

    def test_places(self):
        use_python.check_places(PLACES, Path("/usr"))
        self.expect_fault("the package is", use_python.check_places, PLACES, Path("/usr/local"))
        for part in PLACES:
            self.expect_fault(f"the {part} is /a/b", use_python.check_places, PLACES | {part: "/a/b"}, Path("/usr"))

    def test_versions(self):
        versions = dict.fromkeys(PLACES, "0.2.0")
        use_python.check_versions(versions)
        for part in versions:
            self.expect_fault(f"{part} 0.1.0", use_python.check_versions, versions | {part: "0.1.0"})

    def test_ranking(self):
        rows = [SimpleNamespace(effect=1.0 / k) for k in range(1, 11)]
        use_python.check_ranking(rows)
        for wrong in (rows[1:], rows[::-1], [SimpleNamespace(effect=0.0)] * 10):
            self.expect_fault("the ranking has", use_python.check_ranking, wrong)

    def test_bits(self):
        right = [1.0, 2.0, 0.0]
        use_python.check_bits("gap", right, list(right))
        for other in ([1.0, 2.0, 5e-324], [1.0, 2.0, -0.0], [1.0, 2.0]):
            self.expect_fault("module's gap differs", use_python.check_bits, "gap", other, right)
        for unsolved in ([0.0] * 3, [1.0, 2.0, float("nan")]):
            self.expect_fault("does not solve gap", use_python.check_bits, "gap", list(unsolved), unsolved)


if __name__ == "__main__":
    unittest.main()
