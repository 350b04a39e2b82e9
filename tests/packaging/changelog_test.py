#!/usr/bin/env python3
"""The Debian changelog that engine/packaging/debian/changelog.awk makes of a changelog in Markdown."""

import subprocess
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "engine/packaging/debian/changelog.awk"
ENTRIES = """# Changelog

Text before.

## [0.3.0] - unreleased

### Added

- One line
  that goes on.
- {long}

## [0.2.0] - 2026-11-21

### Fixed

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

  [ Fixed ]
  * A fault.

 -- A B <a@b.org>  Sat, 21 Nov 2026 00:00:00 +0000
"""


def made_of(text):
    values = {"version": "0.3.0~dev", "release": "1", "maintainer": "A B <a@b.org>", "now": "2026-11-23 12:00:00"}
    options = [word for name, value in values.items() for word in ("-v", f"{name}={value}")]
    return subprocess.run(["awk", *options, "-f", SCRIPT], input=text, text=True, check=True, capture_output=True).stdout


class ChangelogTest(unittest.TestCase):
    def test_entries(self):
        self.assertEqual(made_of(ENTRIES.format(long=" ".join(["word"] * 20))), MADE)

    def test_our_own(self):
        lines = made_of((ROOT / "CHANGELOG.md").read_text(encoding="utf-8")).splitlines()
        self.assertEqual([line for line in lines if len(line) > 80 and " " in line.strip(" *")], [])
        self.assertGreater(len(lines), 50)


if __name__ == "__main__":
    unittest.main()
