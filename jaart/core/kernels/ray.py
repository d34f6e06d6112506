"""A ray through a lattice: empty cells skipped, the search begun cell after cell, the first hit its end."""

from __future__ import annotations

from math import nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import records as r
from jaart.core.kernels.blocks import is_short
from jaart.core.kernels.call import search_from
from jaart.core.kernels.counts import forget_counts, write_counts
from jaart.core.kernels.first_guess import fetch_row
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.leaving import FARTHEST, Leave, counting, least_of_energies, leave
from jaart.core.kernels.log import end_log
from jaart.core.kernels.near import fetch_near, surfels_near
from jaart.core.kernels.packet import (
    BAD,
    ENTER,
    FOUND,
    LANES,
    LEAVE,
    LEFT,
    STATE,
    VISITED,
    WALKING,
    T,
    axes_in,
    place_ray,
    spot_in,
    walk_together,
)
from jaart.core.kernels.place import centre_of
from jaart.core.kernels.records import Array, Cell, Cells, End, Out, Plan, RayEnd, Start, Unsigned, Vector
from jaart.core.kernels.stretch import has_hit
from jaart.core.kernels.traversal import Axes, cell_at, onward, spot_at, whole
from jaart.core.kernels.unowned import unowned, unowned_cells
from jaart.core.kernels.vectors import along
from jaart.core.kernels.way import Way, after, distance, free_of, walk, way_of

#: A wall that lies in the lattice's border is looked for from this far before it, and beyond it, in cells.
_RIM = 1e-9
_NOTHING = (nan, nan, nan)
_NOT_ASKED: Any = np.int64(-1)


@kernel(STRICT, inline=True)
def no_hit(state: int) -> RayEnd:
    """The end of a ray that nothing was searched on."""
    return RayEnd(state, nan, _NOTHING, _NOTHING, nan, nan, 0, 0, 0, 0, 0, nan, 0, -1)


@kernel(STRICT, inline=True)
def added(before: RayEnd, end: End) -> RayEnd:
    """A ray's end after one more start. A stretch without any surface leaves the state as it was, and only a hit ends
    doubt.
    """
    doubtful = before.state == r.UNDECIDED and not has_hit(end.state)
    state = before.state if doubtful or end.state == r.BACKGROUND else end.state
    return RayEnd(state, end.t, end.point, end.n, end.energy, end.off, end.steps,
                  before.evaluations + end.evaluations, before.used + end.used, before.cells,
                  before.lowered + end.lowered, end.gap, before.rows + end.steps, before.missing)


@kernel(STRICT, inline=True)
def visiting(end: RayEnd, cells: int) -> RayEnd:
    """A ray's end with so many cells or balls visited."""
    return RayEnd(end.state, end.t, end.point, end.n, end.energy, end.off, end.iterations, end.evaluations, end.used,
                  cells, end.lowered, end.gap, end.rows, end.missing)


@kernel(STRICT)
def leaving(cells: Cells, plan: Plan, axes: Axes, o: Vector, d: Vector, work: Array, fit: Array) -> Leave:
    """How a ray that starts in the lattice leaves its origin."""
    cell = cell_at(axes, 0.0)
    if surfels_near(cells.sites, cell).size == 0:
        return Leave(0.0, _NOT_ASKED, nan)
    centre = centre_of(cells.sites, cell)
    x = (o[0] - centre[0], o[1] - centre[1], o[2] - centre[2])
    return leave(surfels_near(cells.sites, cell), x, o, d, plan, 0.0, work, fit)


@kernel(STRICT, inline=True)
def start_of(cells: Cells, axes: Axes, spot: Vector, begin: Cell, o: Vector, d: Vector, t: float, way: Way,
             trust: float, before: float, number: int) -> Start:
    """Where the search of a cell begins, which the ray is in from t on.

    way: the ray's through the lattice; trust: how far a search may go; before: f at the end of the
    stretch before.
    """
    centre = centre_of(cells.sites, begin)
    base = along((o[0] - centre[0], o[1] - centre[1], o[2] - centre[2]), d, t)
    if cells.stretches == 0:
        return Start(begin, base, t, 0.0, max(way.least - t, -trust), trust, nan, number)
    end = onward(axes, spot, 0.0)[0]
    high = max(end - t, 0.0) if end < way.leave else way.leave - t + _RIM
    before_it = _RIM if t == way.first and way.uniform == 0.0 else 0.0
    return Start(begin, base, t, 0.0, min(max(way.least - t, -before_it), high), high, before, number)


@kernel(STRICT, inline=True)
def search_cell(cells: Cells, plan: Plan, start: Start, d: Vector, rows: Array, end: RayEnd, work: Array,
                fit: Array) -> tuple[RayEnd, float]:
    """A ray's end after the search from one more start, and f at the end of its stretch."""
    one = search_from(plan.search, cells.sites, plan.rule, plan.how, plan.bounds, d, start, rows, end.rows, work, fit)
    if one.steps == 0 and one.state == r.BACKGROUND:
        return end, one.f
    end = added(end, one)
    end_log(rows, end.rows if one.steps > 0 else 0, one.state)
    return end, one.f


@kernel(STRICT)
def behind(end: RayEnd, rows: Array) -> RayEnd:
    """A ray's end after a hit that does not count: it lies at the ray's own origin."""
    end_log(rows, end.rows, r.LEFT_TRUST)
    return RayEnd(r.LEFT_TRUST, nan, _NOTHING, _NOTHING, end.energy, end.off, end.iterations, end.evaluations,
                  end.used, end.cells, end.lowered, nan, end.rows, end.missing)


@kernel(STRICT, inline=True)
def search_on(cells: Cells, plan: Plan, axes: Axes, way: Way, at: float, spot: Vector, begin: Cell, visited: int,
              o: Vector, d: Vector, rows: Array, work: Array, fit: Array) -> RayEnd:
    """The first hit of a ray from the first cell on that a search begins in; arguments as of `walk` and `trace_ray`."""
    end, before, more, inner = no_hit(r.BACKGROUND), nan, visited, way.first == 0.0
    t = at
    while True:
        before = before if more == 1 and way.uniform == 0.0 else nan
        start = start_of(cells, axes, spot, begin, o, d, at, way, plan.how.trust, before, int(fit[r.STARTS]))
        end, before = search_cell(cells, plan, start, d, rows, end, work, fit)
        if inner and has_hit(end.state) and end.t < FARTHEST * plan.rule.h:  # perhaps it is the ray's own origin
            found, inner = leaving(cells, plan, axes, o, d, work, fit), False
            end = counting(end, found)
            if end.t < found.t:
                end, before, more, visited = behind(end, rows), nan, 0, visited - 1
                way = Way(way.free, way.touching, way.uniform, way.first, way.leave, found.t)
                at, spot, begin, more = walk(cells.empty, axes, spot, at, way)
                visited += more
                continue
        if has_hit(end.state):
            break
        t, spot = after(axes, spot, at, distance(cells.empty, spot), way)
        if not t < way.leave:
            break
        at, spot, begin, more = walk(cells.empty, axes, spot, t, way)
        visited += more
        if begin[0] < 0:
            break
    return visiting(end, visited)


@kernel(STRICT, inline=True)
def write_end(out: Out, to: int, end: RayEnd) -> None:
    """Write a ray's end into its row of the columns."""
    out.status[to], out.t[to] = end.state, end.t
    for axis in range(3):
        out.point[to, axis], out.normal[to, axis] = end.point[axis], end.n[axis]
    out.energy[to], out.off_centre[to] = abs(end.energy), end.off
    out.iterations[to], out.evaluations[to] = end.iterations, end.evaluations
    out.neighbours[to], out.cells[to], out.lowered[to] = end.used, end.cells, end.lowered
    out.gap[to] = end.gap


@kernel(STRICT, inline=True)
def ray_of(origins: Array, directions: Array, row: int) -> tuple[Vector, Vector]:
    """Origin and direction of a row."""
    return ((origins[row, 0], origins[row, 1], origins[row, 2]),
            (directions[row, 0], directions[row, 1], directions[row, 2]))


@kernel(STRICT, inline=True)
def end_in(cells: Cells, plan: Plan, p: Array, lane: Unsigned, rows: Array, work: Array, fit: Array) -> RayEnd:
    """How a ray of a packet that walked together ends."""
    if p[BAD + lane] > 0.0:
        return no_hit(r.BAD_RAY)
    visited = int(p[VISITED + lane])
    nx, ny, nz = cells.empty.shape
    axes = axes_in(p, lane, float(nx), float(ny), float(nz))
    t = p[ENTER + lane]
    way = way_of(cells, axes, t, p[LEAVE + lane], least_of_energies(plan) if t == 0.0 else 0.0)
    at, spot = p[T + lane], spot_in(p, lane)
    if p[STATE + lane] == LEFT and not way.touching:
        return visiting(no_hit(r.BACKGROUND), visited)
    if way.touching:
        at, spot, visited = t, spot_at(axes, t), 0
    begin = whole(spot)
    if p[STATE + lane] == WALKING or way.touching:
        at, spot, begin, more = walk(cells.empty, axes, spot, at, way)
        visited += more
        if begin[0] < 0:
            return visiting(no_hit(r.BACKGROUND), visited)
    o, d = (axes[0].o, axes[1].o, axes[2].o), (axes[0].d, axes[1].d, axes[2].d)
    return search_on(cells, plan, axes, way, at, spot, begin, visited, o, d, rows, work, fit)


@kernel(STRICT, entry=True)
def trace_rays(cells: Cells, plan: Plan, origins: Array, directions: Array, begins: Array, pixels: NDArray[np.int64],
               out: Out, rows: Array, packet: Array, work: Array, fit: Array) -> tuple[int, int]:
    """Trace some of the rays and write each into its row of the columns; returns how many of them, before one for which
    the pool was short, and the rows of the log it wrote.

    origins, directions: (R, 3) in cells, directions of unit length; begins: (R,) t before which a ray meets nothing, or
    (0,); pixels: rows to trace; rows: the log of a single ray, (0, LOG_WIDTH) for none; packet, work, fit: scratch of
    this call alone.
    """
    cells, log, p = unowned_cells(cells), unowned(rows), unowned(packet)
    scratch, fitted, written = unowned(work), unowned(fit), 0
    for first in range(0, pixels.shape[0], int(LANES)):
        count = np.uint64(min(pixels.shape[0] - first, int(LANES)))
        for lane in range(count):
            to = pixels[first + int(lane)]
            o, d = ray_of(origins, directions, to)
            place_ray(p, lane, o, d, begins[to] if begins.size > 0 else 0.0)
        walk_together(p, cells.empty, free_of(cells), cells.uniform > 0.0, count)
        for lane in range(count):
            if p[STATE + lane] == FOUND:
                fetch_row(cells.sites, whole(spot_in(p, lane)))
                fetch_near(cells.sites, whole(spot_in(p, lane)))
        for lane in range(count):
            end = end_in(cells, plan, p, lane, log, scratch, fitted)
            if is_short(cells.sites.pool):
                forget_counts(fitted)
                return first + int(lane), 0
            write_end(out, pixels[first + int(lane)], end)
            write_counts(out, pixels[first + int(lane)], fitted)
            written = end.rows
    return pixels.shape[0], written
