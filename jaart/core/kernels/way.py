"""How one ray goes through the cells, from one that a search begins in to the next."""

from __future__ import annotations

from math import floor
from typing import NamedTuple

from jaart.core.kernels.empty_space import away
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Cell, Cells, Empty, Vector
from jaart.core.kernels.traversal import Axes, face_below, holds, onward, spot_at, start_at, whole

#: No cell.
OUTSIDE = (-1, -1, -1)


class Way(NamedTuple):
    """How a ray goes through the cells.

    free: cells farther than this from one with a surfel are skipped; touching: whether the ray runs within a face, so
    that it touches two cells at once and a search may begin in the other; uniform: length of even steps, 0 for exact
    ones; first, leave: t where the ray enters and leaves the lattice; least: t from which hits count.
    """

    free: int
    touching: bool
    uniform: float
    first: float
    leave: float
    least: float


@kernel(STRICT, inline=True)
def free_of(cells: Cells) -> int:
    """A search begins in cells no farther than this from one with a surfel."""
    return cells.halo if cells.stretches == 1 else 0


@kernel(STRICT, inline=True)
def way_of(cells: Cells, axes: Axes, enter: float, leave: float, least: float) -> Way:
    """How a ray goes through a lattice that it enters and leaves at some t."""
    touching = face_below(axes[0]) + face_below(axes[1]) + face_below(axes[2]) > 0
    return Way(free_of(cells), touching and cells.stretches == 0, cells.uniform, enter, leave, least)


@kernel(STRICT, inline=True)
def distance(empty: Empty, spot: Vector) -> int:
    """Distance of a cell from the nearest one with a surfel."""
    return away(empty, whole(spot))


@kernel(STRICT, inline=True)
def begins_in(empty: Empty, axes: Axes, spot: Vector, away: int, way: Way) -> Cell:
    """The cell that a search begins in while the ray is in a cell: it, one beside it, or (-1, -1, -1) for none.

    away: its distance from the nearest cell with a surfel.
    """
    if away <= way.free:
        return whole(spot)
    return start_at(empty, axes, whole(spot)) if way.touching and away == 1 else OUTSIDE


@kernel(STRICT, inline=True)
def skip(away: int, way: Way) -> float:
    """How many cells around a cell no search begins in, and may be skipped."""
    return float(max(away - way.free - 1, 0))


@kernel(STRICT)
def stride(axes: Axes, spot: Vector, t: float, reach: float, way: Way) -> tuple[float, Vector]:
    """The next even step of a ray whose step from t on leads beyond what is free around its cell."""
    steps = floor((t - way.first) / way.uniform + 0.5) + 1.0
    if reach > 0.0:
        steps = max(steps, floor((onward(axes, spot, reach)[0] - way.first) / way.uniform))
    t = way.first + steps * way.uniform
    return t, spot_at(axes, t)


@kernel(STRICT, inline=True)
def after(axes: Axes, spot: Vector, t: float, away: int, way: Way) -> tuple[float, Vector]:
    """Where a ray goes on from a cell: t, and the next cell."""
    if way.uniform > 0.0:
        return stride(axes, spot, t, skip(away, way), way)
    return onward(axes, spot, skip(away, way))


@kernel(STRICT, inline=True)
def walk(empty: Empty, axes: Axes, spot: Vector, t: float, way: Way) -> tuple[float, Vector, Cell, int]:
    """On from a cell to the first that a search begins in: t, the cell, where it begins, and how many were visited.

    It begins in (-1, -1, -1) when the ray leaves the lattice.
    """
    visited = 0
    while holds(axes, spot) and t <= way.leave:
        visited += 1
        away = distance(empty, spot)
        begin = begins_in(empty, axes, spot, away, way)
        if begin[0] >= 0:
            return t, spot, begin, visited
        t, spot = after(axes, spot, t, away, way)
    return t, spot, OUTSIDE, visited
