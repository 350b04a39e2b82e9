#!/usr/bin/env python3
"""Checks that no two files of engine/ and models/ define a type with the same full name outside an unnamed namespace.

To the linker both definitions are the same type, so it uses the functions of either for both. The program then may
destroy an object as if it were of the other type. A compiler cannot see this, because it sees one file at a time.

    type_names.py ROOT
"""

import collections
import re
import sys
from pathlib import Path

SPACE = re.compile(r"(?:inline )?namespace ?([\w:]*) ?\{")
SPACE_ENDS = re.compile(r"\}  // namespace")
TYPE = re.compile(r"(?:struct|class|union|enum class|enum) (?:\[\[\w+\]\] |alignas\(\w+\) )?(\w+)\b(?!::)[^;()]*\{")


def types(text):
    """Full names of the types that stand outside of functions, other types and namespaces without a name."""
    spaces = []
    for line in text.splitlines():
        if found := SPACE.match(line):
            spaces.append(found[1])
        elif SPACE_ENDS.match(line) and spaces:
            spaces.pop()
        elif (found := TYPE.match(line)) and "" not in spaces:
            yield "::".join([*spaces, found[1]])


def problems(root):
    files = collections.defaultdict(list)
    for room in ("engine", "models"):
        for path in sorted((root / room).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                for name in types(path.read_text(encoding="utf-8")):
                    files[name].append(str(path.relative_to(root)))
    for name, defined in files.items():
        if len(defined) > 1:
            yield f"{name} is defined in {' and in '.join(defined)}: rename one, or give it a namespace without a name"


if __name__ == "__main__":
    found_problems = list(problems(Path(sys.argv[1])))
    print("\n".join(found_problems) or "every type has one definition")
    sys.exit(bool(found_problems))
