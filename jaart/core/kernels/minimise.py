"""The least energy in a stretch of the ray, accepted below a level [T §2.4.4].

There is at most one minimum in a cell. It is where the energy's slope changes its sign: found by its root where the
slope has a closed form, and by the difference of two near values elsewhere, as the thesis's bisection does.
"""

from __future__ import annotations

from math import nan

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.probe import E_SLOPE, Look, look, root_between
from jaart.core.kernels.records import Array, Bounds, End, Rule, Search, Sites, Start, Vector
from jaart.core.kernels.stretch import hit_at, nothing_found, state_of


@kernel(STRICT)
def least_energy(sites: Sites, rule: Rule, how: Search, d: Vector, start: Start, a: Look, b: Look, rows: Array,
                 row: int, work: Array, fit: Array) -> tuple[bool, Look, int, int]:
    """Whether a stretch from a to b has a minimum, the look at it, and how many more looks and evaluations it took.

    At its beginning there is one where the energy falls before the stretch and rises in it.
    """
    if a.q < 0.0 and b.q > 0.0:
        best, looks, evaluations = root_between(E_SLOPE, sites, rule, how, d, start, a, b, how.arrived, nan, rows, row,
                                                work, fit)
        return True, best, looks, evaluations
    return start.before < 0.0 and a.q >= 0.0, a, 0, 0


@kernel(STRICT)
def minimise_search(sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, rows: Array,
                    row: int, work: Array, fit: Array) -> End:
    """The minimum of an energy within a stretch, below the level; arguments as of `step_search`.

    What is handed on to the next stretch is the energy's slope at the end of this one.
    """
    size = int(surfels_near(sites, start.cell).size)
    if size == 0:
        return nothing_found(r.BACKGROUND, 0, 0, 0, 0, nan)
    a = look(E_SLOPE, sites, rule, how, d, start, start.low, rows, row, work, fit)
    b = look(E_SLOPE, sites, rule, how, d, start, start.high, rows, row + 1, work, fit)
    looks, evaluations = 2, a.evaluations + b.evaluations
    found, best, more, spent = least_energy(sites, rule, how, d, start, a, b, rows, row + looks, work, fit)
    looks, evaluations = looks + more, evaluations + spent
    state = state_of(b.value, r.BACKGROUND)
    if found and best.e < how.level:
        end = hit_at(r.CONVERGED, sites, rule, how, bounds, d, start, best.s, best.value, best.e, looks, evaluations,
                     evaluations * size, 0, work, fit)
        if end.state == r.CONVERGED:
            return end
        state = end.state
    return nothing_found(state, looks, evaluations, evaluations * size, 0, b.q)
