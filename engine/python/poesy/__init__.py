"""Runs the program poesy, which tells which errors of a parallel robot matter, how much and where. Reads its results.

>>> import poesy
>>> result = poesy.run("study.toml")                     # doctest: +SKIP
>>> print(result.ranking())                              # doctest: +SKIP
>>> result.plot.ranking()                                # doctest: +SKIP

The program itself must be installed: in the virtual environment, on PATH, or at the path that the environment variable
POESY or ``poesy.program`` names.
"""

from __future__ import annotations

import os
from typing import Any

from ._calibrate import Calibration, calibrate
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
from ._figure import figure
from ._mechanism import Coordinate, Frame, Mechanism, Named, mechanism
from ._plot import Plots
from ._program import Progress
from ._program import version as program_version
from ._ranking import Ranking
from ._result import Result, read
from ._run import run
from ._sweep import sweep

__version__ = "0.2.0"

program: str | os.PathLike[str] | None = None
"""Path of the program to run. ``None``: the path in the environment variable POESY, else the program in this virtual
environment, else the first `poesy` on PATH."""

__all__ = [
    "Calibration",
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
    "calibrate",
    "evaluate",
    "figure",
    "mechanism",
    "program_version",
    "read",
    "run",
    "sweep",
]


def __getattr__(name: str) -> Any:
    """Imports `Evaluator`, the compiled solver, on first use, because most installations lack it."""
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
