"""The points near a ball, found in a grid whose cells are sorted, and copied into columns."""

from __future__ import annotations

from math import floor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Cell, Vector

Ints = NDArray[np.int64]


class Grid(NamedTuple):
    """Points sorted by the cells of a grid.

    low: corner (3,); edge: of a cell; shape: (3,) cells along each axis; keys: (N,) number of each point's cell, C
    order, rising; points, normals: (N, 3) in that order; ids: (N,) their numbers in the cloud.
    """

    low: Array
    edge: float
    shape: Ints
    keys: Ints
    points: Array
    normals: Array
    ids: Ints


@kernel(STRICT)
def first_at_least(keys: Ints, key: int) -> int:
    """Where the first number that is not below a key stands in rising numbers."""
    low, high = 0, keys.shape[0]
    while low < high:
        middle = (low + high) // 2
        if keys[middle] < key:
            low = middle + 1
        else:
            high = middle
    return low


@kernel(STRICT)
def cell_range(grid: Grid, axis: int, centre: float, radius: float) -> tuple[int, int]:
    """First and last cell along an axis that a ball reaches."""
    a = int(floor((centre - radius - grid.low[axis]) / grid.edge))
    b = int(floor((centre + radius - grid.low[axis]) / grid.edge))
    return min(max(a, 0), grid.shape[axis] - 1), min(max(b, 0), grid.shape[axis] - 1)


@kernel(STRICT)
def cells_of(grid: Grid, centre: Vector, radius: float) -> tuple[Cell, Cell, int]:
    """First and last cell of those that a ball reaches, and in how many rows along z they are looked through.

    That is one for all where there are more rows than points, as around a point far from all others.
    """
    i0, i1 = cell_range(grid, 0, centre[0], radius)
    j0, j1 = cell_range(grid, 1, centre[1], radius)
    k0, k1 = cell_range(grid, 2, centre[2], radius)
    rows = (i1 - i0 + 1) * (j1 - j0 + 1)
    return (i0, j0, k0), (i1, j1, k1), rows if rows <= grid.keys.shape[0] else 1


@kernel(STRICT)
def run(grid: Grid, low: Cell, high: Cell, rows: int, row: int) -> tuple[int, int]:
    """Where the points of one of the rows of cells from low to high begin and end."""
    wide = high[1] - low[1] + 1
    i, j = low[0] + row // wide, low[1] + row % wide
    to_i, to_j = (i, j) if rows > 1 else (high[0], high[1])
    return (first_at_least(grid.keys, (i * grid.shape[1] + j) * grid.shape[2] + low[2]),
            first_at_least(grid.keys, (to_i * grid.shape[1] + to_j) * grid.shape[2] + high[2] + 1))


@kernel(STRICT, entry=True)
def gather(grid: Grid, centres: Array, radii: Array, first: Ints, ids: NDArray[np.int32], columns: Array,
           write: int) -> None:
    """Count the points within each ball, or copy them into columns.

    centres: (B, 3); radii: (B,). Counting (write = 0) puts the number of ball b's points into first[b + 1];
    writing takes first as where each one's begin in ids, and 6 times that in columns: x, y, z relative to the
    ball's centre and the normals' parts, each contiguous (records.Sites).
    """
    for b in range(centres.shape[0]):
        x, y, z, square = centres[b, 0], centres[b, 1], centres[b, 2], radii[b] * radii[b]
        low, high, rows = cells_of(grid, (x, y, z), radii[b])
        found, size = 0, first[b + 1] - first[b] if write == 1 else 0
        for row in range(rows):
            begin, end = run(grid, low, high, rows, row)
            for at in range(begin, end):
                px, py, pz = grid.points[at, 0] - x, grid.points[at, 1] - y, grid.points[at, 2] - z
                if px * px + py * py + pz * pz <= square:
                    if write == 1:
                        to = 6 * first[b] + found
                        ids[first[b] + found] = grid.ids[at]
                        columns[to], columns[to + size], columns[to + 2 * size] = px, py, pz
                        for axis in range(3):
                            columns[to + (3 + axis) * size] = grid.normals[at, axis]
                    found += 1
        if write == 0:
            first[b + 1] = found
