"""The iteration of Adamson & Alexa from one start: intersect the ray with the plane at x, again and again.

x_{i+1} = ray ∩ H(x_i), a step of e_ts(x_i) along the ray [T 2.20], until the step is short [T 2.14].
The ray is based anew at each start and points are relative to their cell's centre, so that nothing far
from the origin is ever subtracted.
"""

from __future__ import annotations

from math import floor, inf, log, nan, sqrt

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.records import Array, Cell, Cells, Search, Vector
from jaart.core.kernels.tangent import tangent

#: A ray whose angle with the plane has a smaller sine runs along it.
_PARALLEL = 1e-12
#: The lattice's outer faces belong to it; points this many cells beyond them are there but for rounding.
_SLACK = 1e-9
#: Four units in the last place of 1.
_ROUNDING = 8.9e-16

#: (state, t, point, normal, last step, off-centre value, steps, surfels used)
End = tuple[int, float, Vector, Vector, float, float, int, int]


@kernel(STRICT)
def dot(a: Vector, b: Vector) -> float:
    """<a, b>."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel(STRICT)
def along(base: Vector, d: Vector, s: float) -> Vector:
    """base + s·d."""
    return base[0] + s * d[0], base[1] + s * d[1], base[2] + s * d[2]


@kernel(STRICT)
def cell_of(start: Cell, x: Vector) -> Cell:
    """The cell that holds a point given relative to the centre of another cell."""
    return (start[0] + int(floor(x[0] + 0.5)), start[1] + int(floor(x[1] + 0.5)),
            start[2] + int(floor(x[2] + 0.5)))


@kernel(STRICT)
def in_reach(x: float, n: int) -> bool:
    """Whether a coordinate lies within a lattice of n cells."""
    return -_SLACK <= x <= n + _SLACK


@kernel(STRICT)
def held(cell: Cell, x: Vector, shape: Cell) -> tuple[Cell, bool]:
    """The lattice's cell for a point in or on it, and whether it is; x in the lattice's coordinates."""
    i, j, k = cell
    inside = in_reach(x[0], shape[0]) and in_reach(x[1], shape[1]) and in_reach(x[2], shape[2])
    return (min(max(i, 0), shape[0] - 1), min(max(j, 0), shape[1] - 1), min(max(k, 0), shape[2] - 1)), inside


@kernel(STRICT)
def recentred(x: Vector, start: Cell, cell: Cell) -> Vector:
    """A point given relative to one cell's centre, relative to another's."""
    return x[0] - (cell[0] - start[0]), x[1] - (cell[1] - start[1]), x[2] - (cell[2] - start[2])


@kernel(STRICT)
def in_lattice(cell: Cell, x: Vector) -> Vector:
    """A point given relative to a cell's centre, in the lattice's coordinates."""
    return cell[0] + 0.5 + x[0], cell[1] + 0.5 + x[1], cell[2] + 0.5 + x[2]


@kernel(STRICT)
def write_step(rows: Array, row: int, start: int, t: float, cell: Cell, x: Vector, n: Vector, off: Vector,
               step: float, log_weight: float) -> None:
    """Write one step into the log where it has room; points in the lattice's coordinates."""
    if row >= rows.shape[0]:
        return
    to = rows[row]
    to[r.START], to[r.T], to[r.STEP], to[r.WEIGHT], to[r.END] = start, t, step, log_weight, r.CONTINUE
    to[r.X], to[r.Y], to[r.Z] = in_lattice(cell, x)
    to[r.AX], to[r.AY], to[r.AZ] = in_lattice(cell, along(x, off, 1.0))
    to[r.NX], to[r.NY], to[r.NZ] = n
    to[r.CELL_I], to[r.CELL_J], to[r.CELL_K] = cell
    to[r.OFF] = sqrt(dot(off, off))


@kernel(STRICT)
def state_after(search: Search, s: float, t: float, step: float, slope: float, off: float, inside: bool) -> int:
    """The state after a step that led to s from the start (t from the origin): CONTINUE or an end.

    A step no longer than the rounding of f at the local coordinates, seen along the ray, says nothing.
    """
    if not (inside and abs(s) <= search.trust and t > 0.0):
        return r.LEFT_TRUST
    short = abs(step) < search.arrived
    if not short and abs(step * slope) > _ROUNDING * (abs(s) + search.h + 1.0):
        return r.CONTINUE
    if off > search.max_off_centre:
        return r.BOUNDED
    return r.CONVERGED if short else r.FLOOR


@kernel(STRICT, inline=True)
def iterate(cells: Cells, search: Search, o: Vector, d: Vector, start: Cell, t_start: float, number: int,
            rows: Array, row: int) -> End:
    """Search the surface from the ray's point at t_start in a cell [A §4].

    o, d: origin and unit direction; number: of this start on the ray; rows: (L, LOG_WIDTH) log,
    L = 0 for none; row: where to write next. The point and normal are NaN unless the state is a hit.
    """
    base = along((o[0] - (start[0] + 0.5), o[1] - (start[1] + 0.5), o[2] - (start[2] + 0.5)), d, t_start)
    nothing = (nan, nan, nan)
    state, s, step, off_centre, used, f_before = r.CAP, 0.0, nan, nan, 0, inf
    cell, x, n = start, base, nothing
    for done in range(search.cap):
        near = surfels_near(cells, cell)
        if near.size == 0:
            return r.FEW_NEIGHBOURS, nan, nothing, nothing, step, off_centre, done, used
        state, f, n, off, weight, shift = tangent(near, x, search.h)
        used += int(near.size)
        slope, off_centre = dot(n, d), sqrt(dot(off, off))
        step = f / slope
        if rows.shape[0] > 0:
            write_step(rows, row + done, number, t_start + s, cell, x, n, off, step, shift + log(weight))
        if state == r.CONTINUE and abs(slope) < _PARALLEL:
            state = r.PARALLEL
        if state == r.CONTINUE and search.growth == 1 and abs(f) > f_before:
            state = r.CAP
        if state == r.CONTINUE:
            s, f_before = s + step, abs(f)
            x = along(base, d, s)
            cell, inside = held(cell_of(start, x), in_lattice(start, x), cells.empty.shape)
            state = state_after(search, s, t_start + s, step, slope, off_centre, inside)
        if state == r.CONVERGED or state == r.FLOOR:
            return state, t_start + s, in_lattice(start, x), n, step, off_centre, done + 1, used
        if state != r.CONTINUE:
            return state, nan, nothing, nothing, step, off_centre, done + 1, used
        x = recentred(x, start, cell)
    return r.CAP, nan, nothing, nothing, step, off_centre, search.cap, used
