"""The verdict on limits or tolerances in a result file."""

from __future__ import annotations

import math
from typing import Any

import h5py


def verdict(file: h5py.File) -> str | None:
    """The value of `Result.verdict`."""
    if "allocation" in file:
        return "certified" if file["allocation"].attrs["certified"] == 1 else "not certified"
    if "limits" not in file:
        return None
    limits = file["limits"]
    if limits.attrs.get("judge") == "yield" and "yield" in file:
        asked = float(limits.attrs.get("yield", 0.0))
        return _of_yield(file["yield"], asked) if asked > 0.0 else None
    return "kept" if bool(limits["passed"][...].all()) else "not kept"


def _of_yield(found: Any, asked: float) -> str:
    """The verdict on a yield, by the one-sided bounds of Clopper and Pearson. A bound reaches `asked` if a tail of the
    binomial distribution is at most 1 - conf_level."""
    machines, rejects = int(found["machines"][()]), int(found["rejects"][()])
    alpha = 1.0 - float(found.attrs["conf_level"])
    if lower_tail(machines - rejects, machines, asked) < alpha:
        return "not kept"
    return "kept" if lower_tail(rejects, machines, 1.0 - asked) <= alpha else "undecided"


def lower_tail(most: int, trials: int, share: float) -> float:
    """The probability of at most `most` successes in `trials`, each of probability `share`, above 0 and below 1."""
    if most >= trials:
        return 1.0
    if most > trials * share:
        return 1.0 - lower_tail(trials - most - 1, trials, 1.0 - share)
    log_term = (
        math.lgamma(trials + 1) - math.lgamma(most + 1) - math.lgamma(trials - most + 1)
        + most * math.log(share) + (trials - most) * math.log1p(-share)
    )  # fmt: skip
    ratio, total, odds = 1.0, 0.0, (1.0 - share) / share
    for count in range(most, -1, -1):
        total += ratio
        ratio *= count / (trials - count + 1) * odds
        if ratio < 1e-17 * total:
            break
    return math.exp(log_term) * total
