"""The surfels near a cell, and one number of one of them."""

from __future__ import annotations

import numpy as np

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Cell, Cells, Near, Unsigned, Vector

_THREE, _SIX = np.uint64(3), np.uint64(6)


@kernel(STRICT)
def surfels_near(cells: Cells, cell: Cell) -> Near:
    """The surfels near a cell of the lattice, relative to its centre."""
    shape = cells.empty.shape
    number = (cell[0] * shape[1] + cell[1]) * shape[2] + cell[2]
    first, last = np.uint64(cells.first[number]), np.uint64(cells.first[number + 1])
    return Near(cells.columns, _SIX * first, last - first)


@kernel(STRICT)
def point(near: Near, i: Unsigned) -> Vector:
    """Position of surfel i, relative to the cell's centre."""
    at, n = near.base + i, near.size
    return near.columns[at], near.columns[at + n], near.columns[at + n + n]


@kernel(STRICT)
def normal(near: Near, i: Unsigned) -> Vector:
    """Unit normal of surfel i."""
    at, n = near.base + _THREE * near.size + i, near.size
    return near.columns[at], near.columns[at + n], near.columns[at + n + n]
