"""Where on a ray, and in which place's coordinates.

A search counts s from its start, and points relative to the centre of their cell or ball, so that nothing far
from the origin is ever subtracted.
"""

from __future__ import annotations

import numpy as np

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


@kernel(STRICT, inline=True)
def along_axis(i: float, x: float, n: float) -> tuple[float, float, bool]:
    """The cell that holds a coordinate x of cell i's, x from its centre, and whether it lies within n cells."""
    to = min(max(i + np.floor(x + 0.5), 0.0), n - 1.0)
    return to, x - (to - i), -_SLACK <= i + 0.5 + x <= n + _SLACK


@kernel(STRICT)
def located(sites: Sites, start: Start, d: Vector, s: float) -> tuple[Cell, Vector, bool]:
    """The place that holds the ray's point at s, that point relative to its centre, and whether it is in the scene.

    In a cloud a search stays in its ball, whose stretch of the ray bounds s.
    """
    x = along(start.base, d, s)
    if sites.shape[0] == 0:
        return start.cell, x, True
    i, x0, of_x = along_axis(float(start.cell[0]), x[0], float(sites.shape[0]))
    j, x1, of_y = along_axis(float(start.cell[1]), x[1], float(sites.shape[1]))
    k, x2, of_z = along_axis(float(start.cell[2]), x[2], float(sites.shape[2]))
    return (int(i), int(j), int(k)), (x0, x1, x2), of_x and of_y and of_z
