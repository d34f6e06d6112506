"""Rays through a lattice whose searches go side by side, in vectors; see `abreast`."""

from __future__ import annotations

from math import nan

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import records as r
from jaart.core.kernels.abreast import (
    ALONE,
    BASE,
    CELL,
    END,
    ENERGY,
    EVALUATIONS,
    MET,
    NORMAL,
    OFF,
    POINT,
    PULL,
    SEARCHING,
    STARTS,
    STEPS,
    TURN,
    USED,
    WEIGHT,
    S,
    begin,
    forget,
    go_on,
    put_vector,
    step,
    vector_in,
)
from jaart.core.kernels.blocks import is_short
from jaart.core.kernels.counts import forget_counts, write_counts
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import fetch_near, surfels_near
from jaart.core.kernels.packet import (
    ABREAST,
    AT,
    BAD,
    DIRECTION,
    ENTER,
    LANES,
    STATE,
    VISITED,
    WALKING,
    T,
    axes_in,
    place_ray,
    walk_together,
    walk_vector,
)
from jaart.core.kernels.ray import end_in, no_hit, ray_of, write_end
from jaart.core.kernels.records import Array, Cells, Out, Plan, RayEnd, Rule, Sites, Unsigned
from jaart.core.kernels.sums import gaussian_sums
from jaart.core.kernels.traversal import face_below, spot_at, whole
from jaart.core.kernels.unowned import unowned, unowned_cells
from jaart.core.kernels.vectors import along
from jaart.core.kernels.weigh import FAINT

_NOTHING = (nan, nan, nan)
_GOES_ON = float(r.CONTINUE)
#: A ray that was traced alone and written.
_WRITTEN = 6.0


@kernel(STRICT, inline=True)
def goes_alone(p: Array, lane: Unsigned, nx: float, ny: float, nz: float) -> bool:
    """Whether a ray asks for what is not done side by side: it has no meaning, runs within a face or starts inside."""
    x, y, z = axes_in(p, lane, nx, ny, nz)
    return p[BAD + lane] > 0.0 or p[ENTER + lane] == 0.0 or face_below(x) + face_below(y) + face_below(z) > 0


@kernel(STRICT, inline=True)
def sum_near(p: Array, sites: Sites, rule: Rule, lane: Unsigned) -> None:
    """Take the sums over the surfels near a ray's point; where they are too faint to go on so, it goes on alone."""
    near = surfels_near(sites, whole(vector_in(p, CELL, lane)))
    if near.size == 0:
        p[END + lane] = r.FEW_NEIGHBOURS
        return
    s, pull, turn = gaussian_sums(near, vector_in(p, POINT, lane), rule.h)
    if not s > FAINT:
        p[STATE + lane] = ALONE
        return
    p[WEIGHT + lane] = s
    put_vector(p, PULL, lane, True, pull)
    put_vector(p, TURN, lane, True, turn)
    p[STEPS + lane] += 1.0
    p[EVALUATIONS + lane] += 1.0
    p[USED + lane] += float(near.size)


@kernel(STRICT, inline=True)
def search_abreast(p: Array, cells: Cells, plan: Plan, nx: float, ny: float, nz: float, first: Unsigned) -> bool:
    """Search with a vector of rays until each has hit or left; whether there was room for all that was asked for."""
    forget(p, first)
    while begin(p, first) > 0:
        for lane in range(first, first + ABREAST):
            if p[STATE + lane] == SEARCHING:
                fetch_near(cells.sites, whole(vector_in(p, CELL, lane)))
        going = 1
        while going > 0:
            for lane in range(first, first + ABREAST):
                if p[STATE + lane] == SEARCHING and p[END + lane] == _GOES_ON:
                    sum_near(p, cells.sites, plan.rule, lane)
            if is_short(cells.sites.pool):
                return False
            going = step(p, nx, ny, nz, plan.rule.h, plan.how.arrived, plan.how.trust, float(plan.how.cap),
                         plan.bounds.off_centre, first)
        go_on(p, nx, ny, nz, first)
        walk_vector(p, cells.empty, 0, first)
    return True


@kernel(STRICT, inline=True)
def end_together(p: Array, lane: Unsigned) -> RayEnd:
    """How a ray ends that was searched side by side with others."""
    visited, t, point, n = int(p[VISITED + lane]), nan, _NOTHING, _NOTHING
    if p[STARTS + lane] == 0.0:
        end = no_hit(r.BACKGROUND)
        return RayEnd(end.state, nan, point, n, nan, nan, 0, 0, 0, visited, 0, nan, 0, end.missing)
    if p[STATE + lane] == MET:
        i, j, k = vector_in(p, AT, lane)
        x = along(vector_in(p, BASE, lane), vector_in(p, DIRECTION, lane), p[S + lane])
        t, point, n = p[T + lane] + p[S + lane], along((i + 0.5, j + 0.5, k + 0.5), x, 1.0), vector_in(p, NORMAL, lane)
    return RayEnd(int(p[END + lane]), t, point, n, p[ENERGY + lane], p[OFF + lane], int(p[STEPS + lane]),
                  int(p[EVALUATIONS + lane]), int(p[USED + lane]), visited, 0, nan, 0, -1)


@kernel(STRICT, inline=True)
def end_anew(cells: Cells, plan: Plan, p: Array, lane: Unsigned, begin: float, rows: Array, work: Array,
             fit: Array) -> RayEnd:
    """How a ray ends that is traced alone after all, from where it enters; begin: t before which it meets nothing."""
    nx, ny, nz = cells.empty.shape
    t = max(p[ENTER + lane], begin)
    p[T + lane], p[VISITED + lane], p[STATE + lane] = t, 0.0, WALKING
    put_vector(p, AT, lane, True, spot_at(axes_in(p, lane, float(nx), float(ny), float(nz)), t))
    return end_in(cells, plan, p, lane, rows, work, fit)


@kernel(STRICT, inline=True)
def write_ray(out: Out, to: int, end: RayEnd, fit: Array) -> None:
    """Write a ray's end and what it took into its row of the columns."""
    write_end(out, to, end)
    write_counts(out, to, fit)


@kernel(STRICT, inline=True)
def trace_walked(cells: Cells, plan: Plan, p: Array, begins: Array, pixels: NDArray[np.int64], out: Out, rows: Array,
                 work: Array, fit: Array) -> bool:
    """Trace rays of a packet that walked together; whether there was room for all that they asked for."""
    nx, ny, nz = cells.empty.shape
    x, y, z, count = float(nx), float(ny), float(nz), np.uint64(pixels.shape[0])
    for lane in range(count):
        if goes_alone(p, lane, x, y, z):
            write_ray(out, pixels[lane], end_in(cells, plan, p, lane, rows, work, fit), fit)
            p[STATE + lane] = _WRITTEN
    for first in range(np.uint64(0), count, ABREAST):
        if not search_abreast(p, cells, plan, x, y, z, first):
            return False
    for lane in range(count):
        to = pixels[lane]
        if p[STATE + lane] == ALONE:
            begin = begins[to] if begins.size > 0 else 0.0
            write_ray(out, to, end_anew(cells, plan, p, lane, begin, rows, work, fit), fit)
        elif p[STATE + lane] != _WRITTEN:
            fit[r.STARTS] = p[STARTS + lane]
            write_ray(out, to, end_together(p, lane), fit)
    return not is_short(cells.sites.pool)


@kernel(STRICT, entry=True)
def trace_together(cells: Cells, plan: Plan, origins: Array, directions: Array, begins: Array,
                   pixels: NDArray[np.int64], out: Out, rows: Array, packet: Array, work: Array,
                   fit: Array) -> tuple[int, int]:
    """`trace_rays` for searches that go side by side; packet: (ROOM,) of `abreast`; rows: none, (0, LOG_WIDTH)."""
    cells, log, p = unowned_cells(cells), unowned(rows), unowned(packet)
    scratch, fitted, begun, rays = unowned(work), unowned(fit), unowned(begins), unowned(pixels)
    for first in range(0, rays.shape[0], int(LANES)):
        last = min(first + int(LANES), rays.shape[0])
        for i in range(first, last):
            o, d = ray_of(origins, directions, rays[i])
            place_ray(p, np.uint64(i - first), o, d, begun[rays[i]] if begun.size > 0 else 0.0)
        walk_together(p, cells.empty, 0, False, np.uint64(last - first))
        if not trace_walked(cells, plan, p, begun, rays[first:last], out, log, scratch, fitted):
            forget_counts(fitted)
            return first, 0
    return rays.shape[0], 0
