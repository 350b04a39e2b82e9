"""Writes TOML, because the standard library can only read it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from os import PathLike, fspath
from typing import Any

import numpy as np

from ._errors import StudyError

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_ESCAPES = {"\\": "\\\\", '"': '\\"', "\b": "\\b", "\t": "\\t", "\n": "\\n", "\f": "\\f", "\r": "\\r"}


def dumps(table: Mapping[str, Any]) -> str:
    """The TOML text of nested mappings.

    Parameters
    ----------
    table
        Keys are text. Values are mappings, sequences, text, paths, numbers and booleans, also those of NumPy. A sequence
        of mappings becomes an array of tables.

    Raises
    ------
    StudyError
        For any other value, ``None`` included. The message names the key.
    """
    return "".join(_table_lines(plain(table), ())).lstrip("\n")


def plain(value: Any, path: tuple[str, ...] = ()) -> Any:
    """The value converted to ``dict``, ``list``, ``str``, ``int``, ``float`` and ``bool``. Raises as `dumps` does."""
    if isinstance(value, (bool, str, int, float)) and not isinstance(value, np.generic):
        return value
    if isinstance(value, Mapping):
        return {_key_text(key, path): plain(inner, (*path, str(key))) for key, inner in value.items()}
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist(), path)
    if isinstance(value, (list, tuple, range)):
        return [plain(inner, path) for inner in value]
    if isinstance(value, PathLike):
        return fspath(value)
    where = ".".join(path) or "the table"
    raise StudyError(f"{where} is {value!r}, which TOML cannot hold; leave the key out, or give text, a number or a list")


def _key_text(key: Any, path: tuple[str, ...]) -> str:
    if isinstance(key, str):
        return key
    raise StudyError(f"the key {key!r} in {'.'.join(path) or 'the table'} is not a text; keys of TOML are")


def _key(text: str) -> str:
    return text if _BARE_KEY.fullmatch(text) else _string(text)


def _string(text: str) -> str:
    escaped = "".join(_ESCAPES.get(c) or (f"\\u{ord(c):04X}" if ord(c) < 32 or ord(c) == 127 else c) for c in text)
    return f'"{escaped}"'


def _number(value: float) -> str:
    if value != value or value in (float("inf"), float("-inf")):
        return {"nan": "nan", "inf": "inf", "-inf": "-inf"}[repr(value)]
    return repr(value)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, (int, float)):
        return _number(value)
    if isinstance(value, list):
        return "[" + ", ".join(_value(inner) for inner in value) + "]"
    return "{ " + ", ".join(f"{_key(key)} = {_value(inner)}" for key, inner in value.items()) + " }"


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(inner, dict) for inner in value)


def _table_lines(table: dict[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    """The lines of a table. Its values come first, because values below a heading would belong to that heading."""
    for key, value in table.items():
        if not isinstance(value, dict) and not _is_tables(value):
            yield f"{_key(key)} = {_value(value)}\n"
    for key, value in table.items():
        name = ".".join(_key(part) for part in (*path, key))
        if isinstance(value, dict):
            yield f"\n[{name}]\n"
            yield from _table_lines(value, (*path, key))
        elif _is_tables(value):
            for inner in value:
                yield f"\n[[{name}]]\n"
                yield from _table_lines(inner, (*path, key))
