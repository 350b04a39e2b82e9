"""Finds and starts the program `poesy`."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ._errors import Error, FileError, InternalError, Interrupted, PoesyWarning, ProgramNotFound, StudyError

DONE, TOO_MANY_NOT_CONVERGED, LIMIT_NOT_KEPT = 0, 5, 6
_ERRORS: dict[int, type[Error]] = {1: InternalError, 2: StudyError, 3: FileError, 4: Interrupted}
_BEGINNING = "poesy: "
_WARNING = "poesy: warning: "
_PROGRESS = re.compile(
    r"(?:(?:stage|design) (?P<stage>\d+)(?: of \d+)?(?:, stage \d+)?: )?(?P<percent>[\d.]+) % done, "
    r"|looking for poses: |validating designs: "
)


@dataclass(frozen=True)
class Progress:
    """How far a run is, which the program reports every five seconds.

    Attributes
    ----------
    share
        Share of the stage's solves that are done, 0 to 1; 0 while the program looks for poses or
        validates the designs of a sweep.
    stage
        Number of the stage, from 1; above 1 only in studies that solve in several stages. In a sweep, the number of
        the design.
    text
        The program's line of progress. While the program looks for poses, the number found. Then the share done, solves
        per second, samples that did not converge, and time left.
    """

    share: float
    stage: int
    text: str

    def __str__(self) -> str:
        return self.text


@dataclass
class Finished:
    """A finished command: its exit code, what it printed, and its messages without the program's name."""

    code: int
    output: str = ""
    messages: list[str] = field(default_factory=list)
    unnamed: str | None = None  # path that messages must not begin with; see start()

    def take(self, line: str, stacklevel: int) -> None:
        """Keeps a message of the program. A warning of the program becomes a `PoesyWarning`."""
        words = line.removeprefix(_BEGINNING)
        warns = line.startswith(_WARNING)
        words = words.removeprefix(_WARNING.removeprefix(_BEGINNING)) if warns else words
        words = words.removeprefix(f"{self.unnamed}: ") if self.unnamed else words
        if warns:
            warnings.warn(words, PoesyWarning, stacklevel=stacklevel + 1)
        elif words:
            self.messages.append(words)


def find() -> str:
    """The path of the program: ``poesy.program``, else the environment variable POESY, else the program in this virtual
    environment, else the first `poesy` on PATH.

    Raises
    ------
    ProgramNotFound
        If there is no program, or the named file cannot be started.
    """
    chosen = getattr(sys.modules["poesy"], "program", None)
    for source, named in (("poesy.program", chosen), ("the environment variable POESY", os.environ.get("POESY"))):
        if not named:
            continue
        found = shutil.which(os.fspath(named))
        if found is None:
            raise ProgramNotFound(f"{source} is {os.fspath(named)!r}, which is not a program that can be started")
        return str(Path(found).absolute())
    found = _of_environment() or shutil.which("poesy")
    if found is None:
        raise ProgramNotFound(
            "the program poesy is not on PATH; build or install it, then add its folder to PATH, or set the environment "
            'variable POESY, or poesy.program = "/path/to/poesy"'
        )
    return str(Path(found).absolute())


def _of_environment() -> str | None:
    """The `poesy` in the virtual environment of this Python, which is on PATH only while the environment is active."""
    if sys.prefix == sys.base_prefix:
        return None
    return shutil.which("poesy", path=os.path.join(sys.prefix, "bin"))


def call(*arguments: str | os.PathLike[str], folder: Path | None = None) -> str:
    """Runs a short command, and returns what it prints. Raises the exception of its exit code (`exception_of`)."""
    done = start(arguments, folder=folder)
    if done.code != DONE:
        raise exception_of(done)
    return done.output


def start(
    arguments: Sequence[str | os.PathLike[str]],
    folder: Path | None = None,
    on_progress: Callable[[Progress], object] | None = None,
    unnamed: str | None = None,
) -> Finished:
    """Runs the program to its end. Its warnings become `PoesyWarning`.

    unnamed: a path that the user does not know, which is removed from the beginning of messages.

    Ctrl-C, or an exception in `on_progress`, stops the program as one Ctrl-C on a terminal does. The exception
    continues after the program has ended. A second Ctrl-C ends the program at once. The program has its own process
    group, so that it does not get the signal twice.
    """
    command = [find(), *(os.fspath(word) for word in arguments)]
    done = Finished(code=0, unnamed=unnamed)
    with tempfile.TemporaryFile() as printed:
        try:
            process = subprocess.Popen(
                command, cwd=folder, stdin=subprocess.DEVNULL, stdout=printed, stderr=subprocess.PIPE, text=True,
                encoding="utf-8", errors="replace", process_group=0,
            )  # fmt: skip
        except OSError as error:
            raise ProgramNotFound(f"{command[0]} cannot be started: {error}") from error
        with process:
            try:
                _follow(process, done, on_progress)
            except BaseException as error:
                _stop(process, done)
                if done.messages:
                    error.add_note(_BEGINNING + done.messages[-1])
                raise
        printed.seek(0)
        done.output = printed.read().decode("utf-8", errors="replace")
    done.code = process.returncode
    return done


def _follow(process: subprocess.Popen[str], done: Finished, on_progress: Callable[[Progress], object] | None) -> None:
    """Reads the messages and the progress of the program until it ends."""
    assert process.stderr is not None
    for line in process.stderr:
        line = line.rstrip("\n")
        progress = _PROGRESS.match(line)
        if progress is None:
            done.take(line, stacklevel=4)  # shows the line that called run() or evaluate()
        elif on_progress is not None:
            on_progress(Progress(float(progress["percent"] or 0.0) / 100.0, int(progress["stage"] or 1), line))
    process.wait()


def _stop(process: subprocess.Popen[str], done: Finished) -> None:
    process.send_signal(signal.SIGINT)
    try:
        _, said = process.communicate()
    except BaseException:
        process.kill()
        raise
    for line in said.splitlines():
        if not _PROGRESS.match(line):
            done.take(line, stacklevel=4)


def exception_of(done: Finished) -> Error:
    """The exception of an exit code, with the program's last sentence."""
    if done.code < 0:
        return InternalError(f"poesy was ended by {signal.Signals(-done.code).name}")
    sentence = done.messages[-1] if done.messages else f"poesy ended with exit code {done.code} and said nothing"
    return _ERRORS.get(done.code, InternalError)(sentence)


def version() -> dict[str, Any]:
    """``{"version": "0.2.0", "commit": "..."}`` of the program that `run` would start. Raises `ProgramNotFound`."""
    words = call("--version").split()
    return {"version": words[1], "commit": words[2].strip("()")}
