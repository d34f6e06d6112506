"""What the searches of a stretch of the ray have in common: how a hit there is judged and shown."""

from __future__ import annotations

from math import nan

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.judge import judged
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.place import in_scene
from jaart.core.kernels.probe import Look, opposite
from jaart.core.kernels.records import Array, Bounds, End, Rule, Search, Sites, Start, Value, Vector
from jaart.core.kernels.shown import fitted_normal, true_normal
from jaart.core.kernels.vectors import along, dot, length
from jaart.core.kernels.weigh import weigh

_NOTHING = (nan, nan, nan)


@kernel(STRICT)
def through(before: float, after: float, n: Vector, d: Vector) -> bool:
    """Whether f changes its sign as it does through a surface: ∂f/∂d and <n, d> have different signs.

    Between two sheets that face the same way there is another change of sign, which is no surface.
    """
    return opposite(before, after) and (after - before) * dot(n, d) <= 0.0


@kernel(STRICT)
def nothing_found(state: int, steps: int, evaluations: int, used: int, lowered: int, f: float) -> End:
    """The end of a stretch without a hit."""
    return End(state, nan, _NOTHING, _NOTHING, nan, nan, steps, evaluations, used, lowered, f)


@kernel(STRICT)
def hit_at(state: int, sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, s: float,
           v: Value, energy: float, steps: int, evaluations: int, used: int, lowered: int, work: Array,
           fit: Array) -> End:
    """The end of a stretch with a hit at s, if it keeps the bounds; v: the surface there; energy: the error left."""
    if v.state != r.CONTINUE:
        return nothing_found(v.state, steps, evaluations, used, lowered, nan)
    near, x = surfels_near(sites, start.cell), along(start.base, d, s)
    weigh(near, x, rule, work)
    broken = judged(near, x, v, bounds, work)
    if broken != r.CONVERGED:
        return nothing_found(broken, steps, evaluations, used, lowered, nan)
    n = fitted_normal(v, (0.0, 0.0, 0.0), rule, fit)
    if how.true_normal == 1:
        more, n = true_normal(near, x, rule, how, work, fit)
        evaluations += more
    return End(state, start.t + s, in_scene(sites, start.cell, x), n, energy, length(v.off), steps, evaluations, used,
               lowered, nan)


@kernel(STRICT)
def fewer_degrees(v: Value, rule: Rule) -> int:
    """1 where the polynomial had fewer degrees than asked for."""
    return 1 if v.degree < rule.degree else 0


@kernel(STRICT)
def fewer(seen: Look, rule: Rule) -> int:
    """The same of a look."""
    return fewer_degrees(seen.value, rule)
