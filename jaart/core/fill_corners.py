"""Algorithms 3 and 4 literally: the 8-corner vote of sub-cells [T §3.3.3]."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jaart.core.interface_cells import descend
from jaart.core.shapes import Array, Convex, Mask, Shape
from jaart.core.telling import tell

#: How many corners of sub-cells are looked at in one piece: small enough for the processor's cache.
PIECE = 1 << 17


def corners(solids: Sequence[Shape], raster: int, subdivision: int) -> Array:
    """Fill levels (raster, raster, raster) by Algorithm 3, solids in cells, subdivision as in Algorithm 4.

    A corner on a surface is inside. A cell that holds none of its 8 corners stays empty, as in [T]: a
    solid that pokes through a face, or lies within a cell, without reaching a corner is missed. A cell
    with all corners in one convex solid, or surely inside another, needs no sub-cells.
    """
    whole = np.zeros((raster,) * 3, dtype=bool)
    touched = np.zeros((raster,) * 3, dtype=bool)
    edge = np.arange(raster + 1.0)
    for solid in solids:
        held = solid.holds(edge[:, None, None], edge[None, :, None], edge[None, None, :])
        if isinstance(solid, Convex):
            whole |= _over_corners(np.logical_and, held)
        else:
            descend(solid, whole)
        touched |= _over_corners(np.logical_or, held)
    levels = whole.astype(np.float64)
    cells = np.argwhere(touched & ~whole)
    step = max(1, PIECE // (subdivision + 1) ** 3)
    for start in range(0, len(cells), step):
        piece = cells[start:start + step]
        levels[tuple(piece.T)] = _subdivided(solids, piece, subdivision)
        tell(start + len(piece), len(cells))
    return levels


def _over_corners(combine: np.ufunc, held: Mask) -> Mask:
    """And, or or of the 8 corners of each cell, axis by axis."""
    for axis in range(3):
        here, there = np.arange(held.shape[axis] - 1), np.arange(1, held.shape[axis])
        held = combine(held.take(here, axis), held.take(there, axis))
    return held


def _subdivided(solids: Sequence[Shape], cells: NDArray[np.intp], subdivision: int) -> Array:
    """Mean of the corner votes of all sub-cells of each cell (N, 3) [Algorithm 4].

    Neighbouring sub-cells share corners: one inside the cell counts in both of them along each axis,
    one on its face once.
    """
    count = np.ones(subdivision + 1, dtype=np.float32)
    count[[0, -1]] = 0.5
    ticks = np.arange(subdivision + 1) / subdivision
    x, y, z = (cells[:, axis, None] + ticks for axis in range(3))
    inside = np.zeros((len(cells),) + (subdivision + 1,) * 3, dtype=bool)
    for solid in solids:
        low, high = solid.bounds
        if (cells.max(axis=0) + 1.001 > low).all() and (cells.min(axis=0) < high + 0.001).all():
            inside |= solid.holds(x[:, :, None, None], y[:, None, :, None], z[:, None, None, :])
    total = (inside.astype(np.float32) @ count) @ count @ count  # exact: multiples of 1/8 below 2^21
    return total.astype(np.float64) / subdivision**3
