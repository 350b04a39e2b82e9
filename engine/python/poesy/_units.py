"""Units in which people read what files hold in SI, the same as the program's."""

from __future__ import annotations

import math
from typing import NamedTuple


class Unit(NamedTuple):
    """A unit and its size in SI: a value in SI divided by ``si`` is the value in this unit."""

    name: str
    si: float


_SHOWN = {"m": Unit("mm", 1e-3), "rad": Unit("deg", math.pi / 180.0)}


def shown(si_unit: str) -> Unit:
    """The unit in which people read values of an SI unit: "m" as mm, "rad" as deg, any other as it is."""
    return _SHOWN.get(si_unit, Unit(si_unit, 1.0))


def labelled(quantity: str, unit: str) -> str:
    """``"effect [mm]"``; without brackets where there is no unit."""
    return quantity if unit in ("", "1", "-") else f"{quantity} [{unit}]"
