"""The columns that rays are written to, and the order of it: coarse first, in tiles for a pool of threads."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.records import Out

#: Rays in a tile: long enough to hide the cost of a task, short enough to stop soon.
TILE = 4096
#: Few rays are shared evenly too: so many tiles for each thread, of no fewer rays than that.
PIECES, LEAST = 4, 128
#: Every so many pixels in each direction are traced by one pass after the other.
STEPS = (8, 4, 2, 1)

Pixels = NDArray[np.int64]


def pixels_at(size: tuple[int, int], step: int, before: int = 0) -> Pixels:
    """The pixels at multiples of step, without those at multiples of the step of the pass before (0: of none).

    size: (width, height); pixels: numbers x + y·width.
    """
    wanted = np.zeros((size[1], size[0]), bool)
    wanted[::step, ::step] = True
    if before:
        wanted[::before, ::before] = False
    return np.flatnonzero(wanted)


def tiles(pixels: Pixels, threads: int = 1) -> list[Pixels]:
    """The pixels in pieces of at most TILE, some for each thread."""
    length = max(LEAST, min(TILE, -(-len(pixels) // (PIECES * threads))))
    return [pixels[i:i + length] for i in range(0, len(pixels), length)]


def columns_for(count: int) -> Out:
    """Empty columns for so many rays."""
    def numbers() -> NDArray[np.int32]:
        return np.zeros(count, np.int32)

    return Out(t=np.full(count, np.nan), point=np.full((count, 3), np.nan), normal=np.full((count, 3), np.nan),
               energy=np.full(count, np.nan), off_centre=np.full(count, np.nan), iterations=numbers(),
               evaluations=numbers(), neighbours=numbers(), cells=numbers(),
               lowered=numbers(), gap=np.full(count, np.nan), status=np.zeros(count, np.uint8))
