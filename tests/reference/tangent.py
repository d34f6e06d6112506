"""The tangent surface f(x) = <n(x), a(x) - x> [T 2.15, A 5] to 50 digits, every surfel counted, Gaussian weights.

The formulas as they stand, in mpmath: points, normals, x and h are taken as the exact numbers that floats are.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Exact = list[Any]

#: Digits that are carried; 40 of them are stored.
DIGITS = 60
#: exp(-140) is below the last digit.
NEGLIGIBLE = 140.0
#: A context of its own, so that no other test counts in these digits.
MP = mpmath.MPContext()
MP.dps = DIGITS
mpf = MP.mpf


@dataclass(frozen=True)
class Place:
    """The surface at a point: f, the unit normal n, the off-centre vector a - x."""

    f: Any
    n: Exact
    off: Exact


def dot(a: Exact, b: Exact) -> Any:
    """<a, b>."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def unit(a: Exact) -> Exact:
    """a/|a|."""
    length = MP.sqrt(dot(a, a))
    return [c / length for c in a]


@dataclass(frozen=True, eq=False)
class Tangent:
    """A surface; points, normals: (N, 3); h: a float; normal: surfel, or covariance about a(x) [A 8, 9].

    negligible: surfels lighter than the nearest by exp(-this) are left out.
    """

    points: Array
    normals: Array
    h: float
    normal: str
    negligible: float = NEGLIGIBLE

    def at(self, x: Exact) -> Place:
        """The surface at x, to all digits."""
        near = np.array([float(c) for c in x])
        square = ((self.points - near) ** 2).sum(axis=1) / self.h**2
        used = np.flatnonzero(square - square.min() < self.negligible)
        q = [[mpf(float(c)) - b for c, b in zip(self.points[i], x, strict=True)] for i in used]
        y = [dot(v, v) / mpf(self.h) ** 2 for v in q]
        least = min(y)
        w = [MP.exp(least - e) for e in y]
        total = MP.fsum(w)
        off = [MP.fdot(w, [v[k] for v in q]) / total for k in range(3)]
        m = [MP.fdot(w, [mpf(float(self.normals[i, k])) for i in used]) for k in range(3)]
        n = unit(m) if self.normal == "surfel" else least_direction(w, q, off, m)
        return Place(dot(n, off), n, off)


def least_direction(w: Exact, q: list[Exact], off: Exact, m: Exact) -> Exact:
    """The direction in which the points spread least about a(x), turned to the side of m."""
    b = [[v[k] - off[k] for k in range(3)] for v in q]
    matrix = MP.matrix(3, 3)
    for i in range(3):
        weighed = [weight * v[i] for weight, v in zip(w, b, strict=True)]
        for j in range(i, 3):
            matrix[i, j] = matrix[j, i] = MP.fdot(weighed, [v[j] for v in b])
    vectors = MP.eigsy(matrix)[1]
    n = unit([vectors[k, 0] for k in range(3)])
    return n if dot(n, m) > 0 else [-c for c in n]


class Quick:
    """The same surface in float64, at many points at once: where a root is, but not its last digits."""

    def __init__(self, surface: Tangent) -> None:
        self.surface = surface
        self.middle = surface.points.mean(axis=0)
        self.points = surface.points - self.middle

    def at(self, x: Array) -> tuple[Array, Array, Array, Array]:
        """f (K,), n (K, 3), |a - x| (K,) and the distance to the nearest point (K,), x (K, 3) from the middle on."""
        q = self.points - x[:, None]
        square = (q**2).sum(axis=2)
        least = square.min(axis=1)
        w = np.exp(-(square - least[:, None]) / self.surface.h**2)
        w /= w.sum(axis=1, keepdims=True)
        off = np.einsum("kn,kni->ki", w, q)
        n = w @ self.surface.normals
        if self.surface.normal == "covariance":
            b = q - off[:, None]
            spread = np.linalg.eigh(np.einsum("kn,kni,knj->kij", w, b, b))[1][:, :, 0]
            n = spread * np.where((spread * n).sum(axis=1) < 0, -1.0, 1.0)[:, None]
        n = n / np.linalg.norm(n, axis=1, keepdims=True)
        return (n * off).sum(axis=1), n, np.linalg.norm(off, axis=1), np.sqrt(least)
