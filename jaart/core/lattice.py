"""Lattices of fill levels: which cells hold the interface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.scene import Array

Mask = NDArray[np.bool_]


def interface_cells(levels: Array, neighbours: str = "6", border: str = "open") -> Mask:
    """Which cells hold a piece of the surface (nx, ny, nz) [T §3.1].

    levels: (nx, ny, nz) in [0, 1]. A cell does when it is partly full, or full beside an empty one.
    neighbours: "6" looks for the empty one across faces, "26" across edges and corners too;
    border: "open" takes what is outside the lattice as unknown, "closed" as empty.
    """
    empty = np.pad(levels <= 0, 1, constant_values=border == "closed")
    if neighbours == "26":
        beside = _spread(_spread(_spread(empty, 0), 1), 2)
    else:
        beside = _spread(empty, 0) | _spread(empty, 1) | _spread(empty, 2)
    full = levels >= 1
    return ((levels > 0) & ~full) | (full & beside[1:-1, 1:-1, 1:-1])


def _spread(mask: Mask, axis: int) -> Mask:
    """The mask grown by one cell both ways along an axis."""
    grown = np.moveaxis(mask.copy(), axis, 0)
    source = np.moveaxis(mask, axis, 0)
    grown[1:] |= source[:-1]
    grown[:-1] |= source[1:]
    return np.moveaxis(grown, 0, axis)
