"""Runs poesy, which says which errors of a parallel robot matter, how much and where, and reads its results.

>>> import poesy
>>> result = poesy.run("study.toml")                     # doctest: +SKIP
>>> print(result.ranking())                              # doctest: +SKIP
>>> result.plot.ranking()                                # doctest: +SKIP

The program itself has to be there: in the virtual environment, on PATH, or where the environment variable POESY or
``poesy.program`` says.
"""

from __future__ import annotations

import os
from typing import Any

from ._errors import (
    DamagedFile,
    Error,
    FileError,
    InternalError,
    Interrupted,
    NotInResult,
    PoesyWarning,
    ProgramNotFound,
    StudyError,
)
from ._evaluate import Evaluation, evaluate
from ._mechanism import Coordinate, Frame, Mechanism, Named, mechanism
from ._plot import Plots
from ._program import Progress
from ._program import version as program_version
from ._ranking import Ranking
from ._result import Result, read
from ._run import run

__version__ = "0.2.0"

program: str | os.PathLike[str] | None = None
"""The program to run. ``None``: the environment variable POESY says it, else the one of this virtual environment is taken,
else the first `poesy` on PATH."""

__all__ = [
    "Coordinate",
    "DamagedFile",
    "Error",
    "Evaluation",
    "FileError",
    "Frame",
    "InternalError",
    "Interrupted",
    "Mechanism",
    "Named",
    "NotInResult",
    "Plots",
    "PoesyWarning",
    "ProgramNotFound",
    "Progress",
    "Ranking",
    "Result",
    "StudyError",
    "evaluate",
    "mechanism",
    "program_version",
    "read",
    "run",
]


def __getattr__(name: str) -> Any:
    """`Evaluator`, the compiled solver, when it is first asked for: most users do not have it."""
    if name != "Evaluator":
        raise AttributeError(f"module 'poesy' has no attribute {name!r}")
    try:
        from poesy_solver import Evaluator
    except ImportError as error:
        raise ImportError(
            f"poesy.Evaluator is in the compiled module poesy_solver, which is not there ({error}); ./quickstart python and "
            "the Debian package python3-poesy install it, cmake -D POESY_PYTHON_MODULE=ON builds it; or use poesy.evaluate, "
            "which needs only the program"
        ) from error
    return Evaluator


def __dir__() -> list[str]:
    return sorted([*__all__, "Evaluator", "program", "__version__"])
