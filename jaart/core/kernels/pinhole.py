"""The rays of a camera through pixel centres."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Vector
from jaart.core.kernels.vectors import along, scaled

#: A block of pixels has so many along each edge.
EDGE = 8


class View(NamedTuple):
    """A camera as the kernel takes it.

    right, up, forward: its frame; pixel: a pixel's edge, at distance 1 from the eye or in cells;
    parallel: 1 when all rays run forward; width, height: of the picture in pixels.
    """

    eye: Vector
    right: Vector
    up: Vector
    forward: Vector
    pixel: float
    parallel: int
    width: int
    height: int


@kernel(STRICT, inline=True)
def ray_at(view: View, x: float, y: float) -> tuple[Vector, Vector]:
    """Origin and unit direction of the ray through a place of the picture, in pixels from its upper left corner."""
    across, up = (x - 0.5 * view.width) * view.pixel, (0.5 * view.height - y) * view.pixel
    aside = (across * view.right[0] + up * view.up[0], across * view.right[1] + up * view.up[1],
             across * view.right[2] + up * view.up[2])
    if view.parallel:
        return along(view.eye, aside, 1.0), view.forward
    return view.eye, scaled(along(view.forward, aside, 1.0), 1.0 / sqrt(1.0 + across * across + up * up))


@kernel(STRICT, entry=True)
def write_rays(view: View, pixels: NDArray[np.int64], rows: NDArray[np.int64], origins: Array, directions: Array,
               blocks: Array, begins: Array) -> None:
    """Write origin and unit direction of the ray through each pixel into a row of (R, 3).

    pixels: numbers x + y·width counted row by row from the top; rows: one for each; blocks: t before which no ray of a
    block of EDGE × EDGE pixels can meet anything (beams.empty_until), or (0, 0); begins: (R,) gets that of its block.
    """
    for i in range(pixels.shape[0]):
        number, row = pixels[i], rows[i]
        x, y = number % view.width, number // view.width
        o, d = ray_at(view, x + 0.5, y + 0.5)
        for axis in range(3):
            origins[row, axis], directions[row, axis] = o[axis], d[axis]
        if blocks.size > 0:
            begins[row] = blocks[y // EDGE, x // EDGE]
