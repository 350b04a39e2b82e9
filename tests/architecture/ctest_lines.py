#!/usr/bin/env python3
"""Checks that no line of the output of ctest is longer than 120 characters. ctest pads all lines to the longest name.

Usage: ctest_lines.py BUILD    (a folder in which all tests are built)
"""

import re
import subprocess
import sys

MOST = 120
TEST = re.compile(r"^ *Test +#\d+: (.*)$")


def progress_line(count, name, width):
    """What ctest prints of the last test when it has passed."""
    dots = (name + " ").ljust(width + 4, ".")
    return f"{count}/{count} Test #{count}: {dots}   Passed  {3600.0:6.2f} sec"


def problems(listing):
    """listing: what `ctest -N` prints."""
    names = [match[1] for match in map(TEST.match, listing.splitlines()) if match]
    if not names:
        yield "ctest lists no test"
        return
    for line in listing.splitlines():
        if len(line) > MOST:
            yield f"{len(line)} characters: {line}"
    for name in names:
        length = len(progress_line(len(names), name, len(name)))
        if length > MOST:
            yield f"its name makes lines of {length} characters: {name}"
        if not name.isprintable() or not name.isascii():
            yield f"not plain text: {name!r}"


def main():
    listing = subprocess.run(["ctest", "-N"], cwd=sys.argv[1], capture_output=True, text=True, check=True).stdout
    found = list(problems(listing))
    print("\n".join(found) if found else "Every line fits.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
