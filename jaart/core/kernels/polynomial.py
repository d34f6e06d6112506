"""Heights over a plane as a polynomial g(u, v) of degree 0 to 4, by weighted least squares [A 10].

Monomials go by degree, in each by falling powers of u: 1; u, v; u², uv, v²; u³, u²v, uv², v³; u⁴, …, v⁴. So a lower
degree has the leading coefficients, and the leading columns of the same system. u, v and heights are in feature
sizes h, which keeps every monomial near 1.
"""

from __future__ import annotations

from math import nan, sqrt

import numpy as np

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.least_squares import factorise, rank_ratio, substitute
from jaart.core.kernels.records import COEFFICIENTS, Array, Unsigned, Vector
from jaart.core.kernels.roots import Quartic

#: Columns of the scratch array: u, v, height, weight, then the system.
SCRATCH_COLUMNS = 4 + COEFFICIENTS + 1
#: A point of a smaller share of the largest weight does not count.
_NEGLIGIBLE = 1e-6
#: A smaller ratio of R's diagonal leaves too few digits.
_SINGULAR = 1e-7
#: The smallest float of full precision.
_TINY = 2.2250738585072014e-308
_TWO, _THREE, _FOUR = np.uint64(2), np.uint64(3), np.uint64(4)


@kernel()
def terms(degree: int) -> int:
    """Number of coefficients of a degree: 1, 3, 6, 10, 15."""
    return (degree + 1) * (degree + 2) // 2


@kernel()
def _higher(work: Array, a: Unsigned, line: Unsigned, below: Unsigned, patch: float, to: Unsigned,
            rows: Unsigned) -> None:
    """Write a column times u or v, plus patch times another column, into a third."""
    for i in range(rows):
        work[to + i] = work[a + i] * work[line + i] + patch * work[below + i]


@kernel()
def _write_system(work: Array, rows: Unsigned, degree: int, largest: float, patch: float) -> None:
    """Write the monomials' columns and the heights', each row times the root of its weight's share.

    With a patch m they are the monomials' means over it: E(u^(k+1)) = u·E(u^k) + k·m·E(u^(k-1)), which holds for
    a Gaussian patch, and up to the third degree for any that is even.
    """
    first, height, weight = _FOUR * rows, _TWO * rows, _THREE * rows
    per_largest = 1.0 / largest
    for i in range(rows):
        work[first + i] = sqrt(work[weight + i] * per_largest)
    below, lower, to = first, first, first + rows  # where the last degree but one, the last and this one begin
    for d in range(1, degree + 1):
        begin = to
        for j in range(d):
            two_less = below + np.uint64(j) * rows if j < d - 1 else first
            _higher(work, lower + np.uint64(j) * rows, np.uint64(0), two_less, (d - 1 - j) * patch, to, rows)
            to += rows
        _higher(work, begin - rows, rows, lower - rows if d > 1 else first, (d - 1) * patch, to, rows)
        below, lower, to = lower, begin, to + rows
    _higher(work, first, height, first, 0.0, to, rows)


@kernel()
def _weights(work: Array, rows: Unsigned) -> tuple[float, int]:
    """The largest weight, and the number of weights that count beside it."""
    weight, largest, many = _THREE * rows, 0.0, 0
    for i in range(rows):
        largest = max(largest, work[weight + i])
    for i in range(rows):
        many += work[weight + i] > _NEGLIGIBLE * largest
    return largest, many


@kernel()
def _mean_height(work: Array, rows: Unsigned) -> float:
    """The weighted mean of the heights, taken from the first one, so that equal heights give exactly theirs."""
    height, weight = _TWO * rows, _THREE * rows
    origin, total, weights = work[height], 0.0, 0.0
    for i in range(rows):
        total += work[weight + i] * (work[height + i] - origin)
        weights += work[weight + i]
    return origin + total / weights


@kernel()
def fit(work: Array, rows: Unsigned, degree: int, patch: float, coefficients: Array) -> int:
    """Write g's coefficients into (15,), 0 beyond its degree, and return its degree, which may be lower.

    work: flat, at least SCRATCH_COLUMNS·rows long, the first four columns of `rows` values u, v, height and weight; u
    and the rest are overwritten; rows of zeros may fill the columns up. patch: 0 when the polynomial is to pass through
    the points; else each stands for a patch of the surface with this variance along u and along v, and the polynomial's
    mean over it is to. The degree is lowered until 1.5 points a coefficient have weight and no column depends on
    others; degree 0 is the weighted mean. -1 and NaN where no point has weight.
    """
    for k in range(COEFFICIENTS):
        coefficients[k] = 0.0
    largest, many = _weights(work, rows)
    if not largest >= _TINY:
        coefficients[0] = nan
        return -1
    while degree > 0 and 3 * terms(degree) > 2 * many:
        degree -= 1
    if degree > 0:
        _write_system(work, rows, degree, largest, patch)
        first, count = _FOUR * rows, np.uint64(terms(degree))
        right = first + count * rows
        factorise(work, first, rows, count, np.uint64(0))  # u is in the system by now
        while degree > 0 and rank_ratio(work, first, rows, np.uint64(terms(degree))) < _SINGULAR:
            degree -= 1
        substitute(work, first, rows, np.uint64(terms(degree)), right, coefficients)
    if degree == 0:
        coefficients[0] = _mean_height(work, rows)
    return degree


@kernel(STRICT)
def value(c: Array, u: float, v: float) -> float:
    """g(u, v) of the 15 coefficients."""
    g = c[10]
    g = g * u + (c[6] + v * c[11])
    g = g * u + (c[3] + v * (c[7] + v * c[12]))
    g = g * u + (c[1] + v * (c[4] + v * (c[8] + v * c[13])))
    return g * u + (c[0] + v * (c[2] + v * (c[5] + v * (c[9] + v * c[14]))))


@kernel(STRICT)
def gradient(c: Array, u: float, v: float) -> tuple[float, float]:
    """(∂g/∂u, ∂g/∂v) at (u, v)."""
    gu = 4.0 * c[10]
    gu = gu * u + 3.0 * (c[6] + v * c[11])
    gu = gu * u + 2.0 * (c[3] + v * (c[7] + v * c[12]))
    gu = gu * u + (c[1] + v * (c[4] + v * (c[8] + v * c[13])))
    gv = c[11]
    gv = gv * u + (c[7] + v * 2.0 * c[12])
    gv = gv * u + (c[4] + v * (2.0 * c[8] + v * 3.0 * c[13]))
    gv = gv * u + (c[2] + v * (2.0 * c[5] + v * (3.0 * c[9] + v * 4.0 * c[14])))
    return gu, gv


@kernel(STRICT)
def ray_polynomial(c: Array, d: Vector) -> Quartic:
    """g(s·d_u, s·d_v) - s·d_n by powers of s: its roots are where the ray s·d from the origin meets g.

    d: direction in the frame (u, v, n).
    """
    u, v, n = d
    uu, uv, vv = u * u, u * v, v * v
    third = u * (uu * c[6] + vv * c[8]) + v * (uu * c[7] + vv * c[9])
    fourth = uu * (uu * c[10] + uv * c[11] + vv * c[12]) + vv * (uv * c[13] + vv * c[14])
    return c[0], u * c[1] + v * c[2] - n, uu * c[3] + uv * c[4] + vv * c[5], third, fourth


@kernel(STRICT)
def _times_line(p: Quartic, a: float, b: float, plus: float) -> Quartic:
    """plus + p(s)·(a + b·s), for a product of degree 4 at most."""
    return plus + p[0] * a, p[0] * b + p[1] * a, p[1] * b + p[2] * a, p[2] * b + p[3] * a, p[3] * b + p[4] * a


@kernel(STRICT)
def _plus(p: Quartic, q: Quartic) -> Quartic:
    """p + q."""
    return p[0] + q[0], p[1] + q[1], p[2] + q[2], p[3] + q[3], p[4] + q[4]


@kernel(STRICT)
def line_polynomial(c: Array, base: Vector, d: Vector) -> Quartic:
    """g - n along the line base + s·d by powers of s, for a ray that passes by the frame's origin.

    base, d: a point of the ray and its direction in the frame (u, v, n).
    """
    a, b = base[1], d[1]
    of_v = _times_line((c[14], 0.0, 0.0, 0.0, 0.0), a, b, c[9])
    g0 = _times_line(_times_line(_times_line(of_v, a, b, c[5]), a, b, c[2]), a, b, c[0])
    of_v = _times_line((c[13], 0.0, 0.0, 0.0, 0.0), a, b, c[8])
    g1 = _times_line(_times_line(of_v, a, b, c[4]), a, b, c[1])
    g2 = _times_line(_times_line((c[12], 0.0, 0.0, 0.0, 0.0), a, b, c[7]), a, b, c[3])
    g3 = _times_line((c[11], 0.0, 0.0, 0.0, 0.0), a, b, c[6])
    a, b = base[0], d[0]
    g = _plus(g3, _times_line((c[10], 0.0, 0.0, 0.0, 0.0), a, b, 0.0))
    g = _plus(g2, _times_line(g, a, b, 0.0))
    g = _plus(g1, _times_line(g, a, b, 0.0))
    g = _plus(g0, _times_line(g, a, b, -base[2]))
    return g[0], g[1] - d[2], g[2], g[3], g[4]
