"""One look at the surface from a point of a stretch of the ray, and a root between two looks.

What is looked for is named by a number: the change of sign of f, of its slope along the ray, or of an energy's.
"""

from __future__ import annotations

from math import inf, nan
from typing import NamedTuple

from jaart.core.kernels import records as r
from jaart.core.kernels.call import evaluate_at
from jaart.core.kernels.energy import energy, energy_slope, has_slope
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.log import write_step
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.records import Array, Rule, Search, Sites, Start, Value, Vector
from jaart.core.kernels.shown import difference
from jaart.core.kernels.vectors import along, dot

#: What a look brings: f, f and its slope, or the energy's slope.
F, F_SLOPE, E_SLOPE = range(3)
#: Half the width of a central difference of an energy, in h.
_WIDTH = 1e-5
#: No root takes more looks; halving alone would take 60.
_MOST = 80
_UNIT_ROUNDING = 2.3e-16


class Look(NamedTuple):
    """What is seen at s: the quantity looked for, f, its slope along the ray or NaN, the energy or NaN, the surface,
    and how many evaluations that took.
    """

    s: float
    q: float
    f: float
    slope: float
    e: float
    value: Value
    evaluations: int


@kernel(STRICT)
def sided_energy(sites: Sites, rule: Rule, how: Search, d: Vector, start: Start, s: float, work: Array,
                 fit: Array) -> float:
    """The energy at s."""
    near, x = surfels_near(sites, start.cell), along(start.base, d, s)
    v = evaluate_at(how.evaluate, near, x, rule, r.VALUE_ONLY, work, fit)
    return energy(how.energy, how.emphasise, near, x, d, v, rule.c, work)


@kernel(STRICT)
def look(what: int, sites: Sites, rule: Rule, how: Search, d: Vector, start: Start, s: float, rows: Array, row: int,
         work: Array, fit: Array) -> Look:
    """Look at the surface from the ray's point at s with the surfels of the start's place, and log it."""
    near, x = surfels_near(sites, start.cell), along(start.base, d, s)
    want = r.WITH_GRADIENT if what == F_SLOPE else r.VALUE_ONLY
    if what == E_SLOPE and rows.shape[0] == 0 and has_slope(how.energy, how.emphasise):
        want = r.BARYCENTRE
    v = evaluate_at(how.evaluate, near, x, rule, want, work, fit)
    slope, e, q, evaluations = nan, nan, v.f, 1
    if v.state == r.CONTINUE or v.state == r.UNDEFINED_NORMAL:
        if what == E_SLOPE:
            e = energy(how.energy, how.emphasise, near, x, d, v, rule.c, work)
            if has_slope(how.energy, how.emphasise):
                q = energy_slope(how.energy, near, x, d, rule, v, e, work)
            else:
                width, evaluations = _WIDTH * rule.h, 3
                q = (sided_energy(sites, rule, how, d, start, s + width, work, fit)
                     - sided_energy(sites, rule, how, d, start, s - width, work, fit)) / (2.0 * width)
        if what == F_SLOPE and v.state == r.CONTINUE:
            slope = dot(v.gradient, d)
            if slope != slope:
                slope, evaluations = difference(near, x, d, rule, how, v.n, work, fit), 3
    if rows.shape[0] > 0:
        write_step(rows, row, sites, start, s, start.cell, x, v, v.f / dot(v.n, d))
    return Look(s, q, v.f, slope, e, v, evaluations)


@kernel(STRICT)
def opposite(a: float, b: float) -> bool:
    """Whether two numbers have different signs; 0 is different from both."""
    return (a < 0.0 and b >= 0.0) or (a > 0.0 and b <= 0.0)


@kernel(STRICT)
def quantity(what: int, seen: Look) -> float:
    """The number whose change of sign is looked for."""
    return seen.slope if what == F_SLOPE else seen.q


@kernel(STRICT)
def inverse_quadratic(a: float, b: float, c: float, qa: float, qb: float, qc: float) -> float:
    """Share of the way from a to b where inverse quadratic interpolation puts the root, ½ where it is not to be
    trusted [Chandrupatla 1997]; a: the newest place.
    """
    xi, phi = (a - b) / (c - b), (qa - qb) / (qc - qb)
    if phi * phi < xi and (1.0 - phi) * (1.0 - phi) < 1.0 - xi:
        return qa / (qb - qa) * (qc / (qb - qc)) + (c - a) / (b - a) * (qa / (qc - qa)) * (qb / (qc - qb))
    return 0.5


@kernel(STRICT)
def closest(s: float, h: float) -> float:
    """How close a bracket at s can get: rounding is wider than that."""
    return _UNIT_ROUNDING * (abs(s) + h)


@kernel(STRICT)
def root_between(what: int, sites: Sites, rule: Rule, how: Search, d: Vector, start: Start, low: Look, high: Look,
                 width: float, until: float, rows: Array, row: int, work: Array, fit: Array) -> tuple[Look, int, int]:
    """The look where a quantity changes its sign between two looks [Chandrupatla 1997], how many looks and
    evaluations it took.

    width: how close the bracket must get, and f to 0 where that is looked for; until: stop as well where f has the
    other sign than this, NaN for never. The q of a root of f is NaN where the normal changes its side, or is not
    defined: f jumps over 0 there and has no root.
    """
    a, b, c = low, high, low
    looks, evaluations, share, lost = 0, 0, 0.5, False
    best = a if abs(quantity(what, a)) < abs(quantity(what, b)) else b
    for _ in range(_MOST):
        gap, close = abs(b.s - a.s), closest(best.s, rule.h)
        narrow = gap <= width and (what != F or abs(best.f) <= width)
        if narrow or gap <= close or quantity(what, best) == 0.0:
            break
        least = 0.5 * max(width if gap > width else 0.0, close) / gap
        share = min(max(share, least), 1.0 - least)
        new = look(what, sites, rule, how, d, start, b.s + share * (a.s - b.s), rows, row + looks, work, fit)
        looks, evaluations = looks + 1, evaluations + new.evaluations
        q = quantity(what, new)
        if not abs(q) < inf:
            lost = True
            break
        if opposite(until, new.f):
            return new, looks, evaluations
        if (q > 0.0) == (quantity(what, b) > 0.0):
            c = b
        else:
            c = a
            a = b
        b = new
        best = a if abs(quantity(what, a)) < abs(quantity(what, b)) else b
        share = inverse_quadratic(b.s, a.s, c.s, quantity(what, b), quantity(what, a), quantity(what, c))
    if what == F and best.f != 0.0 and (lost or dot(a.value.n, b.value.n) < 0.0):
        best = Look(best.s, nan, best.f, best.slope, best.e, best.value, best.evaluations)
    return best, looks, evaluations
