"""Water: each ray is split into a mirrored and a refracted one, again and again, generation by generation [T §2.1.2].

A ray carries a weight: what it still brings to its pixel, in red, green and blue. The rays of one generation are
traced together, so that neither depth nor number is bound by a call stack. Where an open border cuts through the
water there is no surface: rays pass it unbent.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from jaart.core.environment import Environment
from jaart.core.lights import lights, shadows_wanted
from jaart.core.optics import dots, split
from jaart.core.records import Hits
from jaart.core.secondary import Tracer, beside, first_hits
from jaart.core.settings import Settings
from jaart.core.telling import doing, tell

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Numbers = NDArray[np.intp]

#: Rays of a picture that are followed together.
PIECE = 1 << 17
#: A ray that brings less to its pixel is not followed.
FAINT = 1 / 512
#: Red, green and blue that the water takes along the scene's longest edge, as exponents [Beer and Lambert].
ABSORPTION = np.array((3.2, 0.85, 0.35))


@dataclass(frozen=True, eq=False)
class Radiance:
    """What the rays of a picture see.

    colour: linear light (R, 3); rays: how many were traced behind the first hits; deep, faint: how many were
    not followed because of the depth, or because they brought too little: these see what is behind the
    water; lost: how many changed between air and water where no surface was found.
    """

    colour: Array
    rays: int
    deep: int
    faint: int
    lost: int


@dataclass(frozen=True, eq=False)
class _Rays:
    """One generation: origin, direction, weight (R, 3), pixel (R,), whether they begin in the water (R,)."""

    origin: Array
    direction: Array
    weight: Array
    pixel: Numbers
    inside: Mask

    def __getitem__(self, which: Mask | Numbers) -> _Rays:
        return _Rays(self.origin[which], self.direction[which], self.weight[which], self.pixel[which],
                     self.inside[which])

    def __len__(self) -> int:
        return len(self.pixel)


class Water:
    """The rays of one picture on their way; see `water`."""

    def __init__(self, hits: Hits, settings: Settings, around: Environment, tracer: Tracer) -> None:
        self.hits, self.settings, self.around, self.tracer = hits, settings, around, tracer
        self.colour = np.zeros((len(hits), 3))
        self.rays = self.deep = self.faint = self.lost = 0

    def follow(self, pixels: slice) -> None:
        """Follow the rays of some pixels to their ends."""
        rays = self._first(pixels)
        t, normal = self.hits.t[pixels], self.hits.normal[pixels]
        for generation in range(self.settings.depth + 1):
            rays = self._without_faint(self._meet(rays, t, normal))
            if generation == self.settings.depth or not len(rays):
                break
            t, normal = first_hits(self.tracer, rays.origin, rays.direction, rays.inside)
            self.rays += len(rays)
        self.deep += len(rays)
        self._add(rays, self.around.colour(rays.origin, rays.direction))

    def _first(self, pixels: slice) -> _Rays:
        """The picture's own rays. One that comes through an open border is in the water from there on."""
        origin, direction = self.hits.origin[pixels], self.hits.direction[pixels]
        enter, leave = self.around.span(origin, direction)
        inside = (leave > 0) & self.around.in_water(origin + enter[:, None] * direction)
        return _Rays(origin, direction, np.ones(origin.shape), np.arange(len(self.hits))[pixels], inside)

    def _meet(self, rays: _Rays, t: Array, normal: Array) -> _Rays:
        """Give the pixels what the rays see at the end of their way; the rays that go on from there."""
        hit = np.isfinite(t)
        self._leave(rays[~hit])
        rays, t, normal = rays[hit], t[hit], normal[hit]
        enter, _ = self.around.span(rays.origin, rays.direction)
        rays = self._absorbed(rays, np.where(rays.inside, np.maximum(t - enter, 0.0), 0.0))
        point = rays.origin + t[:, None] * rays.direction
        entering = dots(normal, rays.direction) < 0
        ior = self.settings.ior
        both = split(rays.direction, normal, np.where(entering, 1 / ior, ior))
        self._highlight(rays[entering], point[entering], normal[entering], both.reflected[entering])
        share = both.reflectance[:, None]
        return _joined(
            _Rays(beside(point, normal, ~entering, self.tracer.offset), both.reflected, rays.weight * share,
                  rays.pixel, ~entering),
            _Rays(beside(point, normal, entering, self.tracer.offset), both.refracted, rays.weight * (1 - share),
                  rays.pixel, entering))

    def _leave(self, rays: _Rays) -> None:
        """Rays that meet no more surface see floor and sky, those that end in the water from the border on."""
        enter, leave = self.around.span(rays.origin, rays.direction)
        wet = self.around.in_water(rays.origin + leave[:, None] * rays.direction)
        change = np.where(rays.inside, leave, enter)
        lost = np.flatnonzero(rays.inside != wet)
        change[lost] = self.around.change(rays.origin[lost], rays.direction[lost], enter[lost], leave[lost])
        self.lost += len(lost)
        rays = self._absorbed(rays, np.where(wet, leave, change) - np.where(rays.inside, enter, change))
        self._add(rays, self.around.colour(rays.origin, rays.direction))

    def _absorbed(self, rays: _Rays, way: Array) -> _Rays:
        """The rays after so long a way through the water: exp(-a·way) of the light is left."""
        return replace(rays, weight=rays.weight * np.exp(-(way / self.around.edge)[:, None] * ABSORPTION))

    def _highlight(self, rays: _Rays, point: Array, normal: Array, reflected: Array) -> None:
        """The lights' own mirror images, k_s <r, v>^α as in [T 2.4]."""
        settings, eye = self.settings, self.hits.origin[rays.pixel]
        tracer = self.tracer if shadows_wanted(settings) else None
        for light in lights(settings, point, normal, -rays.direction, eye, tracer):
            seen = np.clip(dots(reflected, light.towards), 0.0, 1.0) ** settings.shininess
            self._add(rays, np.repeat((settings.specular * light.share * seen)[:, None], 3, axis=1))

    def _without_faint(self, rays: _Rays) -> _Rays:
        """The rays that bring something; those that bring little see what is behind the water."""
        brings = rays.weight.max(axis=1, initial=0.0)
        faint = rays[(brings < FAINT) & (brings > 0)]
        self.faint += len(faint)
        self._add(faint, self.around.colour(faint.origin, faint.direction))
        return rays[brings >= FAINT]

    def _add(self, rays: _Rays, seen: Array) -> None:
        if not len(rays):
            return
        first = int(rays.pixel.min())
        for channel in range(3):
            sums = np.bincount(rays.pixel - first, rays.weight[:, channel] * seen[:, channel])
            self.colour[first:first + len(sums), channel] += sums


@doing("light through water")
def water(hits: Hits, settings: Settings, around: Environment, tracer: Tracer) -> Radiance:
    """What the rays of a picture see of the water and of what is around it.

    hits: their first hits, normals outward of the water; settings: depth, ior, lights, specular, shininess,
    shadows; around: sky and floor; tracer: traces the rays behind the first hits. Light is shared between the
    rays by Fresnel's equations, and no ray that is cut off takes any away. Raises Cancelled with the tracer.
    """
    work = Water(hits, settings, around, tracer)
    for begin in range(0, len(hits), PIECE):
        tell(begin, len(hits))
        work.follow(slice(begin, begin + PIECE))
    return Radiance(work.colour, work.rays, work.deep, work.faint, work.lost)


def _joined(a: _Rays, b: _Rays) -> _Rays:
    return _Rays(np.concatenate([a.origin, b.origin]), np.concatenate([a.direction, b.direction]),
                 np.concatenate([a.weight, b.weight]), np.concatenate([a.pixel, b.pixel]),
                 np.concatenate([a.inside, b.inside]))
