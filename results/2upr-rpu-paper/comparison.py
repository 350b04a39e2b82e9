"""Puts the exported tables of both procedures beside the figures that the paper prints (published/), as Markdown."""

import csv
import math
import pathlib
import statistics

HERE = pathlib.Path(__file__).resolve().parent
INDEX = "linear_deformation [mm per mm or deg]"
ANGULAR_INDEX = "angular_deformation [deg per mm or deg]"
ROUNDING = 1e-8  # mm/mm or mm/deg: an index below this is 0 to rounding
DEGREE = math.pi / 180
OTHERS = 0.1  # mm or deg: Section 6.3 sets the 30 errors that the joints absorb to this
UNITS = {"delta": "mm", "epsilon": "deg"}


def rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def published(name):
    return rows(HERE / "published" / f"{name}.csv")


def table(folder, study, name):
    """{first cell: row} of an exported table."""
    lines = rows(folder / study / f"{name}.csv")
    first = next(iter(lines[0]))
    return {line[first]: line for line in lines}


def markdown(header, lines):
    return ["| " + " | ".join(map(str, line)) + " |" for line in [header, ["---"] * len(header), *lines]] + [""]


def difference(ours, theirs):
    return f"{100 * (ours / theirs - 1):+.1f} %"


def kind(factor):
    return factor.split("_")[0]


def indices(folder, study="sensitivity", column=INDEX):
    return {factor: float(row[column]) for factor, row in table(folder, study, "global").items()}


def number(value):
    return "0" if abs(value) < ROUNDING else f"{value:.4g}"


def figure(folder, study, name, columns):
    """The data of a figure: the first column of an exported table and these, to six digits."""
    lines = table(folder, study, name)
    head = ",".join([next(iter(next(iter(lines.values())))), *columns])
    return "\n".join([head, *(",".join([key, *(f"{float(row[column]):.6g}" for column in columns)])
                              for key, row in lines.items())]) + "\n"


# Tables 6 and 7

def published_verdicts():
    """{factor: 2 deforms alone, 1 only in a coupling, 0 absorbed}."""
    verdicts = {}
    for row in published("identified"):
        for what in ("delta", "epsilon"):
            for axis in "xyz":
                if row[f"{what}_{axis}"] != "-":
                    verdicts[f"{what}_{row['limb']}_{row['frame']}_{axis}"] = int(row[f"{what}_{axis}"])
    return verdicts


def identification(converged, other):
    theirs = published_verdicts()
    lines = []
    for stage, least, column in (("Table 6, each error alone", 2, "single"), ("Table 7, with couplings", 1, "coupled")):
        expected = {factor for factor, verdict in theirs.items() if verdict >= least}
        for group in (1, 2, 3):
            line = [stage, f"group {group}", len(expected)]
            for folder in (converged, other):
                found = {factor for factor, row in table(folder, "identification", "identification").items()
                         if row[f"{column}_group_{group}"] == "1"}
                line += [len(found), ", ".join(sorted(found ^ expected)) or "none"]
            lines.append(line)
    names = list(table(converged, "identification", "identification"))
    pairs = {(names[int(row["first_factor"])], names[int(row["second_factor"])])
             for row in table(converged, "identification", "couplings").values()}
    return ["## Tables 6 and 7: which errors deform", "",
            *markdown(["stage", "sizes", "published", "converged", "differ", "published procedure", "differ"], lines),
            "Couplings found: " + "; ".join(f"{a} with {b}" for a, b in sorted(pairs)) +
            ". Neither error of a pair deforms the mechanism alone; the paper lists the angular one.", ""]


# Section 5.2

def simulation(converged, other):
    lines = []
    for row in published("section52"):
        line = [row["case"], row["claim"]]
        for folder in (converged, other):
            found = table(folder, "simulation-" + row["case"].split()[1], "overall")["deformation_max"]
            line += [f"{float(found['max']):.2g}", found["count"]]
        lines.append(line)
    return ["## Section 5.2, Table 8, Figure 7: errors that the joints absorb", "",
            "The table has the largest delta_mu_max over all poses and draws:", "",
            *markdown(["standard deviations", "published", "converged", "solves", "published procedure", "solves"],
                      lines)]


# Figures 8 and 9, and the ranking

def kendall(ranking, index):
    """tau of the published order with ours; pairs that are equal here count as neither."""
    pairs = [(a, b) for n, a in enumerate(ranking) for b in ranking[n + 1:]]
    agree = sum((index[a] > index[b]) - (index[a] < index[b]) for a, b in pairs)
    return agree / len(pairs)


def sensitivity(converged, other):
    ranking = [row["factor"] for row in published("ranking")]
    ours = [indices(converged), indices(other)]
    angular = [indices(folder, column=ANGULAR_INDEX) for folder in (converged, other)]
    places = [{factor: place for place, factor in enumerate(sorted(index, key=index.get, reverse=True), 1)}
              for index in ours]
    lines = []
    for place, factor in enumerate(ranking, 1):
        lines.append([place, factor, *(f"{places[k][factor]}" for k in (0, 1)), *(number(index[factor]) for index in ours),
                      *(number(index[factor]) for index in angular)])
    zeros = [sorted(factor for factor in ranking if index[factor] < ROUNDING) for index in angular]
    return ["## Figures 8 and 9: the indices, and their ranking", "",
            "Errors are ranked by the global index of the average linear deformation, in mm/mm or mm/deg. Kendall's tau "
            f"with the published ranking: **{kendall(ranking, ours[0]):.3f}** converged, "
            f"**{kendall(ranking, ours[1]):.3f}** by the published procedure.", "",
            *markdown(["published rank", "error", "converged", "published procedure", "linear, converged",
                       "linear, published procedure", "angular [deg/..], converged", "angular, published procedure"],
                      lines),
            "In the paper these errors have no effect on the angular deformation: delta_1_1_y, epsilon_1_1_z, delta_1_2_z, "
            "delta_1_3_x, delta_1_4_y. Here these have none, converged: " + ", ".join(zeros[0]) + "; by the published procedure: " +
            ", ".join(zeros[1]) + ".", ""]


# Table 9

def case(folder, study, name):
    """Maximum and mean of the angular (deg) and of the linear deformation (mm)."""
    row = table(folder, study, "cases")[name]
    return {"angular_max_deg": float(row["angular_deformation_extreme [rad]"]) / DEGREE,
            "angular_mean_deg": float(row["angular_deformation_mean [rad]"]) / DEGREE,
            "linear_max_mm": float(row["linear_deformation_extreme [m]"]) * 1e3,
            "linear_mean_mm": float(row["linear_deformation_mean [m]"]) * 1e3}


def beside(theirs, ours):
    return [f"{theirs:.4f}", *(cell for value in ours for cell in (f"{value:.4f}", difference(value, theirs)))]


def table9(converged, other):
    lines = []
    for row in published("table9"):
        cases = [case(folder, "table9", row["case"]) for folder in (converged, other)]
        for column, label in (("angular_max_deg", "maximum"), ("angular_mean_deg", "mean")):
            lines.append([row["case"], label, *beside(float(row[column]), [each[column] for each in cases])])
    return ["## Table 9: the angular deformation, in degrees", "",
            *markdown(["errors", "over the poses", "published", "converged", "difference", "published procedure",
                       "difference"], lines)]


# Table 10

def equal_effect(folder):
    """{factor: tolerance in mm or deg} of the errors that have one."""
    lines = rows(folder / "sensitivity" / "tolerances.csv")
    return {line["factor"]: float(line["equal_effect_display"]) for line in lines
            if math.isfinite(float(line["equal_effect_display"]))}


def published_tolerances():
    return {row["error"]: float(row["tolerance"]) for row in published("table10")}


def table10(converged, other):
    theirs = published_tolerances()
    ours = [equal_effect(folder) for folder in (converged, other)]
    lines = []
    for factor, tolerance in theirs.items():
        cells = []
        for each in ours:
            known = factor in each
            cells += [f"{each[factor]:.4f}" if known else "no effect",
                      difference(each[factor], tolerance) if known else ""]
        lines.append([factor, UNITS[kind(factor)], f"{tolerance:g}", *cells])
    return ["## Table 10: tolerances of equal effect", "",
            "The tolerance of error p, in mm or deg, is mu_ref / mu_p: mu_p is the index of error p, and mu_ref that of the "
            "reference error epsilon_1_1_z, whose tolerance is 1 degree. Limb 2 gets the tolerances of limb 1.", "",
            *markdown(["error", "unit", "published", "converged", "difference", "published procedure", "difference"],
                      lines)]


# Table 11

def with_limb_2(tolerances):
    """Limb 2 has the tolerances of limb 1, whose mirror image it is."""
    mirrored = {factor.replace("_1_", "_2_", 1): value for factor, value in tolerances.items()
                if factor.split("_")[1] == "1"}
    return {**tolerances, **mirrored}


def averages(tolerances):
    """The mean of all linear and of all angular tolerances of the errors that deform."""
    return {what: statistics.fmean(value for factor, value in tolerances.items() if kind(factor) == what)
            for what in UNITS}


def case_text(name, errors):
    lines = [f'\n[[analysis.cases]]\nname = "{name}"', f'errors.linear = "{OTHERS} mm"', f'errors.angular = "{OTHERS} deg"']
    return "\n".join(lines + [f'errors.{factor} = "{value!r} {UNITS[kind(factor)]}"' for factor, value in errors.items()])


def table11_study(folder):
    """The study of Table 11: the paper's tolerances, and those of this folder's indices, each with their averages."""
    ours = with_limb_2(equal_effect(folder))
    theirs = with_limb_2(published_tolerances())
    printed = {row["kind"]: float(row["value"]) for row in published("averages")}
    printed = {"delta": printed["linear"], "epsilon": printed["angular"]}
    base = (HERE / "studies" / "table9.toml").read_text(encoding="utf-8")
    head, rest = base.split("\n[[analysis.cases]]", 1)
    solver = rest[rest.index("\n[solver]"):]
    head = head.replace("Errors without effect on the angular deformation (Section 6.3.1, Table 9, Figure 6)",
                        "Tolerances of equal effect and their averages (Section 6.3.2, Table 11)")
    cases = [case_text("group 1", theirs), case_text("group 2", {f: printed[kind(f)] for f in theirs}),
             case_text("group 1 by our indices", ours),
             case_text("group 2 by our indices", {f: averages(ours)[kind(f)] for f in ours})]
    return head + "\n".join(cases) + "\n" + solver


def table11(converged, other):
    lines = []
    for row in published("table11"):
        for suffix, tolerances in (("", "printed in Table 10"), (" by our indices", "by our indices")):
            cases = [case(folder, "table11", row["case"] + suffix) for folder in (converged, other)]
            for column in ("angular_max_deg", "angular_mean_deg", "linear_max_mm", "linear_mean_mm"):
                lines.append([row["case"], tolerances, column.replace("_", " "),
                              *beside(float(row[column]), [each[column] for each in cases])])
    ours = [averages(with_limb_2(equal_effect(folder))) for folder in (converged, other)]
    printed = {row["kind"]: row for row in published("averages")}
    means = [[what, printed[what]["unit"], printed[what]["value"], *(f"{each[key]:.4f}" for each in ours)]
             for what, key in (("linear", "delta"), ("angular", "epsilon"))]
    return ["## Table 11: tolerances of equal effect (group 1) against their averages (group 2)", "",
            *markdown(["errors", "tolerances", "figure", "published", "converged", "difference", "published procedure",
                       "difference"], lines),
            "The averages of group 2:", "",
            *markdown(["tolerances", "unit", "published", "converged", "published procedure"], means)]


# Tolerances for a limit

def limit(converged, response, size):
    lines = []
    for name, label in (("confirm_equal_effect", "equal effect"), ("confirm_equal_tolerance", "equal tolerance")):
        row = table(converged, name, "overall")[response]
        mean = float(row["mean"]) * 1e3
        rms = math.hypot(mean, float(row["std"]) * 1e3)
        holds = mean <= float(size.split()[0])
        lines.append([label, f"{mean:.4f} mm", f"{rms:.4f} mm", f"{float(row['q_0.95']) * 1e3:.4f} mm", "holds" if holds else "is missed"])
    return [f"## Tolerances for a mean linear deformation of at most {size}", "",
            "`poesy tolerances` computed tolerances of all 41 errors that deform the mechanism, from the indices of all three "
            "limbs. The table has what Monte Carlo studies with these tolerances found, in which all errors vary together:", "",
            *markdown(["tolerances", "mean", "root mean square", "95 % lie below", "the limit"], lines)]


HEAD = """# The first paper compared with poesy

X. Du, B. Wang, J. Zheng, Machines 2022, 10(11), 990. Written by `./regenerate`; no number is typed by hand: published
figures come from [published/](published), ours from the exported tables of the studies in [studies/](studies).

**converged**: Newton's method; draws that do not converge are left out. **published procedure**: Gauss-Newton, 50 iterations, and the last
iterate is kept whether it converged or not. The two columns differ from each other where solves need more than 50 iterations: an unfinished
iterate can be far off, so that a few draws determine an index. Where both columns differ from the paper, the cause is the printed equations, the inferred
workspace or the unknown draws: [README.md](README.md) explains it table by table.

The tables depend on the unit, the frame and the size of the errors: lengths are in metres, the base frame's origin is the paper's, and
errors have the stated sizes, 1 mm and 1 degree in Figures 8 and 9 and Table 10. The paper's method weighs radians against metres at that
origin, so another unit, frame or size of errors gives other numbers and another ranking;
[2upr-rpu-sensitivity](../2upr-rpu-sensitivity/README.md) shows them, and a metric without this dependence.
"""


def text(converged, other, response, size):
    parts = [identification(converged, other), simulation(converged, other), sensitivity(converged, other),
             table9(converged, other), table10(converged, other), table11(converged, other),
             limit(converged, response, size)]
    return HEAD + "\n" + "\n".join(line for part in parts for line in part).rstrip() + "\n"
