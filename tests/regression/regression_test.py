"""Each folder here holds a study and the indices that it gave. An index may only change on purpose.

Usage: regression_test.py POESY [--update]. With --update the expected tables are rewritten: look at the differences
before you commit them. The tables show that nothing changed, not that it is correct; other tests do that.
"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

RELATIVE = 1e-9
# Smaller indices are rounding errors, so their digits may change.
ABSOLUTE = 1e-12


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.reader(file))


def run(program, case):
    with tempfile.TemporaryDirectory() as folder:
        result = Path(folder) / "out.h5"
        subprocess.run([program, "run", case / "study.toml", "-o", result, "--quiet"], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([program, "export", result, "-d", folder], check=True, stdout=subprocess.DEVNULL)
        return (Path(folder) / "global.csv").read_text(encoding="utf-8")


def same(expected, found):
    try:
        return abs(float(expected) - float(found)) <= max(RELATIVE * abs(float(expected)), ABSOLUTE)
    except ValueError:
        return expected == found


def main():
    program, update = sys.argv[1], "--update" in sys.argv
    failed = 0
    for case in sorted(path.parent for path in Path(__file__).parent.glob("*/study.toml")):
        text, expected = run(program, case), case / "expected.csv"
        if update:
            expected.write_text(text, encoding="utf-8")
            continue
        found = list(csv.reader(text.splitlines()))
        wanted = read(expected)
        differences = [(row[0], column, a, b) for row, other in zip(wanted, found) for column, a, b in zip(wanted[0], row, other) if not same(a, b)]
        if len(wanted) != len(found) or differences:
            failed += 1
            print(f"{case.name}: {len(differences)} numbers moved (factor, column, expected, found)")
            for difference in differences[:20]:
                print("  ", *difference)
    sys.exit(failed)


if __name__ == "__main__":
    main()
