#!/usr/bin/env python3
"""Makes the page of all datasets of results from result files, or checks that the page is up to date.

usage: dataset_page.py PAGE FOLDER POESY            fails unless the page agrees with the results in the folder and with
                                                    those of small studies that the program POESY runs
       dataset_page.py --write PAGE FOLDER POESY    writes the page
"""

import difflib
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

HEAD = """# Datasets of result files

Every dataset of every kind of result, as the files say themselves: `tests/interop/dataset_page.py` makes this page from examples of
all kinds, and a test compares it with them. [The result file](result-file.md) explains the groups. COORDINATE is the name of a
coordinate of a pose, RESPONSE of a response, DETAIL of a detail of a mechanism.

"""
REPOSITORY = Path(__file__).resolve().parents[2]
BEGIN = 'format = "poesy-study"\nversion = 1\n'
# Studies whose results have groups that the examples do not have.
STUDIES = {
    "two_fidelities": """
mechanism = { model = "3-prs", fidelity = "both" }
poses.count = 2
errors.linear = { distribution = "normal", sigma = "0.1 mm" }
errors.angular = { distribution = "normal", sigma = "0.1 deg" }
analysis = { kind = "sensitivity", samples = 100 }
""",
    "adaptive": """
mechanism = { model = "2upr-rpu" }
poses.count = 2
errors.linear = { distribution = "normal", sigma = "0.1 mm" }
errors.angular = { distribution = "normal", sigma = "0.1 deg" }
analysis = { kind = "sensitivity", factors = ["delta_1_0_x"], samples = { min = 100, max = 200, relative_error = 0.1 } }
solver.metric = "platform"
""",
    "machines_of_a_drawing": """
mechanism.file = "drawn-delta.toml"
poses = { select = "boundary", count = 2 }
[errors]
zones = { distribution = "normal", sigmas = 3 }
override.zero_1 = { distribution = "measured", values = ["3 um", "-4 um", "5 um", "1 um", "-2 um", "2 um", "0 um", "-6 um"] }
[analysis]
kind = "monte-carlo"
draws = "per machine"
limits = { tip_position = "0.05 mm" }
samples = 100
""",
    "calibrated_machines": """
mechanism.file = "delta-puu.toml"
poses = { select = "file", file = "delta-places.csv" }
errors.linear = { distribution = "normal", sigma = "0.3 mm" }
[analysis]
kind = "monte-carlo"
draws = "per machine"
samples = 100
limits = { z = "0.03 mm", position = "0.2 mm" }
[analysis.calibration]
fit = ["zero_1", "zero_2", "zero_3"]
measured = ["z"]
noise = { z = "5 um" }
""",
    "allocation_of_zones": """
mechanism.file = "drawn-delta.toml"
poses = { select = "boundary", count = 3 }
errors.zones = { distribution = "normal", sigmas = 3 }
[analysis]
kind = "allocation"
limits = { tip_position = "0.5 mm", tip_z = ["-0.5 mm", "0.6 mm"], z = { spread = "0.6 mm" } }
yield = 0.9
[[analysis.parts]]
zones = "all"
each = true
cost = { law = "reciprocal", b = 1, unit = "mm" }
bounds = ["0.01 mm", "0.1 mm"]
""",
    "limited_cases": """
mechanism.file = "drawn-delta.toml"
poses = { select = "boundary", count = 2 }
[analysis]
kind = "evaluate"
limits = { tip_position = "1 mm" }
cases = [ { name = "one", errors = { rod_1 = "0.01 mm" } } ]
"""}


def run(poesy, folder, *arguments):
    subprocess.run([poesy, *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def run_studies(poesy, folder):
    """Writes the results of the studies, of a sweep and of a calibration into the folder."""
    shutil.copy(REPOSITORY / "results/tutorial/drawn-delta.toml", folder)
    for file in (REPOSITORY / "tests/data/calibration").iterdir():
        shutil.copy(file, folder)
    for name, study in STUDIES.items():
        Path(folder, name + ".toml").write_text(BEGIN + study)
        run(poesy, folder, "run", name + ".toml", "-o", name + ".h5", "--quiet", "--yes")
    Path(folder, "errors.csv").write_text("rod_1 [mm]\n0.01\n")
    run(poesy, folder, "evaluate", "limited_cases.toml", "--errors", "errors.csv", "-o", "limited_rows.h5", "--quiet")
    values = "geometry.l_A=60mm,70mm"
    run(poesy, folder, "sweep", "adaptive.toml", "--set", values, "-o", "sweep.h5", "--quiet", "--yes")
    run(poesy, folder, "calibrate", "delta-measured.toml", "--measured", "delta-heights.csv", "-o", "calibration.h5")


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def is_scale(thing):
    return h5py.h5ds.is_scale(thing.id)


def generic_name(file, name):
    """The name of a dataset, with names that a mechanism gives replaced by what they are."""
    group, _, last = name.rpartition("/")
    if group == "poses" and last in [text(one) for one in file["poses"].attrs["coordinates"]]:
        return "poses/COORDINATE"
    if group != "evaluate":
        return name
    if last in [text(one) for one in file["responses/name"][()]]:
        return "evaluate/RESPONSE"
    return "evaluate/DETAIL" if file[name].ndim == 3 else name


def axis_name(scale):
    return scale.name.rpartition("/")[2]


def row_of(file, name):
    thing = file[name]
    generic = generic_name(file, name)
    given = generic.rpartition("/")[2].isupper()
    return {"name": generic.rpartition("/")[2],
            "axes": ", ".join(axis_name(axis[0]) for axis in thing.dims if len(axis)),
            "unit": "of the thing" if given else text(thing.attrs["unit"]),
            "meaning": "" if given else text(thing.attrs["description"])}


def datasets(group):
    for thing in group.values():
        if isinstance(thing, h5py.Group):
            yield from datasets(thing)
        elif group.name == "/" or not is_scale(thing):  # other groups have copies of the root's axes
            yield thing.name.lstrip("/")


def tables_of(paths):
    """For each group its rows, without those that are there already."""
    tables = {}
    for path in paths:
        with h5py.File(path) as file:
            for name in datasets(file):
                rows = tables.setdefault("/" + generic_name(file, name).rpartition("/")[0], [])
                row = row_of(file, name)
                if row not in rows:
                    rows.append(row)
    return tables


def escaped(cell):
    return cell.replace("|", "\\|")


def section(group, rows):
    title = "Axes: `/`" if group == "/" else f"`{group}`"
    lines = [f"## {title}", "", "| dataset | axes | unit | meaning |", "|---|---|---|---|"]
    for row in sorted(rows, key=lambda one: one["name"]):
        lines.append(f"| `{row['name']}` | {row['axes']} | {escaped(row['unit'])} | {escaped(row['meaning'])} |")
    return "\n".join(lines) + "\n"


def page_of(folder, poesy):
    with tempfile.TemporaryDirectory() as own:
        run_studies(poesy, own)
        tables = tables_of([*sorted(Path(folder).glob("*.h5")), *sorted(Path(own).glob("*.h5"))])
    return HEAD + "\n".join(section(group, tables[group]) for group in sorted(tables))


def main(arguments):
    write = arguments[:1] == ["--write"]
    page, folder, poesy = arguments[write:]
    made = page_of(folder, poesy)
    if write:
        Path(page).write_text(made)
        return 0
    found = Path(page).read_text()
    sys.stdout.writelines(difflib.unified_diff(found.splitlines(True), made.splitlines(True), page, "the results"))
    return 0 if found == made else 1


sys.exit(main(sys.argv[1:]))
