"""The rays of a camera through pixel centres."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Vector


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


@kernel(STRICT, entry=True)
def write_rays(view: View, pixels: NDArray[np.int64], rows: NDArray[np.int64], origins: Array,
               directions: Array) -> None:
    """Write origin and unit direction of the ray through each pixel into a row of (R, 3).

    pixels: numbers x + y·width counted row by row from the top; rows: one for each.
    """
    for i in range(pixels.shape[0]):
        number, row = pixels[i], rows[i]
        x = (number % view.width + 0.5 - 0.5 * view.width) * view.pixel
        y = (0.5 * view.height - number // view.width - 0.5) * view.pixel
        per_length = 1.0 if view.parallel else 1.0 / sqrt(1.0 + x * x + y * y)
        for axis in range(3):
            aside = x * view.right[axis] + y * view.up[axis]
            origins[row, axis] = view.eye[axis] + (aside if view.parallel else 0.0)
            directions[row, axis] = (view.forward[axis] + (0.0 if view.parallel else aside)) * per_length
