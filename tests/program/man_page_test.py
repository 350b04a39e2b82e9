"""The manual page: formats without warnings, and tells of every command and option that the program has."""

import re
import shutil
import subprocess
import sys

from poesy_program import ProgramTest, main

if not shutil.which("groff"):
    print("skipped: the Debian package groff-base is missing")
    sys.exit(77)


def formatted(page, *options):
    return subprocess.run(["groff", "-ww", "-man", "-Tutf8", "-P-cbou", *options], input=page, capture_output=True, text=True,
                          timeout=60, check=True)


class ManPage(ProgramTest):
    def test_formats_without_warnings(self):
        page = self.succeeds("man")
        self.assertEqual(formatted(page, "-z").stderr, "")
        if shutil.which("man"):
            self.write("poesy.1", page)
            done = subprocess.run(["man", "--warnings", "-l", "-Tutf8", "poesy.1"], cwd=self.folder, capture_output=True,
                                  timeout=60, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, b""))

    def test_tells_all(self):
        text = " ".join(formatted(self.succeeds("man")).stdout.split())
        commands = re.findall(r"^  ([a-z]+) {2,}", self.succeeds("--help"), re.MULTILINE)
        self.assertGreater(len(commands), 12)
        for command in commands:
            section = text.partition(f" poesy {command} poesy {command} ")[2]
            self.assertTrue(section, command)
            explained = self.succeeds(command, "--help")
            for option in set(re.findall(r"^  (?:-\w, )?(--[a-z-]+)", explained, re.MULTILINE)):
                self.assertIn(option, text if option == "--help" else section)

    def test_sections(self):
        text = formatted(self.succeeds("man")).stdout
        for title in ("NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "COMMANDS", "EXIT STATUS", "FILES", "ENVIRONMENT", "EXAMPLES"):
            self.assertRegex(text, rf"(?m)^{title}$")


main()
