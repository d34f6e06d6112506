"""Rays that go together: the balls that any of them may pierce are looked up in the tree once for all.

Rays beside one another pierce nearly the same balls. All of them stay within a cone about one line, which widens as the
rays part; a ball that it misses is met by none. Those that are left stand in columns, and each ray tests them as
vectors. It meets the balls that it would meet alone, number for number.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.pierce import LEAF_ROOM, Balls, push_ball
from jaart.core.kernels.records import Array, Unsigned, Vector
from jaart.core.kernels.tree import DEEPEST, span_of
from jaart.core.kernels.vectors import along, dot, length, scaled

Ints = NDArray[np.int64]
#: Rays of a bundle at most: a block of 8 × 8 pixels. So few do not go together.
MOST, FEW = 64, 4
#: Balls that a bundle may meet at most; more cost each ray more than the way through the tree.
ROOM = 512
#: Rays that have no list of balls.
ALONE = -1
_COLUMN = [np.uint64(ROOM * i) for i in range(5)]
X, Y, Z, RADIUS, INSIDE = _COLUMN[0], _COLUMN[1], _COLUMN[2], _COLUMN[3], _COLUMN[4]
#: Floats and whole numbers that a bundle takes.
FLOATS, NUMBERS = 5 * ROOM, ROOM + DEEPEST
#: By what share a cone is widened, and a ball in the test that goes before the exact one, against rounding.
_WIDER, _LARGER = 1e-9, 1.0 + 1e-14


class Cone(NamedTuple):
    """Where the rays of a bundle are: at t no farther than wide + t·parting from axis + t·d.

    inverse: 1 over each component of d.
    """

    axis: Vector
    d: Vector
    inverse: Vector
    wide: float
    parting: float


@kernel(STRICT)
def cone_about(origins: Array, directions: Array, rays: Ints, offset: Vector) -> Cone:
    """The cone about the middle one of some rays, in the frame with that offset; rays without a meaning aside."""
    middle = rays[rays.shape[0] // 2]
    o = (origins[middle, 0], origins[middle, 1], origins[middle, 2])
    d = (directions[middle, 0], directions[middle, 1], directions[middle, 2])
    wide = parting = 0.0
    for i in range(rays.shape[0]):
        ray = rays[i]
        aside = (origins[ray, 0] - o[0], origins[ray, 1] - o[1], origins[ray, 2] - o[2])
        turned = (directions[ray, 0] - d[0], directions[ray, 1] - d[1], directions[ray, 2] - d[2])
        here, there = dot(aside, aside), dot(turned, turned)
        wide, parting = (here if here > wide else wide), (there if there > parting else parting)
    return Cone(along(o, offset, -1.0), d, (1.0 / d[0], 1.0 / d[1], 1.0 / d[2]), sqrt(wide), sqrt(parting))


@kernel(STRICT)
def is_sound(cone: Cone) -> bool:
    """Whether a cone is one: its axis is a ray, and how far the rays part is known."""
    return abs(dot(cone.d, cone.d) - 1.0) < 1e-6 and length(cone.axis) + cone.wide + cone.parting < inf


@kernel(STRICT)
def width_at(cone: Cone, middle: Vector, radius: float) -> float:
    """How far from the axis a ray may be while it is within a radius of a point."""
    far = length(along(middle, cone.axis, -1.0)) + radius + cone.wide
    return cone.wide + cone.parting * far + _WIDER * far


@kernel(STRICT)
def may_enter(balls: Balls, node: int, cone: Cone) -> bool:
    """Whether a ray of the cone may meet a node's box."""
    low = (balls.tree.low[node, 0], balls.tree.low[node, 1], balls.tree.low[node, 2])
    high = (balls.tree.high[node, 0], balls.tree.high[node, 1], balls.tree.high[node, 2])
    half = scaled(along(high, low, -1.0), 0.5)
    more = width_at(cone, along(low, half, 1.0), length(half))
    enter, leave = span_of((low[0] - more, low[1] - more, low[2] - more), (high[0] + more, high[1] + more,
                                                                           high[2] + more), cone.axis, cone.inverse)
    return enter <= leave and leave >= 0.0


@kernel(STRICT)
def may_pierce(centre: Vector, radius: float, cone: Cone) -> bool:
    """Whether a ray of the cone may pierce a ball."""
    c, reach = along(centre, cone.axis, -1.0), radius + width_at(cone, centre, radius)
    foot = dot(c, cone.d)
    aside = along(c, cone.d, -foot)
    return dot(aside, aside) <= reach * reach and foot >= -reach


@kernel(STRICT)
def look_up(balls: Balls, cone: Cone, columns: Array, numbers: Ints) -> int:
    """Write the balls that the rays of a cone may pierce; returns how many, ALONE for more than there is room for."""
    tree, found, waiting = balls.tree, 0, 1
    numbers[ROOM] = 0
    while waiting > 0:
        waiting -= 1
        node = numbers[ROOM + waiting]
        if not may_enter(balls, node, cone):
            continue
        if tree.size[node] == 0:
            numbers[ROOM + waiting], numbers[ROOM + waiting + 1] = tree.first[node], node + 1
            waiting += 2
            continue
        for at in range(tree.first[node], tree.first[node] + tree.size[node]):
            ball = tree.order[at]
            c = (balls.sites.centres[ball, 0], balls.sites.centres[ball, 1], balls.sites.centres[ball, 2])
            if may_pierce(c, balls.radii[ball], cone):
                if found == ROOM:
                    return ALONE
                to = np.uint64(found)
                columns[X + to], columns[Y + to], columns[Z + to] = c
                columns[RADIUS + to], numbers[found] = balls.radii[ball], ball
                found += 1
    return found


@kernel(STRICT)
def test_all(columns: Array, count: Unsigned, o: Vector, d: Vector) -> None:
    """Write into INSIDE of each ball a number that is below 0 where the ray misses it for certain."""
    for i in range(count):
        x, y, z = columns[X + i] - o[0], columns[Y + i] - o[1], columns[Z + i] - o[2]
        foot, radius = x * d[0] + y * d[1] + z * d[2], columns[RADIUS + i]
        x, y, z = x - foot * d[0], y - foot * d[1], z - foot * d[2]
        inside = radius * radius * _LARGER - (x * x + y * y + z * z)
        columns[INSIDE + i] = inside if foot >= -radius else -1.0


@kernel(STRICT)
def push_pierced(balls: Balls, columns: Array, numbers: Ints, count: int, o: Vector, d: Vector, keys: Array,
                 items: Ints) -> int:
    """Begin with those of a bundle's balls that a ray pierces; returns the heap's size."""
    test_all(columns, np.uint64(count), o, d)
    size = 0
    for i in range(count):
        if columns[INSIDE + np.uint64(i)] >= 0.0:
            size = push_ball(balls, numbers[i], o, d, keys, items, size)
    return size


@kernel(STRICT)
def listed(balls: Balls, origins: Array, directions: Array, rays: Ints, size: int, columns: Array, numbers: Ints,
           keys: Array) -> int:
    """Write the balls that some rays may pierce; returns how many, ALONE where each had better look itself.

    size: of the bundle, as of `last_of`; keys: of the heap, which must have room for the balls.
    """
    if min(size, rays.shape[0]) < FEW or keys.shape[0] < ROOM + LEAF_ROOM:
        return ALONE
    cone = cone_about(origins, directions, rays, balls.offset)
    return look_up(balls, cone, columns, numbers) if is_sound(cone) else ALONE


@kernel(STRICT)
def last_of(size: int, begin: int, count: int) -> int:
    """Where of so many rays the bundle ends that begins with one of them; too small a size: where they stay alone."""
    return min(begin + (size - begin % size if size >= FEW else MOST), count)


@kernel(STRICT)
def next_size(size: int, found: int) -> int:
    """How many rays the next bundle has: more where few balls were found, fewer where there were too many."""
    if found == ALONE:
        return size // 2 if size >= FEW else FEW
    return min(2 * size, MOST) if 4 * found < ROOM else size
