#!/usr/bin/env python3
"""Checks the pages that people read: links lead to files and headings that exist, the headers that the pages of
engine/docs name exist, and each decision has a short page that the index lists.

Usage: page_links.py ROOT
"""

import re
import sys
from pathlib import Path

FENCED = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADER = re.compile(r"`((?:\w+/)+\w+\.h)`")
SKIPPED = {"build", ".git"}
DECISIONS = "engine/docs/decisions"
TITLE = re.compile(r"# D(\d+)\. .+\n\nStatus: (accepted|superseded by \[D\d+\]\(.+\))\. Date: \d{4}-\d\d-\d\d\. Concerns: [\w/ ]+\.\n")
MOST_LINES = 40


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
    for page in sorted((root / "engine/docs").rglob("*.md")):
        for header in HEADER.findall(page.read_text(encoding="utf-8")):
            if not any((root / folder / header).exists() for folder in (".", "engine")):
                yield f"{page.relative_to(root)}: there is no header {header}"


def decision_problems(root):
    """Pages of decisions that break the rules which their index states."""
    folder = root / DECISIONS
    index = (folder / "README.md").read_text(encoding="utf-8")
    for page in sorted(folder.glob("[0-9]*.md")):
        text = page.read_text(encoding="utf-8")
        title = TITLE.match(text)
        if not title or int(title[1]) != int(page.name[:4]):
            yield f"{DECISIONS}/{page.name}: begin with '# D{int(page.name[:4])}. TITLE' and 'Status: ... Date: ... Concerns: ...'"
        elif f"- [D{title[1]}]({page.name})" not in index:
            yield f"{DECISIONS}/README.md: does not list {page.name}"
        if text.count("\n") > MOST_LINES:
            yield f"{DECISIONS}/{page.name}: has more than {MOST_LINES} lines; move measurements to bench/README.md"


def main():
    root = Path(sys.argv[1])
    found = [*problems(root), *decision_problems(root)]
    print("\n".join(found) if found else "Every link leads somewhere.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
