"""A bounding volume tree over boxes: built by halving, kept in plain arrays, and the test of a ray and a node."""

from __future__ import annotations

from math import copysign
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Vector

Ints = NDArray[np.int64]

#: A node of so many items or fewer is a leaf; of balls, which are tested as vectors, there are more.
LEAF, BALL_LEAF = 6, 12
#: Levels that a tree may have: it halves, so 2^48 items would fit.
DEEPEST = 48
#: By what share of itself a t is moved outwards: it went through four roundings, each of 2^-53 at most.
SLACK = 8 * 2.0**-53


class Tree(NamedTuple):
    """Boxes in boxes. Node 0 is the root; the first child of node i is i + 1.

    low, high: corners (M, 3) of the nodes' boxes; size: items of a leaf (M,), 0 for an inner node; first: where
    a leaf's items begin in order, or an inner node's second child; order: the items (N,), leaf after leaf.
    """

    low: Array
    high: Array
    first: Ints
    size: Ints
    order: Ints


@kernel(STRICT)
def widest_axis(middles: Array, begin: int, end: int) -> int:
    """The axis along which some middles (N, 3) spread most."""
    axis, widest = 0, -1.0
    for other in range(3):
        least, most = middles[begin, other], middles[begin, other]
        for at in range(begin + 1, end):
            least, most = min(least, middles[at, other]), max(most, middles[at, other])
        if most - least > widest:
            axis, widest = other, most - least
    return axis


@kernel(STRICT)
def halve(middles: Array, order: Ints, begin: int, end: int, axis: int) -> int:
    """Sort items into a lower and an upper half by their middles along an axis; returns where the upper begins.

    Hoare's selection, its pivots taken by a fixed sequence of pseudo-random numbers, so that no order of the
    input makes it slow and the same input gives the same tree. middles and order are sorted alike.
    """
    middle, left, right, random = begin + (end - begin) // 2, begin, end - 1, 12345
    while left < right:
        random = (random * 1103515245 + 12345) % 2147483648
        pivot = middles[left + random % (right - left + 1), axis]
        i, j = left, right
        while i <= j:
            while middles[i, axis] < pivot:
                i += 1
            while middles[j, axis] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                for k in range(3):
                    middles[i, k], middles[j, k] = middles[j, k], middles[i, k]
                i, j = i + 1, j - 1
        if middle <= j:
            right = j
        elif middle >= i:
            left = i
        else:
            break
    return middle


@kernel(STRICT, entry=True, allocates=True)
def divide(middles: Array, leaf: int, tree: Tree) -> int:
    """Fill a tree's first, size and order, depth first; returns the number of its nodes.

    Each node is halved along its widest axis until it has at most `leaf` items. middles: of the items (N, 3), sorted
    as order is; tree: arrays long enough; order holds 0 … N - 1.
    """
    begins, ends, parents = np.empty(DEEPEST, np.int64), np.empty(DEEPEST, np.int64), np.empty(DEEPEST, np.int64)
    begins[0], ends[0], parents[0] = 0, tree.order.shape[0], -1
    waiting, node = 1, 0
    while waiting > 0:
        waiting -= 1
        begin, end = begins[waiting], ends[waiting]
        if parents[waiting] >= 0:
            tree.first[parents[waiting]] = node
        tree.first[node], tree.size[node] = begin, end - begin
        if end - begin > leaf:
            tree.size[node] = 0
            middle = halve(middles, tree.order, begin, end, widest_axis(middles, begin, end))
            begins[waiting], ends[waiting], parents[waiting] = middle, end, node
            begins[waiting + 1], ends[waiting + 1], parents[waiting + 1] = begin, middle, -1
            waiting += 2
        node += 1
    return node


@kernel(STRICT, entry=True)
def enclose(lows: Array, highs: Array, tree: Tree, nodes: int) -> None:
    """Write the nodes' boxes, last first: of a leaf around its items lows … highs (N, 3), else around its children."""
    for node in range(nodes - 1, -1, -1):
        for axis in range(3):
            if tree.size[node] == 0:
                low = min(tree.low[node + 1, axis], tree.low[tree.first[node], axis])
                high = max(tree.high[node + 1, axis], tree.high[tree.first[node], axis])
            else:
                low, high = np.inf, -np.inf
                for at in range(tree.first[node], tree.first[node] + tree.size[node]):
                    low = min(low, lows[tree.order[at], axis])
                    high = max(high, highs[tree.order[at], axis])
            tree.low[node, axis], tree.high[node, axis] = low, high


@kernel(STRICT, inline=True)
def clip(near: float, far: float, o: float, inverse: float, low: float, high: float) -> tuple[float, float]:
    """The interval near … far of t, cut to where a line is between two planes."""
    enter, leave = (low - o) * inverse, (high - o) * inverse
    if inverse < 0:
        enter, leave = leave, enter
    # false for NaN, 0 · infinity: a line within a plane is between them
    return (enter if enter > near else near), (leave if leave < far else far)


@kernel(STRICT, inline=True)
def span_of(low: Vector, high: Vector, o: Vector, inverse: Vector) -> tuple[float, float]:
    """First and last t at which a line may be in a box; first > last when it misses it for certain.

    o: origin; inverse: 1 over each component of the direction, infinite where that is 0. Rounding only widens
    the interval, and a line within a face of the box is in it.
    """
    near, far = clip(-np.inf, np.inf, o[0], inverse[0], low[0], high[0])
    near, far = clip(near, far, o[1], inverse[1], low[1], high[1])
    near, far = clip(near, far, o[2], inverse[2], low[2], high[2])
    return near * (1.0 - copysign(SLACK, near)), far * (1.0 + copysign(SLACK, far))


@kernel(STRICT, inline=True)
def span(low: Array, high: Array, node: int, o: Vector, inverse: Vector) -> tuple[float, float]:
    """The same of a node's box."""
    return span_of((low[node, 0], low[node, 1], low[node, 2]), (high[node, 0], high[node, 1], high[node, 2]), o,
                   inverse)
