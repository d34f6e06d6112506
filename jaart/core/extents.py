"""How large a scene is, in the units of its lengths."""

from __future__ import annotations

import numpy as np

from jaart.core import cloud
from jaart.core.errors import SettingsError
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings


def raster(scene: Scene, settings: Settings) -> int:
    """Cells along each edge of a model's lattice."""
    assert scene.model is not None
    return scene.model.raster if settings.raster == "file" else int(settings.raster)


def extent(scene: Scene, settings: Settings) -> tuple[float, float, float]:
    """Size of a scene along x, y, z: cells, or cloud units."""
    low, high = bounds(scene, settings)
    x, y, z = (high - low).tolist()
    return x, y, z


def bounds(scene: Scene, settings: Settings) -> tuple[Array, Array]:
    """Lowest and highest corner (3,) of a scene; a lattice begins at (0, 0, 0)."""
    if scene.kind == "cloud":
        return cloud.bounds(scene)
    shape = (raster(scene, settings),) * 3 if scene.levels is None else scene.levels.shape
    return np.zeros(3), np.array(shape) * np.array(edges(scene))


def edges(scene: Scene) -> tuple[float, float, float]:
    """Edges of a lattice's cell along x, y, z in units of the longest, in which the lattice's lengths count."""
    x, y, z = scene.spacing
    longest = max(x, y, z)
    return x / longest, y / longest, z / longest


def diagonal(scene: Scene, settings: Settings) -> float:
    """Length of the diagonal of the scene's box: the unit "d" of lengths."""
    low, high = bounds(scene, settings)
    return float(np.linalg.norm(high - low))


def spacing(scene: Scene) -> float:
    """The unit "s" of lengths: a cell, or a cloud's mean spacing. Raises SettingsError for a cloud without any."""
    if scene.kind != "cloud":
        return 1.0
    found = cloud.spacing(scene)
    if found == 0:
        raise SettingsError(f"h: {scene.source} has no two points apart, so no spacing; expected h as a number")
    return found


def largest(scene: Scene, settings: Settings) -> float:
    """The largest coordinate that is computed with: clouds are computed about their middle."""
    return max(extent(scene, settings))


def cloud_h(scene: Scene) -> float:
    """The feature size of a cloud where nobody says. Raises SettingsError for a cloud without spacing."""
    spacing(scene)
    return cloud.auto_h(scene)
