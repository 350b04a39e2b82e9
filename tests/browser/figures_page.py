"""Writes a page like that of a report, with all types and varieties of figures, at the sizes of the largest studies.

figures_page.py WEB PAGE.html; WEB is the folder of the build with the scripts of reports.
"""

import base64
import html
import json
import sys
from pathlib import Path

import numpy as np

RESPONSES = ["linear_deformation", "angular_deformation"]
UNITS = ["mm per mm", "mrad per mm"]
NO_EFFECT = "share that is 0 everywhere"


class Page:
    def __init__(self):
        self.random = np.random.default_rng(7)
        self.figures = {}
        self.arrays = {}

    def array(self, numbers):
        name = f"a{len(self.arrays)}"
        self.arrays[name] = base64.b64encode(np.asarray(numbers, "<f4").tobytes()).decode()
        return name

    def interval(self, numbers, width=0.08):
        numbers = np.asarray(numbers)
        ends = {"low": 1 - width, "high": 1 + width}
        return {"value": self.array(numbers)} | {end: self.array(numbers * scale) for end, scale in ends.items()}


def errors(count):
    return [f"delta_{1 + i // 15}_{1 + i // 3 % 5}_{'xyz'[i % 3]}" for i in range(count)]


def add_bars(page):
    local = page.random.gamma(0.6, 1, (2, 71)) * [[1], [3e-6]]
    local[:, 5] = np.nan
    page.figures["ranking"] = {
        "type": "bars", "choices": [{"label": "Response", "options": RESPONSES}],
        "quantities": [
            {"label": "Global index", "units": UNITS, **page.interval(local)},
            {"label": "Effect at the size that the study sets", "units": [["mm"] * 40 + ["mrad"] * 31] * 2,
             "value": page.array(local * 2), "low": None, "high": None},
        ],
        "items": errors(71), "sort": "value"}
    page.figures["compared"] = {
        "type": "bars",
        "quantities": [
            {"label": "Global index", "units": ["mm per mm"], **page.interval(page.random.gamma(1, 1, (2, 1, 9)))}],
        "items": errors(9), "series": ["gauss-newton", "first-order"], "sort": "value"}
    page.figures["removable"] = {
        "type": "bars",
        "quantities": [
            {"label": "Change", "units": [""], "value": page.array([0.3, -0.2, 0.1, 0]), "low": None, "high": None}],
        "items": ["a", "b", "c", "d"], "sort": "none"}


def coordinates(page, poses, count):
    names = [("z", "mm"), ("alpha", "deg"), ("beta", "deg"), ("reach", "mm")]
    low = np.array([500, -30, -20, 0.1])[:, None]
    high = np.array([700, 30, 20, 0.4])[:, None]
    return [{"name": name, "unit": unit, "value": page.array(numbers)}
            for (name, unit), numbers in zip(names[:count], page.random.uniform(low, high, (4, poses)))]


def add_fields(page, key, rows, poses, coordinate_count):
    field = np.abs(np.sin(np.linspace(0, 9, poses))[None, :] * np.linspace(0.1, 2, rows)[:, None]) + 0.02
    field[3 % rows, : poses // 5] = np.nan
    columns = coordinates(page, poses, coordinate_count)
    thinned = {"numbers": page.array(np.arange(poses) * 3)} if key == "large" else {}
    page.figures[f"map_{key}"] = {
        "type": "heatmap", "rows": errors(rows),
        "columns": {"label": "pose", "coordinates": columns, **thinned},
        "layers": [{"label": label, "unit": unit, "value": page.array(field * scale)}
                   for label, unit, scale in zip([*RESPONSES, NO_EFFECT], [*UNITS, "%"], [1, 1e-5, 0])]}
    page.figures[f"workspace_{key}"] = {
        "type": "workspace", "coordinates": columns, **thinned,
        "fields": [{"label": "Mean linear deformation", "unit": "mm", "value": page.array(field[-1])},
                   {"label": "Signed change", "unit": "1", "value": page.array(1e-5 * (field[0] - field[-1]))},
                   {"label": "Local index", "unit": "mm per mm", "rows": errors(rows), "value": page.array(field)}]}


def add_plane(page):
    """Poses of a plane, so that one of three coordinates is the same for all."""
    columns = coordinates(page, 30, 3)
    columns[1]["value"] = page.array(np.full(30, 5.0))
    page.figures["workspace_plane"] = {
        "type": "workspace", "coordinates": columns,
        "fields": [{"label": "Signed change", "unit": "mm", "value": page.array(page.random.normal(0, 1, 30))}]}


def add_lines(page):
    samples = np.geomspace(100, 20000, 12).astype(int)
    def series(label, style="solid"):
        end = page.random.gamma(1, 1)
        numbers = end * (1 + page.random.normal(0, 1, 12) / np.sqrt(samples))
        band = end * 2 / np.sqrt(samples)
        return {"label": label, "style": style, "value": page.array(numbers),
                "low": page.array(numbers - band), "high": page.array(numbers + band)}
    page.figures["history"] = {
        "type": "lines", "x": {"label": "samples", "unit": "", "value": page.array(samples), "log": True}, "most": 8,
        "panels": [{"label": label, "unit": unit, "series": [series(name) for name in errors(25)]}
                   for label, unit in zip(RESPONSES, UNITS)]}
    time = np.linspace(0, 2, 158)
    curve = lambda phase: {"value": page.array(1e-4 * np.sin(3 * time + phase))}
    page.figures["trajectory"] = {
        "type": "lines", "x": {"label": "time", "unit": "s", "value": page.array(time), "log": False}, "most": 4,
        "panels": [{"label": f"tip_{name}", "unit": "mm", "series": [
            {"label": label, "style": style, **curve(k)} for k, (label, style) in
            enumerate([("FS", "solid"), ("FS+T", "dashed"), ("FS+T+R, a set with quite a long name", "dotted")])]}
            for name in "xyzabc"]}
    poses = np.arange(60)
    page.figures["by_pose"] = {
        "type": "lines", "x": {"label": "pose number", "unit": "", "value": page.array(poses), "log": False}, "most": 4,
        "panels": [
            {"label": "share", "unit": "%", "series": [
                {"label": label, "value": page.array(0 * poses)} for label in ("mean", "worst case of all")]},
            {"label": "spread", "unit": "mm", "series": [
                {"label": label, "style": style, **page.interval(page.random.gamma(9, 1, 60))}
                for label, style in [("mean", "solid"), ("worst case of all", "dashed")]]}]}


def add_scatter(page):
    first = page.random.gamma(0.7, 1, (2, 71))
    page.figures["agreement"] = {
        "type": "scatter", "choices": [{"label": "Response", "options": RESPONSES}],
        "x": {"label": "gauss-newton", "value": page.array(first)},
        "y": {"label": "first-order", "value": page.array(first * page.random.normal(1, 0.1, (2, 71)))},
        "units": UNITS, "names": errors(71)}


def add_what_if(page):
    """Machines with one limit on the norm of two components, and one on a value from -1 to 2; costs fall as 1 / size."""
    machines, poses, errors_count = 300, 2, 4
    deviations = page.random.normal(0, 1, (errors_count, machines))
    slopes = page.random.normal(0, 0.25, (poses, 3, errors_count))
    factors = [0.5, 0.75, 1, 1.5, 2]
    names = ["delta_1_4_y", "hole with quite a long name of its own, rail_lean_x_1", "epsilon_2_1_z"]
    page.figures["what-if"] = {
        "type": "whatIf", "factors": factors, "machines": machines, "poses": poses,
        "sliders": [{"name": name, "sizes": [{"label": "position", "value": 0.1 * (k + 1), "unit": "mm"}] * (k + 1),
                     "errors": slots, "costs": [1 / factor for factor in factors]}
                    for k, (name, slots) in enumerate(zip(names, [[0], [1, 3], [2]]))],
        "limits": [{"components": 2, "low": -1, "high": 1}, {"components": 1, "low": -1, "high": None}],
        "components": page.array(np.einsum("kce,eb->kcb", slopes, deviations)), "deviations": page.array(deviations),
        "slopes": page.array(slopes), "yield": [0.8, 0.78, 0.82], "quantile": 1.96, "linearError": 0.02, "missed": 0.001,
        "otherCosts": 10}


def add_extremes(page):
    page.figures["nothing"] = {
        "type": "lines", "x": {"label": "time", "unit": "s", "value": page.array([0, 1]), "log": False}, "most": 4,
        "panels": [{"label": "tip_x", "unit": "mm", "series": []}]}
    page.figures["negative"] = {
        "type": "scatter", "x": {"label": "A", "value": page.array([-4, -2])},
        "y": {"label": "B", "value": page.array([-3, -1])}, "units": ["mm"], "names": ["a", "b"]}


def add_apart(page):
    """Two series a hundredfold apart, one of them 0 once, as bars and as dots; and poses in the order of |beta|."""
    first = np.array([2.0, 1.0, 0.5, 0.2])
    second = first / [150, 50, 120, np.inf]
    quantity = {"label": "effect", "units": ["mm"], "value": page.array([first, second]), "low": None, "high": None}
    page.figures["bars"] = {"type": "bars", "quantities": [quantity], "items": errors(4), "series": ["A", "B"]}
    page.figures["dots"] = {
        "type": "scatter", "x": {"label": "A", "value": page.array(first)}, "units": ["mm"], "names": errors(4),
        "y": {"label": "B", "value": page.array(second)}}
    beta = {"name": "beta", "unit": "deg", "value": page.array([-30, 10, 20, -5])}
    page.figures["map"] = {
        "type": "heatmap", "rows": errors(1), "columns": {"label": "pose", "coordinates": [beta], "order": "|beta|"},
        "layers": [{"label": "B - A", "unit": "mm", "signed": True, "value": page.array([-4, -2, -3, -1])}]}


def add_small_fields(page):
    add_fields(page, "small", 25, 158, 3)


def add_other_fields(page):
    add_fields(page, "large", 71, 1738, 4)
    add_fields(page, "flat", 2, 12, 1)


ALL = (add_bars, add_small_fields, add_other_fields, add_lines, add_scatter, add_what_if)


def figures_page(web, *adds):
    """The text of the page with the figures that are added; with all of them where none is named."""
    page = Page()
    for add in adds or ALL:
        add(page)
    sections = "".join(
        f'<section id="{key}" aria-labelledby="{key}-h"><h2 id="{key}-h">{key}</h2><p>Which errors matter.</p>'
        f'<figure data-figure="{key}"><div class="plot"></div><figcaption>What is seen.</figcaption></figure></section>'
        for key in page.figures)
    read = lambda name: (Path(web) / name).read_text()
    everything = {"about": {"delta_1_1_x": "a shift of the first hole"}, "figures": page.figures, "arrays": page.arrays}
    data = json.dumps(everything).replace("<", "\\u003c")
    policy = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:"
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<meta http-equiv="Content-Security-Policy" content="{html.escape(policy)}">'
        f'<title>Figures</title><style>{read("report.css")}</style></head>'
        '<body><a class="skip" href="#main">Skip to the results</a>'
        f'<header><h1>Figures</h1></header><main id="main">{sections}</main><footer>poesy</footer>'
        f'<script type="application/json" id="report-data">{data}</script>'
        + "".join(f"<script>{read(name)}</script>" for name in ("d3.js", "plot.js", "report.js"))
        + "</body></html>")


if __name__ == "__main__":
    Path(sys.argv[2]).write_text(figures_page(sys.argv[1]))
