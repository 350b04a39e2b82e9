"""What errors do to a mechanism, solved on NumPy arrays where they stand. All numbers are in SI: m and rad."""

import enum
import os
from collections.abc import Mapping, Sequence
from typing import Literal, TypedDict

import numpy
import numpy.typing

__version__: str

Floats = numpy.typing.NDArray[numpy.float64]
Statuses = numpy.typing.NDArray[numpy.uint8]

class Status(enum.IntEnum):
    converged = 0
    stagnated = 1
    iteration_cap = 2
    singular = 3
    non_finite = 4
    not_assembled = 5

class InputError(ValueError): ...
class FileError(OSError): ...
class PoesyWarning(UserWarning): ...

class _Units(TypedDict):
    errors: tuple[str, ...]
    responses: tuple[str, ...]
    pose_coordinates: tuple[str, ...]

class AtPose:
    @property
    def pose(self) -> tuple[float, ...]: ...
    def __call__(self, errors: Floats, out: Floats | None = None, status: Statuses | None = None) -> Floats: ...

class Evaluator:
    def __init__(
        self,
        mechanism: str | os.PathLike[str],
        *,
        metric: Literal["platform", "published", "stiffness"] = "platform",
        fidelity: Literal["exact", "first-order"] = "exact",
        factors: str | Sequence[str] = "all",
        calibrated: bool = False,
        geometry: Mapping[str, float | str] = ...,
    ) -> None: ...
    @property
    def mechanism(self) -> str: ...
    @property
    def errors(self) -> tuple[str, ...]: ...
    @property
    def responses(self) -> tuple[str, ...]: ...
    @property
    def pose_coordinates(self) -> tuple[str, ...]: ...
    @property
    def units(self) -> _Units: ...
    def at(self, pose: numpy.typing.ArrayLike) -> AtPose: ...
    def __call__(
        self,
        poses: numpy.typing.ArrayLike,
        errors: Floats,
        out: Floats | None = None,
        status: Statuses | None = None,
        *,
        paired: bool = False,
    ) -> Floats: ...
