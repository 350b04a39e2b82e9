#!/usr/bin/env python3
"""Reads a sensitivity result of poesy; prints its errors ranked by what they do, draws them as bars with intervals.

read_result loads a result of any kind by its groups; what ranks needs a sensitivity result.

usage: read_results.py RESULT.h5 [--response NAME] [--top N] [-o ranked.svg]

In a program of your own:

    from read_results import read_result, ranked_errors
    result = read_result("study.h5")
    result.groups["sensitivity"]["global"].sel(response="linear_deformation", factor="delta_1_1_y")

Packages of pip and conda-forge: h5py h5netcdf xarray matplotlib. Debian's: python3-h5py python3-h5netcdf python3-xarray
python3-matplotlib.
"""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path

try:
    import h5netcdf  # noqa: F401  xarray reads by it
    import h5py
    import numpy as np
    import xarray
    from matplotlib.figure import Figure
except ImportError as missing:
    sys.exit(
        f"read_results.py: {missing}; needs h5py, h5netcdf, xarray and matplotlib for this Python ({sys.executable}): "
        "pip install h5py h5netcdf xarray matplotlib, or conda install -c conda-forge with the same names; for Debian's "
        "own Python: apt-get install python3-h5py python3-h5netcdf python3-xarray python3-matplotlib, and run it by "
        "/usr/bin/python3"
    )

MAJOR = 1  # of the format
HDF5_FILTERS = {1, 2, 3, 4, 5, 6}  # any other is a plugin, which HDF5 would look for and run
ROUNDING = 1e-10  # an index below it, in SI, is zero but for rounding
# In which unit people read an SI unit, and how many of it are one of that; any other unit is shown as it is.
DISPLAY = {"m": ("mm", 1e3), "rad": ("deg", 180.0 / math.pi)}
INDEX = "global_corrected"  # the index, as `poesy show` has it
LEADING = ("tip_position", "position")  # the responses that come first where there are no limits
FIGURES = (".svg", ".png", ".pdf")


class ResultError(Exception):
    """A file that cannot serve, with the reason and what to do."""


@dataclass(frozen=True)
class Result:
    """A result of any kind. Each group of the file is a Dataset: axes have names, variables a unit; numbers are SI."""

    path: str
    kind: str  # as in the study: "sensitivity", "monte-carlo", "allocation", ...
    model: str
    title: str
    groups: dict[str, xarray.Dataset]

    def units(self, axis: str) -> dict[str, str]:
        """SI units by name; axis: "factor" or "response"."""
        named = self.groups[axis + "s"]
        return dict(zip(named["name"].values, named["unit"].values))


@dataclass(frozen=True)
class RankedError:
    """What one error does to a response. An index and its interval, and the same times sigma."""

    factor: str
    sigma: float  # standard deviation of the error, mm or deg
    sigma_unit: str
    index: tuple[float, float, float]  # value, lower and upper end of the interval
    index_unit: str  # "mm/deg"
    effect: tuple[float, float, float]  # index x sigma
    effect_unit: str  # "mm"


def stranger(file: h5py.File) -> str:
    """What is not as poesy writes it, where HDF5 might read other files for it; "" if each link leads to a group or dataset
    whose values are here. Looks at no value; 'poesy verify' does the same."""
    seen = {h5py.h5o.get_info(file["/"].id).addr}
    groups = [(b"/", 0)]
    while groups:
        group, depth = groups.pop()
        links: list[tuple[bytes, int]] = []
        here = h5py.h5g.open(file.id, group)  # kept, or its links cannot be listed
        here.links.iterate(lambda name, info: links.append((name, info.type)), info=True)
        for name, link in links:
            path = group.rstrip(b"/") + b"/" + name
            shown = "".join(one if one.isprintable() else "?" for one in path.decode(errors="replace"))[:300]
            if link != h5py.h5l.TYPE_HARD or b"/" in name or name in (b"", b"."):
                return f"{shown} is a link to something else"
            thing = h5py.h5o.open(file.id, path)
            if isinstance(thing, h5py.h5d.DatasetID):
                stored = thing.get_create_plist()
                filters = {stored.get_filter(k)[0] for k in range(stored.get_nfilters())}
                if stored.get_layout() == h5py.h5d.VIRTUAL or stored.get_external_count() or filters - HDF5_FILTERS:
                    return f"{shown} has its values in other files, or needs a plugin"
                continue
            address = h5py.h5o.get_info(thing).addr
            if not isinstance(thing, h5py.h5g.GroupID) or address in seen or depth == 16:
                return f"{shown} is no group of a tree"
            seen.add(address)
            groups.append((path, depth + 1))
    return ""


def read_result(path: str) -> Result:
    """Reads a whole file. Raises ResultError where it is no result, one of another major version, or reads other files."""
    if Path(path).exists() and not Path(path).is_file():
        raise ResultError(f"{path}: is a folder, a FIFO or a device; give a result file")
    try:
        with h5py.File(path, "r") as file:
            about = dict(file.attrs)
            strange = stranger(file)
            names = [] if strange else [name for name, thing in file.items() if isinstance(thing, h5py.Group)]
    except OSError as error:
        raise ResultError(f"{path}: cannot be read as HDF5: {error}") from error
    if about.get("filetype") != "poesy-result":
        found = about.get("filetype", "none")
        raise ResultError(f"{path}: not a result of poesy (attribute filetype: {found}); results come from 'poesy run'")
    major, minor = about["version"]
    if major != MAJOR:
        raise ResultError(f"{path}: version {major}.{minor}, this reads {MAJOR}.x; take the script of that version")
    if strange:
        raise ResultError(f"{path}: {strange}, and a result reads nothing but itself; do not trust it; take another copy")
    groups = {name: xarray.load_dataset(path, engine="h5netcdf", group=name) for name in names}
    return Result(str(path), about["kind"], about["model"], about["title"], groups)


def default_response(result: Result) -> str:
    """As `poesy show`: of the responses that the model puts first the displacement of the tool, without a tool that of the
    platform, else the first length, or the first of them."""
    units = result.units("response")
    headline = list(np.atleast_1d(result.groups["responses"].attrs.get("headline", list(units))))
    headline.sort(key=lambda name: LEADING.index(name) if name in LEADING else len(LEADING))
    return headline[0] if headline[0] in LEADING else next((name for name in headline if units[name] == "m"), headline[0])


def ranked_errors(result: Result, response: str | None = None) -> list[RankedError]:
    """The errors by their effect, global index x sigma, the largest first; those without an index last.

    The index is the corrected one, as in `poesy show`.
    """
    if "sensitivity" not in result.groups:
        kind = f"of kind {result.kind}, which has no indices"
        raise ResultError(f"{result.path}: {kind}; give a result of a sensitivity study")
    response = response or default_response(result)
    if response not in result.units("response"):
        known = ", ".join(result.units("response"))
        raise ResultError(f"{result.path}: there is no response '{response}'; it has {known}")
    found = result.groups["sensitivity"].sel(response=response)
    sigma = dict(zip(result.groups["factors"]["name"].values, result.groups["factors"]["sigma"].values))

    def spread(factor: str) -> float:
        value = float(found[INDEX].sel(factor=factor)) * sigma[factor]
        return -1.0 if math.isnan(value) else value

    order = sorted(sigma, key=spread, reverse=True)
    return [_ranked_error(result, response, factor, sigma[factor]) for factor in order]


def _ranked_error(result: Result, response: str, factor: str, sigma: float) -> RankedError:
    si = result.units("response")[response]
    effect_unit, to_effect = DISPLAY.get(si, (si, 1.0))
    si = result.units("factor")[factor]
    sigma_unit, to_sigma = DISPLAY.get(si, (si, 1.0))
    at = result.groups["sensitivity"].sel(response=response, factor=factor)
    index = [float(at[INDEX + end]) for end in ("", "_ci_low", "_ci_high")]
    rounding = max(ROUNDING, float(at["rounding"]) / sigma)
    index = [0.0 if abs(value) < rounding else value for value in index]
    return RankedError(
        factor,
        sigma * to_sigma,
        sigma_unit,
        tuple(value * to_effect / to_sigma for value in index),
        f"{effect_unit}/{sigma_unit}",
        tuple(value * sigma * to_effect for value in index),
        effect_unit,
    )


def table(ranked: list[RankedError]) -> str:
    """One line for each error."""
    lines = [f"{'rank':>4}  {'error':<16} {'index':>9}  {'interval':<21} {'':<8} {'sigma':>12} {'effect':>14}"]
    for rank, error in enumerate(ranked, start=1):
        index, low, high = error.index
        lines.append(
            f"{rank:>4}  {error.factor:<16} {index:>9.4g}  {f'[{low:.4g}, {high:.4g}]':<21} {error.index_unit:<8} "
            f"{error.sigma:>8.4g} {error.sigma_unit:<3} {error.effect[0]:>10.4g} {error.effect_unit:<3}".rstrip()
        )
    return "\n".join(lines)


def draw(ranked: list[RankedError], title: str, path: str) -> None:
    """Bars of the effects, the largest on top, with their intervals. The name of the file says its format."""
    effect, low, high = np.array([error.effect for error in ranked]).T
    rows = np.arange(len(ranked))
    figure = Figure(figsize=(7.0, 1.2 + 0.25 * len(ranked)), layout="constrained")
    axes = figure.subplots()
    axes.barh(rows, effect, color="#7da7d9")
    axes.hlines(rows, low, high, color="black")
    axes.set_yticks(rows, [error.factor for error in ranked])
    axes.margins(y=0.01)
    axes.invert_yaxis()
    axes.set_xlabel(f"global index x sigma [{ranked[0].effect_unit}]")
    axes.set_title(title)
    figure.savefig(path)


def main() -> None:
    parser = argparse.ArgumentParser(description="Prints and draws the errors of a sensitivity result, ranked.")
    parser.add_argument("result", help="RESULT.h5 of 'poesy run'")
    parser.add_argument("--response", help="rank by this response; default: as 'poesy show'")
    parser.add_argument("--top", type=int, help="only the first N errors")
    parser.add_argument("-o", dest="figure", help="draw the bars here: " + ", ".join("*" + end for end in FIGURES))
    asked = parser.parse_args()
    if asked.top is not None and asked.top < 1:
        parser.error("--top must be at least 1")
    if asked.figure and Path(asked.figure).suffix not in FIGURES:
        parser.error(f"-o {asked.figure}: the name must end in {', '.join(FIGURES)}")
    try:
        result = read_result(asked.result)
        ranked = ranked_errors(result, asked.response)[: asked.top]
    except ResultError as error:
        sys.exit(f"read_results.py: {error}")
    level = 100.0 * float(result.groups["sensitivity"].attrs["conf_level"])
    title = f"{asked.response or default_response(result)} of {result.model}, with {level:.3g} % intervals"
    print(f"Effect of each error on {title}")
    print(table(ranked))
    if asked.figure:
        draw(ranked, title, asked.figure)


if __name__ == "__main__":
    main()
