"""Solves given errors at given poses. Errors, poses and responses are arrays."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _program
from ._errors import StudyError
from ._mechanism import Mechanism, mechanism as described
from ._result import Result
from ._study import write_study

Floats = npt.NDArray[np.float64]

_SOLUTIONS = ("converged", "stagnated", "by_series")  # names of statuses that count as solved


class Evaluation(dict[str, Floats]):
    """Responses by name, each [M x N] in SI (m, rad), for pose m and row n of the errors. [M] if each pose has its own
    row. NaN for a solve that did not end in a solution.

    Attributes
    ----------
    status : ndarray of uint8 [M x N] or [M]
        How each solve ended, as an index of `status_names`. 0: converged; 5: the machine cannot be assembled.
    status_names : tuple of str
        Names of the statuses. The last one, not_assembled, is present only if a solve ended with it.
    converged : ndarray of bool
        Whether `status` is 0, converged. Solves that stagnated at rounding level are solutions, too. All others have NaN.
    units : dict of str
        SI unit of each response.
    details : dict of ndarray [M x N x C] or [M x C]
        Further outputs of the mechanism, for instance deviations between limbs as screws; those of the last iterate where
        a solve did not end in a solution.
    joints : ndarray [M x J]
        Displacements of the joints at each pose without errors, m or rad.
    joint_names : tuple of str
    """

    def __init__(self, result: Result, paired: bool) -> None:
        found = result.to_xarray("evaluate")
        self.units = result.units("response")

        def values(name: str) -> Any:
            data = found[name].transpose("pose", "sample", ...)
            return (data.isel(sample=0) if paired else data).values

        self.status: npt.NDArray[np.uint8] = values("status")
        self.status_names = tuple(found["status"].attrs["status_names"])
        is_solution = np.isin(self.status, [code for code, name in enumerate(self.status_names) if name in _SOLUTIONS])
        super().__init__({name: np.where(is_solution, values(name), np.nan) for name in self.units})
        self.converged: npt.NDArray[np.bool_] = self.status == 0
        listed = found.attrs.get("details", [])
        self.details: dict[str, Floats] = {name: values(name) for name in ([listed] if isinstance(listed, str) else listed)}
        self.joints: Floats = found["joint_displacements"].values
        self.joint_names = tuple(str(name) for name in found["joint"].values)


def evaluate(
    mechanism: str | os.PathLike[str] | Mapping[str, Any] | Mechanism,
    poses: npt.ArrayLike | Mapping[str, npt.ArrayLike],
    errors: npt.ArrayLike | Mapping[str, npt.ArrayLike],
    *,
    paired: bool = False,
    geometry: Mapping[str, str] | None = None,
    fidelity: str | None = None,
    solver: Mapping[str, Any] | None = None,
    threads: int | None = None,
) -> Evaluation:
    """Solves given errors at given poses with ``poesy evaluate``.

    Numbers are passed to the program as text, exactly. Inside a loop, `poesy.Evaluator` is far faster.

    Parameters
    ----------
    mechanism
        Name, path of a file, dict or `Mechanism`, as `poesy.mechanism` takes them.
    poses
        [M x dims], or [dims] for one pose, SI, columns in the order of ``mechanism(...).coordinates``. Or columns by
        name. These may be coordinates of a chart, such as "tip" or "actuators", which ``print(mechanism(...).text)``
        lists.
    errors
        [N x P], or [P] for one row, SI, columns in the order of ``mechanism(...).errors``. Or columns by name; other
        errors are then zero, and a single number applies to all rows.
    paired
        Whether row n of the errors is solved only at pose n. Otherwise every row is solved at every pose.
    geometry, fidelity
        As in ``[mechanism]`` of a study: ``geometry={"l_A": "80 mm"}``.
    solver
        As ``[solver]``: ``{"metric": "platform"}``.
    threads
        Default: one for each processor.

    Raises
    ------
    StudyError
        For arrays of a wrong shape, unknown names, and poses out of reach; the message names the row.
    ProgramNotFound, FileError, InternalError
        As `run` does.
    """
    known = described(mechanism)
    pose_columns = _columns(poses, [one.name for one in known.coordinates], "poses", "pose coordinates")
    error_columns = _columns(errors, [one.name for one in known.errors], "errors", "errors")
    chosen: dict[str, Any] = {"model": known.name} if known.path is None else {"file": known}
    chosen |= ({"fidelity": fidelity} if fidelity else {}) | ({"geometry": dict(geometry)} if geometry else {})
    with tempfile.TemporaryDirectory(prefix="poesy-") as named:
        folder = Path(named)
        path, _ = write_study({"mechanism": chosen, "solver": dict(solver or {})}, folder)
        for name, columns in (("poses.csv", pose_columns), ("errors.csv", error_columns)):
            _write_table(folder / name, columns, known._units)
        words = ["evaluate", path.name, "--poses", "poses.csv", "--errors", "errors.csv", "-o", "result.h5", "--quiet"]
        words += ["--paired"] * paired + (["--threads", str(threads)] if threads is not None else [])
        done = _program.start(words, folder=folder)
        if done.code not in (_program.DONE, _program.TOO_MANY_NOT_CONVERGED):  # `status` tells which
            raise _program.exception_of(done)
        return Evaluation(Result(folder / "result.h5"), paired)


def _columns(values: npt.ArrayLike | Mapping[str, npt.ArrayLike], names: list[str], what: str, of: str) -> dict[str, Floats]:
    """The columns by name, made equally long. what, of: the columns and their names in messages."""
    if isinstance(values, Mapping):
        given = {name: np.asarray(column, dtype=float) for name, column in values.items()}
        try:
            whole = np.broadcast_arrays(*map(np.atleast_1d, given.values()))
        except ValueError:
            lengths = ", ".join(f"{name} {column.shape}" for name, column in given.items())
            raise StudyError(f"{what}: columns differ in length: {lengths}") from None
        if not given or any(column.ndim != 1 for column in whole):
            raise StudyError(f"{what} by name: give a number or a list of numbers for at least one name")
        return dict(zip(given, whole))
    table = np.atleast_2d(np.asarray(values, dtype=float))
    if table.ndim != 2 or table.shape[1] != len(names):
        raise StudyError(
            f"{what} has shape {np.shape(values)}; it needs {len(names)} columns, one for each of the {of} ({_some(names)})"
        )
    return {name: table[:, at] for at, name in enumerate(names)}


def _some(names: list[str]) -> str:
    return ", ".join(names) if len(names) <= 6 else ", ".join([*names[:5], "...", names[-1]])


def _write_table(path: Path, columns: Mapping[str, Floats], units: Mapping[str, str]) -> None:
    """Writes columns as CSV. Their titles state the SI units, and repr() of a float reads back as the same number."""
    rows = np.stack(list(columns.values()), axis=1).tolist()
    titles = [f"{name} [{units[name]}]" if units.get(name, "1") != "1" else name for name in columns]
    lines = [",".join(titles), *(",".join(map(repr, row)) for row in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
