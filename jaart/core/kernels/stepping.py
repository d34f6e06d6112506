"""Searches that step from x to x: Adamson & Alexa's iteration, and the secant and Newton steps on the same f.

iterate: x_{i+1} = ray ∩ H(x_i), a step of e_ts(x_i) along the ray [T 2.14, 2.20; A §4], or ray ∩ polynomial;
secant: the root of the line through the last two of these steps; newton: -f/<∇f, r>.
"""

from __future__ import annotations

from math import inf, nan
from typing import Any

import numpy as np

from jaart.core.kernels import records as r
from jaart.core.kernels.accept import ended, more
from jaart.core.kernels.call import accept_at, approach_at, evaluate_at
from jaart.core.kernels.dip import nothing_known, passes_by, tells_sides, with_look
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.log import write_step
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.place import in_scene, located
from jaart.core.kernels.records import Array, Bounds, End, Met, Rule, Search, Sites, Spent, Start, Value, Vector
from jaart.core.kernels.shown import difference
from jaart.core.kernels.vectors import along, dot, length, scaled

#: A ray whose angle with the plane has a smaller sine runs along it.
PARALLEL = 1e-12
#: Four units in the last place of 1.
ROUNDING = 8.9e-16
_NONE: Any = np.int64(0)


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
def state_after(how: Search, start: Start, s: float, step: float, v: Value, slope: float, h: float, inside: bool,
                x: Vector) -> int:
    """The state after a step that led to s: CONTINUE, or an end.

    A step no longer than the rounding of f at the local coordinates, seen along the ray, says nothing.
    """
    if not (inside and start.low <= s <= start.high and start.t + s > 0.0):
        return r.LEFT_TRUST
    if (abs(v.f) if how.by_value == 1 else abs(step)) < how.arrived:
        return r.CONVERGED
    return r.CONTINUE if abs(step * slope) > ROUNDING * (abs(s) + h + length(x)) else r.FLOOR


@kernel(STRICT)
def ahead_of(v: Value, d: Vector, slope: float, how: Search, rule: Rule, fit: Array) -> float:
    """Step along d to the plane H(x) [T 2.20], or to what was fitted above it."""
    return v.f / slope if how.approach == 0 else approach_at(how.approach, v, d, slope, how.trust, rule, fit)


@kernel(STRICT)
def state_before(v: Value, slope: float, how: Search, f_before: float) -> int:
    """CONTINUE, or why there is no step from here."""
    if v.state != r.CONTINUE:
        return v.state
    if abs(slope) < PARALLEL:
        return r.PARALLEL
    return r.CAP if how.growth == 1 and abs(v.f) > f_before else r.CONTINUE


@kernel(STRICT, inline=True)
def steps_from(sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, rows: Array, row: int,
               work: Array, fit: Array) -> End:
    """Search the surface from a start: step until the step is short [T 2.14], or |f| is [A §4].

    A search for a root ends, too, where the ray passes by the surface.

    d: unit direction; rows: (L, LOG_WIDTH) log, L = 0 for none; row: where to write next; work, fit: scratch.
    """
    s, s_before, ahead_before, f_before, step, off = start.s, nan, nan, inf, nan, nan
    spent, dip, sided = Spent(_NONE, _NONE, _NONE, _NONE), nothing_known(), tells_sides(how, rule)
    want = r.WITH_GRADIENT if how.kind == r.NEWTON else r.QUICK
    cell, x = start.cell, along(start.base, d, s)
    fit[r.STARTS] += 1.0
    for done in range(how.cap):
        near = surfels_near(sites, cell)
        if near.size == 0:
            return ended(r.FEW_NEIGHBOURS, step, off, spent, nan)
        v = evaluate_at(how.evaluate, near, x, rule, want, work, fit)
        size: Any = np.int64(near.size)
        fewer = 1 if v.state == r.CONTINUE and v.degree < rule.degree else 0
        spent = Spent(done + 1, spent.evaluations + 1, spent.used + size, spent.lowered + fewer)
        slope, steepness, off = dot(v.n, d), dot(v.gradient, d), length(v.off)
        ahead, differed = ahead_of(v, d, slope, how, rule, fit), 0
        if v.state == r.CONTINUE and how.kind == r.NEWTON and steepness != steepness:
            steepness, differed = difference(near, x, d, rule, how, v.n, work, fit), 1
            spent = more(spent, 2, size)
        step = next_step(how, v, ahead, s, s_before, ahead_before, steepness)
        if rows.shape[0] > 0:
            write_step(rows, row + done, sites, start, s, cell, x, v, step)
        state = state_before(v, slope, how, f_before)
        if state != r.CONTINUE:
            return ended(state, step, off, spent, nan)
        if sided:
            dip = with_look(dip, s, v.f)
            if passes_by(dip):
                return ended(r.BACKGROUND, step, off, spent, nan)
        s_before, ahead_before, f_before = s, ahead, abs(v.f)
        s += step
        to_cell, to, inside = located(sites, start, d, s)
        state = state_after(how, start, s, step, v, slope, rule.h, inside, x)
        if state == r.CONVERGED or state == r.FLOOR:
            point = in_scene(sites, start.cell, along(start.base, d, s))
            met = Met(state, start.t + s, point, cell, x, v, scaled(d, step), to_cell, to, step, 0, differed)
            return accept_at(how.accept, sites, rule, how, bounds, met, spent, work, fit)
        if state != r.CONTINUE:
            return ended(state, step, off, spent, nan)
        cell, x = to_cell, to
    return ended(r.CAP, step, off, spent, nan)


@kernel(STRICT)
def step_search(sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, rows: Array, row: int,
                work: Array, fit: Array) -> End:
    """`steps_from`, to be called by its address."""
    return steps_from(sites, rule, how, bounds, d, start, rows, row, work, fit)
