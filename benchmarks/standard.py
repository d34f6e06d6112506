"""The standard model and the camera that the project's figures are taken with."""

from __future__ import annotations

import numpy as np

import jaart

SIZE = (512, 512)
RASTERS = (16, 32, 64)


def camera(raster: int) -> jaart.Camera:
    """The camera of the figures, given in units of the cube, for a raster."""
    eye = np.array((0.5, 0.58, 0.53)) + 2.2 * np.array((0.30, 0.25, 0.92))
    return jaart.Camera(eye=tuple(eye * raster), target=tuple(np.array((0.52, 0.59, 0.54)) * raster), fov=22)
