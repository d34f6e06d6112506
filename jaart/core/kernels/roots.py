"""Real roots of a polynomial of degree 4 or less: where a ray meets a fitted surface.

Between neighbouring roots of its derivative a polynomial is monotone and has at most one root, which a bracket
holds: so the roots of p'' give those of p', and those give the roots of p. Most rays need none of that: where
p' cannot vanish between -|s| and |s|, the root s that Newton finds is the nearest to 0.
"""

from __future__ import annotations

from math import copysign, nan, sqrt
from typing import TypeAlias

from jaart.core.kernels.jit import STRICT, kernel

#: Coefficients c0 + c1·s + c2·s² + c3·s³ + c4·s⁴, each 0 or of a size between 1e-70 and 1e70.
Quartic: TypeAlias = tuple[float, float, float, float, float]
Roots: TypeAlias = tuple[float, float, float, float]

_EPS = 2.220446049250313e-16
#: Newton's steps from 0 before the roots are isolated instead.
_QUICK = 8
#: A step this much shorter than s squares to less than rounding.
_SETTLED = 1e-9
#: Steps in a bracket: every second one at least halves it or the step; about five are taken.
_MOST = 200


@kernel(STRICT)
def _value(c: Quartic, s: float) -> float:
    """p(s)."""
    return c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * c[4])))


@kernel(STRICT)
def _slope(c: Quartic, s: float) -> float:
    """p'(s)."""
    return c[1] + s * (2.0 * c[2] + s * (3.0 * c[3] + s * (4.0 * c[4])))


@kernel(STRICT)
def _rounding(c: Quartic, s: float) -> float:
    """What rounding makes of p(s), at most about."""
    a = abs(s)
    return _EPS * (abs(c[0]) + a * (abs(c[1]) + a * (abs(c[2]) + a * (abs(c[3]) + a * abs(c[4])))))


@kernel(STRICT)
def _clamped(s: float, low: float, high: float) -> float:
    """The number of [low, high] nearest to s; low for NaN."""
    return min(s, high) if s > low else low


@kernel(STRICT)
def _quadratic(c0: float, c1: float, c2: float) -> tuple[float, float]:
    """The roots of c0 + c1·s + c2·s² without cancellation, NaN or infinite where there is none."""
    square = c1 * c1 - 4.0 * c2 * c0
    if square < 0.0:
        return nan, nan
    q = -0.5 * (c1 + copysign(sqrt(square), c1))
    return q / c2, c0 / q


@kernel(STRICT)
def _root_between(c: Quartic, a: float, b: float) -> float:
    """The root in [a, b], where p is monotone; NaN when p keeps its sign."""
    fa, fb = _value(c, a), _value(c, b)
    if fa == 0.0 or fb == 0.0:
        return a if fa == 0.0 else b
    if not (fa < 0.0 < fb or fb < 0.0 < fa):
        return nan
    below, above = (a, b) if fa < 0.0 else (b, a)
    s, last = _clamped(a + (b - a) * (fa / (fa - fb)), a, b), b - a
    for _ in range(_MOST):
        f = _value(c, s)
        if f < 0.0:
            below = s
        else:
            above = s
        step = f / _slope(c, s)
        after = s - step
        if abs(f) <= _rounding(c, s) or abs(step) <= _EPS * abs(s):
            return s
        if not (min(below, above) < after < max(below, above) and 2.0 * abs(step) <= last):
            after = 0.5 * (below + above)
        last = abs(after - s)
        if last == 0.0:
            return s
        s = after
    return s


@kernel(STRICT)
def _split(c: Quartic, low: float, high: float) -> tuple[float, float, float]:
    """Three numbers, ascending, that part [low, high] so that p is monotone between neighbours."""
    slope = (c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 0.0)
    x, y = _quadratic(c[2], 3.0 * c[3], 6.0 * c[4])
    x, y = _clamped(x, low, high), _clamped(y, low, high)
    x, y = min(x, y), max(x, y)
    return (_clamped(_root_between(slope, low, x), low, x), _clamped(_root_between(slope, x, y), x, y),
            _clamped(_root_between(slope, y, high), y, high))


@kernel(STRICT)
def roots_between(c: Quartic, low: float, high: float) -> Roots:
    """The real roots in [low, high], ascending, NaN in the place of those there are not."""
    if c[3] == 0.0 and c[4] == 0.0:
        x, y = _quadratic(c[0], c[1], c[2])
        x, y = x if low <= x <= high else nan, y if low <= y <= high else nan
        return (y, x, nan, nan) if y < x else (x, y, nan, nan)
    x, y, z = _split(c, low, high)
    return _root_between(c, low, x), _root_between(c, x, y), _root_between(c, y, z), _root_between(c, z, high)


@kernel(STRICT)
def first_root_above(c: Quartic, low: float, high: float) -> float:
    """The least real root in [low, high] (finite), NaN when there is none.

    A root is where p is 0 or changes its sign: a double root that rounding lifts off 0 is none.
    """
    if _value(c, low) == 0.0:
        return low
    w, x, y, z = roots_between(c, low, high)
    for root in (w, x, y):
        if root == root:
            return root
    return z


@kernel(STRICT)
def nearest_root(c: Quartic, reach: float) -> float:
    """The real root of least |s| with |s| <= reach (finite), NaN when there is none [A §4 step 2].

    Right within a few eps times the root's condition. Of two that come out as near it is the negative one.
    """
    if c[0] == 0.0:
        return 0.0
    if c[3] == 0.0 and c[4] == 0.0:
        x, y = _quadratic(c[0], c[1], c[2])
        nearest = x if abs(x) < abs(y) or (abs(x) == abs(y) and x < y) else y
        return nearest if abs(nearest) <= reach else nan
    s = 0.0
    for _ in range(_QUICK):
        step = _value(c, s) / _slope(c, s)
        s -= step
        if abs(step) <= _SETTLED * abs(s):
            break
    r = abs(s)
    alone = r * (2.0 * abs(c[2]) + r * (3.0 * abs(c[3]) + r * (4.0 * abs(c[4])))) < 0.5 * abs(c[1])
    if alone and abs(step) <= _SETTLED * r:
        return s if r <= reach else nan
    nearest = nan
    for root in roots_between(c, -reach, reach):
        if abs(root) <= reach and not abs(root) >= abs(nearest):
            nearest = root
    return nearest
