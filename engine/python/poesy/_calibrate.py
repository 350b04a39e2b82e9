"""Fits the errors of one machine to measurements of it, which are given as arrays."""

from __future__ import annotations

import os
import shutil
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _program
from ._errors import PoesyWarning, StudyError
from ._result import Result
from ._study import write_study

Floats = npt.NDArray[np.float64]
_TEXTS = ("name", "to")


class Calibration(dict[str, float]):
    """Estimates of the fitted errors by name, SI.

    Attributes
    ----------
    sd, low, high : dict of float
        Standard deviation of each error, and the ends of its interval; NaN if no measurement determines the error.
    covariance, correlation : ndarray [k x k]
        Covariance (SI) and correlation of the estimates, in the order of the names.
    residual : ndarray [m]
        Measured value minus fitted value, SI, for each of `measured`.
    measured : tuple of str
        Names of the measured values, "deviation_z of row 1", in the order of the file; distances come last.
    chi_square, p : float
        Sum of squared standardised residuals and prior terms, and the probability of a larger sum if only noise remains.
    dof : int
        Degrees of freedom of `chi_square`.
    left : dict of ndarray [M]
        Error of the platform that is expected to remain after the calibration, at each pose of the study, SI: theta_x
        to tip_z.
    left_sd : dict of ndarray [M]
        Standard deviation of `left`, SI.
    typed : dict of float
        Numbers to type into the controller, SI (`controller` in the study).
    converged : bool
        Whether the fit converged. If not, do not use its numbers.
    result : Result
        The result, for everything else: ``result.to_xarray("calibration")``.
    """

    def __init__(self, result: Result, converged: bool) -> None:
        found = result.to_xarray("calibration")
        names = [str(name) for name in found["fitted"].values]

        def by_name(values: Any) -> dict[str, float]:
            return {name: float(value) for name, value in zip(names, values)}

        super().__init__(by_name(found["estimate"].values))
        self.result = result
        self.converged = converged
        self.sd = by_name(found["sd"].values)
        self.low = by_name(found["low"].values)
        self.high = by_name(found["high"].values)
        self.covariance: Floats = found["covariance"].values
        self.correlation: Floats = found["correlation"].values
        self.residual: Floats = found["residual"].values
        self.measured = tuple(str(name) for name in found["value"].values)
        self.chi_square = float(found["chi_square"])
        self.p = float(found["p"])
        self.dof = int(found["dof"])
        left = result.to_xarray("calibration/left")
        moved = [str(name) for name in left["moved"].values]
        self.left = {name: left["mean"].values[:, at] for at, name in enumerate(moved)}
        self.left_sd = {name: left["sd"].values[:, at] for at, name in enumerate(moved)}
        self.typed: dict[str, float] = {}
        if "calibration/controller" in result.groups:
            typed = result.to_xarray("calibration/controller")
            self.typed = {str(name): float(value) for name, value in zip(typed["typed"].values, typed["value"].values)}


def calibrate(
    study: Mapping[str, Any] | str | os.PathLike[str],
    measured: Mapping[str, npt.ArrayLike | Sequence[str]] | str | os.PathLike[str],
    *,
    threads: int | None = None,
) -> Calibration:
    """Fits errors of one machine to measurements of it, by ``poesy calibrate``.

    Parameters
    ----------
    study
        A dict as `run` takes it, or the path of a study file, with ``[analysis.calibration]``. The kind does not matter.
    measured
        The path of a CSV file, or columns by name, of equal length, SI: pose coordinates, ``deviation_z``,
        ``actual_z``, ``sd_z``, ``distance``, and texts in ``name`` and ``to``. NaN or an empty text is a missing value.
    threads
        Number of threads; default: one for each processor. The result does not depend on it.

    Raises
    ------
    StudyError
        For a wrong study or table; the message names the row. Also if the fit reaches no machine that can be solved.
    ProgramNotFound, FileError, InternalError
        As `run` does.
    """
    folder = Path(tempfile.mkdtemp(prefix="poesy-"))
    try:
        found = _calibrated(study, measured, threads, folder)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    found.result.keep_folder(folder)
    for message in found.result.messages:
        warnings.warn(message, PoesyWarning, stacklevel=2)
    return found


def _calibrated(
    study: Mapping[str, Any] | str | os.PathLike[str],
    measured: Mapping[str, npt.ArrayLike | Sequence[str]] | str | os.PathLike[str],
    threads: int | None,
    folder: Path,
) -> Calibration:
    path = write_study(study, folder)[0] if isinstance(study, Mapping) else Path(study)
    table = folder / "measured.csv"
    if isinstance(measured, Mapping):
        _write_measured(table, measured)
    else:
        table = Path(measured)
    output = folder / "machine.h5"
    words = ["calibrate", str(path), "--measured", str(table), "-o", str(output)]
    done = _program.start(words + (["--threads", str(threads)] if threads is not None else []))
    if done.code not in (_program.DONE, _program.TOO_MANY_NOT_CONVERGED):
        raise _program.exception_of(done)
    if not output.exists():
        raise StudyError(done.messages[-1] if done.messages else "a machine on the way of the fit was not solved")
    return Calibration(Result(output, tuple(done.messages)), done.code == _program.DONE)


def _cells(name: str, column: npt.ArrayLike | Sequence[str]) -> list[str]:
    if name in _TEXTS:
        return [str(text) for text in np.atleast_1d(np.asarray(column, dtype=str))]
    values = np.atleast_1d(np.asarray(column, dtype=float))
    if values.ndim != 1:
        raise StudyError(f"measured['{name}'] has shape {values.shape}; give one number for each row")
    return ["" if np.isnan(value) else repr(float(value)) for value in values]


def _write_measured(path: Path, columns: Mapping[str, npt.ArrayLike | Sequence[str]]) -> None:
    cells = {name: _cells(name, column) for name, column in columns.items()}
    lengths = {len(column) for column in cells.values()}
    if len(lengths) != 1:
        shapes = ", ".join(f"{name} {len(column)}" for name, column in cells.items())
        raise StudyError(f"measured: columns differ in length: {shapes or 'there are none'}")
    lines = [",".join(cells), *map(",".join, zip(*cells.values()))]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
