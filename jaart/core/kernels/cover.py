"""Which of many balls are enough."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array

Ints = NDArray[np.int64]


@kernel(STRICT, entry=True)
def keep(distance: Array, index: Ints, radii: Array, share: float, kept: NDArray[np.bool_]) -> None:
    """Mark the balls that are kept: one that is kept drops later ones whose core it holds.

    A core is the ball of `share` times the radius. distance, index: (N, k) nearest other centres of each ball,
    rising; radii (N,), at most the distance to the last of them; kept (N,): all true.
    """
    for i in range(index.shape[0]):
        if kept[i]:
            for at in range(index.shape[1]):
                j = index[i, at]
                if j > i and distance[i, at] + share * radii[j] <= radii[i]:
                    kept[j] = False
