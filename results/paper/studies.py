"""Runs the studies of the paper, and gives its numbers: NAME -> text, as paper.md has them.

The studies are those of this folder and of ../2upr-rpu-sensitivity, with other sizes of errors, other lengths, or the other metric.
"""

import csv
import math
import re
import subprocess
from pathlib import Path
from types import SimpleNamespace

import h5py
import numpy as np

HERE = Path(__file__).resolve().parent
PUBLISHED = HERE.parent / "2upr-rpu-sensitivity"
RESPONSE = {"published": "linear_deformation", "platform": "gap"}
STUDY = {"published": PUBLISHED / "study.toml", "platform": PUBLISHED / "platform.toml"}
SIZES = (1, 0.3, 0.1, 0.03, 0.01)  # mm and deg
MARGIN = 0.31  # of the tolerances of Table 10, as README.md has it
NAMED = ("epsilon_3_4_z", "epsilon_1_4_z", "epsilon_3_3_x")


class Studies:
    """Results in a folder, each run once with the program poesy."""

    def __init__(self, poesy, folder):
        self.poesy, self.folder = str(poesy), Path(folder)

    def command(self, *arguments):
        done = subprocess.run([self.poesy, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, check=False)
        if done.returncode not in (0, 6):
            raise RuntimeError(f"poesy {' '.join(map(str, arguments))}: {done.stderr}")
        return done.stdout

    def run(self, name, text):
        """Of a study of this name and text the open result."""
        result = self.folder / f"{name}.h5"
        if not result.exists():
            (self.folder / f"{name}.toml").write_text(text, encoding="utf-8")
            self.command("run", f"{name}.toml", "-o", result.name, "--quiet")
        return h5py.File(result)

    def sized(self, metric, size):
        """The published study with errors of another size, mm and deg."""
        text = STUDY[metric].read_text(encoding="utf-8")
        for unit in ("mm", "deg"):
            text = re.sub(rf'(?m)^((?:linear|angular) = .*)"1 {unit}"', rf'\g<1>"{size:g} {unit}"', text)
        return self.run(f"{metric}_{size:g}", text)

    def decimetres(self, metric):
        """The published study of a machine with ten times the lengths and linear errors: what it is called in decimetres."""
        done = subprocess.run(["awk", "-v", "k=10", "-f", PUBLISHED / "larger.awk", STUDY[metric]], capture_output=True, text=True, check=True)
        return self.run(f"{metric}_decimetre", done.stdout)

    def own(self, name, metric):
        """A study of this folder by a metric."""
        text = (HERE / f"{name}.toml").read_text(encoding="utf-8")
        return self.run(f"{name}_{metric}", text.replace('metric = "platform"', f'metric = "{metric}"'))

    def tau(self, one, other):
        """Kendall's, of the rankings of two results."""
        said = self.command("show", f"{one}.h5", f"{other}.h5")
        return float(re.search(r"Kendall's tau of the two rankings is (-?[\d.]+)", said)[1])


def indices(result, metric, dataset="sensitivity/global_corrected"):
    """Of each error its index on the metric's response, mm per mm or deg."""
    names = list(result["factors/name"].asstr())
    angular = np.array([unit == "rad" for unit in result["factors/unit"].asstr()])
    row = list(result["responses/name"].asstr()).index(RESPONSE[metric])
    values = result[dataset][row] * np.where(angular, 1000 * math.pi / 180, 1)
    return dict(zip(names, values))


def together(studies, metric):
    """The root mean square of the response with all errors at once, over what their effects one by one add up to."""
    alone, all_at_once = studies.own("alone", metric), studies.own("together", metric)
    rows = [list(result["responses/name"].asstr()).index(RESPONSE[metric]) for result in (alone, all_at_once)]
    one_by_one = np.sqrt(np.sum((alone["tolerances/rms_effect"][rows[0]] * alone["factors/sigma"][:]) ** 2))
    return all_at_once["monte_carlo/overall_rms"][rows[1]] / one_by_one


def against_table_10(studies):
    """The tolerances of Table 10 of the first paper but that of the reference: how many are printed, and come out within the margin here."""
    with (HERE.parent / "2upr-rpu-paper/published/table10.csv").open(newline="") as file:
        printed = {row["error"]: float(row["tolerance"]) for row in csv.DictReader(file) if row["error"] != "epsilon_1_1_z"}
    index = indices(studies.sized("published", 1), "published", "sensitivity/global")
    within = [name for name, tolerance in printed.items() if abs(index["epsilon_1_1_z"] / index[name] / tolerance - 1) <= MARGIN]
    return len(printed), len(within)


def from_file(path, pattern):
    """A number of a file that another script of results/ has made."""
    return re.search(pattern, (HERE.parent / path).read_text(encoding="utf-8"), re.MULTILINE)[1]


def collect(studies):
    """What the paper and its figures take: numbers by name, and indices by (metric, size) and (metric, "decimetre")."""
    index = {(metric, size): indices(studies.sized(metric, size), metric) for metric in STUDY for size in SIZES}
    for metric in STUDY:
        # Response and linear errors are ten times as large there, so an index per deg is, too.
        found = indices(studies.decimetres(metric), metric)
        index[metric, "decimetre"] = {name: value / (10 if name.startswith("epsilon") else 1) for name, value in found.items()}
    return SimpleNamespace(index=index, numbers={**sizes_and_units(studies, index), **other_numbers(studies)})


def sizes_and_units(studies, index):
    """Which metric's numbers hold in another unit and at another size."""
    numbers = {}
    for metric in STUDY:
        at_one, at_hundredth = index[metric, 1], index[metric, 0.01]
        for name in NAMED:
            for where in (1, "decimetre", 0.01):
                numbers[f"{metric}_{name}_{where}"] = f"{index[metric, where][name]:#.2g}"
        known = [name for name in at_one if at_one[name] > 1e-6]
        change = {name: at_hundredth[name] / at_one[name] for name in known}
        numbers[f"{metric}_lost"] = str(sum(ratio < 1 / 50 for ratio in change.values()))
        numbers[f"{metric}_change"] = f"{100 * max(abs(ratio - 1) for ratio in change.values()):.1f}"
        numbers[f"{metric}_tau_small"] = f"{studies.tau(f'{metric}_1', f'{metric}_0.01'):.2f}"
        numbers[f"{metric}_tau_decimetre"] = f"{studies.tau(f'{metric}_1', f'{metric}_decimetre'):.2f}"
        numbers[f"{metric}_together"] = f"{together(studies, metric):.2f}"
    for size in (1, 0.01):
        numbers[f"tau_{size:g}"] = f"{studies.tau(f'published_{size:g}', f'platform_{size:g}'):.2f}"
    ranked = {metric: sorted(index[metric, 1], key=index[metric, 1].get, reverse=True) for metric in STUDY}
    numbers["last_published"] = str(ranked["published"].index("epsilon_3_3_x") + 1)
    numbers["last_platform"] = str(ranked["platform"].index("epsilon_3_3_x") + 1)
    return numbers


def other_numbers(studies):
    study = studies.sized("platform", 1)
    printed, within = against_table_10(studies)
    drawing = studies.own("drawing", "platform")
    cost = drawing["allocation/stages/cost"]
    certificate = drawing["allocation/certificate"]
    return {
        "errors": str(len(study["factors/name"])), "poses": str(len(study["poses/z"])),
        "samples": str(int(study["run/all_samples"][()] / len(study["factors/name"]) / len(study["poses/z"]))),
        "solves": f"{study['run/all_samples'][()] / 1e6:.2f}",
        "table_10_margin": f"{100 * MARGIN:.0f}", "together_size": f"{studies.own('alone', 'platform')['factors/sigma'][0] * 1000:.1g}",
        "printed": str(printed), "within": str(within),
        "millimetre_unsolved": f"{float(from_file('2upr-rpu-sensitivity/dependence.txt', r'^not converged, % +[0-9.]+ +[0-9.]+ +([0-9.]+)')):.0f}",
        "millimetre_index": f"{float(from_file('2upr-rpu-sensitivity/dependence.txt', r'^epsilon_3_4_z +[0-9.]+ +[0-9.]+ +([-0-9.e]+)')):.7f}",
        "tau_paper": from_file("2upr-rpu-paper/COMPARISON.md", r"Kendall's tau with the published ranking: \*\*([0-9.]+)\*\*"),
        "drawing_errors": str(len(drawing["allocation/tolerance"])),
        "drawing_cheaper": f"{100 * (1 - cost[-1] / cost[0]):.0f}",
        "drawing_machines": f"{int(certificate['machines'][()]) / 1000:.0f}",
        "drawing_rejects": str(int(certificate["rejects"][()])),
        "drawing_most": str(int(certificate["most_rejects"][()])),
        "numpy": from_file("../bench/README.md", r"^\| NumPy, tuned, in 2 processes \|[^|]*\|[^|]*\| ([0-9.]+) k"),
        "speed": from_file("../bench/README.md", r"^\| newton, 158 poses \| avx512 \|[^|]*\| ([0-9.]+) M"),
    }
