"""`python3 -m poesy figure RESULT.h5 -o FIGURE.pdf`: what the program leaves to matplotlib."""

from __future__ import annotations

import argparse
import sys

import poesy


def main(arguments: list[str] | None = None) -> int:
    """Runs a command. Returns an exit code like the program: 2 for a wrong command line, 3 for a file error."""
    parser = argparse.ArgumentParser(prog="python3 -m poesy", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    figure = commands.add_parser("figure", help="draw the figure of a result that a paper prints")
    figure.add_argument("result", metavar="RESULT.h5", help="result file of any kind")
    figure.add_argument("-o", "--output", required=True, metavar="FIGURE", help="FIGURE.pdf, .svg or .png")
    figure.add_argument("--response", metavar="NAME", help="response; default: the one of poesy show")
    figure.add_argument("--size", default="85mm", metavar="WIDTH", help="85mm (a column, default) or 170mm (a page)")
    figure.add_argument("--top", type=int, metavar="N", help="at most N bars of a ranking")
    asked = parser.parse_args(arguments)
    try:
        poesy.figure(poesy.read(asked.result), asked.output, response=asked.response, size=asked.size,
                     **({} if asked.top is None else {"top": asked.top}))
    except (poesy.FileError, OSError) as error:
        print(f"poesy: {error}", file=sys.stderr)
        return 3
    except poesy.Error as error:
        print(f"poesy: {error}", file=sys.stderr)
        return 2
    print(asked.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
