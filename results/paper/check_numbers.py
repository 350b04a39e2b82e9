#!/usr/bin/env python3
"""Runs the studies of the paper again and compares every number in its text, or writes them there.

A number is marked by its name in a comment behind it, 0.16<!--tau_0.01-->. A number with a decimal point or a per cent sign
without a mark is an error, too, and so is an author of CITATION.cff who is not one of the paper.

usage: check_numbers.py [--update] [POESY]; POESY is the program, by default that of the release build
"""

import re
import sys
import tempfile
from pathlib import Path

import studies

PAPER = studies.HERE / "paper.md"
MARKED = re.compile(r"(-?[\d.]+(?:e-?\d+)?)<!--([\w.]+)-->")
UNMARKED = re.compile(r"\d+\.\d+|\d+ ?%")


def body(text):
    """What people read: without front matter, code, links and the references' keys."""
    text = re.sub(r"\A---\n.*?\n---\n", "", text, flags=re.DOTALL)
    return re.sub(r"```.*?```|`[^`]*`|\]\([^)]*\)|@[\w:]+", "", text, flags=re.DOTALL)


def problems(text, numbers):
    for found, name in MARKED.findall(text):
        if name not in numbers:
            yield f"there is no number {name}"
        elif found != numbers[name]:
            yield f"{name} is {numbers[name]}, the paper has {found}"
    for unmarked in UNMARKED.findall(MARKED.sub("", body(text))):
        yield f"{unmarked} has no mark"
    if not MARKED.search(text):
        yield "no number is marked"
    citation = (studies.HERE / "../../CITATION.cff").read_text(encoding="utf-8").split("references:")[0]
    for name in re.findall(r'- name: "(.*)"', citation):
        if f"- name: {name}\n" not in text:
            yield f"{name} of CITATION.cff is no author"


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--update"]
    poesy = Path(arguments[0] if arguments else studies.HERE / "../../build/release/bin/poesy").resolve()
    with tempfile.TemporaryDirectory() as folder:
        numbers = studies.collect(studies.Studies(poesy, folder)).numbers
    text = PAPER.read_text(encoding="utf-8")
    if "--update" in sys.argv:
        text = MARKED.sub(lambda match: f"{numbers.get(match[2], match[1])}<!--{match[2]}-->", text)
        PAPER.write_text(text, encoding="utf-8")
    found = list(problems(text, numbers))
    print("\n".join(found) if found else f"{len(MARKED.findall(text))} numbers of the paper are those of the results")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
