"""The units in which the program shows values that files hold in SI."""

from __future__ import annotations

import math
from typing import NamedTuple


class Unit(NamedTuple):
    """A unit, and its size in SI. A value in SI divided by ``si`` gives the value in this unit."""

    name: str
    si: float


_SHOWN = {"m": Unit("mm", 1e-3), "rad": Unit("deg", math.pi / 180.0)}


def shown(si_unit: str) -> Unit:
    """The unit in which values of an SI unit are shown: mm for "m", deg for "rad", any other unit unchanged."""
    return _SHOWN.get(si_unit, Unit(si_unit, 1.0))


def labelled(quantity: str, unit: str) -> str:
    """A label with its unit, ``"effect [mm]"``; without brackets if there is no unit."""
    return quantity if unit in ("", "1", "-") else f"{quantity} [{unit}]"
