#!/usr/bin/env python3
"""Checks that only a kind's own folder and its row in the registry know a kind of study.

The kinds are the folders that engine/kinds/registry.cpp includes. In the code of engine/, without comments, these are
violations:
- the name of a kind outside of engine/kinds, in code or as a quoted text of one word; sentences may name kinds;
- an include of one kind's folder in another's.
Words that also mean something else (WORDS_OF_OTHERS) count only as quoted texts of one word.
Prints each violation on a line, FILE:LINE: problem. Exits with 1 if there are any.
Usage: kind_names.py [ROOT]
"""

import re
import sys
from pathlib import Path

REGISTRY = "engine/kinds/registry.cpp"
# Names of kinds that also have another meaning, and the files outside of engine/kinds that may have them as quoted
# texts. evaluate: what a model does, and the command that solves rows of errors; sobol: a sequence of points in
# engine/random; allocation: a computation in engine/stats; sweep, calibration: kinds of results of `poesy sweep` and
# `poesy calibrate`, and a table of any study.
WORDS_OF_OTHERS = {
    "evaluate": ("engine/app/evaluate.cpp",),
    "sobol": ("engine/random/low_discrepancy.cpp",),
    "allocation": (),
    "sweep": ("engine/app/sweep.cpp",),
    "calibration": ("engine/study/calibration_keys.cpp", "engine/study/study_file.cpp"),
}
TEXT = re.compile(r'"(?:\\.|[^"\\])*"')
COMMENT = re.compile(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)


def kinds_of(root):
    """The names of the kinds' folders."""
    registry = (root / REGISTRY).read_text(encoding="utf-8")
    return sorted(set(re.findall(r'#include "engine/kinds/([^/"]+)/', registry)))


def without_comments(text):
    """The text with as many lines, without what stands in comments."""
    return COMMENT.sub(lambda found: found[0] if found[0].startswith('"') else "\n" * found[0].count("\n"), text)


def pattern_of(kind, path):
    """What a file must not hold of this kind; None when it may hold all."""
    if kind in WORDS_OF_OTHERS:
        return None if path in WORDS_OF_OTHERS[kind] else re.compile('"' + kind.replace("_", "-") + '"')
    return re.compile(kind.replace("_", "[-_ ]?"), re.IGNORECASE)


def without_sentences(line):
    """The line without texts of more than one word; paths of includes stay."""
    return TEXT.sub(lambda text: '""' if " " in text[0] else text[0], line)


def sources(root):
    return sorted(path for path in (root / "engine").rglob("*") if path.suffix in (".h", ".cpp"))


def naming_problems(path, lines, kinds):
    """Names of kinds in a file outside engine/kinds."""
    for kind in kinds:
        pattern = pattern_of(kind, path)
        for number, line in enumerate(lines, start=1):
            if pattern and pattern.search(without_sentences(line)):
                yield f"{path}:{number}: names the kind of study '{kind}'; ask engine/kinds/registry.h for what it needs"


def include_problems(path, lines, kinds):
    """Includes of one kind's folder in another's."""
    own = path.split("/")[2]
    for kind in kinds:
        if kind == own:
            continue
        for number, line in enumerate(lines, start=1):
            if f'#include "engine/kinds/{kind}/' in line:
                yield f"{path}:{number}: the kind '{own}' includes the kind '{kind}'; what both need belongs in a room below"


def problems(root):
    """All violations in the tree, one line each."""
    kinds = kinds_of(root)
    if not kinds:
        return [f"{REGISTRY}: includes no kind of study, so the engine cannot be searched for their names"]
    found = []
    for file in sources(root):
        path = file.relative_to(root).as_posix()
        if path == REGISTRY:
            continue
        lines = without_comments(file.read_text(encoding="utf-8")).splitlines()
        if not path.startswith("engine/kinds/"):
            found += naming_problems(path, lines, kinds)
        elif path.count("/") > 2:
            found += include_problems(path, lines, kinds)
        else:
            found += naming_problems(path, lines, kinds)
    return found


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]
    found = problems(root)
    print("\n".join(found) if found else "Kinds of studies are known in their folders alone.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
