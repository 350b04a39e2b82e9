"""The manual page made by help2man: it formats without warnings and has every command and option of the program."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from poesy_program import ProgramTest, main

PAGE = Path(os.environ["POESY_MAN_PAGE"])
if not shutil.which("groff") or not PAGE.exists():
    print("skipped: the Debian package groff-base or help2man is missing")
    sys.exit(77)


def formatted(*options):
    return subprocess.run(["groff", "-ww", "-man", "-Tutf8", "-P-cbou", *options, PAGE], capture_output=True, text=True,
                          timeout=60, check=True)


class ManPage(ProgramTest):
    def test_formats_without_warnings(self):
        self.assertEqual(formatted("-z").stderr, "")
        if shutil.which("man"):
            done = subprocess.run(["man", "--warnings", "-l", "-Tutf8", PAGE], capture_output=True, timeout=60, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, b""))

    def test_tells_all(self):
        text = formatted().stdout
        parts = re.split(r"(?m)^   poesy ([a-z]+) .*:$", text)
        told = dict(zip(parts[1::2], parts[2::2]))
        commands = re.findall(r"^  ([a-z]+) {2,}", self.succeeds("--help"), re.MULTILINE)
        self.assertGreater(len(commands), 12)
        self.assertEqual(list(told), commands)
        for command in commands:
            for option in set(re.findall(r"^  (?:-\w, )?(--[a-z-]+)", self.succeeds(command, "--help"), re.MULTILINE)):
                self.assertIn(option, text if option == "--help" else told[command])

    def test_sections(self):
        for title in ("NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "COMMANDS", "EXIT STATUS", "FILES", "ENVIRONMENT", "EXAMPLES"):
            self.assertRegex(formatted().stdout, rf"(?m)^{title}$")


main()
