#!/usr/bin/env python3
"""Installs the Python package by pip without network into a virtual environment, and executes its notebook there.

usage: python_install.py --program PATH [--python PATH]

The environment sees the packages of the system (h5py, xarray, matplotlib, setuptools, wheel; nbclient and ipykernel for
the notebook), so nothing is downloaded. A copy of engine/python is installed, because pip leaves build files next to
the sources. Exits with 0 on success, 1 on failure, and 77 if a package that executes the notebook is missing.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOK = ROOT / "tests" / "python" / "notebook.py"
NOT_RUN = 77
LOOK = """\
import poesy, sys
assert poesy.__file__.startswith(sys.prefix), poesy.__file__
print("poesy", poesy.__version__, "from", poesy.__file__, "with the program", poesy.program_version()["version"])
"""


def run(command, **options):
    print("+", *command, flush=True)
    return subprocess.run([str(word) for word in command], check=False, **options).returncode


def install(python, folder):
    """Makes the environment V in the folder and installs a copy of the package; gives V's Python, or None."""
    left_out = shutil.ignore_patterns("build", "*.egg-info", "__pycache__")
    shutil.copytree(ROOT / "engine" / "python", folder / "python", ignore=left_out)
    python_there = folder / "V" / "bin" / "python"
    pip = [python_there, "-m", "pip", "--disable-pip-version-check", "install", "--no-index"]
    commands = (
        [python, "-m", "venv", "--system-site-packages", folder / "V"],
        [*pip, "--no-build-isolation", "--no-deps", folder / "python"],
    )
    return python_there if all(run(command, cwd=folder) == 0 for command in commands) else None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, type=Path, help="the program poesy")
    parser.add_argument("--python", default="/usr/bin/python3", help="the Python that has the packages")
    asked = parser.parse_args()
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    environment["POESY"] = str(asked.program.resolve())
    with tempfile.TemporaryDirectory() as named:
        folder = Path(named)
        python = install(asked.python, folder)
        if python is None or run([python, "-c", LOOK], cwd=folder, env=environment) != 0:
            return 1
        code = run([python, "-B", NOTEBOOK, folder / "python" / "tutorial.ipynb"], cwd=folder, env=environment)
    words = {0: "installed, and the notebook runs", NOT_RUN: "installed; the notebook was not run"}
    print(words.get(code, "the notebook fails"))
    return code


if __name__ == "__main__":
    sys.exit(main())
