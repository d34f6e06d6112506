"""Rays that go together: the balls that any of them may pierce are looked up in the tree once for all.

Rays beside one another pierce nearly the same balls. All of them stay within a cone about one line, which widens as the
rays part; a ball that it misses is met by none. Those that are left stand in columns, and each ray tests them as
vectors. It meets the balls that it would meet alone, number for number.

Most rays end at the first sheet, so balls are listed up to a horizon, nearest nodes first. A ray that gets there
without an end has more of them listed, and begins anew.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.address import fetch, load
from jaart.core.kernels.blocks import fetch_centre
from jaart.core.kernels.heap import pop, push
from jaart.core.kernels.jit import EXACT, STRICT, kernel
from jaart.core.kernels.pierce import LANES, LEAF_ROOM, Balls, chord_of, push_ball
from jaart.core.kernels.records import Array, Unsigned, Vector
from jaart.core.kernels.tree import BALL_LEAF, Tree, span_of
from jaart.core.kernels.unowned import unowned
from jaart.core.kernels.vectors import along, dot, length

Ints = NDArray[np.int64]
#: Rays of a bundle at most: a block of 8 × 8 pixels. Fewer than that do not go together.
MOST, FEW = 64, 16
#: So many rays go alone where even so few are too many, before some try again.
LONE = 256
#: Balls that a bundle may list at most; more cost each ray more than the way through the tree. So many at once.
ROOM, ROUND = 512, 64
#: Nodes that may wait.
NODES = 512
#: Rays that have no list of balls.
ALONE = -1
_COLUMN = [np.uint64(ROOM * i) for i in range(5)]
X, Y, Z, RADIUS, INSIDE = _COLUMN[0], _COLUMN[1], _COLUMN[2], _COLUMN[3], _COLUMN[4]
#: By what share a cone is widened, and a ball in the test that goes before the exact one, against rounding.
_WIDER, _LARGER, _ROUNDED = 1e-9, 1.0 + 1e-14, 1e-15


class Room(NamedTuple):
    """Where a bundle's balls are written.

    columns: (5 ROOM,) the parts of their centres, radii, and how far in them the ray at hand is; numbers: (ROOM,) of
    the balls; pierced: (ROOM,) which of them a ray pierces; keys, nodes: (NODES,) a heap of the tree's nodes.
    """

    columns: Array
    numbers: Ints
    pierced: Ints
    keys: Array
    nodes: Ints


class Listed(NamedTuple):
    """What a bundle has listed: so many balls, ALONE where there are too many, and so many nodes that wait."""

    balls: int
    nodes: int


class Cone(NamedTuple):
    """Where the rays of a bundle are: at t no farther than wide + t·parting from axis + t·d.

    inverse: 1 over each component of d.
    """

    axis: Vector
    d: Vector
    inverse: Vector
    wide: float
    parting: float


@kernel(STRICT, inline=True)
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


@kernel(STRICT, inline=True)
def is_sound(cone: Cone) -> bool:
    """Whether a cone is one: its axis is a ray, and how far the rays part is known."""
    return abs(dot(cone.d, cone.d) - 1.0) < 1e-6 and length(cone.axis) + cone.wide + cone.parting < inf


@kernel(STRICT, inline=True)
def width_in(cone: Cone, low: Vector, high: Vector) -> float:
    """How far from the axis a ray may be within a box: what it parts on the way to the farthest corner."""
    o = cone.axis
    x, y, z = max(o[0] - low[0], high[0] - o[0]), max(o[1] - low[1], high[1] - o[1]), max(o[2] - low[2], high[2] - o[2])
    far = sqrt(x * x + y * y + z * z) + cone.wide
    return cone.wide + (cone.parting + _WIDER) * far


@kernel(STRICT, inline=True)
def box_of(tree: Tree, node: int) -> tuple[Vector, Vector]:
    """Lowest and highest corner of a node's box."""
    return ((tree.low[node, 0], tree.low[node, 1], tree.low[node, 2]),
            (tree.high[node, 0], tree.high[node, 1], tree.high[node, 2]))


@kernel(STRICT, inline=True)
def push_node(tree: Tree, node: int, cone: Cone, room: Room, waiting: int) -> int:
    """Let a node wait whose box a ray of the cone may meet; returns how many wait."""
    low, high = box_of(tree, node)
    w = width_in(cone, low, high)
    enter, leave = span_of((low[0] - w, low[1] - w, low[2] - w), (high[0] + w, high[1] + w, high[2] + w), cone.axis,
                           cone.inverse)
    return push(room.keys, room.nodes, waiting, enter, node) if enter <= leave and leave >= 0.0 else waiting


@kernel(STRICT, inline=True)
def test_leaf(balls: Balls, begin: int, cone: Cone, wide: float, room: Room, found: int) -> None:
    """Write the next LANES balls into the columns, and into INSIDE what is below 0 where no ray of a cone that is so
    wide pierces one. Those of the leaf that follows are among them.
    """
    leaves, columns, o, d = balls.leaves, room.columns, cone.axis, cone.d
    own, to, count = np.uint64(begin), np.uint64(found), np.uint64(balls.radii.shape[0] + LANES)
    for i in range(np.uint64(LANES)):
        x, y, z = leaves[own + i], leaves[count + own + i], leaves[count + count + own + i]
        radius = leaves[count + count + count + own + i]
        columns[X + to + i], columns[Y + to + i], columns[Z + to + i], columns[RADIUS + to + i] = x, y, z, radius
        x, y, z = x - o[0], y - o[1], z - o[2]
        foot, reach = x * d[0] + y * d[1] + z * d[2], radius + wide
        x, y, z = x - foot * d[0], y - foot * d[1], z - foot * d[2]
        columns[INSIDE + i] = reach * reach - (x * x + y * y + z * z)


@kernel(STRICT, inline=True)
def list_leaf(balls: Balls, node: int, cone: Cone, room: Room, found: int) -> int:
    """Write the balls of a leaf that rays of the cone may pierce; returns how many there are then."""
    tree, columns = balls.tree, room.columns
    low, high = box_of(tree, node)
    wide = width_in(cone, low, high)
    first, last = tree.first[node], tree.first[node] + tree.size[node]
    while first < last:
        test_leaf(balls, first, cone, wide, room, found)
        begin = np.uint64(found)
        for i in range(min(last - first, LANES)):
            at, to = begin + np.uint64(i), np.uint64(found)
            columns[X + to], columns[Y + to] = columns[X + at], columns[Y + at]
            columns[Z + to], columns[RADIUS + to] = columns[Z + at], columns[RADIUS + at]
            room.numbers[found] = tree.order[first + i]
            found += 1 if columns[INSIDE + np.uint64(i)] >= 0.0 else 0
        first += LANES
    return found


@kernel(STRICT)
def list_more(balls: Balls, cone: Cone, room: Room, listed: Listed) -> Listed:
    """List some more balls that the rays of a cone may pierce, or all where any hit will do, nearest nodes first."""
    found, waiting, tree = listed.balls, listed.nodes, balls.tree
    enough = ROOM if balls.any_hit == 1 else found + ROUND
    while waiting > 0 and found < enough:
        if found > ROOM - BALL_LEAF - LANES or waiting > NODES - 2:
            return Listed(ALONE, 0)
        waiting = pop(room.keys, room.nodes, waiting)
        node = room.nodes[waiting]
        if tree.size[node] == 0:
            waiting = push_node(tree, node + 1, cone, room, waiting)
            waiting = push_node(tree, tree.first[node], cone, room, waiting)
        else:
            found = list_leaf(balls, node, cone, room, found)
    return Listed(found, waiting)


@kernel(STRICT, inline=True)
def horizon(room: Room, listed: Listed) -> float:
    """The t from which on a ray may enter balls that are not listed."""
    return room.keys[0] if listed.nodes > 0 else inf


@kernel(STRICT, inline=True)
def test_all(columns: Array, count: Unsigned, o: Vector, d: Vector) -> None:
    """Write into INSIDE of each ball a number that is below 0 where the ray misses it for certain."""
    for i in range(count):
        x, y, z = columns[X + i] - o[0], columns[Y + i] - o[1], columns[Z + i] - o[2]
        foot, radius = x * d[0] + y * d[1] + z * d[2], columns[RADIUS + i]
        x, y, z = x - foot * d[0], y - foot * d[1], z - foot * d[2]
        inside = radius * (radius * _LARGER + _ROUNDED * abs(foot)) - (x * x + y * y + z * z)
        columns[INSIDE + i] = inside if foot >= -radius else -1.0


@kernel(EXACT, inline=True)
def write_entries(columns: Array, pierced: Ints, count: int, o: Vector, d: Vector) -> None:
    """Write into INSIDE where a ray enters those balls that it pierces; infinity for those behind its origin."""
    for i in range(np.uint64(count)):
        at = np.uint64(pierced[i])
        foot, half, _ = chord_of((columns[X + at], columns[Y + at], columns[Z + at]), columns[RADIUS + at], o, d)
        columns[INSIDE + i] = max(foot - half, 0.0) if foot + half > 0.0 else inf


@kernel(STRICT, inline=True)
def fetch_ball(balls: Balls, ball: int) -> None:
    """Fetch ahead what says where a ball is and what it promises."""
    fetch(balls.sites.centres, 3 * ball)
    fetch(balls.radii, ball)
    fetch_centre(load(balls.sites.slots, ball))


@kernel(STRICT, inline=True)
def push_pierced(balls: Balls, room: Room, listed: Listed, o: Vector, d: Vector, keys: Array, items: Ints) -> int:
    """Begin with those of a bundle's balls that a ray pierces; returns the heap's size."""
    test_all(room.columns, np.uint64(listed.balls), o, d)
    pierced = size = 0
    for i in range(listed.balls):  # without a branch, which nobody could foresee
        room.pierced[pierced] = i
        pierced += 1 if room.columns[INSIDE + np.uint64(i)] >= 0.0 else 0
    for i in range(pierced):
        fetch_ball(balls, room.numbers[room.pierced[i]])
    if balls.any_hit == 1:
        for i in range(pierced):
            size = push_ball(balls, room.numbers[room.pierced[i]], o, d, keys, items, size)
        return size
    write_entries(room.columns, room.pierced, pierced, o, d)
    for i in range(pierced):
        enter = room.columns[INSIDE + np.uint64(i)]
        if enter < inf:
            size = push(keys, items, size, enter, room.numbers[room.pierced[i]])
    return size


@kernel(STRICT)
def nothing_listed(balls: Balls, cone: Cone, rays: int, room: Room, keys: Array) -> Listed:
    """What the rays of a cone have listed before one of them asks; ALONE where each had better look itself.

    keys: of the heap of a ray, which must have room for all balls.
    """
    if rays < FEW or keys.shape[0] < ROOM + LEAF_ROOM or not is_sound(cone):
        return Listed(ALONE, 0)
    return Listed(0, push_node(balls.tree, 0, cone, room, 0))


@kernel(STRICT, inline=True)
def last_of(size: int, begin: int, count: int) -> int:
    """Where of so many rays the bundle ends that begins with one of them; too small a size: where they stay alone."""
    return min(begin + (size - begin % size if size >= FEW else LONE), count)


@kernel(STRICT, inline=True)
def next_size(size: int, found: int) -> int:
    """How many rays the next bundle has: more where few balls were found, fewer where there were too many."""
    if found == ALONE:
        return size // 2 if size >= FEW else FEW
    return min(2 * size, MOST) if 4 * found < ROOM else size


@kernel(STRICT)
def unowned_room(room: Room) -> Room:
    """Room for a bundle, its arrays without owners."""
    return Room(unowned(room.columns), unowned(room.numbers), unowned(room.pierced), unowned(room.keys),
                unowned(room.nodes))
