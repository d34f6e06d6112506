"""Where hits begin to count on a ray that starts on the surface itself, as from a hit's point.

Such an origin is a root of f up to rounding, and would be met again at t of 1e-16 or so. A bound on the rounding says
whether it is one; then hits count from where the ray is clearly off the surface, and off by more than the search
resolves. An origin beside the surface, however near, is none: there is no fixed distance that rays must keep.

A least energy is flat, so that nobody can say whether a point has it: its hits count from 1e-4 h on.
"""

from __future__ import annotations

from math import nan
from typing import Any, NamedTuple

import numpy as np

from jaart.core.kernels import records as r
from jaart.core.kernels.call import evaluate_at
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Near, Plan, RayEnd, Vector
from jaart.core.kernels.vectors import dot, length

#: Eight units in the last place of 1: f at a rounded point of the surface is less, times its distance from 0 and h.
ROUNDING = 1.8e-15
#: Hits count from here at the latest, and those of energies always, in h.
FARTHEST, _FLAT = 0.125, 1e-4
_NONE: Any = np.int64(-1)


class Leave(NamedTuple):
    """How a ray leaves its origin.

    t: from which hits count; used: how many surfels were asked, -1 for none; ahead: step to the plane H at the origin,
    NaN where nobody knows.
    """

    t: float
    used: int
    ahead: float


@kernel(STRICT)
def least_of_energies(plan: Plan) -> float:
    """From which t hits of a least energy count on a ray that starts among the surfels; 0 for other searches."""
    return _FLAT * plan.rule.h if plan.how.kind == r.MINIMISE else 0.0


@kernel(STRICT)
def leave(near: Near, x: Vector, o: Vector, d: Vector, plan: Plan, blur: float, work: Array, fit: Array) -> Leave:
    """How a ray leaves its origin; hits count from t = 0 when it does not start on the surface.

    x, o: the origin relative to the place's centre, and in the scene's frame; blur: rounding of that frame.
    """
    if plan.how.kind == r.MINIMISE:
        return Leave(least_of_energies(plan), _NONE, nan)
    v = evaluate_at(plan.how.evaluate, near, x, plan.rule, r.VALUE_ONLY, work, fit)
    size: Any = np.int64(near.size)
    noise, h = ROUNDING * (length(o) + plan.rule.h) + blur, plan.rule.h
    if v.state != r.CONTINUE or not abs(v.f) <= noise:
        return Leave(0.0, size, v.f / dot(v.n, d))
    return Leave(min(max(plan.how.arrived, noise / abs(dot(v.n, d))), FARTHEST * h), size, nan)


@kernel(STRICT)
def counting(end: RayEnd, found: Leave) -> RayEnd:
    """A ray's end with the look at its origin among its evaluations."""
    if found.used < 0:
        return end
    return RayEnd(end.state, end.t, end.point, end.n, end.energy, end.off, end.iterations, end.evaluations + 1,
                  end.used + found.used, end.cells, end.lowered, end.gap, end.rows, end.missing)
