#!/usr/bin/env python3
"""Plants commands that do not exist in a README: readme_commands.py must find each, and nothing in a correct one.

Usage: readme_commands_test.py POESY
"""

import sys
import unittest

import readme_commands

PROGRAM = sys.argv.pop()
RIGHT = """`poesy run STUDY.toml -o result.h5 --threads 2`; poesy wanders through prose unchecked.

    ./quickstart test
    build/release/bin/poesy show result.h5

```sh
cmake --preset debug
poesy template 2upr-rpu > study.toml
```
"""


class ReadmeCommandsTest(unittest.TestCase):
    def expect_one(self, code, words):
        found = list(readme_commands.problems(PROGRAM, f"{RIGHT}\n{code}\n"))
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])

    def test_right_readme_has_no_problem(self):
        self.assertEqual(list(readme_commands.problems(PROGRAM, RIGHT)), [])

    def test_unknown_command(self):
        self.expect_one("    poesy frobnicate result.h5", "no command 'poesy frobnicate'")

    def test_unknown_option(self):
        self.expect_one("```\nbuild/release/bin/poesy show result.h5 --frob\n```", "has no option --frob")

    def test_unknown_preset(self):
        self.expect_one("`cmake --preset fast`", "no preset 'fast'")

    def test_missing_script(self):
        self.expect_one("`./slowstart`", "no file ./slowstart")

    def test_readme_without_commands(self):
        found = list(readme_commands.problems(PROGRAM, "# poesy\n"))
        self.assertEqual(found, ["no poesy command in its code"])


if __name__ == "__main__":
    unittest.main()
