"""Small scenes for the cases, and rays shot into them."""

from __future__ import annotations

from typing import Any

import numpy as np

from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.samples import fibonacci
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings


def cloud(points: Any, normals: Any = None) -> Scene:
    """A cloud of points (N, 3) with or without unit normals (N, 3)."""
    return Scene("case", points=np.array(points, float), normals=None if normals is None else np.array(normals, float))


def sphere(count: int, radius: float = 1.0) -> Scene:
    """Points spread evenly over a sphere about the origin, normals outwards."""
    around = fibonacci(count)
    return cloud(radius * around, around)


def plane(half: int = 4, spacing: float = 1.0, height: float = 0.0) -> Scene:
    """An even square of (2·half + 1)² points at z = height, normals up."""
    steps = spacing * np.arange(-half, half + 1)
    x, y = (a.ravel() for a in np.meshgrid(steps, steps, indexing="ij"))
    return cloud(np.column_stack((x, y, np.full(len(x), height))), np.tile((0.0, 0.0, 1.0), (len(x), 1)))


def shot(scene: Scene, chosen: Settings, origins: Any, directions: Any, threads: int | None = None) -> Hits:
    """Where rays (R, 3), or a single one (3,), meet a scene."""
    rays: tuple[Array, Array] = (np.atleast_2d(np.array(origins, float)), np.atleast_2d(np.array(directions, float)))
    return render(scene, chosen, rays=rays, threads=threads)
