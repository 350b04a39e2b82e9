#!/usr/bin/env python3
"""Checks that no code computes positions in results by hand: Array and ArrayView (engine/base/array.h) know the axes.

Looks for an index that is a product and a sum, such as `values[r * poses + m]`, in the folders of the engine that
hold, store and show results. Numerical folders (stats, random, optimise, linalg, models) work on plain blocks, and so
do the files in NUMERICAL, which solve or invert as parts of a kind.

    index_arithmetic.py ROOT
"""

import re
import sys
from pathlib import Path

ROOMS = ("run", "result", "storage", "report", "kinds")
INDEX = re.compile(r"\w\[[^][]*(?:\*[^][]*\+|\+[^][]*\*)[^][]*\]")
COMMENT = re.compile(r"//.*")
NUMERICAL = {
    "engine/kinds/allocation/load_solver.h",
    "engine/kinds/allocation/machine_loads.cpp",
    "engine/kinds/allocation/mean_squares.cpp",
    "engine/kinds/allocation/variations.cpp",
    "engine/kinds/monte_carlo/part_groups.cpp",
}


def problems(root):
    for room in ROOMS:
        for path in sorted((root / "engine" / room).rglob("*")):
            name = str(path.relative_to(root))
            if path.suffix not in (".h", ".cpp") or name in NUMERICAL:
                continue
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
                if found := INDEX.search(COMMENT.sub("", line)):
                    yield f"{name}:{number}: {found[0][1:]} computes a position; use an Array or an ArrayView"


def main():
    found = list(problems(Path(sys.argv[1])))
    for problem in found:
        print(problem)
    if not found:
        print("no position is computed by hand")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
