"""What becomes of a place where a search says that a ray meets the surface: bounds, and the normal it shows."""

from __future__ import annotations

from math import inf, nan
from typing import Any

import numpy as np

from jaart.core.kernels import records as r
from jaart.core.kernels.call import evaluate_at
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.judge import judged
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.records import Array, Bounds, End, Met, Rule, Search, Sites, Spent
from jaart.core.kernels.shown import difference, fitted_normal, true_normal
from jaart.core.kernels.vectors import length
from jaart.core.kernels.weigh import weigh

_NOTHING = (nan, nan, nan)


@kernel(STRICT)
def ended(state: int, energy: float, off: float, spent: Spent, f: float) -> End:
    """The end of a start that did not hit; f: at the end of a stretch."""
    return End(state, nan, _NOTHING, _NOTHING, energy, off, spent.steps, spent.evaluations, spent.used, spent.lowered,
               f, nan)


@kernel(STRICT)
def more(spent: Spent, evaluations: int, size: int) -> Spent:
    """What was spent, with so many more evaluations of so many surfels."""
    return Spent(spent.steps, spent.evaluations + evaluations, spent.used + evaluations * size, spent.lowered)


@kernel(STRICT)
def accept(sites: Sites, rule: Rule, how: Search, bounds: Bounds, met: Met, spent: Spent, work: Array,
           fit: Array) -> End:
    """The end of a start that hit, or that of one whose hit a bound refuses [T §2.5].

    Where f rises along n there is no surface, but the change of sign between two sheets that face the same way.
    """
    near, v = surfels_near(sites, met.cell), met.v
    size: Any = np.int64(near.size)
    if met.sided == 1:
        spent = more(spent, 2, size)
        if difference(near, met.x, v.n, rule, how, v.n, work, fit) > 0.0:
            return ended(r.BACKGROUND, met.energy, length(v.off), spent, nan)
    if bounds.gap > -inf:  # a fit or a difference leaves other weights
        weigh(near, met.x, rule, work)
    state, gap = judged(near, met.x, v, bounds, work)
    if state != r.CONVERGED:
        return ended(state, met.energy, length(v.off), spent, nan)
    if v.degree > 0 and met.other_fit == 1:
        v, spent = evaluate_at(how.evaluate, near, met.x, rule, r.VALUE_ONLY, work, fit), more(spent, 1, size)
    n = fitted_normal(v, met.to, rule, fit)
    if how.true_normal == 1:
        beside = surfels_near(sites, met.at_cell)
        evaluations, n = true_normal(beside, met.at, rule, how, n, work, fit)
        more_surfels: Any = np.int64(beside.size)
        spent = more(spent, evaluations, more_surfels)
    return End(met.state, met.t, met.point, n, met.energy, length(v.off), spent.steps, spent.evaluations, spent.used,
               spent.lowered, nan, gap)
