"""Lattices of fill levels: which cells hold the interface, and how the levels change."""

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


def gradients(levels: Array, border: str = "open", cells: NDArray[np.integer] | None = None) -> Array:
    """Change of the level per cell along x, y, z, by central differences [T 3.1].

    levels: (nx, ny, nz); cells: indices (N, 3) of the cells wanted, all when None. border: "open"
    takes one-sided differences at the border [T 3.2], "closed" central ones with level 0 outside.
    Returns (N, 3), or (nx, ny, nz, 3). Along an axis with one cell the gradient is 0.
    """
    index = np.indices(levels.shape) if cells is None else np.asarray(cells).T
    if border == "closed":
        levels, index = np.pad(levels, 1), index + 1
    result = np.empty((*index.shape[1:], 3))
    for axis in range(3):
        ahead, behind = list(index), list(index)
        ahead[axis] = np.minimum(index[axis] + 1, levels.shape[axis] - 1)
        behind[axis] = np.maximum(index[axis] - 1, 0)
        width = np.maximum(ahead[axis] - behind[axis], 1)
        result[..., axis] = (levels[tuple(ahead)] - levels[tuple(behind)]) / width
    return result


def _spread(mask: Mask, axis: int) -> Mask:
    """The mask grown by one cell both ways along an axis."""
    grown = np.moveaxis(mask.copy(), axis, 0)
    source = np.moveaxis(mask, axis, 0)
    grown[1:] |= source[:-1]
    grown[:-1] |= source[1:]
    return np.moveaxis(grown, 0, axis)
