"""How far a cell is from the nearest with a surfel."""

from __future__ import annotations

import numpy as np

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Cell, Empty


@kernel(STRICT, inline=True)
def away(empty: Empty, cell: Cell) -> int:
    """A cell's distance from the nearest with a surfel; far from all of them perhaps less."""
    i, j, k = cell
    wide, deep = (empty.shape[1] + 3) >> 2, (empty.shape[2] + 3) >> 2
    brick = int(empty.bricks[np.uint64(((i >> 2) * wide + (j >> 2)) * deep + (k >> 2))])
    if brick < 0:
        return -1 - brick
    return int(empty.near[np.uint64(brick + (((i & 3) << 4) | ((j & 3) << 2) | (k & 3)))])
