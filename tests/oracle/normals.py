"""The normal n(x) of the local frame: averaged from surfels, or the direction in which the points vary least."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tests.oracle.vectors import Vector, dot, mean, minus, times
from tests.oracle.weights import relative

#: An averaged normal shorter than this, or a gap (λ1 - λ0)/λ2 not above it, is undefined.
UNDEFINED = 1e-8


@dataclass
class Normal:
    """A unit normal, or None where it is undefined, and what it was made of.

    length: |Σθn|/Σθ (surfel normals); eigenvalues: λ0 <= λ1 <= λ2 of the covariance with Σθ = 1, in length².
    """

    vector: list[float] | None
    length: float | None = None
    eigenvalues: tuple[float, float, float] | None = None

    @property
    def gap(self) -> float | None:
        """(λ1 - λ0)/λ2, the criterion of good sampling [A Definition 2]; 0 when all points lie in x."""
        if self.eigenvalues is None:
            return None
        low, middle, high = self.eigenvalues
        return (middle - low) / high if high > 0 else 0.0


def offset(x: Vector, points: Sequence[Vector], h: float, weight: str = "gaussian") -> list[float] | None:
    """The off-centre vector c(x) = a(x) - x = Σθ_i (p_i - x) / Σθ_i [T 2.12, A 1]; None with no point in reach."""
    weights = relative(weight, x, points, h)
    return mean([minus(p, x) for p in points], weights) if any(weights) else None


def surfel(x: Vector, points: Sequence[Vector], normals: Sequence[Vector] | None, h: float,
           weight: str = "gaussian") -> Normal:
    """n(x) = Σθ_i n_i / |Σθ_i n_i| [T 2.13]; undefined when |Σθn| <= 1e-8 Σθ, and for points without normals."""
    weights = relative(weight, x, points, h)
    if normals is None or not any(weights):
        return Normal(None)
    m = mean(normals, weights)
    length = math.hypot(*m)
    return Normal(times(m, 1 / length) if length > UNDEFINED else None, length=length)


def covariance(x: Vector, points: Sequence[Vector], normals: Sequence[Vector] | None, h: float,
               weight: str = "gaussian") -> Normal:
    """Eigenvector of the smallest eigenvalue of Σθ_i (p_i - a)(p_i - a)ᵀ / Σθ_i, about the barycentre a(x)."""
    off = offset(x, points, h, weight)
    return Normal(None) if off is None else _least(x, off, points, normals, h, weight)


def covariance_at_x(x: Vector, points: Sequence[Vector], normals: Sequence[Vector] | None, h: float,
                    weight: str = "gaussian") -> Normal:
    """Eigenvector of the smallest eigenvalue of B(x) = Σθ_i (p_i - x)(p_i - x)ᵀ / Σθ_i [T §2.3.3, A 8-9]."""
    off = offset(x, points, h, weight)
    return Normal(None) if off is None else _least(x, [0.0, 0.0, 0.0], points, normals, h, weight)


def _least(x: Vector, centre: Vector, points: Sequence[Vector], normals: Sequence[Vector] | None, h: float,
           weight: str) -> Normal:
    """The least eigenvector about x + centre, turned to the averaged surfel normal where there are normals.

    Without normals its sign is of no meaning.
    """
    weights = relative(weight, x, points, h)
    away = [minus(minus(p, x), centre) for p in points]
    matrix = mean([[b[j] * b[k] for j in range(3) for k in range(3)] for b in away], weights)
    values, vectors = np.linalg.eigh(np.array(matrix).reshape(3, 3))
    low, middle, high = (float(v) for v in values)
    found = Normal(None, eigenvalues=(low, middle, high))
    if middle - low > UNDEFINED * high:
        n = [float(c) for c in vectors[:, 0]]
        found.vector = times(n, -1.0) if normals is not None and dot(n, mean(normals, weights)) < 0 else n
    return found


NORMALS = {"surfel": surfel, "covariance": covariance, "covariance_at_x": covariance_at_x}
