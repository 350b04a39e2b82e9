#!/usr/bin/env python3
"""Checks that the commands in the code blocks of README.md exist: poesy's subcommands and options, presets, scripts.

Usage: readme_commands.py POESY [README]
"""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CODE = re.compile(
    r"^```[^\n]*\n(?P<fenced>.*?)^```|^(?: {4}|\t)(?P<indented>[^\n]*)$|`(?P<inline>[^`\n]+)`", re.DOTALL | re.MULTILINE)
POESY = re.compile(r"(?:^|[\s/;|])poesy ([a-z][a-z-]*)(.*)")
OPTION = re.compile(r"(?<=\s)--?[a-z][a-z-]*")
PRESET = re.compile(r"--preset[ =](\S+)")
SCRIPT = re.compile(r"(?:^|\s)(\./[\w./-]+|\.ci/\w+)")


def code_lines(text):
    for match in CODE.finditer(text.replace("\\\n", " ")):
        code = match["fenced"] or match["indented"] or match["inline"] or ""
        yield from (line.strip() for line in code.splitlines())


def help_of(program, command):
    """What `poesy COMMAND --help` prints; None when there is no such command (that prints the program's own help)."""
    done = subprocess.run([program, command, "--help"], capture_output=True, text=True, timeout=60, check=False)
    is_of_command = re.search(rf"^Usage: \S+ {command}\b", done.stdout, re.MULTILINE)
    return done.stdout if done.returncode == 0 and is_of_command else None


def poesy_problems(program, line):
    match = POESY.search(line)
    if not match:
        return
    command, rest = match.groups()
    text = help_of(program, command)
    if text is None:
        yield f"there is no command 'poesy {command}'"
        return
    known = re.findall(r"--?[a-z][a-z-]*", text)
    for option in OPTION.findall(rest):
        if option not in known:
            yield f"'poesy {command}' has no option {option}"


def other_problems(line, presets):
    for preset in PRESET.findall(line):
        if preset.strip("`") not in presets:
            yield f"there is no preset '{preset}'"
    for script in SCRIPT.findall(line):
        if not script.startswith("./build") and not (ROOT / script).exists():
            yield f"there is no file {script}"


def problems(program, text):
    configure = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
    presets = {preset["name"] for preset in configure if not preset.get("hidden")}
    lines = list(dict.fromkeys(code_lines(text)))
    if not any(POESY.search(line) for line in lines):
        yield "no poesy command in its code"
    for line in lines:
        for problem in (*poesy_problems(program, line), *other_problems(line, presets)):
            yield f"{problem}: {line}"


def main():
    readme = Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT / "README.md"
    found = [f"{readme.name}: {problem}" for problem in problems(sys.argv[1], readme.read_text(encoding="utf-8"))]
    print("\n".join(found) if found else "Every command in the README exists.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
