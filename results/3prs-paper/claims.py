"""What San et al. 2023 say of single and coupled error sources in words, each as a check on error curves.

A check takes the curves of one reading, {subset: {"x" | "y" | "z": values over time}} of the tool tip in mm, subset "FS",
"T", "FS+T", ..., and gives (holds, figures). Words such as "basically the same" have no number in the paper; what a check
takes them to mean stands in its claim, in brackets.
"""

SOURCES = ("FS", "T", "R", "L")
AXES = ("x", "y", "z")
ROUNDING = 1e-9  # mm: an error below this is none
MOSTLY = 2 / 3  # of the way: two curves have the same direction, or the opposite one, that long at least


def peak(curve):
    return max(map(abs, curve))


def peaks(curves, axis, subsets=SOURCES):
    return {subset: peak(curves[subset][axis]) for subset in subsets}


def same_direction(a, b):
    """Share of the points where both have the same sign, of those where both have one."""
    signed = [(x, y) for x, y in zip(a, b) if min(abs(x), abs(y)) > ROUNDING]
    return sum(x * y > 0 for x, y in signed) / len(signed) if signed else None


def per_cent(share):
    return "-" if share is None else f"{100 * share:.0f} %"


def number(value):
    return "0" if abs(value) < ROUNDING else f"{value:.3g}"


def show(values):
    return ", ".join(f"{name} {number(value)}" for name, value in values.items())


# Single sources, Section 5.2.1. These need magnitudes alone.

def most_significant(curves):
    found = {axis: peaks(curves, axis) for axis in AXES}
    largest = {axis: max(values, key=values.get) for axis, values in found.items()}
    return all(source == "FS" for source in largest.values()), "largest: " + ", ".join(
        f"{axis} {source}" for axis, source in largest.items())


def least_in_z(curves):
    found = peaks(curves, "z")
    return min(found, key=found.get) == "L", "z: " + show(found)


def second_in_plane(curves):
    orders = {axis: sorted(SOURCES, key=lambda source: -peak(curves[source][axis])) for axis in ("x", "y")}
    return (all(order[:2] == ["FS", "L"] for order in orders.values()),
            "; ".join(f"{axis}: {' > '.join(order)}" for axis, order in orders.items()))


def equivalent(curves):
    ratios = {axis: peak(curves["T"][axis]) / max(peak(curves["R"][axis]), ROUNDING) for axis in AXES}
    return all(1 / 1.4 <= ratio <= 1.4 for ratio in ratios.values()), "T/R: " + show(ratios)


def larger_in_z(curves):
    found = peaks(curves, "z", ("T", "R"))
    return found["T"] > found["R"], "z: " + show(found)


# Coupled sources, Section 5.2.2. These need signs.

def directions(curves, pairs, axes, same):
    """Whether these pairs have the same (or opposite) direction for most of the way."""
    found = {f"{a}, {b} {axis}": same_direction(curves[a][axis], curves[b][axis]) for a, b in pairs for axis in axes}
    shares = [share for share in found.values() if share is not None]
    holds = len(shares) == len(found) and all((share if same else 1 - share) >= MOSTLY for share in shares)
    return holds, "same direction: " + "; ".join(f"{name} {per_cent(share)}" for name, share in found.items())


def compare(curves, larger, smaller, axes):
    """Whether the first has the higher peak on every one of these axes."""
    found = {axis: (peak(curves[larger][axis]), peak(curves[smaller][axis])) for axis in axes}
    return (all(a > b for a, b in found.values()),
            "; ".join(f"{axis}: {larger} {number(a)}, {smaller} {number(b)}" for axis, (a, b) in found.items()))


def alike(curves, coupled, alone, axes):
    """Whether the coupled curve stays within a fifth of the peak of the single one."""
    found = {axis: max(abs(a - b) for a, b in zip(curves[coupled][axis], curves[alone][axis])) /
             max(peak(curves[alone][axis]), 1e-12) for axis in axes}
    return all(value <= 0.2 for value in found.values()), f"{coupled} off {alone} by " + ", ".join(
        f"{axis} {per_cent(value)}" for axis, value in found.items())


def both(*checks):
    return all(holds for holds, _ in checks), "; ".join(text for _, text in checks)


def superposition(curves):
    """The claim is that coupled curves are no sum of the single ones."""
    worst = 0.0
    for subset, own in curves.items():
        parts = subset.split("+")
        if len(parts) == 1:
            continue
        for axis in AXES:
            total = [sum(values) for values in zip(*(curves[part][axis] for part in parts))]
            scale = max(sum(peak(curves[part][axis]) for part in parts), 1e-12)
            worst = max(worst, max(abs(a - b) for a, b in zip(own[axis], total)) / scale)
    return worst > 0.01, f"largest interaction {worst:.2g} of the sum of the peaks"


PLANE = ("x", "y")
SINGLE = (
    ("5.2.1", "the platforms' hinges (FS) have the most significant effect, in x, y and z", most_significant),
    ("5.2.1", "the rods' lengths (L) have the least effect in z", least_in_z),
    ("5.2.1", "L is second only to FS in x and y", second_in_plane),
    ("5.2.1", "T and R are basically equivalent [peaks within a factor of 1.4, as the printed ones are]", equivalent),
    ("5.2.2", "T is larger than R in z, so they cannot cancel", larger_in_z),
)
COUPLED = (
    ("Fig. 16", "T and R are opposite in x and y", lambda c: directions(c, [("T", "R")], PLANE, False)),
    ("Fig. 16", "FS and L have the same direction in x and y", lambda c: directions(c, [("FS", "L")], PLANE, True)),
    ("Fig. 16", "T, FS and L have the same direction in z",
     lambda c: directions(c, [("T", "FS"), ("T", "L"), ("FS", "L")], "z", True)),
    ("Fig. 16", "coupling is not a simple superposition [off the sum by more than 1 % of the peaks]", superposition),
    ("Fig. 17a", "FS and T have the same direction most of the time, and together are larger than either",
     lambda c: both(directions(c, [("FS", "T")], AXES, True), compare(c, "FS+T", "FS", AXES),
                    compare(c, "FS+T", "T", AXES))),
    ("Fig. 17b", "FS and R have the same direction in x and y, the opposite one in z",
     lambda c: both(directions(c, [("FS", "R")], PLANE, True), directions(c, [("FS", "R")], "z", False))),
    ("Fig. 17c", "FS+L is larger than FS in x and y, and like FS in z [within a fifth of the peak]",
     lambda c: both(compare(c, "FS+L", "FS", PLANE), alike(c, "FS+L", "FS", "z"))),
    ("Fig. 17d", "T+R is smaller than T and than R in x and y, larger in z",
     lambda c: both(compare(c, "T", "T+R", PLANE), compare(c, "R", "T+R", PLANE), compare(c, "T+R", "T", "z"))),
    ("Fig. 17e", "T+L is like T in z", lambda c: alike(c, "T+L", "T", "z")),
    ("Fig. 17f", "R+L is like R in z", lambda c: alike(c, "R+L", "R", "z")),
    ("Fig. 18a", "FS+T+R is like FS in x and y, and larger than FS in z",
     lambda c: both(alike(c, "FS+T+R", "FS", PLANE), compare(c, "FS+T+R", "FS", "z"))),
    ("Fig. 18b", "T is opposite to FS and L in x and y (of FS, Fig. 17a says the contrary), and FS+T+L smaller than FS",
     lambda c: both(directions(c, [("T", "FS"), ("T", "L")], PLANE, False), compare(c, "FS", "FS+T+L", PLANE))),
    ("Fig. 18c", "R is opposite to FS and L in x and y (of FS, Fig. 17b says the contrary)",
     lambda c: directions(c, [("R", "FS"), ("R", "L")], PLANE, False)),
    ("Fig. 18d", "T+R+L is smaller than R in x and y, larger in z",
     lambda c: both(compare(c, "R", "T+R+L", PLANE), compare(c, "T+R+L", "R", "z"))),
    ("6", "coupled, FS and T dominate in z [FS+T reaches half of FS+T+R+L]",
     lambda c: (peak(c["FS+T"]["z"]) >= 0.5 * peak(c["FS+T+R+L"]["z"]),
                "z: " + show(peaks(c, "z", ("FS+T", "FS+T+R+L"))))),
)


def grows(curves):
    """Second trajectory: whether the highest |error| in x and y of each source lies in the second half of the way."""
    ratios = {}
    for source in SOURCES:
        for axis in PLANE:
            curve = list(map(abs, curves[source][axis]))
            half = len(curve) // 2
            if max(curve) > ROUNDING:
                ratios[f"{source} {axis}"] = max(curve[half:]) / max(curve[:half])
    return all(ratio > 1 for ratio in ratios.values()), "second half by first: " + show(ratios)


GROWING = (("5.2.1, 6", "on the second trajectory the error of each source increases with the trajectory "
            "[higher peak in its second half, in x and y]", grows),)
