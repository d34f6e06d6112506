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
#: A distance counts as found when what was not looked at is farther by this share, and by so many edges: cells are
#: rounded.
_SURE, _SLACK = 1.0 - 1e-9, 1e-9


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
def around(cells: Cells, axis: int, x: float) -> tuple[int, float, float]:
    """The cell along an axis that holds x, and how far x is from its lower and upper end, in edges."""
    inner = (x - cells.low[axis]) / cells.edge
    at = min(int(floor(inner)), cells.shape[axis] - 1)
    return at, inner - at, at + 1 - inner


@kernel(STRICT, inline=True)
def beyond(cells: Cells, axis: int, at: int, below: float, above: float) -> float:
    """How far x is along an axis from the points that lie beyond the cells beside its own."""
    return min(below + 1.0 if at > 1 else inf, above + 1.0 if at + 2 < cells.shape[axis] else inf) * cells.edge


@kernel(STRICT, inline=True)
def gap(step: int, below: float, above: float) -> float:
    """How far x is along an axis from the cells one step aside of its own, in edges, at least."""
    return 0.0 if step == 0 else max((below if step < 0 else above) - _SLACK, 0.0)


@kernel(STRICT, entry=True)
def find_nearest(cells: Cells, begin: int, end: int, distance: Array, index: Rows) -> None:
    """Write the nearest others of some of the sorted points into their rows, those that are certain.

    begin, end: which points; distance, index: (N, k) rows by the points' numbers; a row that is not certain begins
    with -1. The cells' rows along z are looked through from the point's own one outwards.
    """
    k = index.shape[1]
    for own in range(begin, end):
        row, x = cells.order[own], (cells.points[own, 0], cells.points[own, 1], cells.points[own, 2])
        for a in range(k):
            distance[row, a], index[row, a] = inf, -1
        at_i, x_below, x_above = around(cells, 0, x[0])
        at_j, y_below, y_above = around(cells, 1, x[1])
        at_k, z_below, z_above = around(cells, 2, x[2])
        low, high = max(at_k - 1, 0), min(at_k + 1, cells.shape[2] - 1)
        for turn in range(9):
            di, dj = (0, -1, 1)[turn // 3], (0, -1, 1)[turn % 3]
            i, j = at_i + di, at_j + dj
            if not (0 <= i < cells.shape[0] and 0 <= j < cells.shape[1]):
                continue
            dx, dy = gap(di, x_below, x_above) * cells.edge, gap(dj, y_below, y_above) * cells.edge
            if dx * dx + dy * dy >= distance[row, k - 1]:
                continue
            cell = (i * cells.shape[1] + j) * cells.shape[2]
            for at in range(cells.first[cell + low], cells.first[cell + high + 1]):
                square = square_between(cells.points, at, x)
                if square < distance[row, k - 1] and at != own:
                    insert(distance, index, row, square, cells.order[at])
        far = min(beyond(cells, 0, at_i, x_below, x_above), min(beyond(cells, 1, at_j, y_below, y_above),
                                                                beyond(cells, 2, at_k, z_below, z_above))) * _SURE
        if distance[row, k - 1] < far * far:
            for a in range(k):
                distance[row, a] = sqrt(distance[row, a])
        else:
            distance[row, 0] = -1.0
