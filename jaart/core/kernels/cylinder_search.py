"""Schaufler and Jensen's hit in a cloud: each ball is a disc, and the first that a ray hits places the cylinder."""

from __future__ import annotations

from math import nan, sqrt
from typing import Any

import numpy as np

from jaart.core.kernels import records as r
from jaart.core.kernels.cylinder import CANCELLED, mean_of, plane_s
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.log import write_step
from jaart.core.kernels.near import normal, surfels_near
from jaart.core.kernels.place import in_scene
from jaart.core.kernels.records import Array, Bounds, End, Rule, Search, Sites, Start, Value, Vector
from jaart.core.kernels.stretch import nothing_found
from jaart.core.kernels.vectors import along, dot, length, scaled
from jaart.core.kernels.weigh import nearest

_NOTHING = (nan, nan, nan)
_ONE: Any = np.int64(1)


@kernel(STRICT)
def cylinder_search(sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, rows: Array,
                    row: int, work: Array, fit: Array) -> End:
    """The mean of the surfels around the ray where it hits the disc of the ball's own point; as `step_search` else.

    The disc's radius is h, the ball's. f of the end is where the disc is hit: the least decides, not that of the means.
    """
    near, centre = surfels_near(sites, start.cell), (0.0, 0.0, 0.0)
    s = plane_s(start.base, d, centre, normal(near, nearest(near, centre, 1.0)))
    x = along(start.base, d, s)
    if not (start.low <= s <= start.high and length(x) < rule.h):
        return nothing_found(r.BACKGROUND, 0, 0, 0, 0, nan)
    m = mean_of(near, x, d, rule.h)
    size, t, hit = sqrt(dot(m.n, m.n)), start.t + s, along(x, d, m.ahead)
    off = along(m.centre, x, -1.0)
    n = scaled(m.n, 1.0 / size)
    if rows.shape[0] > 0:
        v = Value(r.CONTINUE, m.ahead, n, off, m.weight, 0.0, _NOTHING, 0)
        write_step(rows, row, sites, start, s, start.cell, x, v, m.ahead)
    if not size > CANCELLED or t + m.ahead <= 0.0:
        return nothing_found(r.LEFT_TRUST if size > CANCELLED else r.UNDEFINED_NORMAL, _ONE, _ONE, m.many, 0, nan)
    return End(r.CONVERGED, t + m.ahead, in_scene(sites, start.cell, hit), n, m.ahead,
               length(along(m.centre, hit, -1.0)), _ONE, _ONE, m.many, 0, t, nan)
