"""Reads result files as xarray Datasets. Names of axes, units and descriptions come from the files themselves."""

from __future__ import annotations

import stat
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray

from ._errors import DamagedFile, FileError

MAJOR = 1  # major version of the format
_BOOKKEEPING = frozenset({"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"})
_DEEPEST, _MOST_NAMES = 16, 16  # results have three levels, and datasets of up to seven names
_OWN_FILTERS = range(1, 7)  # gzip, shuffle, fletcher32, szip, nbit, scaleoffset
_OTHERS = {stat.S_IFDIR: "a folder", stat.S_IFIFO: "a FIFO", stat.S_IFSOCK: "a socket"}
_LINKS = {h5py.h5l.TYPE_SOFT: "a soft link", h5py.h5l.TYPE_EXTERNAL: "a link to another file"}


class _StrangeFile(Exception):
    """A file has contents that poesy never writes."""


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    """Opens a result file for reading. Raises `FileError` if it does not exist. Raises `DamagedFile` if it is not a
    result, has another version of the format, would read other files, or is damaged, also if the damage shows inside
    the block."""
    if not path.exists():
        raise FileError(f"{path}: there is no such file; results come from poesy.run")
    if not path.is_file():  # HDF5 would wait for a FIFO
        other = _OTHERS.get(stat.S_IFMT(path.stat().st_mode), "a device")
        raise DamagedFile(f"{path}: is {other}, not a file; results come from poesy.run")
    try:
        with h5py.File(path, "r") as file:
            _check(path, file)
            _expect_plain_tree(file)
            yield file
    except _StrangeFile as strange:
        raise DamagedFile(
            f"{path}: {_printable(str(strange))[:300]}, and a result is one tree that reads nothing but itself; "
            "do not trust it; take another copy, or run the study again"
        ) from None
    except (OSError, KeyError, RuntimeError) as error:
        if isinstance(error, FileError):
            raise
        raise DamagedFile(f"{path}: is not an intact HDF5 file: {error}") from error


def _check(path: Path, file: h5py.File) -> None:
    filetype = file.attrs.get("filetype", "none")
    if filetype != "poesy-result":
        found = _printable(str(filetype))
        raise DamagedFile(f"{path}: is not a result of poesy (attribute filetype: {found}); results come from poesy.run")
    major, minor = file.attrs["version"]
    if major != MAJOR:
        remedy = "take a newer package" if major > MAJOR else "run the study again"
        raise DamagedFile(f"{path}: version {major}.{minor}, this reads {MAJOR}.x; {remedy}")


def _printable(text: str) -> str:
    """The text with "?" in place of characters that a terminal cannot print."""
    return "".join(one if one.isprintable() else "?" for one in text)


def _expect_plain_tree(file: h5py.File) -> None:
    """Raises `_StrangeFile` unless the file is one tree of groups and datasets whose values are all in this file.

    Reads no value. HDF5 would open other files for external links, external storage and virtual datasets. The program
    refuses such files, too (h5::File::expect_plain_tree).
    """
    names = Counter([h5py.h5o.get_info(h5py.h5g.open(file.id, b"/")).addr])
    groups = [(b"/", 0)]
    while groups:
        group, depth = groups.pop()
        links: list[tuple[bytes, int]] = []
        here = h5py.h5g.open(file.id, group)  # must stay open while its links are listed
        here.links.iterate(lambda name, info: links.append((name, info.type)), info=True)
        for name, link in links:
            path = group.rstrip(b"/") + b"/" + name
            shown = path.decode(errors="replace")
            if link != h5py.h5l.TYPE_HARD:
                raise _StrangeFile(f"{shown} is {_LINKS.get(link, 'a link of another kind')}")
            if b"/" in name or name in (b"", b"."):  # HDF5 would take it for a path
                raise _StrangeFile(f"{shown} has no name of its own")
            thing = h5py.h5o.open(file.id, path)
            address = h5py.h5o.get_info(thing).addr
            names[address] += 1
            if isinstance(thing, h5py.h5d.DatasetID):
                if names[address] > _MOST_NAMES:
                    raise _StrangeFile(f"{shown} has too many names")
                _expect_own_storage(thing, shown)
            elif not isinstance(thing, h5py.h5g.GroupID):
                raise _StrangeFile(f"{shown} is neither a group nor a dataset")
            elif names[address] > 1:
                raise _StrangeFile(f"{shown} is a group that has two names, or is in itself")
            elif depth == _DEEPEST:
                raise _StrangeFile(f"{shown} is too deep")
            else:
                groups.append((path, depth + 1))


def _expect_own_storage(dataset: h5py.h5d.DatasetID, shown: str) -> None:
    storage = dataset.get_create_plist()
    if storage.get_layout() == h5py.h5d.VIRTUAL:
        raise _StrangeFile(f"{shown} is a virtual dataset, whose values are elsewhere")
    if storage.get_external_count() > 0:
        raise _StrangeFile(f"{shown} has its values in other files (external storage)")
    for number in range(storage.get_nfilters()):
        kind = storage.get_filter(number)[0]
        if kind not in _OWN_FILTERS:  # HDF5 would run a plugin of this machine
            raise _StrangeFile(f"{shown} needs the filter {kind}")


def attributes(thing: Any) -> dict[str, Any]:
    """Attributes of a file, group or dataset as text, numbers and lists."""
    return {name: _python(value) for name, value in thing.attrs.items() if name not in _BOOKKEEPING}


def _python(value: Any) -> Any:
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def group_names(file: h5py.File) -> list[str]:
    """The names of all groups of the file. An inner group, "sensitivity/history", follows its outer one,
    "sensitivity"."""
    names: list[str] = []
    file.visititems(lambda name, thing: names.append(name) if isinstance(thing, h5py.Group) else None)
    return names


def text(file: h5py.File, name: str) -> str:
    """Reads a dataset that is one text."""
    return str(file[name].asstr()[()])


def texts(file: h5py.File, name: str) -> list[str]:
    """Reads a dataset that is a list of texts."""
    return [str(one) for one in file[name].asstr()[...]]


def _values(dataset: h5py.Dataset) -> Any:
    if h5py.check_string_dtype(dataset.dtype) is None:
        return dataset[()]
    read = dataset.asstr()[()]
    return np.array(read.tolist(), dtype=str) if isinstance(read, np.ndarray) else read


def _labels(dataset: h5py.Dataset) -> dict[str, Any]:
    """The attributes of a dataset. Unit and description also have the names by which xarray labels plots."""
    found = attributes(dataset)
    if "unit" in found:
        found["units"] = found["unit"]
    if "description" in found:
        found["long_name"] = found["description"]
    return found


def _scales(dataset: h5py.Dataset) -> list[tuple[str, h5py.Dataset | None]]:
    """For each axis of a dataset its name, and the dimension scale with its labels."""
    if h5py.h5ds.is_scale(dataset.id):
        return [(dataset.name.rpartition("/")[2], dataset)] * dataset.ndim
    found: list[tuple[str, h5py.Dataset | None]] = []
    for number, dimension in enumerate(dataset.dims):
        scale = dimension[0] if len(dimension) else None
        if scale is not None and scale.name is None:  # no link leads to it, so it was not checked
            raise _StrangeFile(f"{dataset.name} has an axis whose labels are not in the tree")
        found.append((scale.name.rpartition("/")[2], scale) if scale is not None else (f"axis_{number}", None))
    return found


def dataset_of(group: h5py.Group, units: Mapping[str, Mapping[str, str]]) -> xarray.Dataset:
    """A group as a Dataset, without the groups inside it.

    Parameters
    ----------
    group
        A group of a result file.
    units
        SI units by name, for each axis whose entries have their own units: "response", "factor", "part". For such an
        axis the Dataset has a further coordinate, ``response_unit``.
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
