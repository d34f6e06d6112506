"""What can be seen of a scene, and the tolerance that is fine enough for it.

A search may end as soon as its next step is far below what anybody could see: a pixel, or the surface's own distance
from the true one, whichever is larger.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from jaart.core import extents
from jaart.core.camera import Camera
from jaart.core.groups.surface import FITTED
from jaart.core.scene import Array, Scene
from jaart.core.settings import PARAMETERS, Settings

#: A step that ends a search is at most this share of what can be seen; the hit is nearer yet, by the steps' shrinking.
SHARE = 0.1
#: Median distance of planes and of fitted polynomials from the true surface, in h² over the scene's longest edge: from
#: below, see benchmarks/auto.py. h²/2R is what a sphere shrinks by.
ERROR, FITTED_ERROR = 1.0, 1e-3
#: The coarsest tolerance, in h: the sources' own.
COARSEST = 0.125
#: The finest of a lattice, in h: f jumps by up to 0.008 h where cells' lists of surfels end at 3.125 h; of a cloud.
FINEST_LATTICE, FINEST_CLOUD = 2.0**-6, 2.0**-40


def pixel(scene: Scene, settings: Settings, camera: Camera, size: tuple[int, int]) -> float:
    """Edge of a pixel where the scene is nearest, in cells or cloud units; 0 from within the scene.

    size: (width, height) of the picture.
    """
    edge = camera.view(size).pixel
    if camera.ortho is not None:
        return edge
    low, high = extents.bounds(scene, settings)
    eye: Array = np.asarray(camera.eye)
    return edge * float(np.linalg.norm(eye - np.clip(eye, low, high)))


def model_error(scene: Scene, settings: Settings, h: float) -> float:
    """About how far the surface is from the true one, in cells or cloud units."""
    factor = FITTED_ERROR if settings.method in FITTED else ERROR
    return factor * h * h / max(extents.largest(scene, settings), h)


def tolerance(scene: Scene, settings: Settings, h: float, unit: float, edge: float = 0.0) -> tuple[float, str]:
    """The tolerance in units that is fine enough, a power of 2 so that it lasts while a camera moves, and why.

    h: feature size; unit: what the tolerance counts in; edge: of a pixel, 0 where there is no picture.
    """
    error = model_error(scene, settings, h)
    finest = FINEST_CLOUD if scene.kind == "cloud" else FINEST_LATTICE
    share = SHARE * max(edge, error) / unit
    found = min(max(2.0 ** math.floor(math.log2(max(share, finest))), finest), COARSEST)
    seen = f"a pixel, {edge:.2g}" if edge > error else f"the model's error, about {error:.2g}"
    if share < finest:
        return found, f"{seen}, is smaller than what f jumps by where neighbourhoods end"
    return found, f"at most {SHARE:g} of {seen}"


def seen(scene: Scene, settings: Settings, camera: Camera | None, size: tuple[int, int] | None) -> Settings:
    """The settings with the tolerance that a picture needs in the place of `auto`; as they are where it is set.

    camera, size: of the picture; None for rays without one, for which the model's error decides.
    """
    if settings.tolerance != "auto" or camera is None or size is None or not PARAMETERS["tolerance"].matters(settings):
        return settings
    return settings.replace(tolerance=for_picture(scene, settings, camera, size)[0])


def for_picture(scene: Scene, settings: Settings, camera: Camera | None,
                size: tuple[int, int] | None) -> tuple[float, str]:
    """The tolerance, in h, or in radii where these are shorter, that a picture or a list of rays needs, and why."""
    from jaart.core.chosen import chosen, unit_of

    values = chosen(scene, settings)
    edge = 0.0 if camera is None or size is None else pixel(scene, settings, camera, size)
    return tolerance(scene, settings, values.h, unit_of(values), edge)


def of_hits(scene: Scene, hits: Any) -> Settings:
    """The settings that hits were traced with."""
    return seen(scene, hits.settings, hits.camera, hits.size)
