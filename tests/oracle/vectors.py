"""Vectors of three numbers, as lists."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

Vector = Sequence[float]


def dot(a: Vector, b: Vector) -> float:
    """<a, b>."""
    return math.fsum(x * y for x, y in zip(a, b, strict=True))


def minus(a: Vector, b: Vector) -> list[float]:
    """a - b."""
    return [x - y for x, y in zip(a, b, strict=True)]


def times(a: Vector, s: float) -> list[float]:
    """a·s."""
    return [x * s for x in a]


def along(origin: Vector, direction: Vector, t: float) -> list[float]:
    """o + t·d."""
    return [o + t * d for o, d in zip(origin, direction, strict=True)]


def cross(a: Vector, b: Vector) -> list[float]:
    """a × b."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a: Vector) -> list[float]:
    """a/|a|."""
    return times(a, 1 / math.hypot(*a))


def mean(vectors: Iterable[Vector], weights: Sequence[float]) -> list[float]:
    """Σw_i v_i / Σw_i."""
    columns = zip(*vectors, strict=True)
    total = math.fsum(weights)
    return [math.fsum(w * c for w, c in zip(weights, column, strict=True)) / total for column in columns]


def frame(n: Vector) -> tuple[list[float], list[float]]:
    """Two unit vectors that are orthogonal to the unit vector n and to each other; u × v = n."""
    axis = [0.0, 0.0, 0.0]
    axis[min(range(3), key=lambda k: abs(n[k]))] = 1.0
    u = unit(cross(axis, n))
    return u, cross(n, u)
