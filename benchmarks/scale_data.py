"""Scenes of any size for the table of scale: a lattice filled slab by slab, a cloud made piece by piece."""

from __future__ import annotations

import numpy as np

import jaart
from jaart.core import samples
from jaart.core.records import Array

#: Centre and radius, in edges of the lattice, of the ball and of the bowl hollowed out of it.
BALL, BOWL = ((0.5, 0.47, 0.5), 0.36), ((0.5, 0.83, 0.5), 0.3)
#: Points made at a time.
PIECE = 1 << 18


def scene_of(kind: str, size: int) -> jaart.Scene:
    """A "lattice" of size^3 cells, or a "cloud" of as many points."""
    return lattice(size) if kind == "lattice" else cloud(size)


def lattice(raster: int) -> jaart.Scene:
    """A ball with a bowl in it: levels of half-spaces at the surface's distance, one slab of cells at a time."""
    levels, at = np.empty((raster,) * 3), np.arange(raster) + 0.5
    y, z = at[:, None], at[None, :]
    for slab, x in zip(levels, at, strict=True):
        inside = np.maximum(_distance(BALL, raster, x, y, z), -_distance(BOWL, raster, x, y, z))
        np.clip(0.5 - inside, 0.0, 1.0, out=slab)
    levels.flags.writeable = False  # so that the scene keeps it and no copy
    return jaart.Scene(f"ball with a bowl {raster}^3", levels=levels)


def cloud(count: int) -> jaart.Scene:
    """The bumpy sphere, positions alone."""
    surface, points = samples.standard_bumps(), samples.fibonacci(count)
    for begin in range(0, count, PIECE):
        points[begin:begin + PIECE] = surface.points_along(points[begin:begin + PIECE])
    points.flags.writeable = False
    return jaart.Scene(f"bumpy {count:,}", points=points, exact=surface)


def _distance(ball: tuple[tuple[float, float, float], float], raster: int, x: float, y: Array, z: Array) -> Array:
    (a, b, c), radius = ball
    found: Array = np.sqrt((x - a * raster)**2 + (y - b * raster)**2 + (z - c * raster)**2) - radius * raster
    return found
