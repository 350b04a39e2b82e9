#!/usr/bin/env python3
"""Uses poesy in Python as it is installed in a folder: the package, the compiled module and the program that they find.

usage: PYTHON use_python.py FOLDER       FOLDER is /usr, or the virtual environment of PYTHON

Package, module, metadata and program must be in the folder and have the same version. A small study is run and ranked.
The compiled solver must give the same bits as the program. Exits with 1 and a message if something is wrong.
"""

import importlib.metadata
import math
import os
import struct
import sys
from pathlib import Path

PLACES = {"package": "lib/python3/dist-packages", "module": "lib/python3/dist-packages",
          "metadata": "lib/python3/dist-packages", "program": "bin"}
STUDY = {"mechanism": {"model": "3-prs"}, "poses": {"count": 4},
         "errors": {"linear": {"distribution": "normal", "sigma": "0.05 mm"},
                    "angular": {"distribution": "normal", "sigma": "0.02 deg"}},
         "analysis": {"kind": "sensitivity", "samples": 200}}
POSES = [[-0.24, 0.0, 0.0], [-0.24, 0.2, -0.1]]  # z, beta, gamma of the 2upr-rpu (m, rad, rad)
ERRORS, SIZE = 71, 1e-4  # number of errors of the 2upr-rpu; their standard deviation (m, rad)


class Fault(Exception):
    """What is wrong, in a sentence."""


def check_places(places, folder):
    """That each part lies where it belongs below the folder."""
    for part, place in places.items():
        if Path(place).resolve().parent != (folder / PLACES[part]).resolve():
            raise Fault(f"the {part} is {place}, not in {folder / PLACES[part]}")


def check_versions(versions):
    if len(set(versions.values())) != 1:
        raise Fault("versions differ: " + ", ".join(f"{part} {version}" for part, version in versions.items()))


def check_ranking(rows):
    """That errors are ranked by effects greater than zero, the largest first."""
    effects = [row.effect for row in rows]
    if len(effects) < 10 or effects != sorted(effects, reverse=True) or effects[0] <= 0:
        raise Fault(f"the ranking has {len(effects)} errors with these effects: {effects[:5]}")


def check_bits(name, solver, program):
    """That both solved everything, to the same bits. Numbers of all poses and samples, in one order."""
    if not all(map(math.isfinite, program)) or not any(program):
        raise Fault(f"the program does not solve {name} at every pose")
    if struct.pack(f"{len(solver)}d", *solver) != struct.pack(f"{len(program)}d", *program):
        raise Fault(f"the module's {name} differs from the program's by {max(abs(a - b) for a, b in zip(solver, program))}")


def use(poesy, poesy_solver, numpy):
    check_ranking(poesy.run(STUDY).ranking())
    errors = numpy.random.default_rng(1).standard_normal((ERRORS, 5)) * SIZE
    evaluator = poesy.Evaluator("2upr-rpu")
    if poesy.Evaluator is not poesy_solver.Evaluator:
        raise Fault("poesy.Evaluator is not that of poesy_solver")
    solved = evaluator(POSES, errors)
    evaluated = poesy.evaluate("2upr-rpu", POSES, errors.T, solver={"metric": "platform"})
    for row, name in enumerate(evaluator.responses):
        check_bits(name, solved[:, row].ravel().tolist(), evaluated[name].ravel().tolist())


def look(folder):
    import numpy
    import poesy
    import poesy_solver
    from poesy import _program

    metadata = importlib.metadata.distribution("poesy")
    check_places({"package": Path(poesy.__file__).parent, "module": poesy_solver.__file__,
                  "metadata": metadata.locate_file("poesy"), "program": _program.find()}, folder)
    check_versions({"package": poesy.__version__, "module": poesy_solver.__version__, "metadata": metadata.version,
                    "program": poesy.program_version()["version"]})
    use(poesy, poesy_solver, numpy)
    print(f"poesy {poesy.__version__} in Python, below {folder}: a study is ranked, the module solves as the program does")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    os.environ.pop("POESY", None)
    try:
        look(Path(sys.argv[1]).absolute())
    except (Fault, ImportError, importlib.metadata.PackageNotFoundError) as fault:
        sys.exit(f"use_python: {fault}")


if __name__ == "__main__":
    main()
