"""The figure of a result for a paper, in a journal's width and type size and without a title."""

from __future__ import annotations

import errno
import io
import os
import re
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import FileError, NotInResult, StudyError
from ._units import labelled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ._result import Result

_INCH = 25.4  # mm
_MILLIMETRES = {"mm": 1.0, "cm": 10.0, "in": _INCH}
_ENDS = (".pdf", ".svg", ".png")
_MOST_BARS = 15
_POINTS = 8
_CHARACTER, _BESIDE, _KEY = 1.5, 20.0, 12.0  # mm: of a character, of what is beside axes, of a line in a legend
# One column of most journals is 85 mm wide, two are 170 mm; type is 8 points. Text stays text in PDF and SVG.
_STYLE: dict[str, Any] = {
    **dict.fromkeys(("font.size", "axes.labelsize", "xtick.labelsize", "ytick.labelsize", "legend.fontsize"), _POINTS),
    "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6, "lines.linewidth": 1.0,
    "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False,
    "pdf.fonttype": 42, "svg.fonttype": "none", "svg.hashsalt": "poesy", "savefig.dpi": 600,
}  # fmt: skip


def figure(
    result: Result,
    path: str | os.PathLike[str] | None = None,
    *,
    response: str | None = None,
    size: str | float = "85 mm",
    top: int = _MOST_BARS,
) -> Figure:
    """Draws the figure of a result for a paper, and writes it to `path` if this is given.

    ====================================================  ==============================================================
    kind                                                  figure
    ====================================================  ==============================================================
    sensitivity, sobol, monte-carlo, allocation,          what `Result.ranking` ranks, at most `top` bars, with intervals
    identification
    coupling, evaluate                                    the response over the poses
    sweep                                                 the first figure of merit over the values, with intervals
    calibration                                           standardised residuals of all measured values
    ====================================================  ==============================================================

    Type has 8 points, and text can be searched. There is no title, because a paper has a caption. The same result gives
    the same bytes.

    Parameters
    ----------
    path
        Ends in .pdf, .svg or .png.
    response
        Response to draw; default: that of `poesy show`. For a sweep the figure of merit, such as "yield".
    size
        Width of the figure: "85 mm" for a column, "170 mm" for a page, or any from 40 to 400 mm. A number is in mm.
    top
        Largest number of bars of a ranking.

    Raises
    ------
    NotInResult
        For a response that the result does not have.
    StudyError
        For any other size or ending.
    """
    import matplotlib
    from matplotlib.figure import Figure

    width = _width(size)
    if top < 1:
        raise StudyError(f"a figure of {top} bars shows nothing; give top = 1 or more")
    if path is not None and Path(path).suffix not in _ENDS:
        raise StudyError(f"{os.fspath(path)}: a figure ends in {', '.join(_ENDS)}")
    draw, height = _drawing(result, response, top)
    with matplotlib.rc_context(_STYLE):
        drawn = Figure(figsize=(width / _INCH, height(width) / _INCH), layout="constrained")
        axes = drawn.add_subplot()
        draw(axes)
        axes.set_title("")
        _fit_texts(drawn)
        if path is not None:
            _save(drawn, Path(path))
    return drawn


def _fit_texts(drawn: Figure) -> None:
    """Breaks labels that are longer than the figure, and puts the legend above the axes, where it hides nothing."""
    width, height = (_INCH * inches for inches in drawn.get_size_inches())
    drawn.draw_without_rendering()  # so that the axes have their widths
    for axes in drawn.axes:
        room = min(width - _BESIDE, width - _INCH * axes.get_window_extent().x0 / drawn.dpi)  # beside long names of bars
        axes.set_xlabel(textwrap.fill(axes.get_xlabel(), int(room / _CHARACTER)).replace("\u00a0", " "))
        axes.set_ylabel(textwrap.fill(axes.get_ylabel(), int((height - _BESIDE / 2) / _CHARACTER)))
    axes = drawn.axes[0]
    if axes.get_legend() is not None:
        names = axes.get_legend_handles_labels()[1]
        columns = int((width - _BESIDE) / (_CHARACTER * max(map(len, names)) + _KEY))
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncol=max(1, min(columns, len(names))))


def _width(size: str | float) -> float:
    """Reads a width, and returns it in mm."""
    found = re.fullmatch(r"\s*([\d.]+)\s*(mm|cm|in)?\s*", str(size))
    try:
        width = float(found[1]) * _MILLIMETRES[found[2] or "mm"] if found else np.nan
    except ValueError:
        width = np.nan
    if not 40.0 <= width <= 400.0:
        raise StudyError(f"the size of a figure is {size!r}; give its width, 40 to 400 mm, e.g. 85mm or 170mm")
    return width


def _save(drawn: Figure, path: Path) -> None:
    """Writes a figure without dates. The file appears complete or not at all."""
    dates = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}.get(path.suffix, {})
    drawing = io.BytesIO()
    drawn.savefig(drawing, format=path.suffix[1:], metadata=dates)
    partial = path.with_name(f"{path.name}.tmp.{os.getpid()}")
    try:
        partial.write_bytes(drawing.getvalue())
        partial.replace(path)
    except OSError as error:
        remedy = "make room, or write it elsewhere" if error.errno == errno.ENOSPC else "write it elsewhere"
        raise FileError(f"{path}: cannot be written ({error.strerror}); {remedy}") from error
    finally:
        partial.unlink(missing_ok=True)


def _drawing(result: Result, response: str | None, top: int) -> tuple[Callable[[Axes], object], Callable[[float], float]]:
    """The function that draws the figure of this kind, and the function that gives its height for a width, both in
    mm."""
    plot = result.plot
    if result.kind == "sweep":
        return (lambda axes: plot.sweep(response, ax=axes)), (lambda width: 0.7 * min(width, 120.0))
    if result.kind == "calibration":
        return (lambda axes: _residuals(result, axes)), (lambda width: 0.7 * min(width, 120.0))
    if result.kind in ("coupling", "evaluate"):
        return (lambda axes: plot.field(response, ax=axes)), (lambda width: 0.75 * min(width, 120.0))
    ranked = len(result.ranking(response).rows)

    def ranking(axes: Axes) -> None:
        plot.ranking(response, top=top, ax=axes)
        if ranked > top:
            # Blanks at which lines do not break; _fit_texts() makes them usual ones.
            axes.set_xlabel(f"{axes.get_xlabel()}: the\u00a0first\u00a0{top}\u00a0of\u00a0{ranked}")

    return ranking, (lambda _: 14.0 + 4.2 * min(ranked, top))


def _residuals(result: Result, axes: Axes) -> None:
    """Draws the standardised residuals in the order of the measurements, and the limit beyond which they are
    outliers."""
    found = result.to_xarray("calibration")
    if "converged" in found and not int(found["converged"]):
        raise NotInResult(f"{result.path}: the fit did not converge, so its residuals mean nothing")
    values = found["standardised"].values
    if np.isnan(values).all():
        raise NotInResult(f"{result.path}: residuals have no standard deviation, because the noise is 0")
    outliers = found["outlier"].values != 0
    numbers = np.arange(1, len(values) + 1)
    axes.plot(numbers[~outliers], values[~outliers], "o", markersize=3, label="measured")
    if outliers.any():
        axes.plot(numbers[outliers], values[outliers], "x", markersize=4, label="outlier")
    for side, label in ((-1.0, None), (1.0, "limit of outliers")):
        axes.axhline(side * float(found["outlier_limit"]), linestyle=":", color="black", linewidth=0.6, label=label)
    axes.legend()
    axes.set_xlabel("number of the measured value")
    axes.set_ylabel(labelled("standardised residual", ""))
