"""Slopes of energies along a direction, in 50 digits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mpmath

from jaart.core.kernels import records as r
from tests.oracle.vectors import Vector
from tests.oracle.weights import WEIGHTS

DIGITS, STEP = 50, mpmath.mpf(10) ** -17


def exact_energy(kind: int, weight: str, x: Sequence[Any], points: Sequence[Vector], normals: Sequence[Vector],
                 h: float, c: float) -> Any:
    """e_oc or e_M in mpmath numbers, as the formulas stand [T 2.22, 2.17, 2.18]."""
    q = [[mpmath.mpf(a) - b for a, b in zip(p, x, strict=True)] for p in points]
    w = [WEIGHTS[weight](mpmath.sqrt(sum(a * a for a in b)), mpmath.mpf(h)) for b in q]
    total = mpmath.fsum(w)
    if kind == r.OFF_CENTRE:
        return mpmath.sqrt(sum((mpmath.fsum(v * b[k] for v, b in zip(w, q, strict=True)) / total) ** 2
                               for k in range(3)))
    distances = []
    for b, n in zip(q, normals, strict=True):
        s = sum(a * mpmath.mpf(m) for a, m in zip(b, n, strict=True))
        across = [a - s * mpmath.mpf(m) for a, m in zip(b, n, strict=True)]
        distances.append(s * s + mpmath.mpf(c) * sum(a * a for a in across))
    return mpmath.fsum(v * e for v, e in zip(w, distances, strict=True)) / total


def exact_slope(kind: int, weight: str, x: Vector, d: Vector, points: Sequence[Vector], normals: Sequence[Vector],
                h: float, c: float) -> float:
    """∂e/∂d by a central difference."""
    with mpmath.workdps(DIGITS):
        a, b = ([mpmath.mpf(p) + sign * STEP * mpmath.mpf(m) for p, m in zip(x, d, strict=True)] for sign in (1, -1))
        return float((exact_energy(kind, weight, a, points, normals, h, c)
                      - exact_energy(kind, weight, b, points, normals, h, c)) / (2 * STEP))
