"""Result files as xarray Datasets, by what the files say of themselves: names of axes, units, descriptions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray

from ._errors import DamagedFile, FileError

NEWEST_MAJOR = 1
_BOOKKEEPING = frozenset({"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"})


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    """The file, open to be read. Raises `FileError` where it is not there, `DamagedFile` where it is no result, is damaged
    here or when it is read in the block, or is of a newer version."""
    if not path.exists():
        raise FileError(f"{path}: there is no such file; results come from poesy.run")
    try:
        with h5py.File(path, "r") as file:
            _check(path, file)
            yield file
    except (OSError, KeyError, RuntimeError) as error:
        if isinstance(error, FileError):
            raise
        raise DamagedFile(f"{path}: is no intact HDF5 file: {error}") from error


def _check(path: Path, file: h5py.File) -> None:
    filetype = file.attrs.get("filetype", "none")
    if filetype != "poesy-result":
        raise DamagedFile(f"{path}: is no result of poesy (attribute filetype: {filetype}); results come from poesy.run")
    major, minor = file.attrs["version"]
    if major > NEWEST_MAJOR:
        raise DamagedFile(f"{path}: version {major}.{minor}, this reads {NEWEST_MAJOR}.x; take a newer package")


def attributes(thing: Any) -> dict[str, Any]:
    """Attributes of a file, group or dataset as text, numbers and lists."""
    return {name: _python(value) for name, value in thing.attrs.items() if name not in _BOOKKEEPING}


def _python(value: Any) -> Any:
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def group_names(file: h5py.File) -> list[str]:
    """Every group of the file, "sensitivity/history" after "sensitivity"."""
    names: list[str] = []
    file.visititems(lambda name, thing: names.append(name) if isinstance(thing, h5py.Group) else None)
    return names


def text(file: h5py.File, name: str) -> str:
    """A dataset that is one text."""
    return str(file[name].asstr()[()])


def texts(file: h5py.File, name: str) -> list[str]:
    """A dataset that is a list of texts."""
    return [str(one) for one in file[name].asstr()[...]]


def _values(dataset: h5py.Dataset) -> Any:
    if h5py.check_string_dtype(dataset.dtype) is None:
        return dataset[()]
    read = dataset.asstr()[()]
    return np.array(read.tolist(), dtype=str) if isinstance(read, np.ndarray) else read


def _labels(dataset: h5py.Dataset) -> dict[str, Any]:
    """Its attributes, and unit and description once more under the names by which xarray labels plots."""
    found = attributes(dataset)
    if "unit" in found:
        found["units"] = found["unit"]
    if "description" in found:
        found["long_name"] = found["description"]
    return found


def _scales(dataset: h5py.Dataset) -> list[tuple[str, h5py.Dataset | None]]:
    """Of each axis its name and the scale that has its labels."""
    if h5py.h5ds.is_scale(dataset.id):
        return [(dataset.name.rpartition("/")[2], dataset)] * dataset.ndim
    found: list[tuple[str, h5py.Dataset | None]] = []
    for number, dimension in enumerate(dataset.dims):
        scale = dimension[0] if len(dimension) else None
        found.append((scale.name.rpartition("/")[2], scale) if scale is not None else (f"axis_{number}", None))
    return found


def dataset_of(group: h5py.Group, units: Mapping[str, Mapping[str, str]]) -> xarray.Dataset:
    """A group without the groups below it.

    Parameters
    ----------
    group
        Of a result file.
    units
        SI units by name, for each axis whose entries have units of their own: "response", "factor", "part". Such an axis
        gets a coordinate ``response_unit`` beside it.
    """
    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = {}
    for name, thing in group.items():
        if not isinstance(thing, h5py.Dataset):
            continue
        axes = _scales(thing)
        for axis, scale in axes:
            if scale is not None and axis not in coordinates:
                coordinates[axis] = (axis, _values(scale), _labels(scale))
        if name not in coordinates:
            variables[name] = (tuple(axis for axis, _ in axes), _values(thing), _labels(thing))
    for axis, known in units.items():
        if axis in coordinates:
            named = [known.get(str(one), "1") for one in coordinates[axis][1]]
            coordinates[f"{axis}_unit"] = (axis, np.array(named, dtype=str), {"description": f"SI unit of each {axis}"})
    return xarray.Dataset(variables, coordinates, attributes(group))
