"""Mechanisms: built in, from files, or described by a dict."""

from __future__ import annotations

import base64
import html
import itertools
import math
import os
import re
import shutil
import tempfile
import weakref
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from . import _program, _toml
from ._errors import FileError, NotInResult, StudyError

_NUMBER = r"[-+]?(?:[\d.]+(?:e[-+]?\d+)?|inf|nan)"
_VECTOR = rf"\(({_NUMBER}), ({_NUMBER}), ({_NUMBER})\)"
_FRAME = re.compile(rf"  (?P<name>\S+) +(?P<joint>\S+)(?: +(?P<type>\S.*?))? +{_VECTOR} +{_VECTOR} +{_VECTOR}")
_COORDINATE = re.compile(rf"  (\S+) +({_NUMBER}) to ({_NUMBER}) +(\S+) (.*)")
_NAMED = re.compile(r"  (\S+) +(N m|\S+) (.*)")  # a name, its unit (only "N m" has a blank), and a description
_SI_OF_SHOWN = {"mm": (1e-3, "m"), "deg": (math.radians(1.0), "rad")}  # size in SI and SI unit of a unit in the text
_RESPONSES = re.compile(
    r'responses(?: by \[solver\] metric = "(?P<metric>[^"]*)")?(?P<usual>, which a study without the key has)?'
)


class Coordinate(NamedTuple):
    """A pose coordinate and its range in the default workspace, SI."""

    name: str
    lower: float
    upper: float
    unit: str  #: "m" or "rad"
    description: str


class Named(NamedTuple):
    """An error or a response, with its SI unit and its description."""

    name: str
    unit: str
    description: str


class Frame(NamedTuple):
    """The frame of a joint at home, in the base frame. The last frame is that of the platform."""

    name: str  #: "1_2" for joint 2 of limb 1; "platform"
    joint: str
    type: str  #: "R", "P", ...; empty for the platform
    actuated: bool
    point: tuple[float, float, float]  #: m, to six digits
    z: tuple[float, float, float]  #: unit vector, along or about the joint
    x: tuple[float, float, float]


class Mechanism:
    """A mechanism as the program understands it, made by `mechanism`.

    Attributes
    ----------
    name, title : str
    path : pathlib.Path or None
        The mechanism's file; ``None`` for a built-in mechanism.
    coordinates : tuple of Coordinate
        Coordinates of a pose, in the order of the columns of `evaluate`.
    errors : tuple of Named
        Every geometric error, in the order of the columns of `evaluate`.
    responses : tuple of Named
        Responses of a study that chooses no metric.
    responses_by_metric : dict
        For an over-constrained mechanism, the responses under ``[solver] metric = "platform"`` and "published".
    frames : tuple of Frame
        Frames of the joints at home; empty for a built-in mechanism.
    text : str
        The whole output of ``poesy models``, which also has geometry, mobility and sets of errors.
    """

    def __init__(self, name: str, path: Path | None, text: str) -> None:
        self.path = path
        self.text = text
        self.name, _, self.title = text.splitlines()[0].partition(": ")
        sections = dict(_sections(text))
        self.coordinates = _coordinates(sections.get("pose coordinates and default workspace", []))
        self.errors = _named(sections.get("error factors", []))
        self.frames = tuple(_frames(sections.get("joints and frames at home, in the base frame", [])))
        self.responses, self.responses_by_metric = _responses(sections)

    @property
    def _units(self) -> dict[str, str]:
        """The SI units of all pose coordinates, of the coordinates of all charts, and of all errors, by name."""
        charts = [_named(lines) for heading, lines in _sections(self.text) if heading.startswith("poses may be given by ")]
        return {one.name: one.unit for one in itertools.chain(*charts, self.coordinates, self.errors)}

    def __repr__(self) -> str:
        return f"<poesy mechanism {self.name}: {self.title}; {len(self.errors)} errors>"

    def __fspath__(self) -> str:
        if self.path is None:
            raise FileError(f"{self.name} is built in and has no file")
        return str(self.path)

    def table(self) -> dict[str, str]:
        """The table [mechanism] of a study: ``{"mechanism": mechanism.table()}``. A study may have the `Mechanism`
        instead."""
        return {"model": self.name} if self.path is None else {"file": str(self.path)}

    def picture(self, path: str | os.PathLike[str]) -> Path:
        """Writes a picture (SVG) of a mechanism that has a file. Raises the exceptions of the program's exit codes."""
        _program.call("models", self._file(), "-o", path)
        return Path(path)

    def _file(self) -> Path:
        if self.path is None:
            raise NotInResult(f"{self.name} is built in; pictures are made of mechanisms from files")
        return self.path

    def _repr_html_(self) -> str | None:
        """The picture as an image with its own data, because web pages made from notebooks drop SVG in other forms."""
        if self.path is None:
            return None
        with tempfile.TemporaryDirectory() as folder:
            drawn = base64.b64encode(self.picture(Path(folder) / "picture.svg").read_bytes()).decode()
        words = html.escape(f"{self.name}: {self.title}, four views of its joints at home")
        return f'<img alt="{words}" src="data:image/svg+xml;base64,{drawn}">'


def mechanism(
    description: str | os.PathLike[str] | Mapping[str, Any] | Mechanism, path: str | os.PathLike[str] | None = None
) -> Mechanism:
    """Checks a mechanism, and returns its errors, responses and frames.

    Parameters
    ----------
    description
        Name of a built-in mechanism ("2upr-rpu"), path of a mechanism's file, or the content of such a file as a dict,
        in which ``format`` and ``version`` may be left out (engine/docs/study-file.md, "Mechanism files").
    path
        Where to write the file of a dict; default: a temporary folder that exists as long as the object.

    Raises
    ------
    StudyError
        If the description is not a mechanism; the message says where and why.
    FileError
        If the file cannot be read or written.
    """
    if isinstance(description, Mechanism):
        return description
    if not isinstance(description, Mapping):
        named = os.fspath(description)
        file = Path(named) if named.endswith(".toml") or os.path.exists(named) else None
        return Mechanism(named, file, _program.call("models", named))
    table = {"format": "poesy-mechanism", "version": 1, **description}
    folder = None if path is not None else Path(tempfile.mkdtemp(prefix="poesy-"))
    file = Path(path) if path is not None else Path(folder or ".") / f"{_file_name(table)}.toml"
    try:
        written = _toml.dumps(table)
        _write(file, written)
        found = Mechanism(str(table.get("name", "")), file, _called_with_line(file, written))
    except BaseException:
        if folder is not None:
            shutil.rmtree(folder, ignore_errors=True)
        raise
    if folder is not None:
        weakref.finalize(found, shutil.rmtree, folder, ignore_errors=True)
    return found


def _file_name(table: Mapping[str, Any]) -> str:
    return re.sub(r"[^\w.-]", "_", str(table.get("name", "mechanism"))).lstrip(".") or "mechanism"


def _write(file: Path, text: str) -> None:
    try:
        file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise FileError(f"{file}: cannot be written: {error.strerror}") from error


def _called_with_line(file: Path, written: str) -> str:
    try:
        return _program.call("models", file)
    except StudyError as error:
        raise with_line(error, str(file), "mechanism", written) from None


def with_line(error: StudyError, path: str, what: str, text: str) -> StudyError:
    """The error with the line itself in place of the file's name, for a file that the user has not seen.

    "/tmp/x/study.toml:12:1: problem" becomes "study, line 12 (samples = 1): problem".
    """
    found = re.match(re.escape(path) + r":(\d+):(\d+): (.*)", str(error), re.DOTALL)
    lines = text.splitlines()
    if found is None or not 1 <= int(found[1]) <= len(lines):
        return error
    return StudyError(f"{what}, line {found[1]} ({lines[int(found[1]) - 1].strip()}): {found[3]}")


def _sections(text: str) -> list[tuple[str, list[str]]]:
    """The headings of the program's text, each with the indented lines below it."""
    found: list[tuple[str, list[str]]] = []
    for line in text.splitlines()[1:]:
        if line and not line.startswith(" "):
            found.append((line, []))
        elif line and found:
            found[-1][1].append(line)
    return found


def _named(lines: list[str]) -> tuple[Named, ...]:
    matches = (_NAMED.fullmatch(line) for line in lines)
    return tuple(Named(*match.groups()) for match in matches if match)


def _coordinates(lines: list[str]) -> tuple[Coordinate, ...]:
    found = []
    for match in filter(None, map(_COORDINATE.fullmatch, lines)):
        name, lower, upper, unit, description = match.groups()
        scale, si_unit = _SI_OF_SHOWN.get(unit, (1.0, unit))
        found.append(Coordinate(name, float(lower) * scale, float(upper) * scale, si_unit, description.strip()))
    return tuple(found)


def _responses(sections: Mapping[str, list[str]]) -> tuple[tuple[Named, ...], dict[str, tuple[Named, ...]]]:
    usual: tuple[Named, ...] = ()
    by_metric: dict[str, tuple[Named, ...]] = {}
    for heading, lines in sections.items():
        match = _RESPONSES.fullmatch(heading)
        if match is None:
            continue
        if match["metric"]:
            by_metric[match["metric"]] = _named(lines)
        if match["usual"] or not usual:  # with only one metric, the text does not say which is the default
            usual = _named(lines)
    return usual, by_metric


def _frames(lines: list[str]) -> list[Frame]:
    found = []
    for line in lines:
        match = _FRAME.fullmatch(line.rstrip())
        if match is None:
            continue
        numbers = [float(number) for number in match.groups()[3:]]
        kind, _, actuated = (match["type"] or "").partition(", ")
        point = (numbers[0] * 1e-3, numbers[1] * 1e-3, numbers[2] * 1e-3)
        z, x = (numbers[3], numbers[4], numbers[5]), (numbers[6], numbers[7], numbers[8])
        found.append(Frame(match["name"], match["joint"], kind.strip(), actuated.startswith("actuated"), point, z, x))
    return found
