"""Even steps along the ray to a change of sign, then a straight line between the two values [T §2.3.5]."""

from __future__ import annotations

from math import ceil, nan

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.probe import F, Look, look, opposite
from jaart.core.kernels.records import Array, Bounds, End, Rule, Search, Sites, Start, Vector
from jaart.core.kernels.stretch import fewer, hit_at, jumps, nothing_found, state_of
from jaart.core.kernels.vectors import dot

#: What may be left of f where a straight line is 0, in h.
_LEFT = 0.1

@kernel(STRICT)
def turned(n_before: Vector, f_before: float, after: Look, f: float, gap: float, h: float) -> bool:
    """Whether f jumps between two looks as it does where the normal turns.

    f: where a straight line would be 0; gap: between the looks. f changes about as fast as the distance, so that
    more than half the gap is no rest of a root.
    """
    if dot(n_before, after.value.n) < 0.0 and abs(f) > min(abs(f_before), abs(after.f)):
        return True
    return abs(f) > max(_LEFT * h, 0.5 * gap)


@kernel(STRICT)
def march_search(sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, rows: Array, row: int,
                 work: Array, fit: Array) -> End:
    """The first change of sign of f within a stretch; arguments as of `step_search`.

    The steps begin anew with every stretch and are shortened to divide it. Where f jumps over 0 at its beginning,
    because other surfels count there, the hit is on the border. Where the normal changes its side f jumps over 0,
    and has no root.
    """
    size = int(surfels_near(sites, start.cell).size)
    if size == 0:
        return nothing_found(r.BACKGROUND, 0, 0, 0, 0, nan)
    fit[r.STARTS] += 1.0
    count = max(int(ceil((start.high - start.low) / how.step)), 1)
    state, looks, refused, lowered, s_before, f_before = r.BACKGROUND, 0, 0, 0, start.low, start.before
    n_before = (nan, nan, nan)
    for i in range(count + 1):
        s = start.low + (start.high - start.low) * (i / count)
        seen = look(F, sites, rule, how, d, start, s, rows, row + looks, work, fit)
        looks, lowered = looks + 1, lowered + fewer(seen, rule)
        if seen.value.state != r.CONTINUE:
            state = state_of(seen.value, state)
        elif jumps(f_before, seen.f, rule.h) if i == 0 else opposite(f_before, seen.f):
            at = s if i == 0 else s_before + (s - s_before) * (f_before / (f_before - seen.f))
            hit = look(F, sites, rule, how, d, start, at, rows, row + looks, work, fit)
            looks, lowered = looks + 1, lowered + fewer(hit, rule)
            if turned(n_before, f_before, seen, hit.f, s - s_before, rule.h):
                s_before, f_before, n_before = s, seen.f, seen.value.n
                continue
            end = hit_at(r.CONVERGED, sites, rule, how, bounds, d, start, at, hit.value, hit.f, looks, looks + refused,
                         (looks + refused) * size, lowered, work, fit)
            if end.state == r.CONVERGED:
                return end
            state, refused = end.state, end.evaluations - looks  # what finding that out took
        s_before, f_before, n_before = s, seen.f, seen.value.n
    return nothing_found(state, looks, looks + refused, (looks + refused) * size, lowered, f_before)
