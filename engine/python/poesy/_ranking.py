"""The ranking of a result as a small table."""

from __future__ import annotations

import html
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from ._constant import INDEX_ROUNDING, constant_text
from ._errors import NotInResult
from ._units import shown

if TYPE_CHECKING:
    import xarray

    from ._result import Result

# The same limits as in the program. Rounding errors above the first hide indices of interest (engine/stats/indices.h).
# With fewer samples at a pose than the second, there is no first-order index (engine/stats/first_order.h).
_INDEX_OF_INTEREST = 1e-6
_FEWEST_INDEX_SAMPLES = 64
_ROWS_SHOWN = 20


@dataclass(frozen=True)
class SensitivityRow:
    """An error, and its effect on the response on its own. Index and effect have the ends of their intervals. They are
    zero if they are only rounding errors, and NaN if the error is too small to tell."""

    rank: int
    name: str
    effect: float  #: effect at the error's size in the study, index x sigma, in `effect_unit`
    effect_low: float
    effect_high: float
    effect_unit: str
    index: float  #: standard deviation of the response over that of the error, in `index_unit`
    index_low: float
    index_high: float
    index_unit: str  #: unit of the index, "mm/deg"
    sigma: float  #: standard deviation of the error in the study, in `unit`
    unit: str
    description: str


@dataclass(frozen=True)
class SobolRow:
    """An error or a group of errors, and its shares of the response's variance, taken over all poses together."""

    rank: int
    name: str
    ST: float  #: total index: the share with all interactions
    ST_low: float
    ST_high: float
    S1: float  #: first-order index: the share of the error alone
    S1_low: float
    S1_high: float
    description: str


@dataclass(frozen=True)
class MonteCarloRow:
    """An error, and its first-order index S1: its own share of the response's variance, estimated from the study's
    draws. NaN if the error is correlated with others."""

    rank: int
    name: str
    S1: float
    S1_low: float
    S1_high: float
    description: str


@dataclass(frozen=True)
class YieldRow:
    """An error in a study of machines with limits, and its share of the limited response's scatter, to first order.
    The share is NaN if the error is correlated with others; one more row, "6 correlated errors together", has the
    share of all of them."""

    rank: int
    name: str
    mean_square_share: float  #: over all poses; for a norm the share for its vector
    mean_square_share_low: float
    mean_square_share_high: float
    change: float  #: change of the yield if the error's sigma grows by a tenth
    change_low: float
    change_high: float
    description: str


@dataclass(frozen=True)
class AllocationRow:
    """A part, whose errors share one tolerance +-T of the drawing."""

    rank: int
    name: str
    tolerance: float  #: T, in `unit`
    unit: str
    sigma: float  #: standard deviation of the errors about their mean, in `unit`
    cost: float  #: cost in the study's currency; NaN if the study's aim has no costs
    share: float  #: share of the cost of all parts
    mean_square_share: float  #: share of all parts' mean square of the response with the tightest limit
    members: str  #: names of the part's errors, separated by blanks


@dataclass(frozen=True)
class IdentificationRow:
    """An error, and whether it deforms the mechanism."""

    rank: int
    name: str
    verdict: str  #: "deforms alone", "deforms in a coupling" or "absorbed"
    deformation: float  #: largest by it alone over that of all errors, averaged over the groups of sizes; rounding is 0
    share: float  #: share of poses where it deforms alone, averaged over the groups of sizes
    description: str


Row = SensitivityRow | SobolRow | MonteCarloRow | YieldRow | AllocationRow | IdentificationRow


@dataclass(frozen=True)
class Ranking(Sequence[Row]):
    """Rows in the order of their rank, each with named fields: ``ranking[0].name``, ``ranking[:5]``.

    Attributes
    ----------
    title
        What is ranked, and by which quantity.
    value
        Name of the field that determines the order: "effect", "ST", "S1", "cost", "mean_square_share", "share" or
        "deformation".
    what
        What a row is: "error", "group" or "part".
    rows
        The rows, all of the type for the kind of study.
    units
        Units of fields whose unit is the same in all rows: ``{"effect": "mm"}``.
    """

    title: str
    value: str
    what: str
    rows: tuple[Row, ...]
    units: Mapping[str, str] = field(default_factory=dict)

    @overload
    def __getitem__(self, at: int) -> Row: ...
    @overload
    def __getitem__(self, at: slice) -> Ranking: ...
    def __getitem__(self, at: int | slice) -> Row | Ranking:
        return replace(self, rows=self.rows[at]) if isinstance(at, slice) else self.rows[at]

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    def to_dict(self) -> dict[str, list[Any]]:
        """The columns by name, for example for ``pandas.DataFrame(ranking.to_dict())``."""
        names = [one.name for one in fields(self.rows[0])] if self.rows else []
        return {name: [getattr(row, name) for row in self.rows] for name in names}

    def _table(self) -> tuple[list[str], list[list[str]]]:
        """Headings and cells for display, without the descriptions, and with a limited number of rows."""
        columns = self.to_dict()
        columns.pop("description", None)
        for name in ("effect_unit", "index_unit"):
            if len(set(columns.get(name, ()))) == 1:
                columns.pop(name)
        headings = [f"{name} [{self.units[name]}]" if name in self.units else name for name in columns]
        cells = [[_cell(value) for value in row] for row in zip(*columns.values())]
        return headings, cells[:_ROWS_SHOWN]

    def __repr__(self) -> str:
        headings, cells = self._table()
        widths = [max(map(len, column)) for column in zip(headings, *cells)]
        numeric = [all(_is_number(row[at]) for row in cells) for at in range(len(headings))]
        lines = [self.title]
        for row in (headings, *cells):
            padded = (c.rjust(w) if right else c.ljust(w) for c, w, right in zip(row, widths, numeric))
            lines.append("  ".join(padded).rstrip())
        return "\n".join(lines + self._rest())

    def _rest(self) -> list[str]:
        hidden = len(self.rows) - _ROWS_SHOWN
        return [f"... and {hidden} more"] if hidden > 0 else []

    def _repr_html_(self) -> str:
        headings, cells = self._table()
        parts = [f"<table><caption>{html.escape(self.title)}</caption><thead><tr>"]
        parts += [f'<th scope="col">{html.escape(text)}</th>' for text in headings]
        parts.append("</tr></thead><tbody>")
        parts += ["<tr>" + "".join(f"<td>{html.escape(text)}</td>" for text in row) + "</tr>" for row in cells]
        return "".join([*parts, "</tbody></table>", *self._rest()])


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return "-" if math.isnan(value) else f"{value:.4g}"
    return str(value)


def _is_number(cell: str) -> bool:
    return cell == "-" or cell.lstrip("-")[:1].isdigit() or cell.lstrip("-") in ("inf",)


def ranking(result: Result, response: str | None) -> Ranking:
    """See `Result.ranking`."""
    ranks = _KINDS.get(result.kind)
    if ranks is None:
        known = ", ".join(sorted(_KINDS))
        raise NotInResult(
            f"{result.path}: a result of kind {result.kind} ranks nothing; kinds that do: {known}; "
            "to_xarray() has everything that this one has"
        )
    return ranks(result, response)


def told_from_rounding(index: float, rounding: float) -> float:
    """The index, SI. 0 if it is only rounding error, NaN if the error is too small to tell. rounding: the rounding
    error of the response divided by the error's sigma, SI."""
    rounding = max(INDEX_ROUNDING, rounding)
    if math.isnan(index) or index >= rounding:
        return index
    return math.nan if rounding > _INDEX_OF_INTEREST else 0.0


def _in_order(values: Any) -> list[int]:
    """The indices of the values, ordered by value, the largest first and NaN last. Equal values keep their order."""
    return sorted(range(len(values)), key=lambda at: -math.inf if math.isnan(values[at]) else values[at], reverse=True)


def _with_ends(found: xarray.Dataset, name: str) -> list[tuple[float, float, float]]:
    """The values of a variable, each with the ends of its interval."""
    columns = (found[f"{name}{end}"].values.tolist() for end in ("", "_ci_low", "_ci_high"))
    return list(zip(*columns))


def _sensitivity(result: Result, response: str | None) -> Ranking:
    response = result.response(response)
    found = result.to_xarray("sensitivity").sel(response=response)
    factors = result.to_xarray("factors")
    effect_unit = shown(result.units("response")[response])
    names, units = factors["name"].values, factors["unit"].values
    sigmas = factors["sigma"].values
    ends = np.array(_with_ends(found, "global_corrected")).T
    rounding = float(found["rounding"])
    rows: list[Row] = []
    for rank, p in enumerate(_in_order(ends[0] * sigmas), start=1):
        unit = shown(str(units[p]))
        sigma, told = float(sigmas[p]), [told_from_rounding(float(end), rounding / sigmas[p]) for end in ends[:, p]]
        effect, effect_low, effect_high = (index * (sigma / effect_unit.si) for index in told)
        index, index_low, index_high = (index * (unit.si / effect_unit.si) for index in told)
        rows.append(
            SensitivityRow(
                rank, str(names[p]), effect, effect_low, effect_high, effect_unit.name, index, index_low, index_high,
                f"{effect_unit.name}/{unit.name}", sigma / unit.si, unit.name, result.description("factor", str(names[p])),
            )  # fmt: skip
        )
    in_units = dict.fromkeys(("effect", "effect_low", "effect_high"), effect_unit.name)
    if len(set(units)) == 1:
        in_units |= dict.fromkeys(("index", "index_low", "index_high"), f"{effect_unit.name}/{shown(str(units[0])).name}")
    title = f"Effect of each error on {response} at the size the study gives it"
    if response in result.constant and not any(math.isnan(row.index) for row in rows if isinstance(row, SensitivityRow)):
        title = constant_text(response)
    return Ranking(title, "effect", "error", tuple(rows), in_units)


def _sobol(result: Result, response: str | None) -> Ranking:
    response = result.response(response)
    found = result.to_xarray("sobol/aggregated").sel(response=response)
    axis = "group" if "group" in found.dims else "factor"
    what = "group" if axis == "group" else "error"
    if response in result.constant:
        return Ranking(constant_text(response), "ST", what, ())
    names = [str(name) for name in found[axis].values]
    total, alone = (_with_ends(found, name) for name in ("ST", "S1"))
    if axis == "group":
        in_words = dict(zip(names, (str(one) for one in result.to_xarray("sobol")["members"].values)))
    else:
        in_words = {name: result.description("factor", name) for name in names}
    rows = tuple(
        SobolRow(rank, names[g], *total[g], *alone[g], in_words[names[g]])
        for rank, g in enumerate(_in_order([value for value, _, _ in total]), start=1)
    )
    return Ranking(f"Shares of the variance of {response}, over the poses together", "ST", what, rows)


def limited_response(result: Result, response: str | None) -> str | None:
    """The limited response by whose scatter errors are ranked, or None. It must be one whose shares of the scatter
    are known. By default it is the response that rejects most machines."""
    if result.kind != "monte-carlo" or "yield" not in result.groups:
        return None
    found = result.to_xarray("yield")
    if "linear_share" not in found:
        return None
    known = found["by_response"].where(found["linear_share"].notnull()).dropna("response")
    if response is None:
        return str(known["response"].values[int(np.argmin(known.values))]) if known.size else None
    return response if response in known["response"].values else None


def _yield(result: Result, response: str) -> Ranking:
    found = result.to_xarray("yield")
    shares = _with_ends(found.sel(response=response), "mean_square_share")
    changes = _with_ends(found, "change")
    names = [str(name) for name in found["factor"].values]
    texts = [result.description("factor", name) for name in names]
    correlated = [name for name, (value, _, _) in zip(names, shares) if math.isnan(value)]
    if correlated:
        alone = sum(value for value, _, _ in shares if not math.isnan(value))
        together = float(found["linear_share"].sel(response=response)) - alone
        names.append(f"{len(correlated)} correlated errors together")
        shares.append((together if together > 1e-12 else 0.0, math.nan, math.nan))  # less is rounding
        changes.append((math.nan, math.nan, math.nan))
        texts.append(", ".join(correlated))
    rows = tuple(
        YieldRow(rank, names[p], *shares[p], *changes[p], texts[p])
        for rank, p in enumerate(_in_order([value for value, _, _ in shares]), start=1)
    )
    title = f"Shares of the scatter of {response}, which is limited, to first order"
    return Ranking(title, "mean_square_share", "error", rows)


def _monte_carlo(result: Result, response: str | None) -> Ranking:
    limited = limited_response(result, response)
    if limited is not None:
        return _yield(result, limited)
    response = result.response(response)
    found = result.to_xarray("monte_carlo").sel(response=response)
    if response in result.constant:
        return Ranking(constant_text(response), "S1", "error", ())
    alone = _with_ends(found, "S1")
    names = [str(name) for name in found["factor"].values]
    rows = tuple(
        MonteCarloRow(rank, names[p], *alone[p], result.description("factor", names[p]))
        for rank, p in enumerate(_in_order([value for value, _, _ in alone]), start=1)
    )
    title = f"First-order indices: the part of the variance of {response} that an error makes alone"
    if (found["count"].values[found["effect_pose"].values] < _FEWEST_INDEX_SAMPLES).any():
        title += f"; none is formed below {_FEWEST_INDEX_SAMPLES} samples at a pose that count"
    return Ranking(title, "S1", "error", rows)


def _allocation(result: Result, response: str | None) -> Ranking:
    if response is not None:
        raise NotInResult(f"{result.path}: parts are ranked by cost, which belongs to no response; leave response out")
    found = result.to_xarray("allocation")
    has_costs = not bool(np.isnan(found["cost"].values).all())
    rows: list[Row] = []
    by = "share" if has_costs else "mean_square_share"
    for rank, n in enumerate(_in_order(found[by].values), start=1):
        part = found.isel(part=n)
        unit = shown(str(part["unit"].values))
        tolerance, sigma, cost, share, mean_square = (
            float(part[name]) for name in ("tolerance", "sigma", "cost", "share", "mean_square_share")
        )
        rows.append(
            AllocationRow(
                rank, str(part["part"].values), tolerance / unit.si, unit.name, sigma / unit.si, cost, share, mean_square,
                str(part["members"].values),
            )  # fmt: skip
        )
    title = f"Tolerances of {len(rows)} parts, {result.verdict}"
    return Ranking(title, "cost" if has_costs else by, "part", tuple(rows))


def _identification(result: Result, response: str | None) -> Ranking:
    if response is not None:
        raise NotInResult(f"{result.path}: errors deform the mechanism or not, whatever the response; leave response out")
    found = result.to_xarray("identification")
    poses = result.to_xarray("poses").sizes["pose"]
    share = (1.0 - found["single_below"].values / poses).mean(axis=0)
    deformation = _relative(found["single_max"].values, found.attrs["rounding"])
    single, coupled = found["single"].values, found["coupled"].values
    names = [str(name) for name in found["factor"].values]
    order = sorted(range(len(names)), key=lambda p: (single[p], coupled[p], deformation[p]), reverse=True)
    rows = []
    for rank, p in enumerate(order, start=1):
        said = "deforms alone" if single[p] else "deforms in a coupling" if coupled[p] else "absorbed"
        description = result.description("factor", names[p])
        rows.append(IdentificationRow(rank, names[p], said, float(deformation[p]), float(share[p]), description))
    title = f"{int(single.sum())} of {len(names)} errors deform alone, {int(coupled.sum())} with couplings"
    return Ranking(title, "deformation", "error", tuple(rows))


def _relative(largest: Any, rounding: float) -> Any:
    """The mean over the groups of sizes, for each error, of its deformation over the largest of the group. Rounding
    counts as 0, and so does a deformation that was not found because nothing was solved.
    """
    clean = np.where(largest > rounding, largest, 0.0)
    most = clean.max(axis=1, keepdims=True)
    return (clean / np.where(most > 0.0, most, 1.0)).mean(axis=0)


_KINDS: dict[str, Callable[[Result, str | None], Ranking]] = {
    "sensitivity": _sensitivity,
    "sobol": _sobol,
    "monte-carlo": _monte_carlo,
    "allocation": _allocation,
    "identification": _identification,
}


def to_salib(result: Result, response: str | None) -> dict[str, Any]:
    """See `Result.to_salib`."""
    if result.kind != "sobol":
        lacks = f"a result of kind {result.kind} has no Sobol' indices of SALib's form"
        raise NotInResult(f"{result.path}: {lacks}; kind sobol has")
    found = result.to_xarray("sobol/aggregated").sel(response=result.response(response))
    axis = "group" if "group" in found.dims else "factor"
    indices: dict[str, Any] = {"names": [str(name) for name in found[axis].values]}
    for name in ("S1", "ST"):
        indices |= {name: found[name].values.copy(), f"{name}_conf": _half_width(found, name)}
    if "S2" in found:
        below = np.tril_indices(len(indices["names"]))
        for name, values in (("S2", found["S2"].values.copy()), ("S2_conf", _half_width(found, "S2"))):
            values[below] = np.nan  # each pair appears once, as in SALib
            indices[name] = values
    return indices


def _half_width(found: xarray.Dataset, name: str) -> Any:
    return (found[f"{name}_ci_high"].values - found[f"{name}_ci_low"].values) / 2.0
