"""The guarded search: the first hit on a stretch, never a loop.

Steps of at most 0.8 h (0.2 h for hats, which are no smooth weights) with f and its slope; a change of sign is a
bracket; so is an extremum between two equal signs, where the slopes at both ends point to 0. Steps are
shortened where the normal turns, f jumps or ends, and near 0. At a silhouette the iteration of
Adamson & Alexa is Newton's method for t² + c² = 0, which never ends; here it is an extremum that stays on its side.
"""

from __future__ import annotations

from math import ceil, nan

from jaart.core.kernels import records as r
from jaart.core.kernels.exclude import exclude
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.probe import F_SLOPE, F, Look, closest, look, opposite, root_between
from jaart.core.kernels.records import Array, Bounds, End, Rule, Search, Sites, Start, Vector
from jaart.core.kernels.stretch import fewer, has_hit, hit_at, jumps, nothing_found, state_of
from jaart.core.kernels.vectors import dot
from jaart.core.kernels.weigh import fineness

#: Length of the steps, in h (of hats, a quarter of it).
_STEP = 0.8
#: f is taken to change by no more than this times the way.
_STEEPEST = 1.5
#: Normals with a smaller cosine between them have turned too far for one step.
_TURNED = 0.5
#: A smaller change of f, in h, is no jump, however steep.
_JUMP = 0.1
#: Within a step f bends by less than this times the step's square over h.
_BENT = 0.05
#: Steps are shortened up to this share where the normal or f jumps, to a part of so many near 0, and up to this share
#: where f ends because no more surfels count.
_FINEST, _FINER, _EDGE = 1e-6, 8.0, 1e-9
#: An extremum is looked for until its bracket is this short, in h.
_EXTREMUM = 1e-9


@kernel(STRICT)
def may_dip(a: Look, b: Look) -> bool:
    """Whether f may cross 0 and come back between two looks of the same sign: its slopes point to 0 at both.

    Where both values are larger than f could change by on the way it does not.
    """
    if not (a.f * b.f > 0.0 and a.f * a.slope < 0.0 and b.f * b.slope > 0.0):
        return False
    return min(abs(a.f), abs(b.f)) < _STEEPEST * (b.s - a.s)


@kernel(STRICT)
def is_rough(a: Look, b: Look, step: float, h: float) -> bool:
    """Whether two looks are too different, or too near to 0, to tell what is between them.

    The normal turns, f changes faster than it can over a sheet, f ends, or f may bend through 0 and back unseen.
    step: the longest step.
    """
    size = b.s - a.s
    if a.value.state == r.CONTINUE and b.value.state == r.CONTINUE:
        if dot(a.value.n, b.value.n) < _TURNED or abs(b.f - a.f) > max(_STEEPEST * size, _JUMP * h):
            return size > step * _FINEST
        nearest = min(abs(a.f), abs(b.f))
        return a.f * b.f > 0.0 and nearest < _BENT * size * size / h and size > step / _FINER
    if a.value.state != r.CONTINUE and b.value.state != r.CONTINUE:
        return False
    f = a.f if a.value.state == r.CONTINUE else b.f
    return abs(f) < _STEEPEST * size and size > step * _EDGE


@kernel(STRICT)
def root_in(sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, low: Look, high: Look,
            before: End, rows: Array, row: int, work: Array, fit: Array) -> End:
    """The end of a stretch with the root between two looks, if there is one that keeps the bounds.

    before: the end without it; row: of the stretch's first look in the log.
    """
    if not opposite(low.f, high.f):
        return before
    hit, looks, spent = root_between(F, sites, rule, how, d, start, low, high, how.arrived, nan, rows,
                                     row + before.steps, work, fit)
    looks, spent = before.steps + looks, before.evaluations + spent
    used = spent * int(surfels_near(sites, start.cell).size)
    if hit.q != hit.q:
        return nothing_found(before.state, looks, spent, used, before.lowered, nan)
    arrived = how.arrived > closest(hit.s, rule.h) or how.arrived > 0.0 == hit.f
    return hit_at(r.CONVERGED if arrived else r.FLOOR, sites, rule, how, bounds, d, start, hit.s, hit.value, hit.f,
                  looks, spent, used, before.lowered, work, fit)


@kernel(STRICT)
def proven(sites: Sites, rule: Rule, bounds: Bounds, d: Vector, start: Start, end: End) -> End:
    """The end of a stretch without a hit, undecided where it cannot be proven that none is there.

    What the off-centre bound refused is proven with the rest; what another bound refused keeps its name.
    """
    if end.state != r.BACKGROUND and end.state != r.BOUNDED:
        return end
    near = surfels_near(sites, start.cell)
    doubtful, pieces = exclude(near, start.base, d, start.low, start.high, rule, bounds.off_centre)
    spent = end.evaluations + pieces
    return nothing_found(r.UNDECIDED if doubtful == doubtful else end.state, end.steps, spent, spent * int(near.size),
                         end.lowered, end.f)


@kernel(STRICT)
def safe_search(sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, rows: Array, row: int,
                work: Array, fit: Array) -> End:
    """The first surface within a stretch; arguments as of `step_search`."""
    surfels = int(surfels_near(sites, start.cell).size)
    if surfels == 0:
        return nothing_found(r.BACKGROUND, 0, 0, 0, 0, nan)
    fit[r.STARTS] += 1.0
    count = max(int(ceil((start.high - start.low) / (_STEP * fineness(rule.weight, rule.h)))), 1)
    a = look(F_SLOPE, sites, rule, how, d, start, start.low, rows, row, work, fit)
    end = nothing_found(r.BACKGROUND, 1, a.evaluations, a.evaluations * surfels, fewer(a, rule), a.f)
    if jumps(start.before, a.f, rule.h):
        end = hit_at(r.FLOOR, sites, rule, how, bounds, d, start, a.s, a.value, a.f, 1, a.evaluations, end.used,
                     end.lowered, work, fit)
    longest = (start.high - start.low) / count
    size = longest
    while a.s < start.high and not has_hit(end.state):
        s = a.s + size
        s = s if s < start.high - 1e-9 * longest else start.high
        b = look(F_SLOPE, sites, rule, how, d, start, s, rows, row + end.steps, work, fit)
        inner, looks, spent = b, 1, b.evaluations
        rough = is_rough(a, b, longest, rule.h)
        if not rough and may_dip(a, b):
            inner, looks, spent = root_between(F_SLOPE, sites, rule, how, d, start, a, b, _EXTREMUM * rule.h, a.f, rows,
                                               row + end.steps + 1, work, fit)
            looks, spent = looks + 1, spent + b.evaluations
        spent += end.evaluations
        end = nothing_found(end.state, end.steps + looks, spent, spent * surfels, end.lowered + fewer(b, rule), b.f)
        size = 0.5 * (b.s - a.s) if rough else min(2.0 * size, longest)
        if rough:
            continue
        end = root_in(sites, rule, how, bounds, d, start, a, inner, end, rows, row, work, fit)
        if not has_hit(end.state):  # the way out of a dip counts where the way in is refused
            end = root_in(sites, rule, how, bounds, d, start, inner, b, end, rows, row, work, fit)
        if b.value.state != r.CONTINUE and not has_hit(end.state):
            end = nothing_found(state_of(b.value, end.state), end.steps, end.evaluations, end.used, end.lowered, b.f)
        a = b
    if has_hit(end.state):
        return end
    end = nothing_found(end.state, end.steps, end.evaluations, end.used, end.lowered, a.f)
    return end if how.proof == 0 else proven(sites, rule, bounds, d, start, end)
