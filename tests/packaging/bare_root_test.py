#!/usr/bin/env python3
"""Plants faults in the texts that bare_root.py reads: it must find each fault, and none in correct texts."""

import unittest

import bare_root

README = """# poesy

```
./quickstart --help
```

## Start

On Debian 12:

```
./quickstart          # installs, builds, runs
./quickstart test     # all tests
./quickstart python   # for Python
```

## Other

```
./quickstart other
```
"""
NAMES = [f"{kind}_{limb}_{joint}_{axis}" for kind in ("epsilon", "delta") for limb in "123" for joint in "10"
         for axis in "xyz"][:25]
SAID = """== Installing
  1  epsilon_9_9_x
== Next: activate the environment
. build/python-venv/bin/activate
python -c '
import poesy
print()'

More: a page
"""
PRINTED = """== Building: rank  error
== The errors that matter most
Effect of each error on gap
                                          not
rank  error  effect  index  low  high  sigma  unit  converged
        [mm] [mm/unit]
{}
A note: 1 of them.

== The published ranking beside it
Two rankings
           rank,      gap,
error   platform  platform
                      [mm]
{}
Kendall's tau of the two rankings is 0.6, over 25 errors
== Writing the reports
   1  this is not of the table
"""


def as_is(_rows):
    pass


def printed(change=as_is, change_comparison=as_is):
    rows = [[str(k + 1), NAMES[k], f"{0.6 - 0.02 * k:.3g}", "1", "0.9", "1.1", "1", "deg", "0"] for k in range(25)]
    both = [[NAMES[k], str(k + 1), "0.6", str(25 - k), "2.8"] for k in range(25)]
    change(rows)
    change_comparison(both)
    return PRINTED.format("\n".join("  " + "  ".join(row) for row in rows), "\n".join("  ".join(row) for row in both))


def set_cell(row, column, text):
    return lambda rows: rows[row].__setitem__(column, text)


class BareRootTest(unittest.TestCase):
    def expect_fault(self, words, function, *arguments):
        with self.assertRaises(bare_root.Fault) as raised:
            function(*arguments)
        self.assertIn(words, str(raised.exception))

    def test_commands_of_the_readme(self):
        self.assertEqual(bare_root.command_of(README, ""), "./quickstart")
        self.assertEqual(bare_root.command_of(README, "test"), "./quickstart test")
        self.assertEqual(bare_root.command_of(README, "python"), "./quickstart python")

    def test_readme_without_the_block(self):
        for old, new in (("## Start", "## Begin"), ("./quickstart          #", "make          #")):
            self.expect_fault("no code block", bare_root.command_of, README.replace(old, new), "")
        self.expect_fault("does not have", bare_root.command_of, README.replace("start test", "start tests"), "test")
        self.expect_fault("have ./quickstart python", bare_root.command_of, README.replace("start python", "start"), "python")

    def test_whole_table(self):
        bare_root.check_table(printed())

    def test_faults_of_the_table(self):
        for words, change in {
                "24 rows": lambda rows: rows.pop(),
                "24 errors": set_cell(3, 1, NAMES[4]),
                "not an error": set_cell(3, 1, "gamma_1_1_x"),
                "a number": set_cell(3, 2, "-"),
                "order": set_cell(3, 2, "9"),
                "exchanged": set_cell(3, 4, "1.2"),
                "not epsilon_1_1_x": set_cell(0, 1, "epsilon_3_3_z"),
        }.items():
            self.expect_fault(words, bare_root.check_table, printed(change))
        self.expect_fault("not there", bare_root.check_table, printed().replace("== The errors", "== Errors"))
        self.expect_fault("not there", bare_root.check_table, printed(lambda rows: rows.clear()))

    def test_comparison(self):
        bare_root.check_comparison(printed())
        for words, change in {
                "those of all errors": lambda rows: rows.pop(),
                "order of the first": set_cell(3, 1, "9"),
                "not another one": set_cell(3, 3, "9"),
        }.items():
            self.expect_fault(words, bare_root.check_comparison, printed(change_comparison=change))
        self.expect_fault("not compared", bare_root.check_comparison, printed().replace("Kendall's tau", "tau"))
        self.expect_fault("not compared", bare_root.check_comparison, printed().replace("== The published", "== Its"))
        self.expect_fault("not another one", bare_root.check_comparison, printed().replace("is 0.6,", "is 0.9,"))

    def test_warnings(self):
        bare_root.check_warnings("rehash: warning: skipping ca-certificates.crt\na.cpp:3:4: note: here\n")
        self.expect_fault("a.h:3:4", bare_root.check_warnings, "[1/2] Building\n/root/poesy/a.h:3:4: warning: unused [-Wunused]\n")

    def test_packages(self):
        few = {"g++", "cmake"}
        bare_root.check_packages(set(), few, "trixie")
        self.expect_fault("npm", bare_root.check_packages, set(), few | {"npm"}, "trixie")
        for suite, most in bare_root.MOST_PACKAGES.items():
            too_many = {str(n) for n in range(most + 1)}
            self.expect_fault(f"{most + 1} packages", bare_root.check_packages, few, few | too_many, suite)

    def test_packages_for_python(self):
        few = {"g++", "python3-numpy"}
        bare_root.check_packages(set(), few, "trixie", python=True)
        self.expect_fault("python3-numpy", bare_root.check_packages, set(), few, "trixie")
        self.expect_fault("octave", bare_root.check_packages, set(), few | {"octave"}, "trixie", True)
        for suite, most in bare_root.MOST_FOR_PYTHON.items():
            too_many = {str(n) for n in range(most + 1)}
            self.expect_fault(f"{most + 1} packages", bare_root.check_packages, set(), too_many, suite, True)

    def test_next_step(self):
        self.assertEqual(bare_root.next_step(SAID), SAID.partition("environment\n")[2].partition("\nMore")[0])
        for old, new in (("== Next", "== Then"), ("bin/activate", "bin/python"), ("import poesy", "import")):
            self.expect_fault("does not say", bare_root.next_step, SAID.replace(old, new))

    def test_ranking_in_python(self):
        rows = [[str(k + 1), NAMES[k], f"{0.6 - 0.02 * k:.3g}", "0.5"] for k in range(20)]

        def check(change=as_is):
            changed = [list(row) for row in rows]
            change(changed)
            bare_root.check_python_ranking("rank  name\n" + "".join(f"  {'  '.join(row)}\n" for row in changed))

        check()
        for words, change in {
                "19 lines": lambda rows: rows.pop(),
                "20 lines": set_cell(3, 0, "9"),
                "first error is epsilon_3_3_z": set_cell(0, 1, "epsilon_3_3_z"),
                "with 0.9 mm": set_cell(0, 2, "0.9"),
        }.items():
            self.expect_fault(words, check, change)

    def test_tests(self):
        bare_root.check_tests("...\n100% tests passed, 0 tests failed out of 1200\n")
        for line in ("99% tests passed, 1 tests failed out of 1200", "100% tests passed, 0 tests failed out of 0", ""):
            self.expect_fault("not all tests passed", bare_root.check_tests, line)

    def test_debians_own_sources(self):
        stanza = "Types: deb\n# a note\nURIs: http://deb.debian.org/debian\nSuites: bookworm bookworm-updates\n"
        other = "Types: deb\nURIs: https://deb.example.org/node\nSuites: nodistro\n"
        line = "deb [signed-by=/a b] http://deb.debian.org/debian bookworm main\n"
        files = {"a.sources": f"{stanza}\n{other}", "b.list": f"{line}deb https://example.org cloud-bookworm main\n"}
        self.assertEqual(bare_root.debian_sources(files, "bookworm"), (line, stanza))
        self.expect_fault("no source", bare_root.debian_sources, {"a.sources": other}, "bookworm")

    def test_sources_of_another_release(self):
        text = "deb http://deb.debian.org/debian bookworm main\nSuites: bookworm bookworm-updates bookworm-security mybookworm\n"
        other = "deb http://deb.debian.org/debian trixie main\nSuites: trixie trixie-updates trixie-security mybookworm\n"
        self.assertEqual(bare_root.of_suite(text, "bookworm", "trixie"), other)
        self.assertEqual(bare_root.of_suite(text, "bookworm", "bookworm"), text)


if __name__ == "__main__":
    unittest.main()
