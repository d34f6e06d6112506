"""Lattices of fill levels: which cells hold the interface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.memory import pieces
from jaart.core.scene import Array

Mask = NDArray[np.bool_]
Cells = NDArray[np.int32]

#: Planes of cells that are looked through at a time.
PLANES = 8


def interface_cells(levels: Array, neighbours: str = "6", border: str = "open") -> Cells:
    """Which cells (N, 3) hold a piece of the surface, x slowest [T §3.1].

    levels: (nx, ny, nz) in [0, 1]. A cell does when it is partly full, or full beside an empty one.
    neighbours: "6" looks for the empty one across faces, "26" across edges and corners too;
    border: "open" takes what is outside the lattice as unknown, "closed" as empty.
    """
    found = [np.empty((0, 3), np.int32)]
    for slab in pieces(len(levels), PLANES):
        some = np.argwhere(_in_slab(levels, slab, neighbours, border)).astype(np.int32)
        some[:, 0] += slab.start
        found.append(some)
    return np.concatenate(found)


def _in_slab(levels: Array, slab: slice, neighbours: str, border: str) -> Mask:
    """Which cells of some planes across x hold a piece of the surface."""
    before, after = min(slab.start, 1), min(len(levels) - slab.stop, 1)
    empty = np.pad(levels[slab.start - before:slab.stop + after] <= 0, ((1 - before, 1 - after), (1, 1), (1, 1)),
                   constant_values=border == "closed")
    if neighbours == "26":
        beside = _spread(_spread(_spread(empty, 0), 1), 2)
    else:
        beside = _spread(empty, 0) | _spread(empty, 1) | _spread(empty, 2)
    own = levels[slab]
    full = own >= 1
    return ((own > 0) & ~full) | (full & beside[1:-1, 1:-1, 1:-1])


def _spread(mask: Mask, axis: int) -> Mask:
    """The mask grown by one cell both ways along an axis."""
    grown = np.moveaxis(mask.copy(), axis, 0)
    source = np.moveaxis(mask, axis, 0)
    grown[1:] |= source[:-1]
    grown[:-1] |= source[1:]
    return np.moveaxis(grown, 0, axis)
