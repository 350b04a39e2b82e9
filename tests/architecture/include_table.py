#!/usr/bin/env python3
"""Checks every #include in the tree against the table "Who may include whom" of engine/README.md.

Also checks that each row of the table names only rows above it, and that the engine never names a mechanism.
Prints each violation on a line, FILE:LINE: problem. Exits with 1 if there are any.
Usage: include_table.py [ROOT]
"""

import re
import sys
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

TABLE = "engine/README.md"
HEADING = "## Who may include whom"
REGISTRY = "models/registry.cpp"
READER = "file"  # the folder of models/ that reads mechanisms from files and is not a mechanism itself
SCANNED = ("engine", "models", "bench", "tests")
EVERYTHING = "everything"
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:<(?P<angle>[^>]+)>|"(?P<quote>[^"]+)")')

# The library that a header in angle brackets belongs to, by patterns of its name. The first match counts.
LIBRARIES = {
    "decompositions": ("Eigen/Cholesky", "Eigen/LU", "Eigen/QR", "Eigen/SVD", "Eigen/Eigenvalues", "Eigen/Dense"),
    "Eigen": ("Eigen/*", "unsupported/Eigen/*"),
    "Boost.Math": ("boost/math/*",),
    "Boost.Random": ("boost/random.hpp", "boost/random/*"),
    "Random123": ("Random123/*",),
    "Highway": ("hwy/*",),
    "oneTBB": ("tbb/*", "oneapi/*"),
    "MPI": ("mpi.h",),
    "HDF5": ("hdf5.h", "hdf5_hl.h", "H5*.h"),
    "OpenSSL": ("openssl/*",),
    "toml++": ("toml++/*", "toml.hpp"),
    "CLI11": ("CLI/*",),
    "fmt": ("fmt/*",),
    "xsimd": ("xsimd/*",),
    "nlohmann-json": ("nlohmann/*",),
    "pybind11": ("pybind11/*",),
    "sanitizers": ("sanitizer/*",),
    "intrinsics": ("*intrin.h", "arm_neon.h"),
    "GoogleTest": ("gtest/*", "gmock/*"),
    "Google Benchmark": ("benchmark/*",),
    "threads": ("atomic", "barrier", "condition_variable", "future", "latch", "mutex", "semaphore", "shared_mutex",
                "stop_token", "thread", "pthread.h"),
    "files": ("filesystem", "fstream", "fcntl.h", "poll.h", "unistd.h", "dirent.h", "stdlib.h", "malloc.h", "sys/*"),
    "terminal": ("iostream", "termios.h"),
    "std-random": ("random",),
}
STANDARD = frozenset("""
    algorithm any array bit bitset cassert cctype cerrno cfenv cfloat charconv chrono cinttypes climits clocale cmath
    compare complex concepts coroutine csetjmp csignal cstdarg cstddef cstdint cstdio cstdlib cstring ctime cuchar
    cwchar cwctype deque exception execution format forward_list functional initializer_list iomanip ios iosfwd istream
    iterator limits list locale map memory memory_resource new numbers numeric optional ostream queue ranges ratio regex
    scoped_allocator set source_location span sstream stack stdexcept streambuf string string_view strstream
    syncstream system_error tuple type_traits typeindex typeinfo unordered_map unordered_set utility valarray variant
    vector version""".split())


@dataclass(frozen=True)
class Library:
    name: str
    files: tuple  # patterns of the including file's path in its folder; empty: all files


@dataclass(frozen=True)
class Room:
    name: str
    includes: tuple
    libraries: tuple


class TableError(Exception):
    """The table itself cannot be read or breaks a rule."""


def parse_libraries(cell):
    """ "fmt, HDF5 in `h5.*` and `h6.*`" -> libraries with the files that may include them."""
    libraries = []
    for item in filter(None, (part.strip() for part in cell.split(","))):
        if item == "-":
            continue
        name, _, files = item.partition(" in ")
        if name != EVERYTHING and name not in LIBRARIES:
            raise TableError(f"unknown library '{name}'; known: {', '.join(LIBRARIES)}")
        libraries.append(Library(name, tuple(re.findall(r"`([^`]+)`", files))))
    return tuple(libraries)


def parse_row(line):
    cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
    if len(cells) != 3:
        raise TableError(f"a row needs three cells: {line.strip()}")
    includes = (EVERYTHING,) if cells[1] == EVERYTHING else tuple(re.findall(r"`([^`]+)`", cells[1]))
    return Room(cells[0].strip("`"), includes, parse_libraries(cells[2]))


def read_table(root):
    """The rooms of the table, in its order."""
    text = (root / TABLE).read_text(encoding="utf-8")
    _, found, section = text.partition(HEADING + "\n")
    if not found:
        raise TableError(f"no section '{HEADING}'")
    section = section.split("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("|")][2:]
    if not rows:
        raise TableError(f"no table in section '{HEADING}'")
    rooms = [parse_row(row) for row in rows]
    check_points_down(root, rooms)
    return rooms


def check_points_down(root, rooms):
    above = set()
    for room in rooms:
        if not (root / room.name).is_dir():
            raise TableError(f"room {room.name} has no folder; remove its row")
        for entry in room.includes:
            target = str(Path(entry).parent) if entry.endswith(".h") else entry
            if entry != EVERYTHING and target not in above:
                raise TableError(f"{room.name} may include {entry}, which does not stand above it")
        above.add(room.name)


def room_of(path, rooms):
    """The room with the longest name that holds this path; None when there is none."""
    holding = [room for room in rooms if path.startswith(room.name + "/")]
    return max(holding, key=lambda room: len(room.name), default=None)


def library_of(header):
    for name, patterns in LIBRARIES.items():
        if any(fnmatch(header, pattern) for pattern in patterns):
            return name
    return None


def quoted_problem(room, header, rooms):
    """Why this room may not include this header of the project; None when it may."""
    target = room_of(header, rooms)
    if target is None:
        if EVERYTHING in room.includes:
            return None
        return f'"{header}" is in no room; write the path from the top of the tree'
    if target == room or EVERYTHING in room.includes or target.name in room.includes or header in room.includes:
        return None
    return f'{room.name} may not include {target.name} ("{header}"); see {TABLE}'


def angle_problem(room, path, header):
    """Why this file may not include <header>; None when it may."""
    if header in STANDARD:
        return None
    name = library_of(header)
    if name is None:
        return f"<{header}> belongs to no known library; name it in {TABLE} and tests/architecture/include_table.py"
    inside = path[len(room.name) + 1:]
    for library in room.libraries:
        if library.name in (name, EVERYTHING):
            if not library.files or any(fnmatch(inside, pattern) for pattern in library.files):
                return None
            return f"{name} (<{header}>) belongs in {' and '.join(library.files)} of {room.name} alone; see {TABLE}"
    return f"{room.name} may not include {name} (<{header}>); see {TABLE}"


def sources(root, folder):
    return sorted(path for path in (root / folder).rglob("*") if path.suffix in (".h", ".cpp"))


def include_problems(root, rooms):
    for file in (file for folder in SCANNED for file in sources(root, folder)):
        path = file.relative_to(root).as_posix()
        room = room_of(path, rooms)
        if room is None:
            yield f"{path}:1: is in no room; add a row to {TABLE}"
            continue
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1):
            match = INCLUDE.match(line)
            if not match:
                continue
            quote, angle = match["quote"], match["angle"]
            problem = quoted_problem(room, quote, rooms) if quote else angle_problem(room, path, angle)
            if problem:
                yield f"{path}:{number}: {problem}"


def mechanism_pattern(root):
    """Matches the names of the registered mechanisms as words of code or of prose: two_upr_rpu, 2UPR-RPU."""
    digits = {"two": "2", "three": "3", "four": "4", "five": "5", "six": "6"}
    registry = (root / REGISTRY).read_text(encoding="utf-8")
    folders = sorted(set(re.findall(r'#include "models/([^/"]+)/', registry)) - {READER})
    if not folders:
        raise TableError(f"{REGISTRY} includes no mechanism, so the engine cannot be searched for their names")
    names = (("[-_ ]?").join(f"(?:{word}|{digits.get(word, word)})" for word in name.split("_")) for name in folders)
    return re.compile("|".join(names), re.IGNORECASE)


def naming_problems(root, rooms):
    """Names of mechanisms in the engine. The program may include models, so its help may show one as an example."""
    pattern = mechanism_pattern(root)
    for file in sources(root, "engine"):
        room = room_of(file.relative_to(root).as_posix(), rooms)
        if room is not None and EVERYTHING in room.includes:
            continue
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1):
            match = pattern.search(line)
            if match:
                path = file.relative_to(root).as_posix()
                yield f"{path}:{number}: the engine names the mechanism '{match[0]}'; it belongs in models/"


def problems(root):
    """All violations in the tree, one line each."""
    try:
        rooms = read_table(root)
        return [*include_problems(root, rooms), *naming_problems(root, rooms)]
    except TableError as error:
        return [f"{TABLE}: {error}"]


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]
    found = problems(root)
    print("\n".join(found) if found else "The includes follow the table.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
