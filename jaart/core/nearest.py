"""The nearest neighbours of each point of a cloud: in a grid where points lie evenly, in a tree where they do not."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.nearest import Cells, find_nearest
from jaart.core.scene import Array

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

#: Cells along the longest edge of the grid that points are counted in; so many neighbours a cell has in the end.
COARSE, A_NEIGHBOUR = 32, 0.5
#: A grid is worth it while it has no more cells than this for each point, and points no more others beside them.
MOST_CELLS, MOST_BESIDE = 16, 12.0
#: Fewer points, or more neighbours, are not worth it.
LEAST, MOST_NEIGHBOURS = 1000, 32
#: Points that a thread takes at once.
_PIECE = 4096


def nearest_others(points: Array, k: int, tree: Callable[[], cKDTree] | None = None
                   ) -> tuple[Array, NDArray[np.intp]]:
    """Distances (N, k) from each of the points (N, 3) to its k nearest others, and which they are.

    A point that stands in the same place is another one. k is clipped to N - 1. tree: makes one over these points, or
    has it.
    """
    k = min(k, len(points) - 1)
    if k < 1:
        return np.empty((len(points), 0)), np.empty((len(points), 0), np.intp)
    cells = even_cells(points, k) if len(points) >= LEAST and k <= MOST_NEIGHBOURS else None
    if cells is None:
        return in_tree(_tree(points, tree), points, np.arange(len(points)), k)
    distance, index = np.empty((len(points), k)), np.empty((len(points), k), np.int64)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        unsure = sum(pool.map(lambda at: find_nearest(cells, at, min(at + _PIECE, len(points)), distance, index),
                              range(0, len(points), _PIECE)))
    if unsure:
        rows = np.flatnonzero(distance[:, 0] < 0)
        distance[rows], index[rows] = in_tree(_tree(points, tree), points, rows, k)
    return distance, index


def in_tree(tree: cKDTree, points: Array, rows: NDArray[np.intp], k: int) -> tuple[Array, NDArray[np.intp]]:
    """The same for some rows of the points, by a tree over all."""
    distance, index = tree.query(points[rows], k + 1, workers=-1)
    itself = index == rows[:, None]
    itself[~itself.any(axis=1), -1] = True  # among more than k in the same place
    return distance[~itself].reshape(-1, k), index[~itself].reshape(-1, k)


def even_cells(points: Array, k: int) -> Cells | None:
    """The points in a grid in whose neighbouring cells nearly all have k others; None where they lie unevenly."""
    low = np.array([points[:, axis].min() for axis in range(3)])
    size = np.array([points[:, axis].max() for axis in range(3)]) - low
    coarse = float(size.max()) / COARSE
    if not coarse > 0.0:
        return None
    filled = np.count_nonzero(np.bincount(_keys(points, low, size, coarse)[0], minlength=1))
    edge = coarse * float(np.sqrt(A_NEIGHBOUR * k * filled / len(points)))  # as on a surface
    if float(np.prod(size / edge + 1.0)) > MOST_CELLS * len(points):
        return None
    keys, shape = _keys(points, low, size, edge)
    count = np.bincount(keys, minlength=int(shape.prod()))
    if float(np.dot(count, count)) > MOST_BESIDE * k * len(points):
        return None
    first = np.zeros(len(count) + 1, np.int64)
    np.cumsum(count, out=first[1:])
    order = np.argsort(keys, kind="stable").astype(np.int64, copy=False)
    return Cells(low, edge, shape, first, points[order], order)


def _keys(points: Array, low: Array, size: Array, edge: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Number of the cell, C order, that each point is in, and how many cells there are along each axis."""
    shape = (size / edge).astype(np.int64) + 1
    keys = np.zeros(len(points), np.int64)
    for axis in range(3):
        at = ((points[:, axis] - low[axis]) / edge).astype(np.int64)
        keys = keys * shape[axis] + np.minimum(at, shape[axis] - 1)
    return keys, shape


def _tree(points: Array, tree: Callable[[], cKDTree] | None) -> cKDTree:
    from scipy.spatial import cKDTree

    return tree() if tree else cKDTree(points)
