"""The nearest neighbours of points that lie about evenly: looked for in the cells of a grid around each."""

from __future__ import annotations

from math import floor, inf, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import EXACT, STRICT, kernel
from jaart.core.kernels.records import Array, Vector

Ints = NDArray[np.int64]
Rows = NDArray[np.int32]
#: A distance counts as found when what was not looked at is farther by this share: cells are rounded.
_SURE = 1.0 - 1e-9


class Cells(NamedTuple):
    """Points sorted by the cells of a grid that holds all of them.

    low: corner (3,); edge: of a cell; shape: (3,) cells along each axis; first: where each cell's points begin, and the
    end; points: (N, 3) in that order; order: (N,) their numbers.
    """

    low: Array
    edge: float
    shape: Ints
    first: Ints
    points: Array
    order: Ints


@kernel(EXACT, inline=True)
def square_between(points: Array, a: int, x: Vector) -> float:
    """Squared distance of a point and x."""
    dx, dy, dz = points[a, 0] - x[0], points[a, 1] - x[1], points[a, 2] - x[2]
    return dx * dx + dy * dy + dz * dz


@kernel(STRICT, inline=True)
def insert(squares: Array, index: Rows, row: int, square: float, number: int) -> None:
    """Put a neighbour among those of a row, which rise; the last falls out."""
    at = squares.shape[1] - 1
    while at > 0 and squares[row, at - 1] > square:
        squares[row, at], index[row, at] = squares[row, at - 1], index[row, at - 1]
        at -= 1
    squares[row, at], index[row, at] = square, number


@kernel(STRICT, inline=True)
def around(cells: Cells, axis: int, x: float) -> tuple[int, int, float]:
    """First and last cell along an axis beside the one that holds x, and how far x is from what lies beyond them."""
    inner = (x - cells.low[axis]) / cells.edge
    at, last = min(int(floor(inner)), cells.shape[axis] - 1), cells.shape[axis] - 1
    below = inner - (at - 1) if at > 1 else inf
    above = at + 2 - inner if at + 2 <= last else inf
    return max(at - 1, 0), min(at + 1, last), min(below, above) * cells.edge


@kernel(STRICT, entry=True)
def find_nearest(cells: Cells, begin: int, end: int, distance: Array, index: Rows) -> None:
    """Write the nearest others of some of the sorted points into their rows, those that are certain.

    begin, end: which points; distance, index: (N, k) rows by the points' numbers; a row that is not certain begins
    with -1.
    """
    k = index.shape[1]
    for own in range(begin, end):
        row, x = cells.order[own], (cells.points[own, 0], cells.points[own, 1], cells.points[own, 2])
        for a in range(k):
            distance[row, a], index[row, a] = inf, -1
        i0, i1, x_far = around(cells, 0, x[0])
        j0, j1, y_far = around(cells, 1, x[1])
        k0, k1, z_far = around(cells, 2, x[2])
        for line in range((i1 - i0 + 1) * (j1 - j0 + 1)):
            i, j = i0 + line // (j1 - j0 + 1), j0 + line % (j1 - j0 + 1)
            cell = (i * cells.shape[1] + j) * cells.shape[2]
            for at in range(cells.first[cell + k0], cells.first[cell + k1 + 1]):
                square = square_between(cells.points, at, x)
                if square < distance[row, k - 1] and at != own:
                    insert(distance, index, row, square, cells.order[at])
        far = min(x_far, min(y_far, z_far)) * _SURE
        if distance[row, k - 1] < far * far:
            for a in range(k):
                distance[row, a] = sqrt(distance[row, a])
        else:
            distance[row, 0] = -1.0
