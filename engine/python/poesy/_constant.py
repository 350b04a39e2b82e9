"""Finds responses of a result that do not vary. No error has a share of them, so no ranking begins with them."""

from __future__ import annotations

from typing import Any

import h5py
import numpy as np

from . import _h5

# An index below this is rounding error; the same as in engine/stats/indices.h.
INDEX_ROUNDING = 1e-10
# The dataset that tells which responses vary, for kinds of study that compute shares.
_FLAGS = {"sobol": "sobol/varies", "monte-carlo": "monte_carlo/varies"}


def constant_responses(kind: str, file: h5py.File) -> frozenset[str]:
    """Names of the responses that do not vary, as far as a result of this kind says."""
    if kind in _FLAGS:
        varies = file[_FLAGS[kind]][...] != 0 if _FLAGS[kind] in file else None
    elif kind == "sensitivity":
        varies = _has_an_effect(file)
    elif kind == "coupling" and "coupling/rounding" in file:
        varies = (file["coupling/effect_max"][...] >= file["coupling/rounding"][...][:, :, None]).any(axis=(1, 2))
    else:
        varies = None
    if varies is None:
        return frozenset()
    return frozenset(name for name, one in zip(_h5.texts(file, "responses/name"), varies) if not one)


def _has_an_effect(file: h5py.File) -> Any:
    """[R] Whether some error has an effect on the response. Also true if none of its indices is known."""
    found = file["sensitivity"]
    rounding = found["rounding"][...][:, None] / file["factors/sigma"][...]
    some = (found["global_corrected"][...] >= np.maximum(INDEX_ROUNDING, rounding)).any(axis=1)
    return some | np.isnan(found["global"][...]).all(axis=1)


def constant_text(response: str) -> str:
    """A sentence on a response that does not vary, in the program's words."""
    return (
        f"{response} does not vary: what its samples scatter, if they do, is the rounding of their solves, "
        "so no error has a share of it"
    )
