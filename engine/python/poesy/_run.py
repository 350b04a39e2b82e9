"""Runs a study by the program."""

from __future__ import annotations

import os
import shutil
import tempfile
import warnings
from collections.abc import Callable, Mapping
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
    """Runs a study to its end and gives its result.

    A study that answers "no" is no error: where a limit is not kept, or tolerances are not certified, ``result.verdict``
    says so. Where more samples did not converge than the study allows, that is warned of (`PoesyWarning`).

    Parameters
    ----------
    study
        A dict with what a study file holds (engine/docs/study-file.md); ``format`` and ``version`` may be left out, a
        `Mechanism` may stand for its table, and files are relative to the current folder. Or the path of a study file.
    output
        The result file. Default: a file in a temporary folder, which is removed with the `Result`.
    threads
        Default: one for each processor. The numbers do not depend on it.
    seed
        Instead of the study's.
    progress
        Called every five seconds of a long run with a `Progress`; ``True`` prints it.
    resume
        Continues a run of the same study to the same output that was stopped; starts it where it kept no checkpoint.
    yes
        Starts a run that is going to take more than a day; without it that is a `StudyError`.

    Returns
    -------
    Result

    Raises
    ------
    StudyError
        For a wrong study or argument; nothing was written.
    FileError
        Where a file cannot be read or written.
    Interrupted
        Where another process stopped the run; the checkpoint beside `output` is kept.
    KeyboardInterrupt
        On Ctrl-C, after the program has stopped and kept its checkpoint. A note says how to resume: the program's command
        works, with a dict for `study` too, because the folder with the study's file is then kept.
    ProgramNotFound, InternalError
        Where there is no program, or it fails.
    """
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
        words = _arguments(path, result_path, threads, seed, progress, resume, yes)
        done = _program.start(words, on_progress=_listener(progress), unnamed=str(path) if text else None)
        result = _result_of(done, result_path)
    except (Interrupted, KeyboardInterrupt):
        raise
    except StudyError as error:
        _remove(folder)
        raise with_line(error, str(folder / path.name), "study", text) if folder is not None and text else error from None
    except BaseException:
        _remove(folder)
        raise
    if folder is not None and output is None:
        result.keep_folder(folder)
    else:
        _remove(folder)
    return result


def _remove(folder: Path | None) -> None:
    if folder is not None:
        shutil.rmtree(folder, ignore_errors=True)


def _arguments(
    study: Path,
    result: Path,
    threads: int | None,
    seed: int | None,
    progress: Callable[[Progress], object] | bool | None,
    resume: bool,
    yes: bool,
) -> list[str]:
    words = ["run", str(study), "-o", str(result)]
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


def _listener(progress: Callable[[Progress], object] | bool | None) -> Callable[[Progress], object] | None:
    return progress if callable(progress) else print if progress else None


def _result_of(done: _program.Finished, path: Path) -> Result:
    if done.code == _program.TOO_MANY_NOT_CONVERGED:
        words = done.messages[-1] if done.messages else "too many samples did not converge"
        warnings.warn(words, PoesyWarning, stacklevel=3)
    elif done.code not in (_program.DONE, _program.LIMIT_NOT_KEPT):
        raise _program.exception_of(done)
    return Result(path, tuple(done.messages))
