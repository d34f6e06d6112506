"""Which of many balls are enough."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array

Ints = NDArray[np.int64]


@kernel(STRICT, entry=True)
def keep(distance: Array, index: NDArray[np.int32], radii: Array, order: Ints, place: NDArray[np.int32], share: float,
         kept: NDArray[np.bool_]) -> None:
    """Mark the balls that are kept: one that is kept drops later ones whose core it holds.

    A core is the ball of `share` times the radius. distance, index: (N, k) nearest other centres of each ball,
    rising; radii (N,), at most the distance to the last of them; order (N,): which ball is first, and so on; place
    (N,): where in it each ball is; kept (N,): all true.
    """
    for at in range(order.shape[0]):
        i = order[at]
        if kept[i]:
            for near in range(index.shape[1]):
                j = index[i, near]
                if place[j] > at and distance[i, near] + share * radii[j] <= radii[i]:
                    kept[j] = False
