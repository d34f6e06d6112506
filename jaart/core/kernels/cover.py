"""Which of many balls are enough."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array

Ints = NDArray[np.int64]
Rows = NDArray[np.int32]


@kernel(STRICT, inline=True)
def is_held(distance: Array, radii: Array, cores: Array, i: int, at: int, j: int) -> bool:
    """Whether ball i holds the core of ball j, its neighbour number at. Those as far as the last do not count, for
    others as far may not be listed, unless all are in one place.
    """
    apart = distance[i, at]
    return apart + cores[j] <= radii[i] and (apart < distance[i, distance.shape[1] - 1] or apart == 0.0)


@kernel(STRICT, entry=True)
def in_question(distance: Array, index: Rows, radii: Array, cores: Array, asked: NDArray[np.bool_]) -> None:
    """Mark the balls of which one holds the core of the other; the arguments, but for asked, as of `keep`."""
    for i in range(index.shape[0]):
        for at in range(index.shape[1]):
            j = index[i, at]
            if is_held(distance, radii, cores, i, at, j):
                asked[i] = asked[j] = True


@kernel(STRICT, entry=True)
def keep(distance: Array, index: Rows, radii: Array, cores: Array, order: Ints, rank: Rows,
         kept: NDArray[np.bool_]) -> None:
    """Mark the balls that are kept: one that is kept drops later ones whose core it holds.

    A core is a smaller ball about the same centre. distance, index: (N, k) nearest other centres of each ball, rising;
    radii, cores: (N,), balls beyond those neighbours are kept whatever holds them; order: balls in question, the first
    first; rank (N,): where in it each of them stands; kept (N,): all true.
    """
    for turn in range(order.shape[0]):
        i = order[turn]
        if kept[i]:
            for at in range(index.shape[1]):
                j = index[i, at]
                if is_held(distance, radii, cores, i, at, j) and rank[j] > turn:
                    kept[j] = False
