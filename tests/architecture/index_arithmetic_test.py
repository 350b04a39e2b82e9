"""Tests that index_arithmetic.py finds positions that are computed by hand, and nothing else."""

import tempfile
import unittest
from pathlib import Path

from index_arithmetic import problems


class IndexArithmetic(unittest.TestCase):
    def found(self, line, name="engine/kinds/some/report.cpp"):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            path.parent.mkdir(parents=True)
            path.write_text(line + "\n", encoding="utf-8")
            return list(problems(Path(folder)))

    def test_a_product_and_a_sum_are_found(self):
        for line in ("mean[r * poses + m]", "mean[m + r * poses]", "mean[(r * sizes + z) * poses + m]", "a[n + 2 * k]"):
            self.assertEqual(len(self.found(f"double x = {line};")), 1, line)

    def test_what_is_no_position_is_left_alone(self):
        for line in ("mean(r, m)", "list[k + 1]", "list[2 * k]", "f([&](auto m) { return a * m + b; })",
                     "x = y;  // mean[r * poses + m]", 'text = " [" + a * b + "]";'):
            self.assertEqual(self.found(line), [], line)

    def test_numerical_rooms_and_files_are_left_alone(self):
        line = "sum += a[i * n + j];"
        self.assertEqual(self.found(line, "engine/stats/linear_fit.cpp"), [])
        self.assertEqual(self.found(line, "engine/kinds/allocation/mean_squares.cpp"), [])
        self.assertEqual(len(self.found(line, "engine/result/result_file.cpp")), 1)


if __name__ == "__main__":
    unittest.main()
