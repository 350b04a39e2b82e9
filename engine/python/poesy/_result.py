"""A result file: what it holds, ranked, drawn and as arrays."""

from __future__ import annotations

import os
import shutil
import tomllib
import weakref
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from . import _h5, _program
from ._constant import constant_responses
from ._errors import DamagedFile, FileError, NotInResult
from ._plot import Plots
from ._ranking import Ranking, ranking, to_salib
from ._units import shown
from ._verdict import verdict

if TYPE_CHECKING:
    import xarray

# Axes whose entries have units of their own: where the names and the units are.
_LEADING = ("tip_position", "position")  # the responses that come first where there are no limits (engine/result/headline.h)
_UNITS = {
    "response": ("responses/name", "responses/unit"),
    "factor": ("factors/name", "factors/unit"),
    "part": ("allocation/part", "allocation/unit"),
}


class Result:
    """A result of any kind of study. `run` and `read` give it.

    Numbers in arrays are SI (m, rad, s), as in the file; numbers in rankings and plots are in mm and deg, as the program
    shows them. Groups are read when they are first asked for.

    Attributes
    ----------
    path : pathlib.Path
        The file.
    kind : str
        "sensitivity", "monte-carlo", "sobol", "allocation", "identification", "coupling", "evaluate" or a later one.
    model, title : str
        Name of the mechanism; title of the study.
    attrs : dict
        Attributes of the file: version of poesy, its commit, the hash of the content, and the above.
    study : dict
        The study with every default filled in, and quantities as text in SI: ``study["analysis"]["samples"]``.
    verdict : str or None
        "kept", "not kept" or "undecided" where the study states limits, "certified" or "not certified" where it looks for
        tolerances, ``None`` where nothing was to be judged.
    messages : tuple of str
        What the program said of the run, without its progress; empty for a file that was read.
    """

    def __init__(self, path: str | os.PathLike[str], messages: tuple[str, ...] = ()) -> None:
        self.path = Path(path)
        self.messages = messages
        self._groups: dict[str, xarray.Dataset] = {}
        self._constant: frozenset[str] | None = None
        with _h5.opened(self.path) as file:
            self.attrs = _h5.attributes(file)
            self.kind, self.model, self.title = (str(self.attrs[name]) for name in ("kind", "model", "title"))
            self._names = tuple(_h5.group_names(file))
            self._study_text = _h5.text(file, "study/text")
            self._units = {
                axis: dict(zip(_h5.texts(file, names), _h5.texts(file, units)))
                for axis, (names, units) in _UNITS.items() if names in file and units in file
            }  # fmt: skip
            self._descriptions = {
                axis: dict(zip(_h5.texts(file, f"{axis}s/name"), _h5.texts(file, f"{axis}s/description")))
                for axis in ("response", "factor")
            }
            self.verdict = verdict(file)
        self.study: dict[str, Any] = tomllib.loads(self._study_text)

    def keep_folder(self, folder: Path) -> None:
        """Removes this folder, which holds the file, together with the result."""
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)

    def __repr__(self) -> str:
        judged = f", {self.verdict}" if self.verdict else ""
        return f"<poesy {self.kind} result of {self.model}{judged}: {self.path}>"

    @property
    def plot(self) -> Plots:
        """Pictures: ``result.plot.ranking()``."""
        return Plots(self)

    @property
    def groups(self) -> tuple[str, ...]:
        """Names of the file's groups: "poses", "sensitivity", "sensitivity/history", ..."""
        return self._names

    @overload
    def to_xarray(self) -> dict[str, xarray.Dataset]: ...
    @overload
    def to_xarray(self, group: str) -> xarray.Dataset: ...
    def to_xarray(self, group: str | None = None) -> dict[str, xarray.Dataset] | xarray.Dataset:
        """Every group as a Dataset, or one of them.

        Dimensions have the names and labels of the file's own axes, so ``.sel(response="gap", factor="delta_1_1_y")``
        works. Each variable has ``unit`` and ``description`` in its attributes, again as ``units`` and ``long_name`` for
        xarray's own plots. Values are SI. Where the entries of an axis have units of their own, the coordinates
        ``response_unit``, ``factor_unit`` and ``part_unit`` have them.

        Raises
        ------
        NotInResult
            For a group that this result does not have; the message lists those that it has.
        DamagedFile
            Where the file is damaged there.
        """
        if group is None:
            return {name: self.to_xarray(name) for name in self._names}
        if group not in self._names:
            raise NotInResult(f"{self.path}: there is no group '{group}'; it has {', '.join(self._names)}")
        if group not in self._groups:
            with _h5.opened(self.path) as file:
                self._groups[group] = _h5.dataset_of(file[group], self._units)
        return self._groups[group].copy(deep=True)

    def units(self, axis: str) -> dict[str, str]:
        """SI units by name. axis: "response", "factor" (errors) or "part"."""
        return dict(self._units.get(axis, {}))

    def description(self, axis: str, name: str) -> str:
        """A response or an error in words: which limb, joint and axis. axis: "response" or "factor"."""
        return self._descriptions.get(axis, {}).get(name, "")

    @property
    def constant(self) -> frozenset[str]:
        """Names of the responses that do not vary: what their samples scatter, if they do, is rounding. No error has a share
        of them. Of kinds sensitivity, sobol, monte-carlo and coupling; of others none is said not to vary."""
        if self._constant is None:
            with _h5.opened(self.path) as file:
                self._constant = constant_responses(self.kind, file)
        return self._constant

    def response(self, name: str | None = None) -> str:
        """The response of this name, or the one that the program ranks by. Of those that vary it is a response with a
        limit, the one whose limit is missed most often; without limits the displacement of the tool, without a tool that
        of the platform; else of those that the mechanism puts first the first that is a length, or the first. Raises
        `NotInResult` for a name that it does not have."""
        units = self._units["response"]
        if name is None:
            listed = self.to_xarray("responses").attrs.get("headline", list(units))
            listed = [listed] if isinstance(listed, str) else list(listed)
            leading = [*self._limited(), *(one for one in _LEADING if one in listed)]
            order = list(dict.fromkeys([*leading, *listed]))
            order = [one for one in order if one not in self.constant] or order
            return order[0] if order[0] in leading else next((one for one in order if units[one] == "m"), order[0])
        if name not in units:
            raise NotInResult(f"{self.path}: there is no response '{name}'; it has {', '.join(units)}")
        return name

    def _limited(self) -> list[str]:
        """Responses with limits, the one whose limit is missed most often first."""
        if "limits" not in self._names:
            return []
        limits = self.to_xarray("limits")
        missed = 1.0 - limits["within"].values / np.maximum(limits["tried"].values, 1)
        return [str(limits["response"].values[k]) for k in np.argsort(-missed, kind="stable")]

    def response_unit(self, name: str) -> tuple[str, float]:
        """The unit in which people read a response, and its size in SI: ("mm", 0.001)."""
        return shown(self._units["response"][name])

    def ranking(self, response: str | None = None) -> Ranking:
        """What the study ranks, most important first, in the program's order and with its numbers.

        ==============  ===================================================================
        kind            rows
        ==============  ===================================================================
        sensitivity     errors by effect, index x sigma, with intervals (`SensitivityRow`)
        sobol           errors or groups by total index ST, over the poses (`SobolRow`)
        monte-carlo     errors by first-order index S1 (`MonteCarloRow`); of a limited response with
                        draws per machine by share of its mean square (`YieldRow`)
        allocation      parts by cost, else by share of the mean square (`AllocationRow`)
        identification  errors by whether they deform the mechanism (`IdentificationRow`)
        ==============  ===================================================================

        By a response that does not vary (`Result.constant`) shares have no rows, and the title says why.

        Parameters
        ----------
        response
            By which to rank; default: the one of `poesy show`; with draws per machine and limits the limited one that
            rejects most machines.

        Raises
        ------
        NotInResult
            For a kind that ranks nothing, and for a response that is not there.
        """
        return ranking(self, response)

    def to_salib(self, response: str | None = None) -> dict[str, Any]:
        """Sobol' indices over the poses together, as SALib's ``sobol.analyze`` gives them.

        Returns
        -------
        dict
            ``names``, and arrays [D] ``S1``, ``S1_conf``, ``ST``, ``ST_conf``, where ``_conf`` is half of the interval; with
            ``second_order = true`` also ``S2`` and ``S2_conf`` [D x D], each pair once, above the diagonal.

        Raises
        ------
        NotInResult
            Where the study is not of kind sobol.
        """
        return to_salib(self, response)

    def show(self, *options: str) -> str:
        """The tables of ``poesy show``, with its options: ``print(result.show("--top", "5"))``.

        Raises as the program does.
        """
        return _program.call("show", self.path.absolute(), *options)

    def report(self, path: str | os.PathLike[str]) -> Path:
        """Writes the report of ``poesy report``, one HTML file that needs nothing else. Raises as the program does."""
        _program.call("report", self.path.absolute(), "-o", path)
        return Path(path)

    def verify(self) -> None:
        """Recomputes the hash of the content. Raises `DamagedFile` where it is not the one in the file."""
        try:
            _program.call("verify", self.path.absolute())
        except FileError as error:
            raise DamagedFile(str(error)) from None


def read(path: str | os.PathLike[str]) -> Result:
    """Reads a result of any kind.

    Raises
    ------
    FileError
        Where there is no such file.
    DamagedFile
        Where it is no result of poesy, is damaged, or is of a version of the format that this package does not read.
    """
    return Result(path)
