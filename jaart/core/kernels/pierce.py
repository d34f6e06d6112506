"""The balls that a ray pierces, in order: a heap of the tree's nodes and of balls, by where the ray enters them."""

from __future__ import annotations

from math import nan, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.blocks import HEAP
from jaart.core.kernels.heap import pop, push
from jaart.core.kernels.jit import EXACT, STRICT, kernel
from jaart.core.kernels.records import Array, Sites, Vector
from jaart.core.kernels.tree import Tree, span
from jaart.core.kernels.unowned import unowned, unowned_sites
from jaart.core.kernels.vectors import along, dot

Ints = NDArray[np.int64]
#: Nothing is left in the heap that counts, or it has no room.
NOTHING, ROOM = -1, -2
#: So many balls of a leaf are tested at once.
LANES = 8
#: A node adds fewer entries than this to the heap.
LEAF_ROOM = 64


class Balls(NamedTuple):
    """A cloud as rays pierce it.

    sites: the balls; radii: (N,); tree: over the balls; leaves: (4·(N + LANES),) the parts of their centres and their
    radii in the order of the leaves, each column with room behind it; stretches: 1 where a ball is searched from side
    to side, 0 where a search starts from its promise, which what is kept at its centre makes; any_hit: 1 where the
    first found will do; offset: of the frame that balls are in; blur: rounding of its origin.
    """

    sites: Sites
    radii: Array
    tree: Tree
    leaves: Array
    stretches: int
    any_hit: int
    offset: Vector
    blur: float


@kernel(EXACT, inline=True)
def chord_of(centre: Vector, radius: float, o: Vector, d: Vector) -> tuple[float, float, float]:
    """Distance t of the ray's foot point on a ball's centre, half the chord, NaN for none, and how far the ray passes
    from the centre; the same bits wherever it is asked for.
    """
    c = (centre[0] - o[0], centre[1] - o[1], centre[2] - o[2])
    foot = dot(c, d)
    aside = along(c, d, -foot)
    distance = sqrt(dot(aside, aside))
    return foot, sqrt((radius - distance) * (radius + distance)) if distance <= radius else nan, distance


@kernel(EXACT, inline=True)
def chord(balls: Balls, ball: int, o: Vector, d: Vector) -> tuple[float, float, float]:
    """`chord_of` a ball by its number."""
    centres = balls.sites.centres
    return chord_of((centres[ball, 0], centres[ball, 1], centres[ball, 2]), balls.radii[ball], o, d)


@kernel(STRICT, inline=True)
def push_ball(balls: Balls, ball: int, o: Vector, d: Vector, keys: Array, items: Ints, size: int) -> int:
    """Add a ball that the ray meets, by where it enters it, or by its priority [A 12]; returns the heap's size.

    γ = (ρ - distance of ray and centre)/ρ.
    """
    foot, half, distance = chord(balls, ball, o, d)
    if not foot + half > 0.0:
        return size
    if balls.any_hit == 1:
        radius = balls.radii[ball]
        return push(keys, items, size, (distance - radius) / radius if radius > 0.0 else 0.0, ball)
    return push(keys, items, size, max(foot - half, 0.0), ball)


@kernel(STRICT)
def push_root(balls: Balls, o: Vector, inverse: Vector, keys: Array, items: Ints) -> int:
    """Begin with the whole tree; returns the heap's size."""
    enter, last = span(balls.tree.low, balls.tree.high, 0, o, inverse)
    return push(keys, items, 0, -2.0, -1) if enter <= last and last > 0.0 else 0


@kernel(STRICT)
def push_children(balls: Balls, node: int, o: Vector, d: Vector, inverse: Vector, keys: Array, items: Ints,
                  size: int) -> int:
    """Add what a node holds and the ray meets: its two children, or its balls; returns the heap's size."""
    tree = balls.tree
    if tree.size[node] == 0:
        for i in range(2):
            child = node + 1 if i == 0 else tree.first[node]
            enter, leave = span(tree.low, tree.high, child, o, inverse)
            if enter <= leave and leave > 0.0:
                size = push(keys, items, size, -2.0 if balls.any_hit == 1 else max(enter, 0.0), -1 - child)
        return size
    for at in range(tree.first[node], tree.first[node] + tree.size[node]):
        size = push_ball(balls, tree.order[at], o, d, keys, items, size)
    return size


@kernel(STRICT, inline=True)
def next_item(balls: Balls, o: Vector, d: Vector, inverse: Vector, limit: float, keys: Array, items: Ints,
              size: int) -> tuple[int, int]:
    """The heap's size, and the nearest ball or promise before a limit; NOTHING for none, ROOM for a full heap,
    which is written down.
    """
    while size > 0 and keys[0] < limit:
        if size > keys.shape[0] - LEAF_ROOM:
            balls.sites.pool[HEAP] = 1
            return size, ROOM
        size = pop(keys, items, size)
        if items[size] >= 0:
            return size, items[size]
        size = push_children(balls, -1 - items[size], o, d, inverse, keys, items, size)
    return size, NOTHING


@kernel(STRICT)
def unowned_balls(balls: Balls) -> Balls:
    """Balls, their arrays without owners."""
    tree = balls.tree
    tree = Tree(unowned(tree.low), unowned(tree.high), unowned(tree.first), unowned(tree.size), unowned(tree.order))
    return Balls(unowned_sites(balls.sites), unowned(balls.radii), tree, unowned(balls.leaves), balls.stretches,
                 balls.any_hit, balls.offset, balls.blur)
