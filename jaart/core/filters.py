"""Filters on fill levels, before the interface is looked for [T §3.3.2]."""

from __future__ import annotations

from typing import Literal

import numpy as np

from jaart.core.scene import Array, frozen
from jaart.core.settings import Settings

#: Levels below this become 0 [T Algorithm 2].
EMPTY_BELOW = 0.1
#: Cells none of whose direct neighbours exceeds this become 0 [T Algorithm 2].
KEPT_BESIDE = 0.25


def wanted(settings: Settings) -> bool:
    """Whether levels are filtered at all."""
    return settings.filter != "none"


def filtered(levels: Array, settings: Settings) -> Array:
    """The levels (nx, ny, nz) after the filter that the settings name; for "none" the same array.

    settings: filter is none, thesis, median or gauss; border says what the last two see outside the
    lattice: "open" the nearest cell, "closed" 0.
    """
    if not wanted(settings):
        return levels
    if settings.filter == "thesis":
        return frozen(thesis(levels))
    return frozen({"median": median, "gauss": gauss}[settings.filter](levels, settings.border))


def thesis(levels: Array) -> Array:
    """Levels below 0.1 become 0, then cells without a direct neighbour above 0.25 do [T Algorithm 2].

    Two passes, so that the order of the cells does not matter, which it does in [T]. Only neighbours
    in the lattice count.
    """
    from scipy.ndimage import maximum_filter

    kept = np.where(levels < EMPTY_BELOW, 0.0, levels)
    beside = maximum_filter(kept, footprint=_direct(), mode="constant")
    return np.where(beside > KEPT_BESIDE, kept, 0.0)


def median(levels: Array, border: str = "open") -> Array:
    """The 14th of the 27 levels of each 3×3×3 block [T §3.3.2]."""
    from scipy.ndimage import median_filter

    result: Array = median_filter(levels, size=3, mode=_outside(border))
    return result


def gauss(levels: Array, border: str = "open") -> Array:
    """Weighted means of each 3×3×3 block, weights 1-2-1 along each axis [T §3.3.2]."""
    from scipy.ndimage import correlate1d

    result = levels
    for axis in range(3):
        result = correlate1d(result, [0.25, 0.5, 0.25], axis=axis, mode=_outside(border))
    return result


def _outside(border: str) -> Literal["constant", "nearest"]:
    """scipy's word for what a filter sees outside the lattice."""
    return "constant" if border == "closed" else "nearest"


def _direct() -> Array:
    """The 6 neighbours of the middle of a 3×3×3 block, without the middle."""
    cross = np.zeros((3, 3, 3))
    cross[1, 1] = cross[1, :, 1] = cross[:, 1, 1] = 1
    cross[1, 1, 1] = 0
    return cross
