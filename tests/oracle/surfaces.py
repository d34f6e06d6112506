"""Surfaces as the zero set of a signed f(x): the tangent plane's height, and a polynomial's in the local frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tests.oracle.normals import NORMALS, offset
from tests.oracle.vectors import Vector, dot, frame, minus
from tests.oracle.weights import relative

#: Points with less than this share of the largest weight do not count as support of a fit.
SUPPORT = 1e-6
#: A fit needs this many supporting points for each coefficient, ...
POINTS_PER_COEFFICIENT = 1.5
#: ... and this ratio of the least to the largest |R_kk| of its QR decomposition in u/h, v/h.
CONDITION = 1e-7


def tangent(x: Vector, points: Sequence[Vector], normals: Sequence[Vector] | None, h: float,
            weight: str = "gaussian", kind: str = "surfel") -> float | None:
    """f(x) = <n(x), a(x) - x> [T 2.15, A 5]; None where the normal is undefined or no point is in reach."""
    off = offset(x, points, h, weight)
    n = NORMALS[kind](x, points, normals, h, weight).vector
    return None if off is None or n is None else dot(n, off)


@dataclass
class Fit:
    """A polynomial g(u, v) over the plane through an origin with normal n.

    value: g(0, 0), a length; degree: that used, at most that asked for; coefficients: of `powers(degree)`, with u and v
    in h and heights in scene units; ratio: min |R_kk| / max |R_kk|.
    """

    value: float
    degree: int
    coefficients: list[float]
    ratio: float
    origin: list[float]
    n: list[float]
    u: list[float]
    v: list[float]
    h: float

    def height(self, u: float, v: float) -> float:
        """g at u and v, in scene units."""
        terms = zip(self.coefficients, powers(self.degree), strict=True)
        return math.fsum(c * (u / self.h) ** i * (v / self.h) ** j for c, (i, j) in terms)

    def crossings(self, origin: Vector, direction: Vector) -> list[float]:
        """Every t at which the ray o + t·d meets the polynomial, in order; [] when it runs within it."""
        start = minus(origin, self.origin)
        u, v, w = (np.poly1d([dot(direction, e), dot(start, e)]) for e in (self.u, self.v, self.n))
        along = -1.0 * w
        for c, (i, j) in zip(self.coefficients, powers(self.degree), strict=True):
            along = along + c * (u / self.h) ** i * (v / self.h) ** j
        negligible = 1e-15 * max(abs(along.coef))
        roots = np.roots(np.where(abs(along.coef) > negligible, along.coef, 0.0))
        return sorted(float(r.real) for r in roots if abs(r.imag) <= 1e-12 * (1 + abs(r)))


def powers(degree: int) -> list[tuple[int, int]]:
    """(i, j) of every monomial u^i v^j up to the degree: 1, u, v, u², uv, v², ..."""
    return [(total - j, j) for total in range(degree + 1) for j in range(total + 1)]


def polynomial_fit(x: Vector, points: Sequence[Vector], normals: Sequence[Vector] | None, h: float, degree: int,
                   weight: str = "gaussian", kind: str = "surfel") -> Fit | None:
    """The weighted least squares polynomial over H(x), the plane through x with normal n(x) [A §4, 10].

    Heights are <n, p_i - x>, weights θ_i(x). The degree is the largest, up to that asked for, which enough points
    support and whose QR is well conditioned; degree 0 is the weighted mean of the heights.
    None where n(x) is undefined or no point is in reach.
    """
    n = NORMALS[kind](x, points, normals, h, weight).vector
    return None if n is None else fit_over(x, n, points, h, degree, weight)


def fit_over(origin: Vector, n: Vector, points: Sequence[Vector], h: float, degree: int, weight: str) -> Fit:
    """The fit over a given plane, with weights θ(|p_i - origin|)."""
    u, v = frame(n)
    weights = relative(weight, origin, points, h)
    used = [(w, minus(p, origin)) for w, p in zip(weights, points, strict=True) if w > 0]
    supporting = sum(1 for w, _ in used if w > SUPPORT)
    roots = np.array([math.sqrt(w) for w, _ in used])
    heights = roots * np.array([dot(q, n) for _, q in used])
    place = [(dot(q, u) / h, dot(q, v) / h) for _, q in used]
    for tried in range(degree, 0, -1):
        terms = powers(tried)
        if supporting < POINTS_PER_COEFFICIENT * len(terms):
            continue
        rows = roots[:, None] * np.array([[s**i * t**j for i, j in terms] for s, t in place])
        q, r = np.linalg.qr(rows)
        diagonal = np.abs(np.diag(r))
        ratio = float(diagonal.min() / diagonal.max())
        if ratio >= CONDITION:
            coefficients = [float(c) for c in np.linalg.solve(r, q.T @ heights)]
            return Fit(coefficients[0], tried, coefficients, ratio, list(origin), list(n), u, v, h)
    mean_height = math.fsum(w * dot(q, n) for w, q in used) / math.fsum(w for w, _ in used)
    return Fit(mean_height, 0, [mean_height], 1.0, list(origin), list(n), u, v, h)


def polynomial(x: Vector, points: Sequence[Vector], normals: Sequence[Vector] | None, h: float, degree: int,
               weight: str = "gaussian", kind: str = "surfel") -> float | None:
    """f(x) = g(0, 0), the constant term of the fit at x [A §4 step 3]; for degree 0 the f of `tangent`."""
    fit = polynomial_fit(x, points, normals, h, degree, weight, kind)
    return None if fit is None else fit.value
