"""Searches that step from x to x: Adamson & Alexa's iteration, and the secant and Newton steps on the same f.

iterate: x_{i+1} = ray ∩ H(x_i), a step of e_ts(x_i) along the ray [T 2.14, 2.20; A §4], or ray ∩ polynomial;
secant: the root of the line through the last two of these steps; newton: -f/<∇f, r>.
"""

from __future__ import annotations

from math import inf, nan

from jaart.core.kernels import records as r
from jaart.core.kernels.call import evaluate_at
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.judge import judged
from jaart.core.kernels.log import write_step
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.place import in_scene, located
from jaart.core.kernels.polynomial import ray_polynomial
from jaart.core.kernels.records import Array, Bounds, End, Near, Rule, Search, Sites, Start, Value, Vector
from jaart.core.kernels.roots import nearest_root
from jaart.core.kernels.shown import difference, fitted_normal, true_normal
from jaart.core.kernels.vectors import along, dot, frame, length, scaled
from jaart.core.kernels.weigh import weigh

#: A ray whose angle with the plane has a smaller sine runs along it.
_PARALLEL = 1e-12
#: Four units in the last place of 1.
_ROUNDING = 8.9e-16
_NOTHING = (nan, nan, nan)


@kernel(STRICT)
def ended(state: int, step: float, off: float, steps: int, evaluations: int, used: int, lowered: int) -> End:
    """The end of a start that did not hit."""
    return End(state, nan, _NOTHING, _NOTHING, step, off, steps, evaluations, used, lowered, nan)


@kernel(STRICT)
def approach(v: Value, d: Vector, slope: float, reach: float, rule: Rule, fit: Array) -> float:
    """Step along d to the plane H(x) [T 2.20], or to the polynomial where the ray meets it within reach."""
    if v.degree > 0:
        e1, e2 = frame(v.n)
        root = nearest_root(ray_polynomial(fit, (dot(d, e1), dot(d, e2), slope)), reach / rule.h)
        if root == root:
            return root * rule.h
    return v.f / slope


@kernel(STRICT)
def next_step(how: Search, v: Value, ahead: float, s: float, s_before: float, ahead_before: float,
              steepness: float) -> float:
    """The step of iterate, secant or newton.

    ahead: e_ts at s; s_before, ahead_before: of the step before, NaN at first; steepness: <∇f, r>.
    """
    if how.kind == r.SECANT and ahead != ahead_before:
        step = -ahead * (s - s_before) / (ahead - ahead_before)
        return step if abs(step) <= how.trust else ahead
    if how.kind == r.NEWTON:
        return -v.f / steepness
    return ahead


@kernel(STRICT)
def state_after(how: Search, bounds: Bounds, start: Start, s: float, step: float, v: Value, slope: float, rule: Rule,
                inside: bool, near: Near, x: Vector, work: Array) -> int:
    """The state after a step that led to s: CONTINUE or an end.

    A step no longer than the rounding of f at the local coordinates, seen along the ray, says nothing.
    """
    if not (inside and start.low <= s <= start.high and start.t + s > 0.0):
        return r.LEFT_TRUST
    short = (abs(v.f) if how.by_value == 1 else abs(step)) < how.arrived
    if not short and abs(step * slope) > _ROUNDING * (abs(s) + rule.h + length(x)):
        return r.CONTINUE
    if bounds.gap > 0.0:  # differences leave other weights
        weigh(near, x, rule, work)
    state = judged(near, x, v, bounds, work)
    return r.FLOOR if state == r.CONVERGED and not short else state


@kernel(STRICT)
def step_search(sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, rows: Array, row: int,
                work: Array, fit: Array) -> End:
    """Search the surface from a start: step until the step is short [T 2.14], or |f| is [A §4].

    d: unit direction; rows: (L, LOG_WIDTH) log, L = 0 for none; row: where to write next; work, fit: scratch.
    """
    s, s_before, ahead_before, f_before = start.s, nan, nan, inf
    off, step, used, evaluations, lowered = nan, nan, 0, 0, 0
    want = r.WITH_GRADIENT if how.kind == r.NEWTON else r.VALUE_ONLY
    cell, x = start.cell, along(start.base, d, s)
    for done in range(how.cap):
        near = surfels_near(sites, cell)
        if near.size == 0:
            return ended(r.FEW_NEIGHBOURS, step, off, done, evaluations, used, lowered)
        v = evaluate_at(how.evaluate, near, x, rule, want, work, fit)
        state, slope, off = v.state, dot(v.n, d), length(v.off)
        used, evaluations = used + int(near.size), evaluations + 1
        lowered += 1 if state == r.CONTINUE and v.degree < rule.degree else 0
        ahead = approach(v, d, slope, how.trust, rule, fit)
        steepness = dot(v.gradient, d)
        if state == r.CONTINUE and how.kind == r.NEWTON and steepness != steepness:
            steepness, evaluations = difference(near, x, d, rule, how, v.n, work, fit), evaluations + 2
        step = next_step(how, v, ahead, s, s_before, ahead_before, steepness)
        if rows.shape[0] > 0:
            write_step(rows, row + done, sites, start, s, cell, x, v, step)
        if state == r.CONTINUE and abs(slope) < _PARALLEL:
            state = r.PARALLEL
        if state == r.CONTINUE and how.growth == 1 and abs(v.f) > f_before:
            state = r.CAP
        if state == r.CONTINUE:
            s_before, ahead_before, f_before = s, ahead, abs(v.f)
            s += step
            cell, x_next, inside = located(sites, start, d, s)
            state = state_after(how, bounds, start, s, step, v, slope, rule, inside, near, x, work)
            if state == r.CONVERGED or state == r.FLOOR:
                if how.kind == r.NEWTON and v.degree > 0:  # differences leave another fit
                    v, evaluations = evaluate_at(how.evaluate, near, x, rule, want, work, fit), evaluations + 1
                n = fitted_normal(v, scaled(d, step), rule, fit)
                if how.true_normal == 1:
                    more, n = true_normal(surfels_near(sites, cell), x_next, rule, how, n, work, fit)
                    evaluations += more
                hit = in_scene(sites, start.cell, along(start.base, d, s))
                return End(state, start.t + s, hit, n, step, off, done + 1, evaluations, used, lowered, nan)
            x = x_next
        if state != r.CONTINUE:
            return ended(state, step, off, done + 1, evaluations, used, lowered)
    return ended(r.CAP, step, off, how.cap, evaluations, used, lowered)
