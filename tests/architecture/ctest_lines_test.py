#!/usr/bin/env python3
"""Lists tests with long names: ctest_lines.py must find each of them, and nothing in a list of short names."""

import unittest

import ctest_lines


def listing(*names):
    tests = "".join(f"  Test {f'#{number}':>4}: {name}\n" for number, name in enumerate(names, start=1))
    return f"Test project /build\n{tests}\nTotal Tests: {len(names)}\n"


class CtestLinesTest(unittest.TestCase):
    def test_short_names(self):
        self.assertEqual(list(ctest_lines.problems(listing("io.A.B", "io.A.C"))), [])

    def test_name_that_makes_a_long_line(self):
        found = list(ctest_lines.problems(listing("io.A.B", "io." + 90 * "a")))
        self.assertEqual(len(found), 1, found)
        self.assertIn("io.aaa", found[0])

    def test_long_listed_line(self):
        self.assertIn("characters: ", "".join(ctest_lines.problems(listing(120 * "a"))))

    def test_bytes(self):
        self.assertIn("not plain", "".join(ctest_lines.problems(listing("io.\xC2\xB5"))))

    def test_no_test(self):
        self.assertEqual(list(ctest_lines.problems(listing())), ["ctest lists no test"])

    def test_line_as_ctest_prints_it(self):
        self.assertEqual(ctest_lines.progress_line(7, "a.b", 5), "7/7 Test #7: a.b .....   Passed  3600.00 sec")


if __name__ == "__main__":
    unittest.main()
