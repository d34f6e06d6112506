"""Which cells a ray crosses, by integer stepping [T §3.1.4].

Along an axis a cell is left when t reaches the plane of its far face; that plane's t is computed from
the integer index, never accumulated, so a ray cannot loop and every test of an order agrees with every other.
"""

from __future__ import annotations

from math import floor, inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Cell, Vector

#: A smaller component of a unit direction moves nothing within a lattice.
_STILL = 1e-290


class Axis(NamedTuple):
    """A ray along one axis, x = o + t·d: per_d = 1/d; way is 1, -1, or 0 for no motion; n cells."""

    o: float
    d: float
    per_d: float
    way: int
    n: int


Axes = tuple[Axis, Axis, Axis]


@kernel(STRICT)
def axis_of(o: float, d: float, n: int) -> Axis:
    """One axis of a ray with an origin and a unit direction."""
    if abs(d) <= _STILL:
        return Axis(o, 0.0, inf, 0, n)
    return Axis(o, d, 1.0 / d, 1 if d > 0.0 else -1, n)


@kernel(STRICT)
def axes_of(o: Vector, d: Vector, shape: Cell) -> Axes:
    """The three axes of a ray through a lattice."""
    return axis_of(o[0], d[0], shape[0]), axis_of(o[1], d[1], shape[1]), axis_of(o[2], d[2], shape[2])


@kernel(STRICT)
def plane_t(axis: Axis, plane: float) -> float:
    """The t at which a ray passes a plane of an axis that it moves along."""
    return (plane - axis.o) * axis.per_d


@kernel(STRICT)
def slab(axis: Axis) -> tuple[float, float]:
    """Where a ray enters and leaves 0 <= x <= n along one axis; (inf, -inf) when it never does."""
    if axis.way == 0:
        return (-inf, inf) if 0.0 <= axis.o <= axis.n else (inf, -inf)
    a, b = plane_t(axis, 0.0), plane_t(axis, float(axis.n))
    return (a, b) if axis.way > 0 else (b, a)


@kernel(STRICT)
def clip(axes: Axes) -> tuple[float, float]:
    """Where a ray enters and leaves the lattice, from its origin on; enters > leaves: never."""
    ax, bx = slab(axes[0])
    ay, by = slab(axes[1])
    az, bz = slab(axes[2])
    return max(max(ax, ay), max(az, 0.0)), min(bx, min(by, bz))


@kernel(STRICT)
def index_at(axis: Axis, t: float) -> int:
    """Index of the cell along an axis at t; on a face it is the cell that the ray runs into.

    The rounded guess is put right by the same t of planes that stepping uses.
    """
    i = int(floor(min(max(axis.o + t * axis.d, 0.0), axis.n - 1.0)))
    if axis.way > 0:
        while i < axis.n - 1 and plane_t(axis, i + 1.0) <= t:
            i += 1
        while i > 0 and plane_t(axis, float(i)) > t:
            i -= 1
    elif axis.way < 0:
        while i > 0 and plane_t(axis, float(i)) <= t:
            i -= 1
        while i < axis.n - 1 and plane_t(axis, i + 1.0) > t:
            i += 1
    return i


@kernel(STRICT)
def cell_at(axes: Axes, t: float) -> Cell:
    """The cell that a ray runs into at t."""
    return index_at(axes[0], t), index_at(axes[1], t), index_at(axes[2], t)


@kernel(STRICT)
def exit_t(axis: Axis, i: int, reach: int) -> float:
    """The t at which a ray leaves the cells i - reach … i + reach of an axis."""
    if axis.way == 0:
        return inf
    return plane_t(axis, i + reach + 1.0 if axis.way > 0 else float(i - reach))


@kernel(STRICT)
def index_after(axis: Axis, i: int, reach: int, own: float, t: float) -> int:
    """The index after leaving a block at t: over the far face where own == t, else where the ray is."""
    if own == t:
        return i + axis.way * (reach + 1)
    return i if reach == 0 or axis.way == 0 else index_at(axis, t)


@kernel(STRICT)
def advance(axes: Axes, cell: Cell, reach: int) -> tuple[float, Cell]:
    """(t, next cell) where a ray leaves the block of cells within reach of a cell.

    Through an edge or a corner two or three indices change at once. The next cell may lie outside.
    """
    i, j, k = cell
    tx, ty, tz = exit_t(axes[0], i, reach), exit_t(axes[1], j, reach), exit_t(axes[2], k, reach)
    t = min(tx, min(ty, tz))
    return t, (index_after(axes[0], i, reach, tx, t), index_after(axes[1], j, reach, ty, t),
               index_after(axes[2], k, reach, tz, t))


@kernel(STRICT)
def inside(cell: Cell, shape: Cell) -> bool:
    """Whether a cell belongs to the lattice."""
    return 0 <= cell[0] < shape[0] and 0 <= cell[1] < shape[1] and 0 <= cell[2] < shape[2]


@kernel(STRICT, entry=True)
def crossed(o: Array, d: Array, shape: Cell, cells: NDArray[np.int32], borders: Array) -> int:
    """Write every cell that a ray crosses, and the t where it crosses into each; returns their number.

    o, d: (3,) origin and unit direction; cells: (nx + ny + nz + 3, 3) and borders, one longer, are
    written in place; borders ends with the t where the ray leaves the lattice.
    """
    axes = axes_of((o[0], o[1], o[2]), (d[0], d[1], d[2]), shape)
    t, leave = clip(axes)
    if not t <= leave:
        return 0
    cell, n = cell_at(axes, t), 0
    one_cell: Any = np.int64(0)
    borders[0] = t
    while inside(cell, shape) and n < cells.shape[0]:
        cells[n, 0], cells[n, 1], cells[n, 2] = cell
        t, cell = advance(axes, cell, one_cell)
        n += 1
        borders[n] = t
    return n


@kernel(STRICT)
def face_below(axis: Axis) -> int:
    """1 when a ray runs within the face between a cell and the one below it, else 0."""
    return 1 if axis.way == 0 and 0.0 < axis.o < axis.n and axis.o == floor(axis.o) else 0


@kernel(STRICT)
def start_at(empty: NDArray[np.uint8], axes: Axes, cell: Cell) -> Cell:
    """The cell with a surfel that a ray touches while it is in a cell; (-1, -1, -1) for none.

    A ray within a face, an edge or through corners along an axis touches two or four cells at once.
    """
    if empty[cell] == 0:
        return cell
    if empty[cell] == 1:
        for i in range(face_below(axes[0]) + 1):
            for j in range(face_below(axes[1]) + 1):
                for k in range(face_below(axes[2]) + 1):
                    touched = (max(cell[0] - i, 0), max(cell[1] - j, 0), max(cell[2] - k, 0))
                    if empty[touched] == 0:
                        return touched
    return -1, -1, -1
