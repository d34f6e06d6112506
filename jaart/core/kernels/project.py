"""The point-set surface of Alexa and Levin: r lies on it where its projection leaves it in place [T §2.3.2, 2.8-2.11].

The plane nearest to the surfels around its own foot q = r + t·n, then a polynomial g over it, weighted about q:
ψ(r) = q + g(0, 0)·n and f(r) = <n, ψ(r) - r> = t + g(0, 0).
"""

from __future__ import annotations

from math import nan

from jaart.core.kernels import records as r
from jaart.core.kernels.fitted import FOOT_WEIGHTS, WEIGHTS, fit_above, normal_at, whole_vectors
from jaart.core.kernels.jit import kernel
from jaart.core.kernels.records import Array, Near, Rule, Value, Vector
from jaart.core.kernels.reference_plane import reference_plane
from jaart.core.kernels.sums import offset_sums
from jaart.core.kernels.tangent import no_value
from jaart.core.kernels.vectors import along, dot, scaled
from jaart.core.kernels.weigh import weigh

_NOTHING = (nan, nan, nan)


@kernel()
def projection(near: Near, x: Vector, rule: Rule, want: int, work: Array, coefficients: Array) -> Value:
    """f(x) = t + g(0, 0), g fitted over the reference plane of x [T 2.8-2.11].

    near: surfels; x: relative to their place's centre; want: unused, no closed form of ∇f; work: scratch of `places`,
    the weights at x stay in front; coefficients: (15,), g's are written there, in h, its heights
    counted from x. n is the plane's normal, on the side of n(x), from which the search for the plane starts; the
    state is UNDEFINED_NORMAL where there is no plane near it.
    """
    wide = whole_vectors(near.size)
    kept, w = work[WEIGHTS * wide:], work[FOOT_WEIGHTS * wide:]
    s, shift = weigh(near, x, rule, kept)
    if not s > 0.0:
        return no_value(r.FEW_NEIGHBOURS, _NOTHING, s, shift)
    off = scaled(offset_sums(near, x, kept), 1.0 / s)
    state, n0, _ = normal_at(near, x, rule, s, off, kept, coefficients)
    if state != r.CONTINUE:
        return no_value(state, off, s, shift)
    state, t, n = reference_plane(near, x, dot(n0, off) / rule.h, n0, rule, w)
    if state != r.CONTINUE:
        return no_value(state, off, s, shift)
    foot = along(x, n, t * rule.h)
    weigh(near, foot, rule, w)
    degree = fit_above(near, foot, n, rule, w, work, coefficients)
    if degree < 0:
        return no_value(r.FEW_NEIGHBOURS, off, s, shift)
    coefficients[0] += t
    for i in range(near.size):
        work[i] = kept[i]
    return Value(state, coefficients[0] * rule.h, n, off, s, shift, _NOTHING, degree)
