"""The columns that rays are written to, and the order of it: coarse first, in tiles for a pool of threads."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.pinhole import EDGE
from jaart.core.kernels.records import Out
from jaart.core.reuse import lent

#: Rays in a tile: long enough to hide the cost of a task, short enough to stop soon.
TILE = 4096
#: Where it is known how long a ray takes, a tile may be longer: it takes about so long [s], within these bounds.
TILE_SECONDS, SHORTEST, LONGEST = 0.003, TILE, 16_384
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


@functools.lru_cache(maxsize=4)
def in_blocks(size: tuple[int, int], step: int, before: int = 0) -> Pixels:
    """The same pixels block by block, so that rays that are traced one after the other are neighbours.

    A block has a left and a right half, for some rays of it that go together should be close to one another as well:
    its quarters are 4 × 4 pixels.
    """
    pixels, edge = pixels_at(size, step, before), EDGE * step
    y, x = np.divmod(pixels, size[0])
    halves = 2 * (y // edge * (size[0] // edge + 1) + x // edge) + 2 * (x % edge) // edge
    return pixels[np.argsort(halves, kind="stable")]


def tile_of(seconds: float) -> int:
    """How many rays make a tile when one takes a thread so long; whole blocks of neighbours."""
    rays = int(min(max(TILE_SECONDS / max(seconds, 1e-12), SHORTEST), LONGEST))
    return rays // EDGE**2 * EDGE**2


def tiles(pixels: Pixels, threads: int = 1, most: int = TILE) -> list[Pixels]:
    """The pixels in pieces of at most so many, some for each thread."""
    length = max(LEAST, min(most, -(-len(pixels) // (PIECES * threads))))
    return [pixels[i:i + length] for i in range(0, len(pixels), length)]


def columns_for(count: int) -> Out:
    """Columns for so many rays, each row of which is written when its ray has ended.

    All but the status lie in two pieces, large enough for a system to give them in few, large pages.
    """
    floats, numbers = lent((10 * count,)), lent((8, count), np.int32)
    t, energy, off_centre, gap = floats[:4 * count].reshape(4, count)
    point, normal = floats[4 * count:].reshape(2, count, 3)
    numbers[5:] = 0  # not every kind of tracer counts these
    return Out(t=t, point=point, normal=normal, energy=energy, off_centre=off_centre, iterations=numbers[0],
               evaluations=numbers[1], neighbours=numbers[2], cells=numbers[3], lowered=numbers[4], gap=gap,
               status=np.empty(count, np.uint8), starts=numbers[5], eigenvectors=numbers[6], gradients=numbers[7])
