"""Checks that every exported table of a folder is plain CSV: one header, equal rows, numbers but for the first column.

usage: check_tables.py FOLDER
"""

import csv
import pathlib
import sys


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
            for cell in row[1:]:
                float(cell)


if __name__ == "__main__":
    main(*sys.argv[1:])
