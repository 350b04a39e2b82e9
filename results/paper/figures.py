#!/usr/bin/env python3
"""Draws the figures of the paper from the results of its studies.

usage: figures.py [POESY]; POESY is the program, by default that of the release build
"""

import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

import studies  # noqa: E402

METRICS = {"published": ("#b35806", "published metric: linear deformation"), "platform": ("#2166ac", "platform's metric: gap")}
plt.rcParams.update({"font.size": 8, "axes.spines.top": False, "axes.spines.right": False, "svg.hashsalt": "poesy"})


def save(figure, name):
    figure.savefig(studies.HERE / name, dpi=200, metadata={"Software": None})
    plt.close(figure)


def draw_rankings(index):
    """A dot for each error by both metrics, each index over the largest, in the order of the platform's."""
    figure, axes = plt.subplots(figsize=(6.3, 3.4), layout="constrained")
    order = sorted(index["platform", 1], key=index["platform", 1].get, reverse=True)
    for metric, (colour, name) in METRICS.items():
        values = [index[metric, 1][error] for error in order]
        axes.plot(range(len(order)), [value / max(values) for value in values], "o" if metric == "platform" else "D", color=colour,
                  markersize=4, label=name)
    axes.set_xticks(range(len(order)), order, rotation=90, fontsize=6.5)
    axes.set_ylabel("effect at 1 mm or 1 deg\nover the largest one")
    axes.set_ylim(-0.03, 1.05)
    axes.grid(axis="x", linewidth=0.3)
    axes.legend(frameon=False)
    save(figure, "rankings.png")


def draw_sizes(index):
    """Each index over what it is at 1 mm or 1 deg, at smaller errors."""
    figure, both = plt.subplots(1, 2, figsize=(6.3, 2.6), sharey=True, layout="constrained")
    for axes, (metric, (colour, name)) in zip(both, METRICS.items()):
        known = [error for error, value in index[metric, 1].items() if value > 1e-6]
        for error in known:
            ratios = [index[metric, size][error] / index[metric, 1][error] for size in studies.SIZES]
            axes.loglog(studies.SIZES, ratios, "o-", color=colour, linewidth=0.8, markersize=2.5, alpha=0.7)
        axes.set_title(name, fontsize=8)
        axes.set_xlabel("size of the errors [mm or deg]")
    both[0].set_ylabel("index over that at 1 mm or 1 deg")
    both[0].set_ylim(5e-3, 3)
    save(figure, "sizes.png")


def main():
    poesy = Path(sys.argv[1] if len(sys.argv) > 1 else studies.HERE / "../../build/release/bin/poesy").resolve()
    with tempfile.TemporaryDirectory() as folder:
        index = studies.collect(studies.Studies(poesy, folder)).index
    draw_rankings(index)
    draw_sizes(index)


if __name__ == "__main__":
    main()
