"""Runs a study with the program."""

from __future__ import annotations

import os
import shutil
import tempfile
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import _program
from ._errors import Interrupted, PoesyWarning, StudyError
from ._mechanism import with_line
from ._program import Progress
from ._result import Result
from ._study import write_study


def run(
    study: Mapping[str, Any] | str | os.PathLike[str],
    *,
    output: str | os.PathLike[str] | None = None,
    threads: int | None = None,
    seed: int | None = None,
    progress: Callable[[Progress], object] | bool | None = None,
    resume: bool = False,
    yes: bool = False,
) -> Result:
    """Runs a study to its end, and returns its result.

    It is not an error if a limit is not kept or if tolerances are not certified; ``result.verdict`` tells. If more
    samples did not converge than the study allows, there is a `PoesyWarning`.

    Parameters
    ----------
    study
        The path of a study file, or its content as a dict (engine/docs/study-file.md). In a dict, ``format`` and
        ``version`` may be left out, a `Mechanism` may replace its table, and files are relative to the current folder.
    output
        Path of the result file. Default: a file in a temporary folder, which is removed together with the `Result`.
    threads
        Number of threads; default: one for each processor. The result does not depend on it.
    seed
        Seed of the draws, in place of the study's.
    progress
        Called every five seconds of a long run with a `Progress`; ``True`` prints it.
    resume
        Continues a stopped run of the same study to the same output. Starts from the beginning if there is no
        checkpoint.
    yes
        Allows a run that will take more than a day; otherwise such a run raises `StudyError`.

    Returns
    -------
    Result

    Raises
    ------
    StudyError
        For a wrong study or argument; nothing was written.
    FileError
        If a file cannot be read or written.
    Interrupted
        If another process stopped the run; the checkpoint beside `output` is kept.
    KeyboardInterrupt
        On Ctrl-C, after the program has stopped and kept its checkpoint. A note has the program's command to resume. It
        also works if `study` is a dict, because the folder with the study's file is kept.
    ProgramNotFound, InternalError
        If there is no program, or if it fails.
    """
    with prepared(study, output) as place:
        words = arguments(place, threads, seed, progress, resume, yes)
        done = _program.start(["run", *words], on_progress=listener(progress), unnamed=place.unnamed)
        result = result_of(done, place.result)
    return place.kept(result)


@dataclass(frozen=True)
class Prepared:
    """The files of one call of the program."""

    study: Path  # the study's file
    result: Path  # the result's file
    unnamed: str | None  # the study's file if the user does not know it
    folder: Path | None  # a temporary folder with the study's file, the result's file, or both
    own: bool  # whether the result is in that folder

    def kept(self, result: Result) -> Result:
        """The result, after its temporary folder is removed or bound to it, so that the folder is removed with it."""
        if self.folder is not None and self.own:
            result.keep_folder(self.folder)
        else:
            _remove(self.folder)
        return result


@contextmanager
def prepared(
    study: Mapping[str, Any] | str | os.PathLike[str], output: str | os.PathLike[str] | None
) -> Iterator[Prepared]:
    """Prepares the files. A dict is written as a study file, and its folder is removed on errors except
    interruptions."""
    folder = None
    text = ""
    if isinstance(study, Mapping) or output is None:
        folder = Path(tempfile.mkdtemp(prefix="poesy-"))
    try:
        if isinstance(study, Mapping):
            assert folder is not None
            path, text = write_study(study, folder)
        else:
            path = Path(study)
        result_path = Path(output) if output is not None else Path(folder or ".") / "study.h5"
        yield Prepared(path, result_path, str(path) if text else None, folder, output is None)
    except (Interrupted, KeyboardInterrupt):
        raise
    except StudyError as error:
        _remove(folder)
        raise with_line(error, str(folder / path.name), "study", text) if folder is not None and text else error from None
    except BaseException:
        _remove(folder)
        raise


def _remove(folder: Path | None) -> None:
    if folder is not None:
        shutil.rmtree(folder, ignore_errors=True)


def arguments(
    place: Prepared,
    threads: int | None,
    seed: int | None,
    progress: Callable[[Progress], object] | bool | None,
    resume: bool,
    yes: bool,
) -> list[str]:
    words = [str(place.study), "-o", str(place.result)]
    for option, value in (("--threads", threads), ("--seed", seed)):
        if value is not None:
            words += [option, str(value)]
    if resume:
        words.append("--resume")
    if yes:
        words.append("--yes")
    if not progress:
        words.append("--quiet")
    return words


def listener(progress: Callable[[Progress], object] | bool | None) -> Callable[[Progress], object] | None:
    return progress if callable(progress) else print if progress else None


def result_of(done: _program.Finished, path: Path) -> Result:
    if done.code == _program.TOO_MANY_NOT_CONVERGED:
        words = done.messages[-1] if done.messages else "too many samples did not converge"
        warnings.warn(words, PoesyWarning, stacklevel=3)
    elif done.code not in (_program.DONE, _program.LIMIT_NOT_KEPT):
        raise _program.exception_of(done)
    return Result(path, tuple(done.messages))
