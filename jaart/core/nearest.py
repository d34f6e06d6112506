"""The nearest neighbours of each point of a cloud: in a grid where points lie evenly, in a tree where they do not."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.nearest import Cells, find_nearest
from jaart.core.pieces import do_each
from jaart.core.point_grid import cell_numbers, corners, first_and_order
from jaart.core.scene import Array
from jaart.core.telling import tell

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

#: Cells along the longest edge of the grid that points are counted in; so many neighbours a cell has in the end.
COARSE, A_NEIGHBOUR = 32, 0.5
#: A grid is worth it while it has no more cells than this for each point, and points no more others beside them.
MOST_CELLS, MOST_BESIDE = 16, 12.0
#: Fewer points, or more neighbours, are not worth it.
LEAST, MOST_NEIGHBOURS = 1000, 32
#: Points whose neighbours a thread finds at a time.
POINTS_AT_ONCE = 1 << 13


def nearest_others(points: Array, k: int, tree: Callable[[], cKDTree] | None = None
                   ) -> tuple[Array, NDArray[np.int32]]:
    """Distances (N, k) from each of the points (N, 3) to its k nearest others, and which they are.

    A point that stands in the same place is another one. k is clipped to N - 1. tree: makes one over these points, or
    has it.
    """
    k = min(k, len(points) - 1)
    if k < 1:
        return np.empty((len(points), 0)), np.empty((len(points), 0), np.int32)
    cells = even_cells(points, k) if len(points) >= LEAST and k <= MOST_NEIGHBOURS else None
    distance, index = np.empty((len(points), k)), np.empty((len(points), k), np.int32)
    if cells is None:
        in_tree(_made(points, tree), points, None, distance, index)
        return distance, index

    def find(at: int) -> None:
        find_nearest(cells, at, min(at + POINTS_AT_ONCE, len(points)), distance, index)

    do_each(find, range(0, len(points), POINTS_AT_ONCE), progress=tell)
    unsure = np.flatnonzero(distance[:, 0] < 0)
    if len(unsure):
        in_tree(_made(points, tree), points, unsure, distance, index)
    return distance, index


def in_tree(tree: cKDTree, points: Array, rows: NDArray[np.intp] | None, distance: Array,
            index: NDArray[np.int32]) -> None:
    """Write the same of some rows of the points, or of all, by a tree over all."""
    k = distance.shape[1]

    def find(some: NDArray[np.intp]) -> None:
        away, which = tree.query(points[some], k + 1)
        itself = which == some[:, None]
        itself[~itself.any(axis=1), -1] = True  # among more than k in the same place
        distance[some], index[some] = away[~itself].reshape(-1, k), which[~itself].reshape(-1, k)

    rows = tree.indices if rows is None else rows  # points of a leaf together: they read the same parts of the tree
    do_each(find, [rows[i:i + POINTS_AT_ONCE] for i in range(0, len(rows), POINTS_AT_ONCE)], progress=tell)


def tree_over(points: Array) -> cKDTree:
    """A tree over points that finds nearest ones."""
    from scipy.spatial import cKDTree

    return cKDTree(points)


def even_cells(points: Array, k: int) -> Cells | None:
    """The points in a grid in whose neighbouring cells nearly all have k others; None where they lie unevenly."""
    low, high = corners(points)
    coarse = float((high - low).max()) / COARSE
    if not coarse > 0.0:
        return None
    filled = np.count_nonzero(np.bincount(cell_numbers(points, low, high, coarse)[0], minlength=1))
    edge = coarse * float(np.sqrt(A_NEIGHBOUR * k * filled / len(points)))  # as on a surface
    if float(np.prod((high - low) / edge + 1.0)) > MOST_CELLS * len(points):
        return None
    keys, shape = cell_numbers(points, low, high, edge)
    first, order = first_and_order(keys, int(shape.prod()))
    count = np.diff(first)
    if float(np.dot(count, count)) > MOST_BESIDE * k * len(points):
        return None
    return Cells(low, edge, shape, first, points[order], order)


def _made(points: Array, tree: Callable[[], cKDTree] | None) -> cKDTree:
    return tree() if tree else tree_over(points)
