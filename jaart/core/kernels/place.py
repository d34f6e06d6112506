"""Where on a ray, and in which place's coordinates.

A search counts s from its start, and points relative to the centre of their cell or ball, so that nothing far
from the origin is ever subtracted.
"""

from __future__ import annotations

from math import floor

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Cell, Sites, Start, Vector
from jaart.core.kernels.vectors import along

#: The lattice's outer faces belong to it; points this many cells beyond them are there but for rounding.
_SLACK = 1e-9


@kernel(STRICT)
def centre_of(sites: Sites, cell: Cell) -> Vector:
    """Centre of a cell or a ball in the scene's coordinates."""
    if sites.shape[0] == 0:
        i = cell[0]
        return sites.centres[i, 0], sites.centres[i, 1], sites.centres[i, 2]
    return cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5


@kernel(STRICT)
def in_scene(sites: Sites, cell: Cell, x: Vector) -> Vector:
    """A point given relative to a place's centre, in the scene's coordinates."""
    return along(centre_of(sites, cell), x, 1.0)


@kernel(STRICT)
def in_reach(x: float, n: int) -> bool:
    """Whether a coordinate lies within a lattice of n cells."""
    return -_SLACK <= x <= n + _SLACK


@kernel(STRICT)
def located(sites: Sites, start: Start, d: Vector, s: float) -> tuple[Cell, Vector, bool]:
    """The place that holds the ray's point at s, that point relative to its centre, and whether it is in the scene.

    In a cloud a search stays in its ball, whose stretch of the ray bounds s.
    """
    x = along(start.base, d, s)
    if sites.shape[0] == 0:
        return start.cell, x, True
    i, j, k = start.cell
    nx, ny, nz = sites.shape
    inside = (in_reach(i + 0.5 + x[0], nx) and in_reach(j + 0.5 + x[1], ny) and in_reach(k + 0.5 + x[2], nz))
    to_i = min(max(i + int(floor(x[0] + 0.5)), 0), nx - 1)
    to_j = min(max(j + int(floor(x[1] + 0.5)), 0), ny - 1)
    to_k = min(max(k + int(floor(x[2] + 0.5)), 0), nz - 1)
    return (to_i, to_j, to_k), (x[0] - (to_i - i), x[1] - (to_j - j), x[2] - (to_k - k)), inside
