#!/usr/bin/env python3
"""Tests what packages take from CHANGELOG.md: Debian's changelog (engine/packaging/debian/changelog.awk) and the
version of the packages (engine/packaging/generator.cmake). All files state the same version."""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "engine/packaging/debian/changelog.awk"
GENERATOR = ROOT / "engine/packaging/generator.cmake"
ENTRIES = """# Changelog

Text before.

## [0.3.0] - unreleased

### Added

- One line
  that goes on.
- {long}

## [0.2.0] - 2026-11-21

### Python and MATLAB

- A fault.

## [0.1.0] - unreleased

- Never released.
"""
MADE = """poesy (0.3.0~dev-1) unstable; urgency=medium

  [ Added ]
  * One line that goes on.
  * word word word word word word word word word word word word word word word
    word word word word word

 -- A B <a@b.org>  Mon, 23 Nov 2026 12:00:00 +0000

poesy (0.2.0-1) unstable; urgency=medium

  [ Python and MATLAB ]
  * A fault.

 -- A B <a@b.org>  Sat, 21 Nov 2026 00:00:00 +0000
"""


# For each file with the version, a pattern whose only group is the version.
SAID = {
    "CMakeLists.txt": r"^project\(poesy VERSION (\S+) ",
    "CITATION.cff": r"^version: (\S+)$",
    "engine/python/poesy/__init__.py": r'^__version__ = "(.+)"$',
    "engine/packaging/conda/recipe.yaml": r'^  version: "(.+)"$',
    "engine/packaging/homebrew/poesy.rb": r"^  url .*/poesy-(.+)\.tar\.gz\"$",
}


def our_own(path="CHANGELOG.md"):
    return (ROOT / path).read_text(encoding="utf-8")


def said(path, pattern):
    return re.search(pattern, our_own(path), re.MULTILINE)[1]


def made_of(text, version="0.3.0~dev"):
    values = {"version": version, "release": "1", "maintainer": "A B <a@b.org>", "now": "2026-11-23 12:00:00"}
    options = [word for name, value in values.items() for word in ("-v", f"{name}={value}")]
    return subprocess.run(["awk", *options, "-f", SCRIPT], input=text, text=True, check=True, capture_output=True).stdout


class ChangelogTest(unittest.TestCase):
    def test_entries(self):
        self.assertEqual(made_of(ENTRIES.format(long=" ".join(["word"] * 20))), MADE)

    def test_our_own(self):
        lines = made_of(our_own()).splitlines()
        self.assertEqual([line for line in lines if len(line) > 80 and " " in line.strip(" *")], [])
        self.assertGreater(len(lines), 50)

    def test_an_entry_with_a_date(self):
        dated = ENTRIES[ENTRIES.index("## [0.2.0]"):]
        self.assertEqual(made_of(dated, "0.2.0"), MADE[MADE.index("poesy (0.2.0-1)"):])


class VersionTest(unittest.TestCase):
    def generated(self, changelog, program="0.2.0"):
        """What cpack makes of a changelog: the version of the packages, or the error."""
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "CHANGELOG.md").write_text(changelog, encoding="utf-8")
            (Path(folder) / "version.cmake").write_text(
                f'include({GENERATOR})\nmessage(STATUS "${{CPACK_PACKAGE_FILE_NAME}}")\n', encoding="utf-8")
            given = {"SOURCE": folder, "VERSION": program, "PROCESSOR": "x86_64"}
            done = subprocess.run(
                ["cmake", *(f"-DCPACK_POESY_{name}={value}" for name, value in given.items()), "-DCPACK_GENERATOR=TGZ",
                 "-DCPACK_SYSTEM_NAME=Linux", "-DCPACK_INSTALL_CMAKE_PROJECTS=build;poesy;ALL;/", "-P", "version.cmake"],
                cwd=folder, text=True, capture_output=True, check=False)
            return done.stdout.removeprefix("-- ").strip() or " ".join(done.stderr.split())

    def test_of_packages(self):
        self.assertEqual(self.generated("# Changelog\n\n## [0.2.0] - 2026-11-26\n"), "poesy-0.2.0-Linux-x86_64")
        self.assertEqual(self.generated("## [0.3.0] - unreleased\n\n## [0.2.0] - 2026-11-26\n"),
                         "poesy-0.3.0~dev-Linux-x86_64")
        self.assertIn("CHANGELOG.md releases 0.2.1, and the program says 0.2.0", self.generated("## [0.2.1] - 2026-12-24\n"))
        self.assertIn("has no line", self.generated("# Changelog\n"))

    def test_is_the_newest_with_a_date(self):
        version, date = re.search(r"^## \[(.+)\] - (\d{4}-\d\d-\d\d)$", our_own(), re.MULTILINE).groups()
        self.assertEqual({path: said(path, pattern) for path, pattern in SAID.items()}, dict.fromkeys(SAID, version))
        self.assertEqual(said("CITATION.cff", r'^date-released: "(.+)"$'), date)


if __name__ == "__main__":
    unittest.main()
