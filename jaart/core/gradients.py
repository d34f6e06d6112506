"""How the fill level changes at a cell: the gradients that a cell's normal comes from.

Each is a weighted mean of central differences, so that a linear field gives its exact slope. At an
"open" border differences are one-sided [T 3.2] and those outside are taken from the nearest cell; a
"closed" lattice goes on with level 0. Along an axis with one cell an open lattice does not change.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.memory import pieces
from jaart.core.scene import Array

Index = NDArray[np.integer]

#: The Gauss filter of `smooth` ends at so many sigma.
TRUNCATE = 4.0


def gradients(levels: Array, cells: Index, border: str = "open", gradient: str = "central",
              smoothing: float = 0.8) -> Array:
    """Change of the level (N, 3) per cell along x, y, z.

    levels: (nx, ny, nz); cells: indices (N, 3); border: "open" or "closed"; gradient: "central",
    "youngs" or "smooth"; smoothing: sigma of smooth, cells.
    """
    if gradient == "smooth":
        return smooth(levels, cells, border, smoothing)
    return {"central": central, "youngs": youngs}[gradient](levels, cells, border)


def central(levels: Array, cells: Index, border: str = "open") -> Array:
    """Central differences (N, 3) [T 3.1]. See `gradients` for the arguments."""
    levels, cells = with_outside(levels, cells, border, 1)
    result = np.empty((len(cells), 3))
    for piece in pieces(len(cells)):
        for axis in range(3):
            result[piece, axis] = _slope(levels, list(cells[piece].T), axis)
    return result


def youngs(levels: Array, cells: Index, border: str = "open") -> Array:
    """Central differences averaged over the 3×3 rows beside the cell, weights 1-2-1 both ways (N, 3).

    Beyond the sources: Youngs' 27-cell stencil (Parker & Youngs 1992), its weights 1, 2, 4 divided by
    16. See `gradients` for the arguments.
    """
    levels, cells = with_outside(levels, cells, border, 2)
    result = np.empty((len(cells), 3))
    for piece in pieces(len(cells)):
        for axis in range(3):
            result[piece, axis] = _mean_slope(levels, cells[piece], axis)
    return result


def _mean_slope(levels: Array, cells: Index, axis: int) -> Array:
    """Central differences (N,) along an axis, averaged over the 3×3 rows beside each cell."""
    index = [cells[:, a, None, None] for a in range(3)]
    for other, beside in zip({0, 1, 2} - {axis}, (np.array([[-1], [0], [1]]), np.array([[-1, 0, 1]])), strict=True):
        index[other] = np.clip(index[other] + beside, 0, levels.shape[other] - 1)
    rows = _slope(levels, index, axis)
    for _ in range(2):
        rows = 0.25 * (rows[:, 0] + rows[:, 2]) + 0.5 * rows[:, 1]
    return rows


def smooth(levels: Array, cells: Index, border: str = "open", smoothing: float = 0.8) -> Array:
    """Central differences after a Gauss filter (N, 3), which is the filter of the differences; beyond the sources.

    smoothing: sigma of the filter, cells; it ends at 4 sigma. See `gradients` for the others.
    """
    from scipy.ndimage import gaussian_filter

    reach = int(TRUNCATE * smoothing + 0.5)
    levels, cells = with_outside(levels, cells, border, reach + 1)
    result = np.zeros((len(cells), 3))
    for axis in range(3):
        if levels.shape[axis] > 1:
            slope = np.gradient(levels, axis=axis)
            if reach:
                slope = gaussian_filter(slope, smoothing, truncate=TRUNCATE, mode="nearest")
            result[:, axis] = slope[tuple(cells.T)]
    return result


def with_outside(levels: Array, cells: Index, border: str, width: int) -> tuple[Array, Index]:
    """The lattice with what is known outside, and its cells in it: so many cells of level 0 where it is closed."""
    cells = np.asarray(cells)
    return (np.pad(levels, width), cells + width) if border == "closed" else (levels, cells)


def _slope(levels: Array, index: list[Index], axis: int) -> Array:
    """Central differences along an axis at the cells (i, j, k), one-sided at the border."""
    ahead, behind = list(index), list(index)
    ahead[axis] = np.minimum(index[axis] + 1, levels.shape[axis] - 1)
    behind[axis] = np.maximum(index[axis] - 1, 0)
    width = np.maximum(ahead[axis] - behind[axis], 1)
    slope: Array = (levels[tuple(ahead)] - levels[tuple(behind)]) / width
    return slope
