"""The plane or polynomial at the centre of a cell or a ball alone, without iteration [A §6]."""

from __future__ import annotations

from typing import Any

import numpy as np

from jaart.core.kernels import records as r
from jaart.core.kernels.call import accept_at, evaluate_at
from jaart.core.kernels.guess import meets, read_guess, write_guess
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.log import write_step
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.place import in_scene, located
from jaart.core.kernels.records import FIT_SIZE, Array, Bounds, End, Met, Rule, Search, Sites, Spent, Start, Vector
from jaart.core.kernels.stretch import fewer_degrees, nothing_found
from jaart.core.kernels.vectors import along

_ONE: Any = np.int64(1)


@kernel(STRICT)
def centre_search(sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, rows: Array, row: int,
                  work: Array, fit: Array) -> End:
    """The ray's hit with what the surface is seen as from the centre of the start's place; as `step_search` else.

    In a lattice the first hit ahead of the start within the trust region; in a ball its promise, whose row of guesses
    lies behind the coefficients in fit and costs no evaluation.
    """
    centre, row_kept, cost = (0.0, 0.0, 0.0), fit[FIT_SIZE:], _ONE
    size: Any = np.int64(surfels_near(sites, start.cell).size)
    fit[r.STARTS] += 1.0
    if sites.shape[0] == 0:
        v, cost = read_guess(row_kept, fit), _ONE - _ONE
    else:
        v = evaluate_at(how.evaluate, surfels_near(sites, start.cell), centre, rule, r.VALUE_ONLY, work, fit)
        write_guess(row_kept, v, fit)
    size, lowered = size * cost, fewer_degrees(v, rule) * cost
    if v.state != r.CONTINUE:
        return nothing_found(v.state, 0, cost, size, lowered, v.f)
    low = start.low if sites.shape[0] == 0 else max(0.0, -start.t)
    s = meets(row_kept, start.base, d, low, start.high, rule.h)
    x = along(start.base, d, s)
    if rows.shape[0] > 0:
        write_step(rows, row, sites, start, 0.0, start.cell, centre, v, s)
    if s != s or not located(sites, start, d, s)[2]:
        return nothing_found(r.LEFT_TRUST, 1, cost, size, lowered, v.f)
    point = in_scene(sites, start.cell, x)
    met = Met(r.CONVERGED, start.t + s, point, start.cell, centre, v, x, start.cell, x, v.f, 0, 0)
    spent = Spent(_ONE, cost, size, lowered)
    return accept_at(how.accept, sites, rule, how, bounds, met, spent, work, fit)
