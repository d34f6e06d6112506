"""Proof that a piece of a ray meets no surface: bounds of every weight, and so of f, that hold on all of the piece.

Guaranteed intersection by bounds is that of Kalra & Barr 1989. The tangent surface [T 2.12, 2.13, 2.15] is where
<Σθn, Σθ(p - x)> = 0. Seen from the middle x of the piece |p - x - s·d|² is
|p - x|² - 2s·t + s² with t = <p - x, d>, and exp(-s²/h²) is common to all Gaussian weights: each of them only grows or
only falls along the ray, and its range on a piece is that of its ends. Bounds are widened by more than rounding can be.
"""

from __future__ import annotations

from math import inf, nan, sqrt
from typing import NamedTuple

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import normal, point
from jaart.core.kernels.records import Near, Rule, Vector
from jaart.core.kernels.vectors import along, dot, frame, length, scaled
from jaart.core.kernels.weigh import WENDLAND_END, radial
from jaart.core.kernels.weights import exp_minus

#: Pieces are halved until they are this short, in h; one that is shorter stays undecided.
_SHORTEST = 1e-7
#: No stretch takes more pieces; one that needs more stays undecided.
_MOST = 10_000
#: Exponent up to which a weight may grow on a piece: a longer piece is halved before its bounds overflow.
_STEEPEST = 600.0
#: More than rounding makes of a number, relative to its size.
_ROUNDING = 16 * 2.220446049250313e-16
#: More than underflow takes from a product.
_TINY = 1e-300


class Bound(NamedTuple):
    """Everything from low to high."""

    low: float
    high: float


class Mean(NamedTuple):
    """What is known of a weighted mean of numbers: bounds of their weighted sum, the least and the most of them."""

    low: float
    high: float
    least: float
    most: float


class Middle(NamedTuple):
    """What a piece is seen from: the least |p - x|²/h², the mean t of the surfels, and axes, the first along Σθn."""

    least: float
    mean: float
    n: Vector
    u: Vector
    v: Vector


@kernel(STRICT)
def product(a: Bound, b: Bound) -> Bound:
    """All products of a number of a and one of b."""
    w, x, y, z = a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high
    low, high = min(min(w, x), min(y, z)), max(max(w, x), max(y, z))
    error = _ROUNDING * max(abs(low), abs(high)) + _TINY
    return Bound(low - error, high + error)


@kernel(STRICT)
def total(a: Bound, b: Bound) -> Bound:
    """All sums of a number of a and one of b."""
    error = _ROUNDING * (max(abs(a.low), abs(a.high)) + max(abs(b.low), abs(b.high)))
    return Bound(a.low + b.low - error, a.high + b.high + error)


@kernel(STRICT)
def widened(a: Bound, by: float) -> Bound:
    """All numbers that are at most so far from one of a."""
    return total(a, Bound(-by, by))


@kernel(STRICT)
def away(a: Bound) -> float:
    """The least size of a number of a."""
    return max(max(a.low, -a.high), 0.0)


@kernel(STRICT)
def middle_of(near: Near, x: Vector, rule: Rule, d: Vector) -> Middle:
    """What a piece with its middle at x is seen from: good values make the bounds close, any make them right."""
    least, square = inf, rule.h * rule.h
    for i in range(near.size):
        p = point(near, i)
        q = (p[0] - x[0], p[1] - x[1], p[2] - x[2])
        least = min(least, dot(q, q) / square)
    s, mean, m = 0.0, 0.0, (0.0, 0.0, 0.0)
    for i in range(near.size):
        p = point(near, i)
        q = (p[0] - x[0], p[1] - x[1], p[2] - x[2])
        w = exp_minus(dot(q, q) / square - least)
        s, mean, m = s + w, mean + w * dot(q, d), along(m, normal(near, i), w)
    size = length(m)
    n = scaled(m, 1.0 / size) if size > 0.0 else (0.0, 0.0, 1.0)
    u, v = frame(n)
    return Middle(least, mean / s, n, u, v)


@kernel(STRICT)
def weight_bound(rule: Rule, middle: Middle, square: float, t: float, half: float, error: float) -> Bound:
    """Bounds of a surfel's weight on a piece, up to the factor that all share.

    square: |p - x|²; t: <p - x, d>; half: of the piece's length; error: of p - x.
    """
    aside = max(square - t * t, 0.0)
    near_end, far_end = max(abs(t) - half, 0.0), abs(t) + half
    slack = _ROUNDING * (square + t * t) + 4.0 * error * (sqrt(square) + half)
    nearest, farthest = max(aside + near_end * near_end - slack, 0.0), aside + far_end * far_end + slack
    if nearest > rule.reach * rule.reach:
        return Bound(0.0, 0.0)
    if rule.weight == r.GAUSSIAN:
        y = square / (rule.h * rule.h)
        bend = 2.0 * half * abs(t - middle.mean) / (rule.h * rule.h)
        if bend > _STEEPEST:
            return Bound(0.0, inf)
        turn = exp_minus(bend)
        w = exp_minus(max(y - middle.least, 0.0))
        low, high = w * turn, w / turn
        unsure = _ROUNDING * (4.0 + y + middle.least + bend) + 4.0 * slack / (rule.h * rule.h)
        low = low * (1.0 - unsure) if y - middle.least + bend < _STEEPEST else 0.0  # exp_minus ends at 1e-308
        high *= 1.0 + unsure
    else:
        end = rule.h * WENDLAND_END if rule.weight == r.WENDLAND else rule.h
        if nearest > end * end:
            return Bound(0.0, 0.0)
        low = radial(rule.weight, farthest / (end * end)) - _ROUNDING
        high = radial(rule.weight, nearest / (end * end)) + _ROUNDING
    return Bound(0.0 if farthest > rule.reach * rule.reach else max(low, 0.0), high)


@kernel(STRICT)
def added(mean: Mean, w: Bound, a: float) -> Mean:
    """A mean with one more number."""
    low, high = (w.low * a, w.high * a) if a >= 0.0 else (w.high * a, w.low * a)
    return Mean(mean.low + low, mean.high + high, min(mean.least, a), max(mean.most, a))


@kernel(STRICT)
def bound_of(mean: Mean, w: Bound, error: float) -> Bound:
    """Bounds of a weighted mean: its sum over the weights' sum, and never beyond the numbers themselves.

    error: of the sum and of the numbers, for a weight of 1.
    """
    low, high = mean.low - error * w.high, mean.high + error * w.high
    low = low / w.high if low > 0.0 else (low / w.low if w.low > 0.0 else -inf)
    high = high / w.high if high < 0.0 else (high / w.low if w.low > 0.0 else inf)
    low, high = low - _ROUNDING * abs(low), high + _ROUNDING * abs(high)
    return Bound(max(low, mean.least - error), min(high, mean.most + error))


@kernel(STRICT)
def certainly_none(near: Near, x: Vector, d: Vector, half: float, rule: Rule, off_centre: float) -> bool:
    """Whether no point within half from x along d is on the surface with its barycentre near enough.

    off_centre: bound of |a(x) - x|, infinite for none.
    """
    middle = middle_of(near, x, rule, d)
    w_low = w_high = farthest = largest = 0.0
    nothing = Mean(0.0, 0.0, inf, -inf)
    a0 = a1 = a2 = m0 = m1 = m2 = nothing
    n, u, v = middle.n, middle.u, middle.v
    for i in range(near.size):
        p, own = point(near, i), normal(near, i)
        q = (p[0] - x[0], p[1] - x[1], p[2] - x[2])
        size = length(q)
        error = _ROUNDING * (length(p) + length(x) + half)
        w = weight_bound(rule, middle, dot(q, q), dot(q, d), half, error)
        if w.high == inf:
            return False
        if w.high == 0.0:
            continue
        a0, a1, a2 = added(a0, w, dot(q, n)), added(a1, w, dot(q, u)), added(a2, w, dot(q, v))
        m0, m1, m2 = added(m0, w, dot(own, n)), added(m1, w, dot(own, u)), added(m2, w, dot(own, v))
        w_low, w_high = w_low + w.low, w_high + w.high
        farthest, largest = max(farthest, size), max(largest, error)
    if w_high == 0.0:
        return True
    rounding = _ROUNDING * (float(near.size) + 4.0)
    w = Bound(w_low * (1.0 - rounding), w_high * (1.0 + rounding))
    error = rounding * farthest + largest
    v0 = widened(bound_of(a0, w, error), half * abs(dot(d, n)))
    v1 = widened(bound_of(a1, w, error), half * abs(dot(d, u)))
    v2 = widened(bound_of(a2, w, error), half * abs(dot(d, v)))
    n0, n1, n2 = bound_of(m0, w, rounding), bound_of(m1, w, rounding), bound_of(m2, w, rounding)
    g = total(total(product(n0, v0), product(n1, v1)), product(n2, v2))
    if g.low > 0.0 or g.high < 0.0:
        return True
    return sqrt(away(v0) * away(v0) + away(v1) * away(v1) + away(v2) * away(v2)) * (1.0 - _ROUNDING) > off_centre


@kernel(STRICT)
def exclude(near: Near, base: Vector, d: Vector, low: float, high: float, rule: Rule,
            off_centre: float) -> tuple[float, int]:
    """Try to prove that a stretch of a ray, base + s·d from low to high, meets no surface.

    Returns the s from which on it could not be proven, NaN where all was, and how many pieces were looked at. A piece
    that cannot be excluded is halved; after one that could the next is twice as long.
    """
    if not low <= high:
        return 0.0, 0
    s, size, pieces = low, high - low, 0
    while s < high:
        end = min(s + size, high)
        half = 0.5 * (end - s)
        pieces += 1
        if certainly_none(near, along(base, d, s + half), d, half * (1.0 + _ROUNDING) + _ROUNDING * abs(s), rule,
                          off_centre):
            s, size = end, 2.0 * size
        else:
            size = 0.5 * min(size, end - s)
        if size < _SHORTEST * rule.h or pieces == _MOST:
            return s, pieces
    return nan, pieces
