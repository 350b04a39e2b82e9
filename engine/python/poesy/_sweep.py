"""Runs a study for several values of its keys, with the program."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from . import _program
from ._program import Progress
from ._result import Result
from ._run import arguments, listener, prepared, result_of


def sweep(
    study: Mapping[str, Any] | str | os.PathLike[str],
    values: Mapping[str, str | Sequence[Any]],
    *,
    output: str | os.PathLike[str] | None = None,
    response: str | None = None,
    threads: int | None = None,
    seed: int | None = None,
    progress: Callable[[Progress], object] | bool | None = None,
    resume: bool = False,
    yes: bool = False,
) -> Result:
    """Runs a study for each combination of values of its keys, with the same draws, and compares the designs.

    >>> radii = poesy.sweep("tricept.toml", {"geometry.a": "150:375:25 mm"})          # doctest: +SKIP
    >>> radii.to_xarray("sweep")["merit"].sel(quantity="yield")                       # doctest: +SKIP

    The numbers of each design have the same bits as those of `poesy.run` for its study. The group "sweep" of the result
    has the values, the figures of merit with their intervals, and their changes from the first design and
    from the best one. Intervals of changes take into account that all designs use the same draws.
    ``result.plot.sweep()`` draws the figures of merit.

    Parameters
    ----------
    study
        As for `poesy.run`.
    values
        The values of each key, by its full name (``"errors.linear.sigma"``; ``"geometry.R"`` is short for
        ``"mechanism.geometry.R"``): a range ``"FROM:TO:STEP"`` with a unit at its end, or a list of values with units,
        ``["20 um", "50 um"]``.
    response
        Response whose root mean square is compared. Default: the one by which the first design ranks errors.
    output, threads, seed, progress, resume, yes
        As for `poesy.run`. The stages of `Progress` are the designs.

    Returns
    -------
    Result
        A result of kind "sweep".

    Raises
    ------
    StudyError
        For a wrong study, key or value, or a study without a figure of merit; nothing was written.
    FileError, Interrupted, KeyboardInterrupt, ProgramNotFound, InternalError
        As `poesy.run` does.
    """
    with prepared(study, output) as place:
        words = arguments(place, threads, seed, progress, resume, yes)
        for key, given in values.items():
            words += ["--set", f"{key}={given if isinstance(given, str) else ','.join(map(str, given))}"]
        if response is not None:
            words += ["--response", response]
        done = _program.start(["sweep", *words], on_progress=listener(progress), unnamed=place.unnamed)
        result = result_of(done, place.result)
    return place.kept(result)
