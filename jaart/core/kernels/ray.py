"""A ray through a lattice: empty cells skipped, the search begun cell after cell, the first hit its end."""

from __future__ import annotations

from math import isfinite, nan, sqrt

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import records as r
from jaart.core.kernels.call import search_from
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.log import end_log
from jaart.core.kernels.place import centre_of
from jaart.core.kernels.records import Array, Cell, Cells, End, Out, Plan, RayEnd, Start, Vector
from jaart.core.kernels.traversal import Axes, advance, axes_of, cell_at, clip, inside, start_at
from jaart.core.kernels.unowned import unowned, unowned_cells
from jaart.core.kernels.vectors import along

#: From farther away one unit in the last place of the origin is wider than a cell.
_FAR = 1e15
_NOTHING = (nan, nan, nan)


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
    """A ray's end after one more start. A stretch without any surface leaves the state as it was."""
    state = before.state if end.state == r.BACKGROUND else end.state
    return RayEnd(state, end.t, end.point, end.n, end.energy, end.off, end.steps,
                  before.evaluations + end.evaluations, before.used + end.used, before.cells,
                  before.lowered + end.lowered, end.gap, before.rows + end.steps, before.missing)


@kernel(STRICT)
def visiting(end: RayEnd, cells: int) -> RayEnd:
    """A ray's end with so many cells or balls visited."""
    return RayEnd(end.state, end.t, end.point, end.n, end.energy, end.off, end.iterations, end.evaluations, end.used,
                  cells, end.lowered, end.gap, end.rows, end.missing)


@kernel(STRICT)
def has_hit(state: int) -> bool:
    """Whether a state is a hit."""
    return state == r.CONVERGED or state == r.FLOOR


@kernel(STRICT)
def next_cell(cells: Cells, axes: Axes, cell: Cell, t: float, first_t: float, skip: int) -> tuple[float, Cell]:
    """Where a ray goes on after a cell, and the skipped ones around it; by even steps when so asked."""
    t_exit, ahead = advance(axes, cell, skip)
    if cells.uniform == 0.0:
        return t_exit, ahead
    steps = np.floor((t - first_t) / cells.uniform + 0.5) + 1.0
    if skip > 0:
        steps = max(steps, np.floor((t_exit - first_t) / cells.uniform))
    t = first_t + steps * cells.uniform
    return t, cell_at(axes, t)


@kernel(STRICT)
def start_of(cells: Cells, axes: Axes, cell: Cell, o: Vector, d: Vector, t: float, leave: float, trust: float,
             before: float, number: int) -> tuple[bool, Start]:
    """Whether a search begins in a cell that the ray is in from t on, and from where.

    leave: t where the ray leaves the lattice; trust: how far a search may go; before: f at the end of the
    stretch before.
    """
    if cells.stretches == 1:
        begin = cell
        found = int(cells.empty[cell]) <= cells.halo
        high = min(advance(axes, cell, 0)[0], leave) - t
        low, high = 0.0, max(high, 0.0)
    else:
        begin = start_at(cells.empty, axes, cell)
        found = begin[0] >= 0
        low, high, before = -trust, trust, nan
    centre = centre_of(cells.sites, begin)
    base = along((o[0] - centre[0], o[1] - centre[1], o[2] - centre[2]), d, t)
    return found, Start(begin, base, t, 0.0, low, high, before, number)


@kernel(STRICT)
def trace_ray(cells: Cells, plan: Plan, o: Vector, d: Vector, rows: Array, work: Array, fit: Array) -> RayEnd:
    """The first hit of a ray, or how its last start ended.

    o, d: origin and unit direction, in cells; rows: (L, LOG_WIDTH) log of every step, L = 0 for none.
    """
    if is_bad(o, d):
        return no_hit(r.BAD_RAY)
    shape = cells.empty.shape
    axes = axes_of(o, d, shape)
    t, leave = clip(axes)
    end, visited, number, before = no_hit(r.BACKGROUND), 0, 0, nan
    first_t = t
    cell = cell_at(axes, t) if t <= leave else (-1, -1, -1)
    while inside(cell, shape):
        visited += 1
        found, start = start_of(cells, axes, cell, o, d, t, leave, plan.how.trust, before, number)
        before = nan
        if found:
            one = search_from(plan.search, cells.sites, plan.rule, plan.how, plan.bounds, d, start, rows, end.rows,
                              work, fit)
            number, before = number + 1, one.f
            if one.steps > 0 or one.state != r.BACKGROUND:
                end = added(end, one)
                end_log(rows, end.rows if one.steps > 0 else 0, one.state)
            if has_hit(one.state):
                break
        free = int(cells.empty[cell]) - (cells.halo if cells.stretches == 1 else 0)
        t, cell = next_cell(cells, axes, cell, t, first_t, max(free - 1, 0))
        if not t < leave:  # a skipped block may reach past the lattice
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
               rows: Array, work: Array, fit: Array) -> int:
    """Trace some of the rays and write each into its row of the columns; returns the rows of the log it wrote.

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
        write_end(out, to, end)
        written = end.rows
    return written
