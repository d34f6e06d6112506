"""The surfels near a place, and one number of one of them."""

from __future__ import annotations

import numpy as np

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Cell, Near, Sites, Unsigned, Vector

_THREE, _SIX = np.uint64(3), np.uint64(6)


@kernel(STRICT)
def place_number(sites: Sites, cell: Cell) -> int:
    """Number of a cell, C order, or of a ball."""
    return cell[0] if sites.shape[0] == 0 else (cell[0] * sites.shape[1] + cell[1]) * sites.shape[2] + cell[2]


@kernel(STRICT)
def surfels_near(sites: Sites, cell: Cell) -> Near:
    """The surfels near a cell of a lattice or in a ball's neighbourhood, relative to its centre."""
    number = place_number(sites, cell)
    first, last = np.uint64(sites.first[number]), np.uint64(sites.first[number + 1])
    return Near(sites.columns, _SIX * first, last - first)


@kernel(STRICT)
def point(near: Near, i: Unsigned) -> Vector:
    """Position of surfel i, relative to the place's centre."""
    at, n = near.base + i, near.size
    return near.columns[at], near.columns[at + n], near.columns[at + n + n]


@kernel(STRICT)
def normal(near: Near, i: Unsigned) -> Vector:
    """Unit normal of surfel i."""
    at, n = near.base + _THREE * near.size + i, near.size
    return near.columns[at], near.columns[at + n], near.columns[at + n + n]
