"""Vectors as tuples of three numbers."""

from __future__ import annotations

from math import sqrt

from jaart.core.kernels.jit import EXACT, kernel
from jaart.core.kernels.records import Vector


@kernel(EXACT)
def dot(a: Vector, b: Vector) -> float:
    """<a, b>."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel(EXACT)
def length(a: Vector) -> float:
    """|a|."""
    return sqrt(dot(a, a))


@kernel(EXACT)
def along(base: Vector, d: Vector, s: float) -> Vector:
    """base + s·d."""
    return base[0] + s * d[0], base[1] + s * d[1], base[2] + s * d[2]


@kernel(EXACT)
def scaled(a: Vector, s: float) -> Vector:
    """s·a."""
    return s * a[0], s * a[1], s * a[2]


@kernel(EXACT)
def frame(n: Vector) -> tuple[Vector, Vector]:
    """Two unit vectors that are perpendicular to a unit vector and to each other.

    Without a branch on which component is largest [Duff et al. 2017, Building an orthonormal basis, revisited].
    """
    sign = 1.0 if n[2] >= 0.0 else -1.0
    a = -1.0 / (sign + n[2])
    b = n[0] * n[1] * a
    return (1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]), (b, sign + n[1] * n[1] * a, -n[1])
