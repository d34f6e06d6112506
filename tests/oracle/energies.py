"""Energies whose minimum along a ray is a hit. Each is None where it is undefined."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tests.oracle.normals import NORMALS, offset
from tests.oracle.surfaces import tangent
from tests.oracle.vectors import Vector, dot, minus, times
from tests.oracle.weights import relative

Points = Sequence[Vector]


def e_ts(x: Vector, direction: Vector, points: Points, normals: Points | None, h: float, weight: str = "gaussian",
         kind: str = "surfel") -> float | None:
    """f(x)/<n(x), d>, the signed way along the unit direction d to the plane H(x) [T 2.20].

    Infinite, with the sign of f, where the plane is parallel to d; None when it then also holds x.
    """
    f, n = tangent(x, points, normals, h, weight, kind), NORMALS[kind](x, points, normals, h, weight).vector
    if f is None or n is None:
        return None
    cosine = dot(n, direction)
    if cosine == 0:
        return math.copysign(math.inf, f) if f else None
    return f / cosine


def e_oc(x: Vector, points: Points, h: float, weight: str = "gaussian") -> float | None:
    """|x - a(x)|, the off-centre value [T 2.22]."""
    off = offset(x, points, h, weight)
    return None if off is None else math.hypot(*off)


def e_mahalanobis(x: Vector, points: Points, normals: Points, h: float, c: float = 0.25,
                  weight: str = "gaussian") -> float | None:
    """e_M(x) = Σθ_N (<x-p_i,n_i>² + c·|(x-p_i) - <x-p_i,n_i>n_i|²), a squared length [T 2.17, 2.18]."""
    weights = relative(weight, x, points, h)
    if not any(weights):
        return None
    distances = []
    for p, n in zip(points, normals, strict=True):
        away = minus(x, p)
        height = dot(away, n)
        within = minus(away, times(n, height))
        distances.append(height * height + c * dot(within, within))
    return math.fsum(w * d for w, d in zip(weights, distances, strict=True)) / math.fsum(weights)


def e_angle(x: Vector, points: Points, normals: Points | None, h: float, weight: str = "gaussian",
            kind: str = "surfel") -> float | None:
    """|<c(x)/|c(x)|, n(x)>|, from 0 on the surface to 1 [T 2.23]; 0 at x = a(x)."""
    off = offset(x, points, h, weight)
    n = NORMALS[kind](x, points, normals, h, weight).vector
    if off is None or n is None:
        return None
    length = math.hypot(*off)
    return abs(dot(times(off, 1 / length), n)) if length > 0 else 0.0


def emphasised(angle: float | None, energy: float | None) -> float | None:
    """1 - (1 - |e_angle|)(1 - |e|), |e| capped at 1 [T 2.24]; None when either is."""
    if angle is None or energy is None:
        return None
    return 1 - (1 - abs(angle)) * (1 - min(abs(energy), 1.0))
