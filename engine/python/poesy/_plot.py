"""Pictures of a result in matplotlib, in the units that the program shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _ranking
from ._constant import constant_text
from ._errors import NotInResult
from ._units import Unit, labelled, shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._result import Result

_QUANTITIES = ("rms", "mean", "std", "min", "max")
_BAR, _LINE = "#7da7d9", "#1f3b5c"
_RANKED = {
    "effect": "effect on {response}",
    "ST": "ST, share of the variance of {response}",
    "S1": "S1, share of the variance of {response}",
    "cost": "cost",
    "mean_square_share": "share of the scatter of {response}",
    "part_share": "share of the mean square under the tightest limit",
    "deformation": "deformation by the error alone, relative to the largest",
}


@dataclass(frozen=True)
class _Field:
    """A quantity at each of M poses."""

    values: Any  # [M] in `unit`
    label: str
    unit: str


class Plots:
    """Pictures of one result. Each method draws into `ax`, or into a new figure, and returns the Axes.

    If the result lacks the data, a method raises `NotInResult`, whose message names the kinds that have them.
    """

    def __init__(self, result: Result) -> None:
        self._result = result

    def ranking(self, response: str | None = None, *, top: int = 20, ax: Axes | None = None) -> Axes:
        """Draws the ranking of `Result.ranking` as bars, the first on top, with intervals if they are known.

        Parameters
        ----------
        response
            Response by which to rank; default: that of `poesy show`.
        top
            Largest number of rows.
        """
        ranked = self._result.ranking(response)[:top]
        if not ranked.rows:
            raise NotInResult(f"{self._result.path}: {ranked.title}")
        words = _RANKED["part_share" if ranked.what == "part" and ranked.value != "cost" else ranked.value]
        values = np.array([getattr(row, ranked.value) for row in ranked])
        at = np.arange(len(values))
        axes = _axes(ax, 1.4 + 0.27 * len(values))
        axes.barh(at, values, color=_BAR)
        low, high = ([getattr(row, f"{ranked.value}_{end}", None) for row in ranked] for end in ("low", "high"))
        if None not in low:
            axes.hlines(at, low, high, color=_LINE)
            for ends in (low, high):  # marks show an interval that is too short to be seen
                axes.plot(ends, at, "|", color=_LINE, markersize=4)
        axes.set_yticks(at, [row.name for row in ranked])
        axes.invert_yaxis()
        axes.margins(y=0.01)
        label = words.format(response="" if "{" not in words else self._result.response(response))
        axes.set_xlabel(labelled(label, ranked.units.get(ranked.value, "")))
        axes.set_title(_title(self._result))
        return axes

    def field(
        self,
        response: str | None = None,
        of: str | None = None,
        *,
        quantity: str | None = None,
        x: str | None = None,
        y: str | None = None,
        ax: Axes | None = None,
    ) -> Axes:
        """Draws a quantity at each pose, as colour over two pose coordinates. For a trajectory, as a line over time.

        ==============  ============================================================  ==============================
        kind            what is drawn                                                 `of`
        ==============  ============================================================  ==============================
        sensitivity     effect of an error: its local index x sigma                   the error; default: the first
        sobol           total index ST of an error or group                           likewise
        monte-carlo     `quantity`: "rms" (default), "mean", "std", "min", "max"
        evaluate        the response; default: the largest magnitude of all rows      the case, or number of the row
        coupling        effect of sources, at the largest size                        the sources; default: all
        allocation      root mean square over what the limit allows it, predicted
        ==============  ============================================================  ==============================

        Parameters
        ----------
        response
            Response to draw; default: that of `poesy show`, for an allocation the first one with a limit.
        x, y
            Pose coordinates; default: the first two that differ between poses. Points may hide each other, because
            poses have more than two dimensions. With `x` alone, values are drawn over that coordinate.
        """
        shown_field = self._field(response, of, quantity)
        poses = self._result.to_xarray("poses")
        names: list[str | None] = [x, y] if x is not None else [*self._coordinates()]
        chosen = [_coordinate(self._result, poses, name) for name in names if name is not None]
        axes = _axes(ax, 4.2)
        axes.set_title(_title(self._result))
        axes.set_xlabel(chosen[0].label)
        if len(chosen) == 1:
            order = np.argsort(chosen[0].values, kind="stable")
            style = "-" if names[0] == "time" else "o"
            axes.plot(chosen[0].values[order], shown_field.values[order], style, color=_LINE)
            axes.set_ylabel(labelled(shown_field.label, shown_field.unit))
            return axes
        drawn = axes.scatter(chosen[0].values, chosen[1].values, c=shown_field.values, cmap="viridis", s=40)
        axes.set_ylabel(chosen[1].label)
        axes.figure.colorbar(drawn, ax=axes, label=labelled(shown_field.label, shown_field.unit))
        return axes

    def main_effects(
        self, response: str | None = None, errors: str | Sequence[str] | None = None, *, ax: Axes | None = None
    ) -> Axes:
        """Draws the mean of a response over the value of one error, while all others vary. A band is its interval.

        For results of kind monte-carlo.

        Parameters
        ----------
        errors
            One error, drawn over its value, or several, drawn over their values in standard deviations. Default: the
            four errors with the largest S1.
        """
        result = self._result
        if "monte_carlo/main_effect" not in result.groups:
            lacks = f"this result of kind {result.kind} has no main effects"
            raise NotInResult(f"{result.path}: {lacks}; results of kind monte-carlo have them")
        response = result.response(response)
        _expect_shares(result, response)
        group = result.to_xarray("monte_carlo/main_effect").sel(response=response)
        factors = result.to_xarray("factors")
        names = [str(name) for name in factors["name"].values]
        if errors is None:
            errors = [row.name for row in result.ranking(response) if row.name in names][:4]
        wanted = [errors] if isinstance(errors, str) else list(errors)
        for name in wanted:
            if name not in names:
                raise NotInResult(f"{result.path}: there is no error '{name}'; ranking() lists those that vary")
        unit = Unit(*result.response_unit(response))
        axes = _axes(ax, 4.2)
        for name in wanted:
            at, error_unit = names.index(name), shown(result.units("factor")[name])
            scale = error_unit.si if len(wanted) == 1 else float(factors["sigma"].values[at])
            curve = group.sel(factor=name)
            over = group["error"].sel(factor=name).values / scale
            line = axes.plot(over, curve["mean"].values / unit.si, label=name)[0]
            low, high = curve["ci_low"].values / unit.si, curve["ci_high"].values / unit.si
            axes.fill_between(over, low, high, alpha=0.2, color=line.get_color())
        alone = len(wanted) == 1
        axes.set_xlabel(labelled(wanted[0], error_unit.name) if alone else "error [standard deviations]")
        axes.set_ylabel(labelled(f"mean of {response}", unit.name))
        if not alone:
            axes.legend()
        axes.set_title(_title(result))
        return axes

    def yields(self, *, ax: Axes | None = None) -> Axes:
        """Draws the share of good machines with its interval, first under all limits, then under each limit alone.

        For results of kind monte-carlo with draws per machine and limits, and of kind allocation, whose machines are
        those of the certificate. A dotted line is the yield that the study asks for.
        """
        names, shares = self._shares()
        axes = _axes(ax, 1.4 + 0.4 * len(names))
        at = np.arange(len(names))
        value, low, high = (100.0 * np.array(shares).T)
        axes.errorbar(value, at, xerr=[value - low, high - value], fmt="o", color=_LINE, capsize=3)
        axes.set_yticks(at, names)
        axes.set_ylim(len(names) - 0.5, -0.5)
        asked = self._asked()
        if asked is not None:
            axes.axvline(100.0 * asked, linestyle=":", color="black", label=f"asked: {100.0 * asked:g} %")
            axes.legend()
        axes.set_xlabel("good machines [%]")
        axes.set_title(_title(self._result))
        return axes

    def sweep(self, quantity: str | None = None, *, ax: Axes | None = None) -> Axes:
        """Draws a figure of merit over the first key of a sweep, with its interval as a band. There is a line for each
        combination of the other keys.

        For results of kind sweep.

        Parameters
        ----------
        quantity
            Figure of merit: "yield", "root mean square of gap", ...; default: the first one of the result.
        """
        result = self._result
        if result.kind != "sweep":
            raise NotInResult(f"{result.path}: this result of kind {result.kind} is of one design; poesy.sweep compares several")
        group = result.to_xarray("sweep")
        quantities = [str(name) for name in group["quantity"].values]
        quantity = quantity or quantities[0]
        found = _selected(result, group, "quantity", quantity)
        keys = [str(key).rsplit(".", 1)[-1] for key in group["key"].values]
        texts = [[str(value) for value in row] for row in group["value"].values]
        first = [row[0] for row in texts]
        curves = next((n for n, value in enumerate(first) if value != first[0]), len(first))
        over = group["number"].values[::curves, 0]
        numbers = not np.isnan(over).any()
        over = over if numbers else np.arange(len(over))
        axes = _axes(ax, 4.2)
        for c in range(curves):
            name = ", ".join(f"{key} = {value}" for key, value in zip(keys[1:], texts[c][1:]))
            line = axes.plot(over, found["merit"].values[c::curves], "o-", markersize=3, label=name)[0]
            low, high = (found[end].values[c::curves] for end in ("low", "high"))
            if not np.isnan(low).all():
                axes.fill_between(over, low, high, alpha=0.2, linewidth=0, color=line.get_color())
        if not numbers:
            axes.set_xticks(over, first[::curves])
        axes.set_xlabel(labelled(keys[0], str(group["unit"].values[0])))
        axes.set_ylabel(labelled(quantity, str(found["quantity_unit"].values)))
        if curves > 1:
            axes.legend()
        axes.set_title(_title(result))
        return axes

    def _asked(self) -> float | None:
        asked = self._result.study.get("analysis", {}).get("yield")
        return float(asked) if asked else None

    def _shares(self) -> tuple[list[str], list[list[float]]]:
        result = self._result
        if result.kind == "allocation":
            found = result.to_xarray("allocation/certificate")
            return ["all limits"], [[float(found[name]) for name in ("yield", "ci_low", "ci_high")]]
        if "yield" not in result.groups:
            raise NotInResult(
                f"{result.path}: this result of kind {result.kind} has no yield; a study of kind monte-carlo with "
                'draws = "per machine" and [analysis.limits] has, and one of kind allocation'
            )
        found = result.to_xarray("yield")
        names, shares = ["all limits"], [[float(found[name]) for name in ("value", "ci_low", "ci_high")]]
        for response in found["response"].values:
            alone = found.sel(response=response)
            if not np.isnan(float(alone["by_response"])):
                names.append(str(response))
                shares.append([float(alone[f"by_response{end}"]) for end in ("", "_ci_low", "_ci_high")])
        return names, shares

    def _coordinates(self) -> list[str]:
        """The coordinates to draw over: time, or the first one or two pose coordinates that differ between poses."""
        poses = self._result.to_xarray("poses")
        if "time" in poses:
            return ["time"]
        listed = poses.attrs["coordinates"]
        names = [listed] if isinstance(listed, str) else list(listed)
        return [name for name in names if np.ptp(poses[name].values) > 0.0][:2] or names[:1]

    def _field(self, response: str | None, of: str | None, quantity: str | None) -> _Field:
        result = self._result
        fields = {
            "sensitivity": _sensitivity_field,
            "sobol": _sobol_field,
            "evaluate": _evaluate_field,
            "coupling": _coupling_field,
        }
        if result.kind == "monte-carlo":
            return _monte_carlo_field(result, response, quantity)
        if result.kind == "allocation":
            return _allocation_field(result, response)
        if result.kind not in fields:
            known = ", ".join([*fields, "monte-carlo", "allocation"])
            lacks = f"a result of kind {result.kind} has no values over poses to draw"
            raise NotInResult(f"{result.path}: {lacks}; kinds that have: {known}")
        return fields[result.kind](result, result.response(response), of)


def _sensitivity_field(result: Result, response: str, of: str | None) -> _Field:
    error = of or result.ranking(response)[0].name
    group = result.to_xarray("sensitivity").sel(response=response)
    found = _selected(result, group, "factor", error)
    sigma = float(result.to_xarray("factors")["sigma"].values[list(group["factor"].values).index(error)])
    rounding = float(found["rounding"]) / sigma
    unit = Unit(*result.response_unit(response))
    local = [_ranking.told_from_rounding(float(value), rounding) for value in found["local"].values]
    return _Field(np.array(local) * sigma / unit.si, f"effect of {error} on {response}", unit.name)


def _expect_shares(result: Result, response: str) -> None:
    if response in result.constant:
        raise NotInResult(f"{result.path}: {constant_text(response)}; ranking() begins with a response that varies")


def _sobol_field(result: Result, response: str, of: str | None) -> _Field:
    _expect_shares(result, response)
    name = of or result.ranking(response)[0].name
    group = result.to_xarray("sobol").sel(response=response)
    found = _selected(result, group, "group" if "group" in group.dims else "factor", name)
    return _Field(found["ST"].values, f"ST of {name} on {response}", "")


def _monte_carlo_field(result: Result, response: str | None, quantity: str | None) -> _Field:
    name = result.response(response)
    unit = Unit(*result.response_unit(name))
    group = result.to_xarray("monte_carlo").sel(response=name)
    quantity = quantity or _QUANTITIES[0]
    if quantity not in _QUANTITIES:
        raise NotInResult(f"{result.path}: quantity is {quantity!r}; it is one of {', '.join(_QUANTITIES)}")
    return _Field(group[quantity].values / unit.si, f"{quantity} of {name}", unit.name)


def _evaluate_field(result: Result, response: str, of: str | None) -> _Field:
    unit = Unit(*result.response_unit(response))
    found = result.to_xarray("evaluate")[response]
    rows = next(axis for axis in found.dims if axis != "pose")
    if of is None:
        return _Field(np.abs(found.transpose("pose", rows).values).max(axis=1) / unit.si, f"largest {response}", unit.name)
    names = [str(name) for name in found[rows].values]
    if str(of) not in names:
        raise NotInResult(f"{result.path}: there is no {rows} '{of}'; it has {', '.join(names[:20])}")
    return _Field(found.isel({rows: names.index(str(of))}).values / unit.si, f"{response} of {rows} {of}", unit.name)


def _coupling_field(result: Result, response: str, of: str | None) -> _Field:
    unit = Unit(*result.response_unit(response))
    found = result.to_xarray("coupling")["effect"].sel(response=response).isel(size=-1)
    subset = of or str(found["subset"].values[-1])
    chosen = _selected(result, found, "subset", subset)
    return _Field(chosen.values / unit.si, f"effect of {subset} on {response} at {chosen['size'].values}", unit.name)


def _allocation_field(result: Result, response: str | None) -> _Field:
    found = result.to_xarray("allocation")
    limited = [str(name) for name, limit in zip(found["response"].values, found["limit"].values) if not np.isnan(limit)]
    name = limited[0] if response is None else result.response(response)
    if name not in limited:
        raise NotInResult(f"{result.path}: {name} has no limit in this study; {', '.join(limited)} has")
    return _Field(100.0 * found["limit_use"].sel(response=name).values, f"rms of {name} over what its limit allows", "%")


def _selected(result: Result, data: Any, axis: str, name: str) -> Any:
    known = [str(one) for one in data[axis].values]
    if name not in known:
        again = "; for another response, sweep again with --response" if result.kind == "sweep" else ""
        raise NotInResult(f"{result.path}: there is no {axis} '{name}'; it has {', '.join(known)}{again}")
    return data.sel({axis: name})


@dataclass(frozen=True)
class _Coordinate:
    values: Any  # [M]
    label: str


def _coordinate(result: Result, poses: Any, name: str) -> _Coordinate:
    if name not in poses or poses[name].dims != ("pose",):
        known = [str(one) for one in poses.data_vars if poses[one].dims == ("pose",)]
        raise NotInResult(f"{result.path}: poses have no coordinate '{name}'; they have {', '.join(known)}")
    unit = shown(poses[name].attrs["unit"])
    return _Coordinate(poses[name].values / unit.si, labelled(name, unit.name))


def _axes(ax: Axes | None, height: float) -> Axes:
    if ax is not None:
        return ax
    from matplotlib import pyplot  # imported here, because the package must work without a screen and matplotlib

    return pyplot.subplots(figsize=(7.0, height), layout="constrained")[1]


def _title(result: Result) -> str:
    return result.title or f"{result.kind} of {result.model}"
