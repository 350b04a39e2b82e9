"""Checks that every exported table of a folder is plain CSV: one header, equal rows, numbers but for the first column and for units.

usage: check_tables.py FOLDER
"""

import csv
import math
import pathlib
import sys

UNITS = {"per m", "per rad", "m", "rad", "1"}
NO_NUMBERS = {"NaN", "inf", "-inf"}


def main(folder):
    tables = sorted(pathlib.Path(folder).glob("*.csv"))
    assert len(tables) >= 4, folder
    for path in tables:
        assert '"' not in path.read_text(), path
        with path.open(newline="") as file:
            header, *rows = csv.reader(file)
        assert len(set(header)) == len(header) > 1 and all(header), path
        assert rows, path
        for row in rows:
            assert len(row) == len(header), path
            for name, cell in zip(header[1:], row[1:]):
                assert cell in UNITS if name == "unit" else math.isfinite(float(cell)) or cell in NO_NUMBERS, (path, name, cell)


if __name__ == "__main__":
    main(*sys.argv[1:])
