"""The least energy in a stretch of the ray, accepted below a level [T §2.4.4].

It is where the energy's slope changes its sign: found by its root where the slope has a closed form, and by the
difference of two near values elsewhere, as the thesis's bisection does. The thesis takes a cell to have one minimum at
most; a stretch is looked at in steps of 0.4 h (0.1 h for hats), in each of which there is one at most.
"""

from __future__ import annotations

from math import ceil, nan

from jaart.core.kernels import records as r
from jaart.core.kernels.call import evaluate_at
from jaart.core.kernels.energy import has_slope
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.probe import E_SLOPE, look, root_between
from jaart.core.kernels.records import Array, Bounds, End, Rule, Search, Sites, Start, Vector
from jaart.core.kernels.stretch import hit_at, nothing_found, state_of
from jaart.core.kernels.vectors import along
from jaart.core.kernels.weigh import fineness

#: Length of the steps, in h.
_STEP = 0.4


@kernel(STRICT)
def minimise_search(sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, rows: Array,
                    row: int, work: Array, fit: Array) -> End:
    """The first minimum of an energy within a stretch that lies below the level; arguments as of `step_search`.

    A minimum is where the slope turns from falling to rising between two looks, or at the beginning of the stretch
    where the energy fell before it. What is handed on to the next stretch is the slope at the end of this one.
    """
    size = int(surfels_near(sites, start.cell).size)
    if size == 0:
        return nothing_found(r.BACKGROUND, 0, 0, 0, 0, nan)
    fit[r.STARTS] += 1.0
    count = max(int(ceil((start.high - start.low) / (_STEP * fineness(rule.weight, rule.h)))), 1)
    a = look(E_SLOPE, sites, rule, how, d, start, start.low, rows, row, work, fit)
    blind = has_slope(how.energy, how.emphasise)  # looks have no normal, and so no end for the want of one
    state, looks, evaluations, falling = r.BACKGROUND, 1, a.evaluations, start.before < 0.0
    state = state if blind else state_of(a.value, state)
    for i in range(1, count + 1):
        s = start.low + (start.high - start.low) * (i / count)
        b = look(E_SLOPE, sites, rule, how, d, start, s, rows, row + looks, work, fit)
        looks, evaluations, best, found = looks + 1, evaluations + b.evaluations, a, False
        if a.q < 0.0 and b.q >= 0.0:
            best, more, spent = root_between(E_SLOPE, sites, rule, how, d, start, a, b, how.arrived, nan, rows,
                                             row + looks, work, fit)
            looks, evaluations, found = looks + more, evaluations + spent, True
        elif i == 1:
            found = falling and a.q >= 0.0
        if found and best.e < how.level:
            v = best.value
            if blind:
                near, x = surfels_near(sites, start.cell), along(start.base, d, best.s)
                v, evaluations = evaluate_at(how.evaluate, near, x, rule, r.VALUE_ONLY, work, fit), evaluations + 1
            end = hit_at(r.CONVERGED, sites, rule, how, bounds, d, start, best.s, v, best.e, looks, evaluations,
                         evaluations * size, 0, work, fit)
            if end.state == r.CONVERGED:
                return end
            state = end.state
        state, a = state if blind else state_of(b.value, state), b
    return nothing_found(state, looks, evaluations, evaluations * size, 0, a.q)
