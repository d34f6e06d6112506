"""Points sorted by the cells of a grid: the cells are numbered, the points counted, then put in their places."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array

Ints = NDArray[np.int64]


@kernel(STRICT, entry=True)
def number_cells(points: Array, low: Array, edge: float, shape: Ints, keys: Ints) -> None:
    """Write the number of the cell, C order, that each point (N, 3) is in.

    low: corner (3,) of the grid; edge: of a cell; shape: (3,) cells along each axis; keys: (N,).
    """
    for i in range(points.shape[0]):
        key = 0
        for axis in range(3):
            key = key * shape[axis] + min(int((points[i, axis] - low[axis]) / edge), shape[axis] - 1)
        keys[i] = key


@kernel(STRICT, entry=True)
def sort_by_key(keys: Ints, first: Ints, order: Ints) -> None:
    """Write the items' numbers by rising key, equal ones as they stand, and where those of each key begin.

    keys: (N,) in 0 … K - 1; first: (K + 1,), all 0 before; order: (N,).
    """
    for i in range(keys.shape[0]):
        first[keys[i] + 1] += 1
    for key in range(1, first.shape[0]):
        first[key] += first[key - 1]
    for i in range(keys.shape[0]):
        order[first[keys[i]]] = i
        first[keys[i]] += 1
    for key in range(first.shape[0] - 1, 0, -1):  # each begins where the one before it ended
        first[key] = first[key - 1]
    first[0] = 0
