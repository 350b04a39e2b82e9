"""Shared by tests of results/: runs the command of a folder into a temporary folder, and reads what it wrote."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

RESULTS = pathlib.Path(__file__).resolve().parents[2] / "results"
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e-?\d+)?")


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def figures_of(folder):
    return {path.name: path.read_text(encoding="utf-8") for path in (folder / "figures").iterdir()}


def regenerated(name, program):
    """COMPARISON.md and the figures that results/NAME/regenerate writes with this program."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-B", RESULTS / name / "regenerate", folder], check=True,
                       env={**os.environ, "POESY": program})
        written = pathlib.Path(folder)
        return (written / "COMPARISON.md").read_text(encoding="utf-8"), figures_of(written)


def rows_under(text, heading):
    """Cells of the table under a heading, without its first line."""
    section = text.split(heading)[1].split("\n## ")[0]
    return [cells(line) for line in section.splitlines() if line.startswith("|")][2:]
