"""A ray through a lattice: empty cells skipped, the search begun cell after cell, the first hit its end."""

from __future__ import annotations

from math import isfinite, nan, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import records as r
from jaart.core.kernels.blocks import is_short
from jaart.core.kernels.call import search_from
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.leaving import FARTHEST, Leave, counting, least_of_energies, leave
from jaart.core.kernels.log import end_log
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.place import centre_of
from jaart.core.kernels.records import Array, Cell, Cells, End, Out, Plan, RayEnd, Start, Vector
from jaart.core.kernels.stretch import has_hit
from jaart.core.kernels.traversal import Axes, advance, axes_of, cell_at, clip, inside, start_at
from jaart.core.kernels.unowned import unowned, unowned_cells
from jaart.core.kernels.vectors import along

#: From farther away one unit in the last place of the origin is wider than a cell.
_FAR = 1e15
#: A wall that lies in the lattice's border is looked for from this far before it, and beyond it, in cells.
_RIM = 1e-9
_NOTHING, _OUTSIDE = (nan, nan, nan), (-1, -1, -1)
_NOT_ASKED: Any = np.int64(-1)


@kernel(STRICT)
def is_bad(o: Vector, d: Vector) -> bool:
    """Whether a ray has no meaning: not finite, no unit direction, or an origin beyond all precision."""
    for axis in range(3):
        if not (isfinite(d[axis]) and abs(o[axis]) < _FAR):
            return True
    return abs(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - 1.0) > 1e-6


@kernel(STRICT)
def no_hit(state: int) -> RayEnd:
    """The end of a ray that nothing was searched on."""
    return RayEnd(state, nan, _NOTHING, _NOTHING, nan, nan, 0, 0, 0, 0, 0, nan, 0, -1)


@kernel(STRICT)
def added(before: RayEnd, end: End) -> RayEnd:
    """A ray's end after one more start. A stretch without any surface leaves the state as it was, and only a hit ends
    doubt.
    """
    doubtful = before.state == r.UNDECIDED and not has_hit(end.state)
    state = before.state if doubtful or end.state == r.BACKGROUND else end.state
    return RayEnd(state, end.t, end.point, end.n, end.energy, end.off, end.steps,
                  before.evaluations + end.evaluations, before.used + end.used, before.cells,
                  before.lowered + end.lowered, end.gap, before.rows + end.steps, before.missing)


@kernel(STRICT)
def visiting(end: RayEnd, cells: int) -> RayEnd:
    """A ray's end with so many cells or balls visited."""
    return RayEnd(end.state, end.t, end.point, end.n, end.energy, end.off, end.iterations, end.evaluations, end.used,
                  cells, end.lowered, end.gap, end.rows, end.missing)


class Way(NamedTuple):
    """How a ray goes through the cells, as in Cells; halo: -1 where a search begins in cells with a surfel only.

    first: t where the ray enters the lattice; leave: t where it leaves it; least: t from which hits count.
    """

    halo: int
    uniform: float
    first: float
    leave: float
    least: float


@kernel(STRICT)
def begins_in(empty: NDArray[np.uint8], axes: Axes, cell: Cell, halo: int) -> Cell:
    """The cell that a search begins in while the ray is in a cell: it, one beside it, or (-1, -1, -1) for none."""
    if halo < 0:
        return start_at(empty, axes, cell)
    return cell if int(empty[cell]) <= halo else _OUTSIDE


@kernel(STRICT)
def free_around(empty: NDArray[np.uint8], cell: Cell, way: Way) -> int:
    """How many cells around a cell no search begins in, and may be skipped."""
    return max(int(empty[cell]) - max(way.halo, 0) - 1, 0)


@kernel(STRICT)
def stride(empty: NDArray[np.uint8], axes: Axes, cell: Cell, t: float, way: Way) -> tuple[float, Cell]:
    """The next even step of a ray whose step from t on leads beyond what is free around its cell."""
    skip = free_around(empty, cell, way)
    steps = np.floor((t - way.first) / way.uniform + 0.5) + 1.0
    if skip > 0:
        steps = max(steps, np.floor((advance(axes, cell, skip)[0] - way.first) / way.uniform))
    t = way.first + steps * way.uniform
    return t, cell_at(axes, t)


@kernel(STRICT)
def walk(empty: NDArray[np.uint8], axes: Axes, cell: Cell, t: float, way: Way) -> tuple[float, Cell, Cell, int]:
    """On from a cell to the first that a search begins in: t, the cell, where it begins, and how many were visited.

    The cell is (-1, -1, -1) when the ray leaves the lattice. Exact and even steps have a loop each.
    """
    visited, begin = 0, _OUTSIDE
    while way.uniform == 0.0 and inside(cell, empty.shape) and t <= way.leave:
        visited += 1
        begin = begins_in(empty, axes, cell, way.halo)
        if begin[0] >= 0:
            return t, cell, begin, visited
        t, cell = advance(axes, cell, free_around(empty, cell, way))
    while way.uniform > 0.0 and inside(cell, empty.shape) and t <= way.leave:
        visited += 1
        begin = begins_in(empty, axes, cell, way.halo)
        if begin[0] >= 0:
            return t, cell, begin, visited
        t, cell = stride(empty, axes, cell, t, way)
    return t, _OUTSIDE, _OUTSIDE, visited


@kernel(STRICT)
def leaving(cells: Cells, plan: Plan, axes: Axes, o: Vector, d: Vector, work: Array, fit: Array) -> Leave:
    """How a ray that starts in the lattice leaves its origin."""
    cell = cell_at(axes, 0.0)
    if surfels_near(cells.sites, cell).size == 0:
        return Leave(0.0, _NOT_ASKED, nan)
    centre = centre_of(cells.sites, cell)
    x = (o[0] - centre[0], o[1] - centre[1], o[2] - centre[2])
    return leave(surfels_near(cells.sites, cell), x, o, d, plan, 0.0, work, fit)


@kernel(STRICT)
def start_of(cells: Cells, axes: Axes, cell: Cell, begin: Cell, o: Vector, d: Vector, t: float, way: Way,
             trust: float, before: float, number: int) -> Start:
    """Where the search of a cell begins, which the ray is in from t on.

    way: the ray's through the lattice; trust: how far a search may go; before: f at the end of the
    stretch before.
    """
    centre = centre_of(cells.sites, begin)
    base = along((o[0] - centre[0], o[1] - centre[1], o[2] - centre[2]), d, t)
    if cells.stretches == 0:
        return Start(begin, base, t, 0.0, max(way.least - t, -trust), trust, nan, number)
    end = advance(axes, cell, 0)[0]
    high = max(end - t, 0.0) if end < way.leave else way.leave - t + _RIM
    before_it = _RIM if t == way.first and way.uniform == 0.0 else 0.0
    return Start(begin, base, t, 0.0, min(max(way.least - t, -before_it), high), high, before, number)


@kernel(STRICT)
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


@kernel(STRICT)
def trace_ray(cells: Cells, plan: Plan, o: Vector, d: Vector, rows: Array, work: Array, fit: Array) -> RayEnd:
    """The first hit of a ray, or how its last start ended.

    o, d: origin and unit direction, in cells; rows: (L, LOG_WIDTH) log of every step, L = 0 for none.
    """
    if is_bad(o, d):
        return no_hit(r.BAD_RAY)
    shape = cells.empty.shape
    axes = axes_of(o, d, shape)
    t, last = clip(axes)
    visited, number, before = 0, 0, nan
    cell = cell_at(axes, t) if t <= last else _OUTSIDE
    end, inner = no_hit(r.BACKGROUND), t == 0.0
    flat = least_of_energies(plan) if inner else 0.0
    way = Way(cells.halo if cells.stretches == 1 else -1, cells.uniform, t, last, flat)
    while inside(cell, shape):
        at, cell, begin, more = walk(cells.empty, axes, cell, t, way)
        visited += more
        if begin[0] < 0:
            break
        before = before if more == 1 and way.uniform == 0.0 else nan
        start = start_of(cells, axes, cell, begin, o, d, at, way, plan.how.trust, before, number)
        end, before = search_cell(cells, plan, start, d, rows, end, work, fit)
        number += 1
        if inner and has_hit(end.state) and end.t < FARTHEST * plan.rule.h:  # perhaps it is the ray's own origin
            found, inner = leaving(cells, plan, axes, o, d, work, fit), False
            end = counting(end, found)
            if end.t < found.t:
                end, before, t, visited = behind(end, rows), nan, at, visited - 1
                way = Way(way.halo, way.uniform, way.first, way.leave, found.t)
                continue
        if has_hit(end.state):
            break
        if way.uniform == 0.0:
            t, cell = advance(axes, cell, free_around(cells.empty, cell, way))
        else:
            t, cell = stride(cells.empty, axes, cell, at, way)
        if not t < last:
            break
    return visiting(end, visited)


@kernel(STRICT)
def write_end(out: Out, to: int, end: RayEnd) -> None:
    """Write a ray's end into its row of the columns."""
    out.status[to], out.t[to] = end.state, end.t
    for axis in range(3):
        out.point[to, axis], out.normal[to, axis] = end.point[axis], end.n[axis]
    out.energy[to], out.off_centre[to] = abs(end.energy), end.off
    out.iterations[to], out.evaluations[to] = end.iterations, end.evaluations
    out.neighbours[to], out.cells[to], out.lowered[to] = end.used, end.cells, end.lowered
    out.gap[to] = end.gap


@kernel(STRICT, entry=True)
def trace_rays(cells: Cells, plan: Plan, origins: Array, directions: Array, pixels: NDArray[np.int64], out: Out,
               rows: Array, work: Array, fit: Array) -> tuple[int, int]:
    """Trace some of the rays and write each into its row of the columns; returns how many of them, before one for which
    the pool was short, and the rows of the log it wrote.

    origins, directions: (R, 3) in cells, directions of unit length; pixels: rows to trace; rows: the log of a
    single ray, (0, LOG_WIDTH) for none; work, fit: scratch of this call alone.
    """
    cells, log = unowned_cells(cells), unowned(rows)
    scratch, fitted, written = unowned(work), unowned(fit), 0
    for i in range(pixels.shape[0]):
        to = pixels[i]
        o = (origins[to, 0], origins[to, 1], origins[to, 2])
        d = (directions[to, 0], directions[to, 1], directions[to, 2])
        end = trace_ray(cells, plan, o, d, log, scratch, fitted)
        if is_short(cells.sites.pool):
            return i, 0
        write_end(out, to, end)
        written = end.rows
    return pixels.shape[0], written
