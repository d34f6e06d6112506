"""The weights of the surfels near x, written down once for all sums that follow."""

from __future__ import annotations

from math import sqrt

import numpy as np

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import EXACT, kernel
from jaart.core.kernels.near import point
from jaart.core.kernels.records import Array, Near, Rule, Unsigned, Vector
from jaart.core.kernels.select import kth_smallest
from jaart.core.kernels.weights import exp_minus

_FIRST: Unsigned = np.uint64(0)
#: Below this Σθ the weights are taken again, relative to the nearest surfel's (a distance of about 12 h).
FAINT = 1e-60
#: Where Wendland's function ends, in h: there it is as wide as the Gaussian at half its height.
WENDLAND_END = 2.653


@kernel(EXACT)
def square_distance(near: Near, i: Unsigned, x: Vector, per_h: float) -> float:
    """|p_i - x|²/h², the same bits wherever it is asked for."""
    p = point(near, i)
    qx, qy, qz = (p[0] - x[0]) * per_h, (p[1] - x[1]) * per_h, (p[2] - x[2]) * per_h
    return qx * qx + qy * qy + qz * qz


@kernel()
def nearest(near: Near, x: Vector, per_h: float) -> Unsigned:
    """Number of the surfel nearest to x."""
    found, least = _FIRST, square_distance(near, _FIRST, x, per_h)
    for i in range(near.size):
        square = square_distance(near, i, x, per_h)
        if square < least:
            found, least = i, square
    return found


@kernel()
def shifted_weight(near: Near, i: Unsigned, nearest_one: Unsigned, x: Vector, per_h: float) -> float:
    """θ_i / θ_nearest of the Gaussian, 0 where it would underflow.

    The exponent (|q_i|² - |q_0|²)/h² is taken as (q_i - q_0)·(q_i + q_0)/h², in which nothing cancels.
    """
    p, p0 = point(near, i), point(near, nearest_one)
    e = ((p[0] - p0[0]) * per_h) * (((p[0] - x[0]) + (p0[0] - x[0])) * per_h)
    e += ((p[1] - p0[1]) * per_h) * (((p[1] - x[1]) + (p0[1] - x[1])) * per_h)
    e += ((p[2] - p0[2]) * per_h) * (((p[2] - x[2]) + (p0[2] - x[2])) * per_h)
    return exp_minus(max(e, 0.0)) if e < 700.0 else 0.0


@kernel()
def gaussian(near: Near, x: Vector, h: float, reach: float, w: Array) -> tuple[float, float]:
    """Write exp(-q²/h²) [T 2.7; A §6], 0 beyond the reach; returns (Σθ, shift).

    Far away all weights underflow; their ratios do not. There every weight is divided by exp(shift), the
    nearest surfel's, which in the limit gets 1 and the others 0 [T §2.3.6].
    """
    per_h = 1.0 / h
    square = (reach * per_h) * (reach * per_h)
    s = 0.0
    for i in range(near.size):
        y = square_distance(near, i, x, per_h)
        w[i] = exp_minus(y) if y <= square else 0.0
        s += w[i]
    if s > FAINT or near.size == 0:
        return s, 0.0
    nearest_one = nearest(near, x, per_h)
    least = square_distance(near, nearest_one, x, per_h)
    s = 0.0
    for i in range(near.size):
        w[i] = shifted_weight(near, i, nearest_one, x, per_h) if square_distance(near, i, x, per_h) <= square else 0.0
        s += w[i]
    return s, -least


@kernel()
def radial(weight: int, y: float) -> float:
    """The hat, the squared hat [T §3.2.2] or Wendland's function, y: squared distance as a share of its end's."""
    if weight == r.SQUARED_HAT:
        v = 1.0 - y
    else:
        q = sqrt(y)
        v = 1.0 - q
        if weight == r.WENDLAND:
            v = v * v * v * v * (4.0 * q + 1.0)
    return v if y < 1.0 else 0.0


@kernel()
def compact(near: Near, x: Vector, weight: int, h: float, reach: float, w: Array) -> float:
    """Write the hat 1 - q/h, the squared hat 1 - q²/h² [T §3.2.2] or Wendland's function; returns Σθ.

    Each is 0 from its end on, and beyond the reach. Wendland's: (1 - q/s)⁴(4q/s + 1), s = 2.653 h
    [Wendland 1995].
    """
    end = h * WENDLAND_END if weight == r.WENDLAND else h
    per_end = 1.0 / end
    square = (reach * per_end) * (reach * per_end)
    s = 0.0
    for i in range(near.size):
        y = square_distance(near, i, x, per_end)
        v = radial(weight, y)
        w[i] = v if y <= square else 0.0
        s += w[i]
    return s


@kernel()
def keep_nearest(near: Near, x: Vector, per_h: float, k: int, w: Array) -> float:
    """Set the weights of all but the k nearest surfels to 0; returns Σθ. Of equally far ones the first count.

    w: (2·N,), the second half is overwritten.
    """
    n = near.size
    for i in range(n):
        w[n + i] = square_distance(near, i, x, per_h)
    bound, ties = kth_smallest(w, n, k)
    s = 0.0
    for i in range(n):
        y = square_distance(near, i, x, per_h)
        if y > bound:
            w[i] = 0.0
        elif y == bound:
            if ties == 0:
                w[i] = 0.0
            else:
                ties -= 1
        s += w[i]
    return s


@kernel()
def weigh(near: Near, x: Vector, rule: Rule, w: Array) -> tuple[float, float]:
    """Write θ_i of all surfels near a place into w[:N]; returns (Σθ, shift), every θ divided by exp(shift).

    x: relative to the place's centre; w: (2·N,) at least. Surfels beyond rule.reach, and all but the rule.k
    nearest where k > 0, get 0. Σθ is 0 where no surfel is in reach.
    """
    shift = 0.0
    if rule.weight == r.GAUSSIAN:
        s, shift = gaussian(near, x, rule.h, rule.reach, w)
    else:
        s = compact(near, x, rule.weight, rule.h, rule.reach, w)
    if 0 < rule.k < near.size:
        s = keep_nearest(near, x, 1.0 / rule.h, rule.k, w)
    return s, shift


@kernel()
def fineness(weight: int, h: float) -> float:
    """A length within which sums with a weight change smoothly: h, for hats, whose support ends suddenly, a quarter."""
    return h if weight == r.GAUSSIAN or weight == r.WENDLAND else 0.25 * h


@kernel()
def slope_factor(weight: int, h: float, y: float, w: float) -> float:
    """-θ'(q)/q of a surfel, so that ∇θ_i = slope_factor·(p_i - x); y: q²/h²; w: θ_i itself."""
    if w == 0.0:
        return 0.0
    if weight == r.GAUSSIAN:
        return 2.0 / (h * h) * w
    if weight == r.HAT:
        return 1.0 / (h * h * sqrt(y)) if y > 0.0 else 0.0
    if weight == r.SQUARED_HAT:
        return 2.0 / (h * h)
    u = 1.0 - sqrt(y) / WENDLAND_END
    return 20.0 * u * u * u / ((WENDLAND_END * h) * (WENDLAND_END * h))


@kernel()
def any_within(near: Near, x: Vector, distance: float) -> bool:
    """Whether a surfel is no farther from x than a distance. All are looked at, as vectors, which costs less than to
    stop at the first.
    """
    count = 0.0
    for i in range(near.size):
        count += 1.0 if square_distance(near, i, x, 1.0) <= distance * distance else 0.0
    return count > 0.0
