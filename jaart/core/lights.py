"""Lights: where they stand as seen from points of the surface, and which points lie in the shadow of others."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jaart.core.optics import dots, unit
from jaart.core.secondary import Tracer, beside, blocked
from jaart.core.settings import Settings

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Light:
    """One light as N points see it.

    towards: unit directions to it (N, 3), zeros for a point at the light itself, which it does not reach;
    distance: (N,) in cells; share: of its light that arrives (N,), 0 in the shadow.
    """

    towards: Array
    distance: Array
    share: Array


def shadows_wanted(settings: Settings) -> bool:
    """Whether shadow rays are needed; the headlight throws no shadow that its eye sees."""
    return settings.shadows and settings.light != "headlight"


def lights(settings: Settings, point: Array, normal: Array, viewer: Array, eye: Array | None = None,
           tracer: Tracer | None = None) -> Iterator[Light]:
    """Each light of the settings in turn.

    point, normal: (N, 3) of the surface, normals outward; viewer: unit vectors (N, 3) to where each point is seen
    from; eye: (N, 3) where the headlight is, None for the viewer's place; tracer: for shadows, None for none.
    A light on the other side of the surface than the viewer needs no shadow ray, for it lights nothing seen.
    """
    if isinstance(settings.light, str):
        yield Light(viewer, np.full(len(point), np.inf), np.ones(len(point))) if eye is None else _seen(point, eye)
        return
    for position in np.atleast_2d(np.asarray(settings.light, dtype=np.float64)):
        light = _seen(point, position)
        if tracer is not None:
            side = np.copysign(1.0, dots(normal, viewer))
            lit = np.flatnonzero(side * dots(normal, light.towards) > 0)
            start = beside(point[lit], normal[lit], side[lit] < 0, tracer.offset)
            light.share[lit[blocked(tracer, start, light.towards[lit], side[lit] < 0, light.distance[lit])]] = 0.0
        yield light


def _seen(point: Array, position: Array) -> Light:
    way = np.broadcast_to(position, point.shape) - point
    towards = unit(way)
    return Light(towards, np.abs(dots(way, towards)), np.ones(len(point)))
