"""What the searches of a stretch of the ray have in common: how a hit there is judged and shown."""

from __future__ import annotations

from math import nan

from jaart.core.kernels import records as r
from jaart.core.kernels.accept import ended
from jaart.core.kernels.call import accept_at
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.place import in_scene
from jaart.core.kernels.probe import Look, opposite
from jaart.core.kernels.records import Array, Bounds, End, Met, Rule, Search, Sites, Spent, Start, Value, Vector
from jaart.core.kernels.vectors import along

#: f jumps by less than twice this, in h, where lists of surfels change.
_JUMP = 0.1


@kernel(STRICT)
def has_hit(state: int) -> bool:
    """Whether a state is a hit."""
    return state == r.CONVERGED or state == r.FLOOR


@kernel(STRICT)
def jumps(before: float, after: float, h: float) -> bool:
    """Whether f jumps over 0 as it may where a stretch begins and other surfels count, not as a turned normal does."""
    return opposite(before, after) and min(abs(before), abs(after)) <= _JUMP * h


@kernel(STRICT)
def nothing_found(state: int, steps: int, evaluations: int, used: int, lowered: int, f: float) -> End:
    """The end of a stretch without a hit."""
    return ended(state, nan, nan, Spent(steps, evaluations, used, lowered), f)


@kernel(STRICT)
def state_of(v: Value, otherwise: int) -> int:
    """The state that a look without a hit leaves a stretch in: where no surfel counts there is just no surface."""
    return r.UNDEFINED_NORMAL if v.state == r.UNDEFINED_NORMAL else otherwise


@kernel(STRICT)
def hit_at(state: int, sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, s: float,
           v: Value, energy: float, steps: int, evaluations: int, used: int, lowered: int, work: Array,
           fit: Array) -> End:
    """The end of a stretch with a hit at s, if it is one and keeps the bounds; v: the surface there."""
    if v.state != r.CONTINUE:
        return nothing_found(v.state, steps, evaluations, used, lowered, nan)
    x = along(start.base, d, s)
    sided = 0 if how.kind == r.MINIMISE else 1
    point = in_scene(sites, start.cell, x)
    met = Met(state, start.t + s, point, start.cell, x, v, (0.0, 0.0, 0.0), start.cell, x, energy, sided, 1)
    return accept_at(how.accept, sites, rule, how, bounds, met, Spent(steps, evaluations, used, lowered), work, fit)


@kernel(STRICT)
def fewer_degrees(v: Value, rule: Rule) -> int:
    """1 where the polynomial had fewer degrees than asked for."""
    return 1 if v.state == r.CONTINUE and v.degree < rule.degree else 0


@kernel(STRICT)
def fewer(seen: Look, rule: Rule) -> int:
    """The same of a look."""
    return fewer_degrees(seen.value, rule)
