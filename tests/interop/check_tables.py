"""Checks that all exported tables of a folder are plain CSV: one header, rows of equal length, numbers except for the
first column, units and words.

usage: check_tables.py FOLDER
"""

import csv
import math
import pathlib
import sys

UNITS = {"per m", "per rad", "m", "rad", "1"}
NO_NUMBERS = {"NaN", "inf", "-inf"}
WORDS = {"chosen", "errors"}  # columns with words, in tables of the parts of an allocation


def is_right(name, cell):
    if name == "unit":
        return cell in UNITS
    return bool(cell) if name in WORDS else cell in NO_NUMBERS or math.isfinite(float(cell))


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
                assert is_right(name, cell), (path, name, cell)


if __name__ == "__main__":
    main(*sys.argv[1:])
