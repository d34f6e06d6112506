"""Builds bounding volume trees over balls or over any boxes."""

from __future__ import annotations

import numpy as np

from jaart.core.kernels import tree as kernels
from jaart.core.kernels.tree import BALL_LEAF, LEAF, Tree
from jaart.core.scene import Array


def box_tree(lows: Array, highs: Array, leaf: int = LEAF) -> Tree:
    """The tree over boxes from lows to highs (N, 3), N >= 1.

    leaf: items of a leaf at most, at least 1. Nodes are halved by the median, so leaves hold at least leaf / 2
    items and the tree is about log2(N / leaf) levels deep whatever the boxes are.
    """
    count = len(lows)
    most = 4 * count // (leaf + 1) + 1  # a node is halved from leaf + 1 items on: so at most 2 N / (leaf + 1) leaves
    room = Tree(np.empty((most, 3)), np.empty((most, 3)), np.empty(most, np.int64), np.empty(most, np.int64),
                np.arange(count))
    low, high = (np.require(a, np.float64, ("C", "W")) for a in (lows, highs))
    used = kernels.divide(low + high, leaf, room)  # twice the middles: only their order counts
    kernels.enclose(low, high, room, used)
    return Tree(room.low[:used].copy(), room.high[:used].copy(), room.first[:used].copy(), room.size[:used].copy(),
                room.order)


def ball_tree(points: Array, radii: Array, leaf: int = BALL_LEAF) -> Tree:
    """The tree over balls around points (N, 3) of radii (N,), its boxes rounded outwards."""
    reach = np.asarray(radii)[:, None]
    low, high = points - reach, points + reach
    return box_tree(np.nextafter(low, -np.inf, out=low), np.nextafter(high, np.inf, out=high), leaf)
