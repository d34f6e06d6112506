"""The columns that rays are written to, and the order of it: coarse first, in tiles for a pool of threads."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.records import Out

#: Rays in a tile: long enough to hide the cost of a task, short enough to stop soon.
TILE = 4096
#: Every so many pixels in each direction are traced by one pass after the other.
STEPS = (8, 4, 2, 1)

Pixels = NDArray[np.int64]


def coarse_passes(size: tuple[int, int]) -> list[tuple[int, Pixels]]:
    """(step, pixels) of each pass: those at multiples of step that no earlier pass has.

    size: (width, height); pixels: numbers x + y·width.
    """
    width, height = size
    x, y = np.arange(width), np.arange(height)[:, None]
    passes = []
    for step, before in zip(STEPS, (0, *STEPS), strict=False):
        wanted = (x % step == 0) & (y % step == 0)
        if before:
            wanted &= (x % before != 0) | (y % before != 0)
        passes.append((step, np.flatnonzero(wanted)))
    return [(step, pixels) for step, pixels in passes if len(pixels)]


def tiles(pixels: Pixels) -> list[Pixels]:
    """The pixels in pieces of at most TILE."""
    return [pixels[i:i + TILE] for i in range(0, len(pixels), TILE)]


def columns_for(count: int) -> Out:
    """Empty columns for so many rays."""
    def numbers() -> NDArray[np.int32]:
        return np.zeros(count, np.int32)

    return Out(t=np.full(count, np.nan), point=np.full((count, 3), np.nan), normal=np.full((count, 3), np.nan),
               energy=np.full(count, np.nan), off_centre=np.full(count, np.nan), iterations=numbers(),
               evaluations=numbers(), neighbours=numbers(), cells=numbers(),
               lowered=numbers(), gap=np.full(count, np.nan), status=np.zeros(count, np.uint8),
               starts=numbers(), eigenvectors=numbers(), gradients=numbers())
