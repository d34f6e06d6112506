"""Rays that walk through the cells together, up to the first cell that a search begins in.

Rays beside one another cross nearly the same cells. Side by side in columns of `LANES` their steps are done as vectors;
the functions are those of a ray alone, without branches, so that a ray's t does not hang on its company.
"""

from __future__ import annotations

from math import isfinite, sqrt

import numpy as np

from jaart.core.kernels.empty_space import away
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Empty, Unsigned, Vector
from jaart.core.kernels.traversal import Axes, Axis, axis_of, clip, onward, spot_at

#: Rays of a packet: a block of 8 × 8 pixels.
LANES: Unsigned = np.uint64(64)
#: Columns of a packet: what traversal.Axis says of each of three axes, then index, t and the rest.
_COLUMN = [np.uint64(64 * i) for i in range(25)]
ORIGIN, DIRECTION, PER_D, WAY, AHEAD, AT = _COLUMN[0], _COLUMN[3], _COLUMN[6], _COLUMN[9], _COLUMN[12], _COLUMN[15]
T, LEAVE, ENTER, STATE, VISITED, AWAY, BAD = (_COLUMN[18], _COLUMN[19], _COLUMN[20], _COLUMN[21], _COLUMN[22],
                                                     _COLUMN[23], _COLUMN[24])
#: Floats that a packet takes.
ROOM = 64 * 25
#: Added to the first column of three, the columns of the axes.
X, Y, Z = _COLUMN[0], _COLUMN[1], _COLUMN[2]
#: A ray walks, has found a cell to search in, or has left the lattice.
WALKING, FOUND, LEFT = 0.0, 1.0, 2.0
#: From farther away one unit in the last place of the origin is wider than a cell.
_FAR = 1e15
#: So many rays walk on together until none of them does: two vectors, one of which waits while the other works.
ABREAST: Unsigned = np.uint64(16)


@kernel(STRICT, inline=True)
def is_bad(o: Vector, d: Vector) -> bool:
    """Whether a ray has no meaning: not finite, no unit direction, or an origin beyond all precision."""
    for axis in range(3):
        if not (isfinite(d[axis]) and abs(o[axis]) < _FAR):
            return True
    return abs(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - 1.0) > 1e-6


@kernel(STRICT, inline=True)
def axis_in(p: Array, axis: Unsigned, lane: Unsigned, n: float) -> Axis:
    """One axis of a ray of the packet."""
    return Axis(p[ORIGIN + axis + lane], p[DIRECTION + axis + lane], p[PER_D + axis + lane], p[WAY + axis + lane],
                p[AHEAD + axis + lane], n - 1.0)


@kernel(STRICT, inline=True)
def axes_in(p: Array, lane: Unsigned, nx: float, ny: float, nz: float) -> Axes:
    """The three axes of a ray of the packet."""
    return axis_in(p, X, lane, nx), axis_in(p, Y, lane, ny), axis_in(p, Z, lane, nz)


@kernel(STRICT, inline=True)
def put_axis(p: Array, axis: Unsigned, lane: Unsigned, known: Axis) -> None:
    """Write what is known of one axis of a ray."""
    p[DIRECTION + axis + lane], p[PER_D + axis + lane] = known.d, known.per_d
    p[WAY + axis + lane], p[AHEAD + axis + lane] = known.way, known.ahead


@kernel(STRICT, inline=True)
def spot_in(p: Array, lane: Unsigned) -> Vector:
    """The cell that a ray of the packet has come to."""
    return p[AT + X + lane], p[AT + Y + lane], p[AT + Z + lane]


@kernel(STRICT)
def enter(p: Array, nx: float, ny: float, nz: float, count: Unsigned) -> None:
    """Put rays, whose ORIGIN, DIRECTION and T are written, where they enter the lattice, or at T where it is later."""
    for lane in range(count):
        x = axis_of(p[ORIGIN + X + lane], p[DIRECTION + X + lane], nx)
        y = axis_of(p[ORIGIN + Y + lane], p[DIRECTION + Y + lane], ny)
        z = axis_of(p[ORIGIN + Z + lane], p[DIRECTION + Z + lane], nz)
        put_axis(p, X, lane, x)
        put_axis(p, Y, lane, y)
        put_axis(p, Z, lane, z)
        near, far = clip((x, y, z))
        t = max(near, p[T + lane])
        p[ENTER + lane], p[LEAVE + lane], p[T + lane] = near, far, t
        p[STATE + lane], p[VISITED + lane] = (WALKING if t <= far else LEFT), 0.0
    for lane in range(count):
        p[AT + X + lane], p[AT + Y + lane], p[AT + Z + lane] = spot_at(axes_in(p, lane, nx, ny, nz), p[T + lane])


@kernel(STRICT, inline=True)
def look_around(p: Array, empty: Empty, first: Unsigned) -> None:
    """Write how far the cells of a vector of rays are from the nearest one with a surfel."""
    for i in range(ABREAST):
        lane = first + i
        if p[STATE + lane] == WALKING:
            cell = int(p[AT + X + lane]), int(p[AT + Y + lane]), int(p[AT + Z + lane])
            p[AWAY + lane] = float(away(empty, cell))


@kernel(STRICT)
def step(p: Array, nx: float, ny: float, nz: float, free: float, first: Unsigned) -> int:
    """One step of every ray of a vector that walks; returns how many go on walking."""
    walking = 0
    for i in range(ABREAST):
        lane = first + i
        away, state = p[AWAY + lane], p[STATE + lane]
        reach = max(away - free - 1.0, 0.0)
        t, spot = onward(axes_in(p, lane, nx, ny, nz), spot_in(p, lane), reach)
        x, y, z = spot
        inside = 0.0 <= x < nx and 0.0 <= y < ny and 0.0 <= z < nz and t <= p[LEAVE + lane]
        walks, found = state == WALKING, away <= free
        goes = walks and not found
        p[VISITED + lane] += 1.0 if walks else 0.0
        p[STATE + lane] = (FOUND if found else (WALKING if inside else LEFT)) if walks else state
        p[T + lane] = t if goes else p[T + lane]
        p[AT + X + lane] = x if goes else p[AT + X + lane]
        p[AT + Y + lane] = y if goes else p[AT + Y + lane]
        p[AT + Z + lane] = z if goes else p[AT + Z + lane]
        walking += 1 if goes and inside else 0
    return walking


@kernel(STRICT, inline=True)
def place_ray(p: Array, lane: Unsigned, o: Vector, d: Vector, t: float) -> None:
    """Write where a ray comes from and goes, and the t before which it meets nothing.

    One without meaning is put where it meets nothing at all.
    """
    bad = is_bad(o, d)
    p[BAD + lane] = 1.0 if bad else 0.0
    if bad:
        o, d = (-1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)
    p[ORIGIN + X + lane], p[ORIGIN + Y + lane], p[ORIGIN + Z + lane] = o
    p[DIRECTION + X + lane], p[DIRECTION + Y + lane], p[DIRECTION + Z + lane] = d
    p[T + lane] = t


@kernel(STRICT)
def walk_vector(p: Array, empty: Empty, free: int, first: Unsigned) -> None:
    """Walk until each ray of a vector is in a cell that a search begins in or has left the lattice."""
    nx, ny, nz = empty.shape
    walking = 1
    while walking > 0:
        look_around(p, empty, first)
        walking = step(p, float(nx), float(ny), float(nz), float(free), first)


@kernel(STRICT)
def walk_together(p: Array, empty: Empty, free: int, even: bool, count: Unsigned) -> None:
    """Walk from where the rays are placed to the first cell that each has to search in.

    p: (ROOM,), the rays placed; free: a search begins in cells no farther than this from one with a surfel;
    even: steps are even, and every ray goes alone.
    """
    nx, ny, nz = empty.shape
    enter(p, float(nx), float(ny), float(nz), count)
    for lane in range(count, LANES):
        p[STATE + lane] = LEFT
    if not even:
        for first in range(np.uint64(0), count, ABREAST):
            walk_vector(p, empty, free, first)
