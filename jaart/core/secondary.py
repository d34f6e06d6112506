"""Rays that start on the surface: moved off it, and kept from meeting the sheet that they leave.

A hit is only as exact as the solver's tolerance, and the surface seen from a cell is not quite that seen from
the next one. So a ray starts a little aside, on its side of the surface. And it believes no hit that is nearer than
the feature size and shows the side that it cannot see: from the air a surface faces the ray, from the water it
is turned away.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from threading import Event

import numpy as np
from numpy.typing import NDArray

from jaart.core import extents
from jaart.core.chosen import arrival, chosen
from jaart.core.optics import dots
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.settings import Settings

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
#: Where rays meet the surface: origins (R, 3), unit directions (R, 3), whether any hit will do for the first.
Shoot = Callable[[Array, Array, bool], Hits]

#: A ray that met its own sheet goes on this share of the feature size farther along.
_ON = 0.25


def shooter(scene: Scene, settings: Settings, threads: int | None = None, cancel: Event | None = None) -> Shoot:
    """How a scene's rays are traced. The function returned raises Cancelled after cancel was set."""
    def shoot(origins: Array, directions: Array, any_hit: bool) -> Hits:
        return render(scene, settings, rays=(origins, directions), threads=threads, cancel=cancel, any_hit=any_hit)

    return shoot


@dataclass(frozen=True)
class Tracer:
    """How rays that start on the surface are traced, lengths in cells.

    shoot: traces a list of rays; offset: how far off the surface they start, above the error of a hit;
    near: up to where a hit that shows the wrong side is the sheet that the ray started from.
    """

    shoot: Shoot
    offset: float
    near: float


def tracer(scene: Scene, settings: Settings, threads: int | None = None, cancel: Event | None = None) -> Tracer:
    """The tracer of a scene: two tolerances aside, and no sheet is thinner than the feature size h."""
    rounding = 16 * float(np.spacing(np.abs(extents.bounds(scene, settings)).max()))
    values = chosen(scene, settings)
    offset = max(2 * arrival(values), rounding)
    near = max(values.h, 4 * offset)
    return Tracer(shooter(scene, settings, threads, cancel), offset, near)


def beside(point: Array, normal: Array, inside: Mask, offset: float) -> Array:
    """Points (N, 3) moved off the surface, against the outward normal where the ray goes inside."""
    return point + np.where(inside, -offset, offset)[:, None] * normal


def first_hits(tracer: Tracer, origin: Array, direction: Array, inside: Mask) -> tuple[Array, Array]:
    """Distance (R,) and outward normal (R, 3) of each first hit, NaN where there is none.

    origin, direction: (R, 3); inside: whether the ray starts in the water (R,). It steps over hits of its own
    sheet, each time by a share of the feature size, so that there are only few.
    """
    t, normal = np.full(len(origin), np.nan), np.full(origin.shape, np.nan)
    ahead, todo = np.zeros(len(origin)), np.arange(len(origin))
    while len(todo):
        way = direction[todo]
        found = tracer.shoot(origin[todo] + ahead[todo, None] * way, way, False)
        t[todo], normal[todo] = ahead[todo] + found.t, found.normal
        own = _own_sheet(tracer, found, t[todo], inside[todo])
        todo = todo[own]
        ahead[todo] = np.maximum(t[todo], ahead[todo]) + _ON * tracer.near  # a mean of points may lie behind
    return t, normal


def blocked(tracer: Tracer, origin: Array, direction: Array, inside: Mask, distance: Array) -> Mask:
    """Whether the surface stands between each origin and the point so far away along its direction (R,)."""
    found = tracer.shoot(origin, direction, True)
    own = _own_sheet(tracer, found, found.t, inside)
    known: Mask = found.hit & (found.t < distance) & ~own
    unsure = np.flatnonzero(found.hit & ~known)
    if len(unsure):
        t, _ = first_hits(tracer, origin[unsure], direction[unsure], inside[unsure])
        known[unsure] = t < distance[unsure]
    return known


def _own_sheet(tracer: Tracer, found: Hits, t: Array, inside: Mask) -> Mask:
    """Which hits are the sheet that the ray started from: close, and seen from the wrong side."""
    wrong: Mask = found.hit & (t < tracer.near)
    wrong &= (dots(found.normal, found.direction) > 0) != inside
    return wrong
