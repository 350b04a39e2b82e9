#!/usr/bin/env python3
"""Checks the pages that people read: links lead to files and headings that exist, headers in THEORY.md are there.

Usage: page_links.py ROOT
"""

import re
import sys
from pathlib import Path

FENCED = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADER = re.compile(r"`((?:\w+/)+\w+\.h)`")
SKIPPED = {"build", ".git"}


def prose(page):
    return FENCED.sub("", page.read_text(encoding="utf-8"))


def anchors(page):
    """The names that GitHub gives to headings."""
    for heading in re.findall(r"^#+ (.*)$", prose(page), re.MULTILINE):
        yield re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def problems(root):
    for page in sorted(root.rglob("*.md")):
        if SKIPPED & set(page.relative_to(root).parts):
            continue
        name = page.relative_to(root)
        for link in LINK.findall(prose(page)):
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = link.partition("#")
            target = page.parent / path if path else page
            if not target.exists():
                yield f"{name}: there is no {link}"
            elif anchor and anchor not in anchors(target):
                yield f"{name}: no heading for {link}"
    for header in HEADER.findall((root / "engine/THEORY.md").read_text(encoding="utf-8")):
        if not any((root / folder / header).exists() for folder in (".", "engine")):
            yield f"engine/THEORY.md: there is no header {header}"


def main():
    found = list(problems(Path(sys.argv[1])))
    print("\n".join(found) if found else "Every link leads somewhere.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
