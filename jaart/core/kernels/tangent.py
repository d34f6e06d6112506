"""The tangent surface f(x) = <n(x), a(x) - x> [T 2.15, A 5], interpreted from its sums."""

from __future__ import annotations

from math import inf, nan

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import kernel
from jaart.core.kernels.normals import covariance_normal, normal_of_sum, surfel_normal
from jaart.core.kernels.records import Array, Near, Rule, Value, Vector
from jaart.core.kernels.sums import covariance_gradient_sums, gaussian_sums, offset_sums, surfel_gradient_sums
from jaart.core.kernels.vectors import dot, scaled
from jaart.core.kernels.weigh import FAINT, weigh

_NOTHING = (nan, nan, nan)


@kernel()
def no_value(state: int, off: Vector, s: float, shift: float) -> Value:
    """What there is where no surfel counts, no normal is defined, or nobody asks for it."""
    return Value(state, nan, _NOTHING, off, s, shift, _NOTHING, 0)


@kernel()
def tangent_surfel(near: Near, x: Vector, rule: Rule, want: int, w: Array, fit: Array) -> Value:
    """f(x) with the average of the surfels' normals [T 2.13].

    near: surfels; x: relative to their place's centre; one of VALUE_ONLY … BARYCENTRE; w: (2·N,) for the
    weights; fit: for its counts alone. ∇f = (2/h²) Σθ_N (n_i·turn + n·(p_i - a))(p_i - a) - n for the Gaussian.
    """
    if want == r.QUICK and rule.weight == r.GAUSSIAN and rule.k == 0 and rule.reach == inf:
        s, q, m = gaussian_sums(near, x, rule.h)
        if s > FAINT:
            off = scaled(q, 1.0 / s)
            state, n, _ = normal_of_sum(m, s, off)
            return Value(state, dot(n, off), n, off, s, 0.0, _NOTHING, 0)
    s, shift = weigh(near, x, rule, w)
    if not s > 0.0:
        return no_value(r.FEW_NEIGHBOURS, _NOTHING, s, shift)
    off = scaled(offset_sums(near, x, w), 1.0 / s)
    if want == r.BARYCENTRE:
        return no_value(r.CONTINUE, off, s, shift)
    state, n, turn = surfel_normal(near, s, off, w)
    if state != r.CONTINUE:
        return no_value(state, off, s, shift)
    gradient = _NOTHING
    if want == r.WITH_GRADIENT:
        fit[r.GRADIENTS] += 1.0
        b, g = surfel_gradient_sums(near, x, rule, n, off, turn, w)
        gradient = ((g[0] + b * off[0]) / s - n[0], (g[1] + b * off[1]) / s - n[1], (g[2] + b * off[2]) / s - n[2])
    return Value(state, dot(n, off), n, off, s, shift, gradient, 0)


@kernel()
def tangent_covariance(near: Near, x: Vector, rule: Rule, want: int, w: Array, fit: Array) -> Value:
    """f(x) with the direction of least spread of the points [A 5, 8, 9]; arguments as of `tangent_surfel`.

    ∇f = (2/h²) Σθ_N (<turn, q><n, q> + n·(p_i - a))(p_i - x) - n, q = p_i - a; about x, q = p_i - x, and
    f·turn + <c, turn> n are taken off.
    """
    s, shift = weigh(near, x, rule, w)
    if not s > 0.0:
        return no_value(r.FEW_NEIGHBOURS, _NOTHING, s, shift)
    off = scaled(offset_sums(near, x, w), 1.0 / s)
    if want == r.BARYCENTRE:
        return no_value(r.CONTINUE, off, s, shift)
    fit[r.EIGENVECTORS] += 1.0
    state, n, turn = covariance_normal(near, x, rule, s, off, w)
    if state != r.CONTINUE:
        return no_value(state, off, s, shift)
    f, gradient = dot(n, off), _NOTHING
    if want == r.WITH_GRADIENT:
        fit[r.GRADIENTS] += 1.0
        about_x = rule.normal == r.COVARIANCE_AT_X
        centre = (0.0, 0.0, 0.0) if about_x else off
        b, g = covariance_gradient_sums(near, x, rule, n, off, centre, turn, w)
        back, own = (f, 1.0 + dot(off, turn)) if about_x else (0.0, 1.0)
        gradient = ((g[0] + b * off[0]) / s - own * n[0] - back * turn[0],
                    (g[1] + b * off[1]) / s - own * n[1] - back * turn[1],
                    (g[2] + b * off[2]) / s - own * n[2] - back * turn[2])
    return Value(state, f, n, off, s, shift, gradient, 0)
