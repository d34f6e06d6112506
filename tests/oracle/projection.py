"""The point set surface by projection (Levin 2003; Alexa et al. 2001, 2003) [T §2.3.2, 2.8-2.11].

For r near the surface find the reference plane through q = r + t·n with unit normal n that minimises
    E(t, n) = Σ <n, p_i - q>² θ(|p_i - q|),
the weights taken about q, the foot of r. Then fit a polynomial g over that plane, weights again about q, and project:
    ψ(r) = q + g(0, 0)·n.    The surface is where ψ(r) = r, so f(r) = <n, ψ(r) - r> = t + g(0, 0).

E has many local minima, and falls to 0 far away where all weights vanish. The one meant is found from the start
n_0 = n(r) (the named normal kind) and t_0 = <n_0, a(r) - r>, with |t - t_0| < h/2 and n tilted from n_0 by a tangent of
less than 1/2 in each of two orthogonal directions; without one in there f is undefined.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import optimize

from tests.oracle.normals import NORMALS, offset
from tests.oracle.surfaces import Fit, fit_over
from tests.oracle.vectors import Vector, along, dot, frame, minus, times, unit
from tests.oracle.weights import WEIGHTS, slope

#: Half the range of (t - t_0)/h and of both tangents of the tilt.
RANGE = 0.5


@dataclass
class Projection:
    """The reference plane of r, q = r + t·n, and the fit over it; value: f(r) = t + g(0, 0)."""

    t: float
    n: list[float]
    fit: Fit
    value: float
    point: list[float]


def plane_energy(r: Vector, t: float, n: Vector, points: Sequence[Vector], h: float, weight: str = "gaussian") -> float:
    """E(t, n) = Σ <n, p_i - r - t·n>² θ(|p_i - r - t·n|) [T 2.11], n of unit length."""
    q = along(r, n, t)
    return math.fsum(dot(n, minus(p, q)) ** 2 * WEIGHTS[weight](math.dist(p, q), h) for p in points)


def plane_gradient(r: Vector, t: float, n: Vector, points: Sequence[Vector], h: float,
                   weight: str = "gaussian") -> tuple[float, list[float]]:
    """∂E/∂t and the derivative of E by n within the sphere of unit vectors.

    With b_i = p_i - q, s_i = <n, b_i> and ψ_i = -θ'(|b_i|)/|b_i|:
    ∂E/∂t = Σ(s_i³ ψ_i - 2 s_i θ_i), and by n the tangential part of Σ(2 s_i θ_i + t s_i² ψ_i) b_i.
    """
    q = along(r, n, t)
    by_t, by_n = [], []
    for p in points:
        b = minus(p, q)
        s, distance = dot(n, b), math.hypot(*b)
        theta, psi = WEIGHTS[weight](distance, h), slope(weight, distance, h)
        by_t.append(s**3 * psi - 2 * s * theta)
        by_n.append(times(b, 2 * s * theta + t * s * s * psi))
    total = [math.fsum(column) for column in zip(*by_n, strict=True)]
    return math.fsum(by_t), minus(total, times(n, dot(n, total)))


def reference_plane(r: Vector, n0: Vector, t0: float, points: Sequence[Vector], h: float,
                    weight: str = "gaussian") -> tuple[float, list[float]] | None:
    """(t, n) of the minimum of E within the range about the start, or None."""
    u, v = frame(n0)

    def plane(place: np.ndarray) -> tuple[float, list[float], list[float]]:
        m = [n + float(place[1]) * a + float(place[2]) * b for n, a, b in zip(n0, u, v, strict=True)]
        return t0 + float(place[0]) * h, unit(m), m

    scale = math.fsum(WEIGHTS[weight](math.dist(p, along(r, n0, t0)), h) for p in points) * h * h
    if scale <= 0:
        return None

    def energy(place: np.ndarray) -> float:
        t, n, _ = plane(place)
        return plane_energy(r, t, n, points, h, weight) / scale

    def gradient(place: np.ndarray) -> np.ndarray:
        t, n, m = plane(place)
        by_t, by_n = plane_gradient(r, t, n, points, h, weight)
        return np.array([by_t * h, dot(by_n, u) / math.hypot(*m), dot(by_n, v) / math.hypot(*m)]) / scale

    bounds = [(-RANGE, RANGE)] * 3
    least = optimize.minimize(energy, np.zeros(3), jac=gradient, bounds=bounds, method="L-BFGS-B",
                              options={"ftol": 0.0, "gtol": 1e-10, "maxiter": 1000})
    if max(abs(least.x)) >= RANGE:
        return None
    # A minimum of values is known to half the digits only; the root of the gradient to all.
    root = optimize.root(gradient, least.x, options={"xtol": 1e-14})
    better = max(abs(root.x - least.x)) < 1e-3 and max(abs(gradient(root.x))) <= max(abs(gradient(least.x)))
    t, n, _ = plane(root.x if better else least.x)
    return t, n


def project(r: Vector, points: Sequence[Vector], normals: Sequence[Vector] | None, h: float, degree: int = 2,
            weight: str = "gaussian", kind: str = "covariance") -> Projection | None:
    """The projection of r, with `value` f(r); None where n(r), the start or the plane is undefined."""
    off = offset(r, points, h, weight)
    n0 = NORMALS[kind](r, points, normals, h, weight).vector
    if off is None or n0 is None:
        return None
    found = reference_plane(r, n0, dot(n0, off), points, h, weight)
    if found is None:
        return None
    t, n = found
    q = along(r, n, t)
    fit = fit_over(q, n, points, h, degree, weight)
    return Projection(t, n, fit, t + fit.value, along(q, n, fit.value))
