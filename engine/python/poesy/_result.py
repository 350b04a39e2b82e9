"""A result file, with its data as rankings, pictures and arrays."""

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

_LEADING = ("tip_position", "position")  # lead if there are no limits (engine/result/headline.h)
# For each axis whose entries have their own units, the datasets with the names and the units.
_UNITS = {
    "response": ("responses/name", "responses/unit"),
    "factor": ("factors/name", "factors/unit"),
    "part": ("allocation/part", "allocation/unit"),
}


class Result:
    """A result of any kind of study, as `run` and `read` return it.

    Numbers in arrays are SI (m, rad, s), as in the file. Numbers in rankings and plots are in mm and deg, as the
    program shows them. Groups are read on first use.

    Attributes
    ----------
    path : pathlib.Path
        The result file.
    kind : str
        "sensitivity", "monte-carlo", "sobol", "allocation", "identification", "coupling", "evaluate", "sweep" or a later
        one.
    model, title : str
        Name of the mechanism; title of the study.
    attrs : dict
        Attributes of the file: version and commit of poesy, hash of the content, kind, model and title.
    study : dict
        The study with every default filled in, and quantities as text in SI: ``study["analysis"]["samples"]``.
    verdict : str or None
        "kept", "not kept" or "undecided" if the study states limits, "certified" or "not certified" if it looks for
        tolerances, ``None`` if the study asks for no judgement.
    messages : tuple of str
        Messages of the program about the run, without its progress; empty for a file that was read.
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
        """Makes the folder that holds the result file be removed together with this object."""
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)

    def __repr__(self) -> str:
        judged = f", {self.verdict}" if self.verdict else ""
        return f"<poesy {self.kind} result of {self.model}{judged}: {self.path}>"

    @property
    def plot(self) -> Plots:
        """Methods that draw the result, such as ``result.plot.ranking()``."""
        return Plots(self)

    @property
    def groups(self) -> tuple[str, ...]:
        """The names of the file's groups: "poses", "sensitivity", "sensitivity/history", ..."""
        return self._names

    @overload
    def to_xarray(self) -> dict[str, xarray.Dataset]: ...
    @overload
    def to_xarray(self, group: str) -> xarray.Dataset: ...
    def to_xarray(self, group: str | None = None) -> dict[str, xarray.Dataset] | xarray.Dataset:
        """All groups as Datasets by name, or one group as a Dataset.

        Dimensions have the names and labels of the file's axes, so ``.sel(response="gap", factor="delta_1_1_y")``
        works. Each variable has the attributes ``unit`` and ``description``, and again as ``units`` and ``long_name``
        for the plots of xarray. Values are SI. If the entries of an axis have their own units, these are in the
        coordinates ``response_unit``, ``factor_unit`` and ``part_unit``.

        Raises
        ------
        NotInResult
            If the result lacks the group; the message lists its groups.
        DamagedFile
            If this part of the file is damaged.
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
        """The SI units on an axis by name. axis: "response", "factor" (errors) or "part"."""
        return dict(self._units.get(axis, {}))

    def description(self, axis: str, name: str) -> str:
        """The description of a response or an error, such as its limb, joint and axis. axis: "response" or "factor"."""
        return self._descriptions.get(axis, {}).get(name, "")

    @property
    def constant(self) -> frozenset[str]:
        """The names of responses that do not vary, apart from rounding errors. No error has a share of them. They are
        known for the kinds sensitivity, sobol, monte-carlo and coupling; for other kinds the set is empty."""
        if self._constant is None:
            with _h5.opened(self.path) as file:
                self._constant = constant_responses(self.kind, file)
        return self._constant

    def response(self, name: str | None = None) -> str:
        """The response of this name, or by default the one by which the program ranks, chosen from those that vary.

        It is the response whose limit is missed most often. Without limits it is the displacement of the tool, or else
        of the platform. If there is neither, it is the first length among the responses that the mechanism puts first,
        or else the first of these. Raises `NotInResult` for a name that the result does not have."""
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
        """The responses with limits, those first whose limits are missed most often."""
        if "limits" not in self._names:
            return []
        limits = self.to_xarray("limits")
        missed = 1.0 - limits["within"].values / np.maximum(limits["tried"].values, 1)
        return [str(limits["response"].values[k]) for k in np.argsort(-missed, kind="stable")]

    def response_unit(self, name: str) -> tuple[str, float]:
        """The unit in which the program shows a response, and the size of this unit in SI: ("mm", 0.001)."""
        return shown(self._units["response"][name])

    def ranking(self, response: str | None = None) -> Ranking:
        """The ranking of errors or parts, the most important first, in the order and with the numbers of the program.

        ==============  ===================================================================
        kind            rows
        ==============  ===================================================================
        sensitivity     errors by effect, index x sigma, with intervals (`SensitivityRow`)
        sobol           errors or groups by total index ST, over the poses (`SobolRow`)
        monte-carlo     errors by first-order index S1 (`MonteCarloRow`); of a limited response with
                        draws per machine by share of its scatter (`YieldRow`)
        allocation      parts by cost, else by share of the mean square (`AllocationRow`)
        identification  errors by whether they deform the mechanism (`IdentificationRow`)
        ==============  ===================================================================

        For a response that does not vary (`Result.constant`), a ranking by shares has no rows, and its title says why.

        Parameters
        ----------
        response
            Response by which to rank; default: that of `poesy show`. With draws per machine and limits, the default is
            the limited response that rejects most machines.

        Raises
        ------
        NotInResult
            For a kind without a ranking, and for a response that the result does not have.
        """
        return ranking(self, response)

    def to_salib(self, response: str | None = None) -> dict[str, Any]:
        """The Sobol' indices over all poses together, in the form that ``sobol.analyze`` of SALib returns.

        Returns
        -------
        dict
            ``names``, and arrays [D] ``S1``, ``S1_conf``, ``ST``, ``ST_conf``, where ``_conf`` is half of the interval; with
            ``second_order = true`` also ``S2`` and ``S2_conf`` [D x D], each pair once, above the diagonal.

        Raises
        ------
        NotInResult
            If the study is not of kind sobol.
        """
        return to_salib(self, response)

    def show(self, *options: str) -> str:
        """The tables of ``poesy show``, with its options: ``print(result.show("--top", "5"))``.

        Raises the exceptions of the program's exit codes.
        """
        return _program.call("show", self.path.absolute(), *options)

    def report(self, path: str | os.PathLike[str]) -> Path:
        """Writes the report of ``poesy report``, one HTML file that needs no other file. Raises as `show` does."""
        _program.call("report", self.path.absolute(), "-o", path)
        return Path(path)

    def verify(self) -> None:
        """Recomputes the hash of the content. Raises `DamagedFile` if the file states another hash."""
        try:
            _program.call("verify", self.path.absolute())
        except FileError as error:
            raise DamagedFile(str(error)) from None


def read(path: str | os.PathLike[str]) -> Result:
    """Reads a result of any kind.

    Raises
    ------
    FileError
        If the file does not exist.
    DamagedFile
        If it is not a result of poesy, is damaged, or has a version of the format that this package does not read.
    """
    return Result(path)
