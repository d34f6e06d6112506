"""Which points count at x: within a radius or the k nearest, of the cell's centre or of x itself.

Distances are compared as exact rational numbers, so "equal" means equal.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from tests.oracle.vectors import Vector
from tests.oracle.weights import squares

Cell = tuple[int, int, int]


def cell_centre(cell: Cell) -> list[float]:
    """The middle of the cell [i, i+1)×[j, j+1)×[k, k+1)."""
    return [c + 0.5 for c in cell]


def ball(x: Vector, points: Sequence[Vector], radius: float) -> list[int]:
    """Ids of the points with |p - x| <= radius, in order of id."""
    square, one = squares(x, points)
    limit = Fraction(radius) ** 2 * one
    return [i for i, s in enumerate(square) if s <= limit]


def knn(x: Vector, points: Sequence[Vector], k: int) -> list[int]:
    """Ids of the k points nearest to x, nearest first; at equal distance the lower id first.

    A k larger than the cloud gives the whole cloud.
    """
    square, _ = squares(x, points)
    return sorted(range(len(points)), key=lambda i: (square[i], i))[:k]


def cell_ball(cell: Cell, points: Sequence[Vector], radius: float) -> list[int]:
    """`ball` about the centre of the cell that holds x [T §3.1.3]."""
    return ball(cell_centre(cell), points, radius)


def cell_knn(cell: Cell, points: Sequence[Vector], k: int) -> list[int]:
    """`knn` of the centre of the cell that holds x."""
    return knn(cell_centre(cell), points, k)
