"""The general surface of Adamson & Alexa: a polynomial above the plane at x, 0 where it passes through x [A §4]."""

from __future__ import annotations

from math import inf, nan
from typing import Any

import numpy as np

from jaart.core.kernels import records as r
from jaart.core.kernels.blocks import wide_of
from jaart.core.kernels.jit import kernel
from jaart.core.kernels.near import point
from jaart.core.kernels.normals import Normal, covariance_normal, surfel_normal
from jaart.core.kernels.polynomial_fit import fit
from jaart.core.kernels.records import Array, Near, Rule, Unsigned, Value, Vector
from jaart.core.kernels.sums import offset_sums
from jaart.core.kernels.tangent import no_value
from jaart.core.kernels.vectors import frame, scaled
from jaart.core.kernels.weigh import weigh

_ONE: Unsigned = np.uint64(1)
_TWO: Unsigned = np.uint64(2)
_THREE: Unsigned = np.uint64(3)
#: Columns that a fit takes; behind them the weights at x, those at a foot point, two columns each, and the numbers of
#: the surfels with a weight.
WEIGHTS: Unsigned = np.uint64(20)
FOOT_WEIGHTS: Unsigned = np.uint64(22)
_WHICH: Unsigned = np.uint64(24)
_NOTHING = (nan, nan, nan)


@kernel(inline=True)
def whole_vectors(size: Unsigned) -> Unsigned:
    """How long columns of so many rows are that are filled up to whole vectors."""
    signed: Any = np.int64(size)
    return np.uint64(wide_of(signed))


@kernel()
def with_weight(w: Array, size: Unsigned, which: Array) -> Unsigned:
    """Write the numbers of the surfels that have a weight; returns how many there are."""
    found = np.uint64(0)
    for i in range(size):  # without a branch, which nobody could foresee
        which[found] = i
        found += _ONE if w[i] > 0.0 else np.uint64(0)
    return found


@kernel(inline=True)
def write_row(near: Near, i: Unsigned, frame_at: tuple[Vector, Vector, Vector, Vector], per_h: float, weight: float,
              work: Array, to: Unsigned, rows: Unsigned) -> None:
    """Write u, v and height in h of surfel i, and its weight, into a row of four columns.

    frame_at: origin, the directions of u and v, and the normal.
    """
    x, e1, e2, n = frame_at
    p = point(near, i)
    qx, qy, qz = (p[0] - x[0]) * per_h, (p[1] - x[1]) * per_h, (p[2] - x[2]) * per_h
    work[to] = qx * e1[0] + qy * e1[1] + qz * e1[2]
    work[to + rows] = qx * e2[0] + qy * e2[1] + qz * e2[2]
    work[to + _TWO * rows] = qx * n[0] + qy * n[1] + qz * n[2]
    work[to + _THREE * rows] = weight


@kernel()
def fit_above(near: Near, x: Vector, n: Vector, rule: Rule, w: Array, work: Array, coefficients: Array) -> int:
    """Fit g to the heights of the surfels above the plane through x with normal n; returns its degree, as `fit` does.

    w: weights of the surfels, behind the columns of the fit. Where not all of them count, those without one take no
    row; rows of zeros fill the columns up to whole vectors.
    """
    e1, e2 = frame(n)
    at, per_h, size, which = (x, e1, e2, n), 1.0 / rule.h, near.size, work[_WHICH * whole_vectors(near.size):]
    if rule.reach < inf or rule.k > 0:
        size = with_weight(w, near.size, which)
    rows = whole_vectors(size)
    if size < near.size:
        for i in range(size):
            one = np.uint64(which[i])
            write_row(near, one, at, per_h, w[one], work, i, rows)
    else:
        for i in range(size):
            write_row(near, i, at, per_h, w[i], work, i, rows)
    for i in range(size, rows):
        work[i] = work[i + rows] = work[i + _TWO * rows] = work[i + _THREE * rows] = 0.0
    return fit(work, rows, rule.degree, rule.patch, coefficients)


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

    near: surfels; x: relative to their place's centre; want: unused, no closed form of ∇f; work: scratch of
    `places`, the weights at x stay in front; coefficients: g's are written there, in h.
    Degree 0 is the tangent surface.
    """
    w = work[WEIGHTS * whole_vectors(near.size):]
    s, shift = weigh(near, x, rule, w)
    if not s > 0.0:
        return no_value(r.FEW_NEIGHBOURS, _NOTHING, s, shift)
    off = scaled(offset_sums(near, x, w), 1.0 / s)
    state, n, _ = normal_at(near, x, rule, s, off, w, coefficients)
    if state != r.CONTINUE:
        return no_value(state, off, s, shift)
    degree = fit_above(near, x, n, rule, w, work, coefficients)
    if degree < 0:
        return no_value(r.FEW_NEIGHBOURS, off, s, shift)
    for i in range(near.size):
        work[i] = w[i]
    return Value(state, coefficients[0] * rule.h, n, off, s, shift, _NOTHING, degree)
