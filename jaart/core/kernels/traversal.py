"""Which cells a ray crosses, by integer stepping [T §3.1.4].

Along an axis a cell is left when t reaches the plane of its far face; that plane's t is computed from
the integer index, never accumulated, so a ray cannot loop and every test of an order agrees with every other.
"""

from __future__ import annotations

from math import floor, inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.empty_space import away
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Cell, Empty, Vector

#: A smaller component of a unit direction moves nothing within a lattice.
STILL = 1e-290


class Axis(NamedTuple):
    """A ray along one axis, x = o + t·d: per_d = 1/d; way is 1, -1, or 0 for no motion.

    ahead: 1 where the face that a cell is left through is its upper one, else 0; last: the last cell's index. Indices
    are whole floats here: they are only ever compared with t's.
    """

    o: float
    d: float
    per_d: float
    way: float
    ahead: float
    last: float


Axes = tuple[Axis, Axis, Axis]


@kernel(STRICT, inline=True)
def axis_of(o: float, d: float, n: float) -> Axis:
    """One axis of a ray with an origin and a unit direction."""
    still = abs(d) <= STILL
    way = 0.0 if still else (1.0 if d > 0.0 else -1.0)
    return Axis(o, 0.0 if still else d, inf if still else 1.0 / d, way, 1.0 if way > 0.0 else 0.0, n - 1.0)


@kernel(STRICT, inline=True)
def axes_of(o: Vector, d: Vector, shape: Cell) -> Axes:
    """The three axes of a ray through a lattice."""
    return axis_of(o[0], d[0], shape[0]), axis_of(o[1], d[1], shape[1]), axis_of(o[2], d[2], shape[2])


@kernel(STRICT, inline=True)
def plane_t(axis: Axis, plane: float) -> float:
    """The t at which a ray passes a plane of an axis that it moves along."""
    return (plane - axis.o) * axis.per_d


@kernel(STRICT, inline=True)
def slab(axis: Axis) -> tuple[float, float]:
    """Where a ray enters and leaves 0 <= x <= n along one axis; (inf, -inf) when it never does."""
    still, inside = axis.way == 0.0, 0.0 <= axis.o <= axis.last + 1.0
    a, b = plane_t(axis, 0.0), plane_t(axis, axis.last + 1.0)
    low, high = (a, b) if axis.way > 0.0 else (b, a)
    return ((-inf if inside else inf) if still else low), ((inf if inside else -inf) if still else high)


@kernel(STRICT, inline=True)
def clip(axes: Axes) -> tuple[float, float]:
    """Where a ray enters and leaves the lattice, from its origin on; enters > leaves: never."""
    ax, bx = slab(axes[0])
    ay, by = slab(axes[1])
    az, bz = slab(axes[2])
    return max(max(ax, ay), max(az, 0.0)), min(bx, min(by, bz))


@kernel(STRICT, inline=True)
def index_at(axis: Axis, t: float) -> float:
    """Index of the cell along an axis at t; on a face it is the cell that the ray runs into.

    The rounded guess, off by one at most, is put right by the same t of planes that stepping uses.
    """
    i: float = np.floor(min(max(axis.o + t * axis.d, 0.0), axis.last))
    end = axis.ahead * axis.last
    on = axis.way != 0.0 and i != end and plane_t(axis, i + axis.ahead) <= t
    back = axis.way != 0.0 and i != axis.last - end and plane_t(axis, i + 1.0 - axis.ahead) > t
    return i + (axis.way if on else (-axis.way if back else 0.0))


@kernel(STRICT, inline=True)
def spot_at(axes: Axes, t: float) -> Vector:
    """The cell, its indices as floats, that a ray runs into at t."""
    return index_at(axes[0], t), index_at(axes[1], t), index_at(axes[2], t)


@kernel(STRICT, inline=True)
def whole(spot: Vector) -> Cell:
    """A cell from its indices as floats."""
    return int(spot[0]), int(spot[1]), int(spot[2])


@kernel(STRICT)
def cell_at(axes: Axes, t: float) -> Cell:
    """The cell that a ray runs into at t."""
    return whole(spot_at(axes, t))


@kernel(STRICT, inline=True)
def exit_t(axis: Axis, i: float, reach: float) -> float:
    """The t at which a ray leaves the cells i - reach … i + reach of an axis."""
    t = plane_t(axis, i + axis.way * reach + axis.ahead)
    return inf if axis.way == 0.0 else t


@kernel(STRICT, inline=True)
def index_after(axis: Axis, i: float, reach: float, own: float, t: float) -> float:
    """The index after leaving a block at t: over the far face where own == t, else where the ray is."""
    if own == t:
        return i + axis.way * (reach + 1.0)
    return i if reach == 0.0 else index_at(axis, t)


@kernel(STRICT, inline=True)
def onward(axes: Axes, spot: Vector, reach: float) -> tuple[float, Vector]:
    """(t, next cell) where a ray leaves the block of cells within reach of a cell; indices as floats.

    Through an edge or a corner two or three indices change at once. The next cell may lie outside.
    """
    i, j, k = spot
    tx, ty, tz = exit_t(axes[0], i, reach), exit_t(axes[1], j, reach), exit_t(axes[2], k, reach)
    t = min(tx, min(ty, tz))
    return t, (index_after(axes[0], i, reach, tx, t), index_after(axes[1], j, reach, ty, t),
               index_after(axes[2], k, reach, tz, t))


@kernel(STRICT)
def advance(axes: Axes, cell: Cell, reach: int) -> tuple[float, Cell]:
    """(t, next cell) where a ray leaves the block of cells within reach of a cell, as `onward`."""
    t, spot = onward(axes, (float(cell[0]), float(cell[1]), float(cell[2])), float(reach))
    return t, whole(spot)


@kernel(STRICT, inline=True)
def holds(axes: Axes, spot: Vector) -> bool:
    """Whether a cell, its indices as floats, belongs to the lattice."""
    return (0.0 <= spot[0] <= axes[0].last and 0.0 <= spot[1] <= axes[1].last and 0.0 <= spot[2] <= axes[2].last)


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
    return 1 if axis.way == 0.0 and 0.0 < axis.o <= axis.last and axis.o == floor(axis.o) else 0


@kernel(STRICT)
def start_at(empty: Empty, axes: Axes, cell: Cell) -> Cell:
    """The cell with a surfel that a ray touches while it is in a cell; (-1, -1, -1) for none.

    A ray within a face, an edge or through corners along an axis touches two or four cells at once.
    """
    if away(empty, cell) == 0:
        return cell
    if away(empty, cell) == 1:
        for i in range(face_below(axes[0]) + 1):
            for j in range(face_below(axes[1]) + 1):
                for k in range(face_below(axes[2]) + 1):
                    touched = (max(cell[0] - i, 0), max(cell[1] - j, 0), max(cell[2] - k, 0))
                    if away(empty, touched) == 0:
                        return touched
    return -1, -1, -1
