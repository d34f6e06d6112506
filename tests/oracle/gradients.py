"""The truth in 50 digits: f of the tangent surface, and its gradient by central differences.

With 50 digits and steps of 1e-15 a difference is good to 1e-28, so nothing has to be derived by hand. Formulas are
written again here, in mpmath, whose exponents have no limit: at a distance of q the exponent of a weight is good to
1e-50 q²/h².
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mpmath

from tests.oracle.normals import UNDEFINED
from tests.oracle.vectors import Vector
from tests.oracle.weights import WEIGHTS

DIGITS = 50
STEP = mpmath.mpf(10) ** -15

Exact = list[Any]


def _exact(vectors: Sequence[Vector]) -> list[Exact]:
    return [[mpmath.mpf(c) for c in v] for v in vectors]


def _sum(weights: Exact, vectors: list[Exact]) -> Exact:
    return [mpmath.fsum(w * v[k] for w, v in zip(weights, vectors, strict=True)) for k in range(3)]


def _dot(a: Exact, b: Exact) -> Any:
    return mpmath.fsum(p * q for p, q in zip(a, b, strict=True))


def _least(away: list[Exact], weights: Exact, total: Any) -> Exact | None:
    """Eigenvector of the smallest eigenvalue of Σθ b bᵀ/Σθ, or None without a gap."""
    matrix = mpmath.matrix(3, 3)
    for j in range(3):
        for k in range(3):
            matrix[j, k] = mpmath.fsum(w * b[j] * b[k] for w, b in zip(weights, away, strict=True)) / total
    values, vectors = mpmath.eigsy(matrix)
    order = sorted(range(3), key=lambda k: values[k])
    if values[order[1]] - values[order[0]] <= UNDEFINED * values[order[2]]:
        return None
    return [vectors[k, order[0]] for k in range(3)]


def normal_and_offset(x: Sequence[Any], points: Sequence[Vector], normals: Sequence[Vector] | None, h: float,
                      weight: str = "gaussian", kind: str = "surfel",
                      like: Exact | None = None) -> tuple[Exact, Exact] | None:
    """n(x) and a(x) - x in mpmath numbers, or None where undefined.

    kind: surfel, covariance or covariance_at_x. An eigenvector is turned to the averaged surfel normal; without
    normals to the vector `like`, if given.
    """
    with mpmath.workdps(DIGITS):
        centre, feature = [mpmath.mpf(c) for c in x], mpmath.mpf(h)
        q = [[c - o for c, o in zip(p, centre, strict=True)] for p in _exact(points)]
        weights = [WEIGHTS[weight](mpmath.sqrt(_dot(b, b)), feature) for b in q]
        total = mpmath.fsum(weights)
        if total == 0:
            return None
        off = [c / total for c in _sum(weights, q)]
        average = _sum(weights, _exact(normals)) if normals is not None else like
        if kind == "surfel":
            if normals is None or average is None:
                return None
            length = mpmath.sqrt(_dot(average, average))
            return ([c / length for c in average], off) if length > UNDEFINED * total else None
        away = q if kind == "covariance_at_x" else [[b - c for b, c in zip(v, off, strict=True)] for v in q]
        n = _least(away, weights, total)
        if n is not None and average is not None and _dot(n, average) < 0:
            n = [-c for c in n]
        return None if n is None else (n, off)


def exact_tangent(x: Sequence[Any], points: Sequence[Vector], normals: Sequence[Vector] | None, h: float,
                  weight: str = "gaussian", kind: str = "surfel", like: Exact | None = None) -> Any:
    """f(x) = <n(x), a(x) - x> [T 2.15] as an mpmath number; None where undefined."""
    found = normal_and_offset(x, points, normals, h, weight, kind, like)
    with mpmath.workdps(DIGITS):
        return None if found is None else _dot(*found)


def tangent_gradient(x: Vector, points: Sequence[Vector], normals: Sequence[Vector] | None, h: float,
                     weight: str = "gaussian", kind: str = "surfel", like: Vector | None = None) -> list[float] | None:
    """∇f at x to the last bit of a float; None where f is undefined at x or a step beside it.

    Where a compact weight has a kink within a step of x (the hat at a point or at its rim), there is no gradient.
    An eigenvector keeps the side it has at x; without normals that of `like`, or without one some side.
    """
    with mpmath.workdps(DIGITS):
        side = [mpmath.mpf(c) for c in like] if like is not None else None
        here = normal_and_offset(x, points, normals, h, weight, kind, side)
        if here is None:
            return None
        given, slopes = normals if kind == "surfel" else None, []
        for k in range(3):
            values = []
            for sign in (1, -1):
                place = [mpmath.mpf(c) + (sign * STEP if i == k else 0) for i, c in enumerate(x)]
                values.append(exact_tangent(place, points, given, h, weight, kind, here[0]))
            if None in values:
                return None
            slopes.append(float((values[0] - values[1]) / (2 * STEP)))
        return slopes
