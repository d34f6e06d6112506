"""The general surface of Adamson & Alexa: a polynomial above the plane at x, 0 where it passes through x [A §4]."""

from __future__ import annotations

from math import nan

import numpy as np

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import kernel
from jaart.core.kernels.near import point
from jaart.core.kernels.normals import Normal, covariance_normal, surfel_normal
from jaart.core.kernels.polynomial import fit
from jaart.core.kernels.records import Array, Near, Rule, Unsigned, Value, Vector
from jaart.core.kernels.sums import offset_sums
from jaart.core.kernels.tangent import no_value
from jaart.core.kernels.vectors import frame, scaled
from jaart.core.kernels.weigh import weigh

_TWO: Unsigned = np.uint64(2)
_THREE: Unsigned = np.uint64(3)
_NOTHING = (nan, nan, nan)


@kernel()
def write_places(near: Near, x: Vector, n: Vector, per_h: float, work: Array) -> None:
    """Write u, v and height of every surfel above the plane through x with normal n, in h, as three columns."""
    e1, e2 = frame(n)
    rows = near.size
    for i in range(rows):
        p = point(near, i)
        qx, qy, qz = (p[0] - x[0]) * per_h, (p[1] - x[1]) * per_h, (p[2] - x[2]) * per_h
        work[i] = qx * e1[0] + qy * e1[1] + qz * e1[2]
        work[i + rows] = qx * e2[0] + qy * e2[1] + qz * e2[2]
        work[i + _TWO * rows] = qx * n[0] + qy * n[1] + qz * n[2]


@kernel()
def normal_at(near: Near, x: Vector, rule: Rule, s: float, off: Vector, w: Array, fit: Array) -> Normal:
    """n(x) from the surfels' normals or from the spread of the points, as the rule says; fit: counts eigenvectors."""
    if rule.normal == r.SURFEL:
        return surfel_normal(near, s, off, w)
    fit[r.EIGENVECTORS] += 1.0
    return covariance_normal(near, x, rule, s, off, w)


@kernel()
def polynomial(near: Near, x: Vector, rule: Rule, want: int, work: Array, coefficients: Array) -> Value:
    """f(x) = g(0, 0), g fitted to the heights of the surfels above the plane through x with normal n(x) [A 10].

    near: surfels; x: relative to their place's centre; want: unused, no closed form of ∇f; work: scratch of 20
    numbers a surfel, the weights at x stay in the first of them; coefficients: g's are written there, in h.
    Degree 0 is the tangent surface.
    """
    w = work[_THREE * near.size:]
    s, shift = weigh(near, x, rule, w)
    if not s > 0.0:
        return no_value(r.FEW_NEIGHBOURS, _NOTHING, s, shift)
    off = scaled(offset_sums(near, x, w), 1.0 / s)
    state, n, _ = normal_at(near, x, rule, s, off, w, coefficients)
    if state != r.CONTINUE:
        return no_value(state, off, s, shift)
    write_places(near, x, n, 1.0 / rule.h, work)
    degree = fit(work, near.size, rule.degree, rule.patch, coefficients)
    if degree < 0:
        return no_value(r.FEW_NEIGHBOURS, off, s, shift)
    for i in range(near.size):
        work[i] = w[i]
    return Value(state, coefficients[0] * rule.h, n, off, s, shift, _NOTHING, degree)
