"""A ray through a lattice: empty cells skipped, every cell with a surfel a start, the first hit its end."""

from __future__ import annotations

from math import isfinite, nan, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import records as r
from jaart.core.kernels.iterate import iterate
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Cells, Out, RayEnd, Search, Vector
from jaart.core.kernels.traversal import advance, axes_of, cell_at, clip, inside, start_at
from jaart.core.kernels.unowned import unowned, unowned_cells

#: From farther away one unit in the last place of the origin is wider than a cell.
_FAR = 1e15


@kernel(STRICT)
def is_bad(o: Vector, d: Vector) -> bool:
    """Whether a ray has no meaning: not finite, no unit direction, or an origin beyond all precision."""
    for axis in range(3):
        if not (isfinite(d[axis]) and abs(o[axis]) < _FAR):
            return True
    return abs(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - 1.0) > 1e-6


@kernel(STRICT)
def end_log(rows: Array, row: int, state: int) -> None:
    """Write the end of a start into the row of its last step."""
    if row <= rows.shape[0]:
        rows[row - 1, r.END] = state


@kernel(STRICT)
def trace_ray(cells: Cells, search: Search, o: Vector, d: Vector, rows: Array) -> RayEnd:
    """The first hit of a ray, or how its last start ended.

    o, d: origin and unit direction, in cells; rows: (L, LOG_WIDTH) log of every step, L = 0 for none.
    """
    nothing = (nan, nan, nan)
    if is_bad(o, d):
        return r.BAD_RAY, nan, nothing, nothing, nan, nan, 0, 0, 0, 0
    shape = cells.empty.shape
    axes = axes_of(o, d, shape)
    t, leave = clip(axes)
    if not t <= leave:
        return r.BACKGROUND, nan, nothing, nothing, nan, nan, 0, 0, 0, 0
    state, step, off, visited = r.BACKGROUND, nan, nan, 0
    none: Any = np.int64(0)  # no literal, for which the callees would be compiled once more
    iterations = evaluations = used = starts = none
    cell = cell_at(axes, t)
    while inside(cell, shape):
        visited += 1
        start = start_at(cells.empty, axes, cell)
        if start[0] >= 0:
            state, t_hit, point, n, step, off, iterations, touched = iterate(
                cells, search, o, d, start, t, starts, rows, evaluations)
            evaluations, used, starts = evaluations + iterations, used + touched, starts + 1
            if iterations > 0:
                end_log(rows, evaluations, state)
            if state == r.CONVERGED or state == r.FLOOR:
                return state, t_hit, point, n, step, off, iterations, evaluations, used, visited
        t, cell = advance(axes, cell, max(int(cells.empty[cell]) - 1, 0))
        if not t < leave:  # a skipped block may reach past the lattice
            break
    return state, nan, nothing, nothing, step, off, iterations, evaluations, used, visited


@kernel(STRICT)
def trace_rays(cells: Cells, search: Search, origins: Array, directions: Array, pixels: NDArray[np.int64],
               out: Out) -> None:
    """Trace some of the rays and write each into its row of the columns.

    origins, directions: (R, 3) in cells, directions of unit length; pixels: rows to trace.
    """
    cells, no_log = unowned_cells(cells), unowned(np.empty((0, r.LOG_WIDTH)))
    for i in range(pixels.shape[0]):
        to = pixels[i]
        o = (origins[to, 0], origins[to, 1], origins[to, 2])
        d = (directions[to, 0], directions[to, 1], directions[to, 2])
        state, t, point, n, step, off, iterations, evaluations, used, visited = trace_ray(cells, search, o, d, no_log)
        out.status[to], out.t[to] = state, t
        for axis in range(3):
            out.point[to, axis], out.normal[to, axis] = point[axis], n[axis]
        out.energy[to], out.off_centre[to] = abs(step), off
        out.iterations[to], out.evaluations[to] = iterations, evaluations
        out.neighbours[to], out.cells[to] = used, visited
