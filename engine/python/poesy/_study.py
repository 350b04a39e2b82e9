"""Writes a study that is a dict to a file, which means the same as a study file in the current folder would."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from . import _toml
from ._mechanism import Mechanism

STUDY_NAME = "study.toml"
FILE_KEYS = ("file", "machines")  # keys whose text names a file


def write_study(study: Mapping[str, Any], folder: Path) -> tuple[Path, str]:
    """Writes the file STUDY_NAME into the folder. Returns its path and its text.

    The dict names files relative to the current folder, by FILE_KEYS, but a study file names them relative to its
    own folder. So these files are linked into the folder under the same names. Then the resolved study, which is part
    of the result and its hash, has no name of a temporary folder. ``format`` and ``version`` may be left out.
    """
    table = _linked({"format": "poesy-study", "version": 1, **study}, folder)
    text = _toml.dumps(table)
    path = folder / STUDY_NAME
    path.write_text(text, encoding="utf-8")
    return path, text


def _linked(value: Any, folder: Path) -> Any:
    if isinstance(value, Mechanism):
        return value.table() if value.path is None else {"file": _link(value.path.name, value.path, folder)}
    if isinstance(value, Mapping):
        return {key: _file(inner, folder) if key in FILE_KEYS else _linked(inner, folder) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_linked(inner, folder) for inner in value]
    return value


def _file(named: Any, folder: Path) -> Any:
    if isinstance(named, Mechanism) and named.path is not None:
        return _link(named.path.name, named.path, folder)
    if not isinstance(named, (str, os.PathLike)):
        return _linked(named, folder)
    return _link(os.fspath(named), Path(named), folder)


def _link(name: str, target: Path, folder: Path) -> str:
    """Links a file into the folder. Returns its name there, or its full path if the name leads out of the folder or is
    taken."""
    target = target.absolute()
    link = folder / name
    if Path(name).is_absolute() or ".." in Path(name).parts or name == STUDY_NAME or not target.exists():
        return str(target)
    if not link.is_symlink():
        link.parent.mkdir(parents=True, exist_ok=True)
        link.symlink_to(target)
    return name if Path(os.readlink(link)) == target else str(target)
