"""Rays through small scenes at tight settings, with the oracle that their hits are held against."""

from __future__ import annotations

import numpy as np

from jaart.core.records import Hits, Trace
from jaart.core.render import render
from jaart.core.settings import Settings
from jaart.core.trace import trace
from tests.core.oracle_scene import Array, Oracle, grazing_rays, rays_of, scene_of

TIGHT = Settings(tolerance=1e-10, max_iterations=100, max_off_centre="none", border="closed", radius=2.5)
H = 0.8


def rays(name: str, count: int = 60) -> tuple[Array, Array]:
    """Rays through a scene, grazing ones included."""
    if name == "standard":
        return tuple(np.concatenate(pair) for pair in zip(rays_of(np.full(3, 12.0), count), grazing_rays(24),
                                                          strict=True))  # type: ignore[return-value]
    return rays_of(np.array([7.0, 5.0, 6.0]), count)


def rendered(name: str, settings: Settings, count: int = 60) -> tuple[Hits, Oracle]:
    """The hits of those rays, and the oracle."""
    return render(scene_of(name), settings, rays=rays(name, count)), Oracle.of(scene_of(name), settings)


def traced(name: str, settings: Settings, hits: Hits, i: int) -> Trace:
    """One of the rays with its steps."""
    return trace(scene_of(name), settings, hits.origin[i], hits.direction[i])
