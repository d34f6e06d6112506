"""What the searches of a stretch of the ray have in common: how a hit there is judged and shown."""

from __future__ import annotations

from math import nan

from jaart.core.kernels import records as r
from jaart.core.kernels.call import evaluate_at
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.judge import judged
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.place import in_scene
from jaart.core.kernels.probe import Look, opposite
from jaart.core.kernels.records import Array, Bounds, End, Rule, Search, Sites, Start, Value, Vector
from jaart.core.kernels.shown import difference, fitted_normal, true_normal
from jaart.core.kernels.vectors import along, length
from jaart.core.kernels.weigh import weigh

_NOTHING = (nan, nan, nan)
#: f jumps by less than twice this, in h, where lists of surfels change.
_JUMP = 0.1


@kernel(STRICT)
def jumps(before: float, after: float, h: float) -> bool:
    """Whether f jumps over 0 as it may where a stretch begins and other surfels count, not as a turned normal does."""
    return opposite(before, after) and min(abs(before), abs(after)) <= _JUMP * h


@kernel(STRICT)
def nothing_found(state: int, steps: int, evaluations: int, used: int, lowered: int, f: float) -> End:
    """The end of a stretch without a hit."""
    return End(state, nan, _NOTHING, _NOTHING, nan, nan, steps, evaluations, used, lowered, f)


@kernel(STRICT)
def state_of(v: Value, otherwise: int) -> int:
    """The state that a look without a hit leaves a stretch in: where no surfel counts there is just no surface."""
    return r.UNDEFINED_NORMAL if v.state == r.UNDEFINED_NORMAL else otherwise


@kernel(STRICT)
def hit_at(state: int, sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, s: float,
           v: Value, energy: float, steps: int, evaluations: int, used: int, lowered: int, work: Array,
           fit: Array) -> End:
    """The end of a stretch with a hit at s, if it keeps the bounds; v: the surface there; energy: the error left.

    Where f rises along n there is no surface, but the change of sign between two sheets that face the same way.
    """
    if v.state != r.CONTINUE:
        return nothing_found(v.state, steps, evaluations, used, lowered, nan)
    near, x, before = surfels_near(sites, start.cell), along(start.base, d, s), evaluations
    if how.kind != r.MINIMISE:
        evaluations += 2
        if difference(near, x, v.n, rule, how, v.n, work, fit) > 0.0:
            return nothing_found(r.BACKGROUND, steps, evaluations, used, lowered, nan)
    weigh(near, x, rule, work)
    broken = judged(near, x, v, bounds, work)
    if broken != r.CONVERGED:
        return nothing_found(broken, steps, evaluations, used, lowered, nan)
    if v.degree > 0:  # the last fit may have been at another look
        v, evaluations = evaluate_at(how.evaluate, near, x, rule, r.VALUE_ONLY, work, fit), evaluations + 1
    n = fitted_normal(v, (0.0, 0.0, 0.0), rule, fit)
    if how.true_normal == 1:
        more, n = true_normal(near, x, rule, how, n, work, fit)
        evaluations += more
    used += (evaluations - before) * int(near.size)
    return End(state, start.t + s, in_scene(sites, start.cell, x), n, energy, length(v.off), steps, evaluations, used,
               lowered, nan)


@kernel(STRICT)
def fewer_degrees(v: Value, rule: Rule) -> int:
    """1 where the polynomial had fewer degrees than asked for."""
    return 1 if v.state == r.CONTINUE and v.degree < rule.degree else 0


@kernel(STRICT)
def fewer(seen: Look, rule: Rule) -> int:
    """The same of a look."""
    return fewer_degrees(seen.value, rule)
