"""Points in the cells of a grid: their box, the number of each one's cell, and their order by cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.grid_sort import number_cells, sort_by_key
from jaart.core.scene import Array

Ints = NDArray[np.int64]
#: With more cells than so many for each point, points are sorted without counting them cell by cell.
FEW_CELLS = 4


def corners(points: Array) -> tuple[Array, Array]:
    """Lowest and highest corner (3,) of points (N, 3), each column alone: rows of three numbers make no vectors."""
    return (np.array([points[:, axis].min() for axis in range(3)]),
            np.array([points[:, axis].max() for axis in range(3)]))


def cell_numbers(points: Array, low: Array, high: Array, edge: float) -> tuple[Ints, Ints]:
    """Number of the cell, C order, that each point (N, 3) is in, and how many cells (3,) there are along each axis.

    low, high: corners of a box around the points; edge: of a cell.
    """
    shape, keys = ((high - low) / edge).astype(np.int64) + 1, np.empty(len(points), np.int64)
    number_cells(points, low, edge, shape, keys)
    return keys, shape


def first_and_order(keys: Ints, count: int) -> tuple[Ints, Ints]:
    """Where the points of each of so many cells begin (count + 1,), and the points' numbers by cell, as they stand."""
    first, order = np.zeros(count + 1, np.int64), np.empty(len(keys), np.int64)
    sort_by_key(keys, first, order)
    return first, order


def order_of(keys: Ints, shape: Ints) -> Ints:
    """The points' numbers by cell, those in one cell as they stand; of few points in many cells, too."""
    count = int(np.prod(shape, dtype=object))
    if count > FEW_CELLS * len(keys):
        return np.argsort(keys, kind="stable").astype(np.int64, copy=False)
    return first_and_order(keys, count)[1]
