"""The points near a ball, found in a grid whose cells are sorted, and copied into columns."""

from __future__ import annotations

from math import floor
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.address import floats_at, ids_at, points_at, wholes_at
from jaart.core.kernels.blocks import PARTS, SOURCE, columns_in, fill_up, lay, spare_ids, wide_of
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Cell, Vector

Ints = NDArray[np.int64]
#: What a pool knows: how many points; addresses of the grid's corner with its edge, its shape, keys, points, normals
#: and ids, of the balls' centres and of how far around each a point counts.
(COUNT, LOW, SHAPE, KEYS, POINTS, NORMALS, IDS, CENTRES, REACH) = range(SOURCE, SOURCE + 9)


class Grid(NamedTuple):
    """Points sorted by the cells of a grid.

    low: corner (3,) and what follows; edge: of a cell; shape: (3,) cells along each axis; keys: (N,) number of each
    point's cell, C order, rising; points, normals: (N, 3) in that order, or no normals; ids: (N,) their numbers in the
    cloud.
    """

    low: Array
    edge: float
    shape: Ints
    keys: Ints
    points: Array
    normals: Array
    ids: NDArray[np.int32]


@kernel(STRICT)
def first_at_least(keys: Ints, key: int) -> int:
    """Where the first number that is not below a key stands in rising numbers: halved without a branch."""
    at, left = 0, keys.shape[0]
    while left > 1:
        half = left // 2
        at += half if keys[at + half - 1] < key else 0
        left -= half
    return at + 1 if left == 1 and keys[at] < key else at


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


@kernel(STRICT)
def grid_of(pool: Ints) -> Grid:
    """The grid that a pool gathers from."""
    count, low = pool[COUNT], floats_at(pool[LOW], 4)
    return Grid(low, low[3], wholes_at(pool[SHAPE], 3), wholes_at(pool[KEYS], count), points_at(pool[POINTS], count),
                points_at(pool[NORMALS], count), ids_at(pool[IDS], count))


@kernel(STRICT, inline=True)
def is_within(grid: Grid, at: int, centre: Vector, square: float) -> bool:
    """Whether a point lies no farther from a centre than the root of a square."""
    x, y, z = grid.points[at, 0] - centre[0], grid.points[at, 1] - centre[1], grid.points[at, 2] - centre[2]
    return x * x + y * y + z * z <= square


@kernel(STRICT)
def find(grid: Grid, centre: Vector, radius: float, ids: Any) -> int:
    """Write down where in the grid the points within a ball stand, as many as there is room for; returns how many."""
    found, (low, high, rows) = 0, cells_of(grid, centre, radius)
    for row in range(rows):
        begin, end = run(grid, low, high, rows, row)
        if found + end - begin <= ids.shape[0]:
            for at in range(begin, end):  # without a branch, which nobody could foresee
                ids[found] = at
                found += 1 if is_within(grid, at, centre, radius * radius) else 0
            continue
        for at in range(begin, end):
            if is_within(grid, at, centre, radius * radius):
                if found < ids.shape[0]:
                    ids[found] = at
                found += 1
    return found


@kernel(STRICT)
def gather_ball(pool: Ints, cell: Cell) -> int:
    """Gather the points within reach of a ball's centre; returns the block's address, 0 where there is no room.

    cell: the ball's number, then 0, 0.
    """
    grid, ball = grid_of(pool), cell[0]
    at, reach = points_at(pool[CENTRES], ball + 1), floats_at(pool[REACH], ball + 1)
    centre = (at[ball, 0], at[ball, 1], at[ball, 2])
    spare, most = spare_ids(pool)
    ids = ids_at(spare, most)
    size = find(grid, centre, reach[ball], ids)
    address = lay(pool, size)
    if address == 0:
        return 0
    parts, wide = pool[PARTS], wide_of(size)
    columns = floats_at(columns_in(pool, address, size), parts * wide)
    fill_up(columns, parts, size)
    for a in range(size):
        one = ids[a]
        for axis in range(3):
            columns[axis * wide + a] = grid.points[one, axis] - centre[axis]
            if parts == 6:
                columns[(3 + axis) * wide + a] = grid.normals[one, axis]
    return address


@kernel(STRICT, entry=True)
def read_ids(pool: Ints, balls: Ints, first: Ints, ids: NDArray[np.int32]) -> None:
    """Write the ids of the points near some balls (P,), in the order that they are gathered in.

    first: (P + 1,) where each one's begin in ids.
    """
    grid = grid_of(pool)
    for p in range(balls.shape[0]):
        ball, own = balls[p], ids[first[p]:first[p + 1]]
        at, reach = points_at(pool[CENTRES], ball + 1), floats_at(pool[REACH], ball + 1)
        find(grid, (at[ball, 0], at[ball, 1], at[ball, 2]), reach[ball], own)
        for a in range(own.shape[0]):
            own[a] = grid.ids[own[a]]
