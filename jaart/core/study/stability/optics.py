"""Rows 47 to 49 and 66: refraction at its limits, and lights at or in the surface."""

from __future__ import annotations

import math

import numpy as np

from jaart.core.colours import Bytes
from jaart.core.environment import Environment
from jaart.core.optics import dots, split
from jaart.core.parameter import Length
from jaart.core.picture import picture
from jaart.core.records import Hits
from jaart.core.scene import Array, Model, Scene
from jaart.core.secondary import tracer
from jaart.core.settings import Settings, preset
from jaart.core.shade import shade
from jaart.core.shapes import Sphere
from jaart.core.study.stability.case import Outcome, case, largest
from jaart.core.study.stability.scenes import plane, shot
from jaart.core.water import water

#: Water's index of refraction.
IOR = 1.33


@case(47, "1001 rays at the critical angle of water, 48.75°, and within 500 ulp of it",
      "no NaN, |t| = 1, shares of light in [0, 1]")
def refraction_exactly_at_the_critical_angle() -> Outcome:
    """At the angle itself and above it by rounding the radicand is negative: it counts as 0."""
    sine = 1 / IOR + np.arange(-500, 501) * np.spacing(1 / IOR)
    turn = np.linspace(0, 2 * math.pi, len(sine))
    up = np.column_stack((np.cos(turn), np.zeros(len(turn)), np.sin(turn)))
    aside = np.column_stack((np.sin(turn), np.zeros(len(turn)), -np.cos(turn)))
    both = split(sine[:, None] * aside - np.sqrt((1 - sine) * (1 + sine))[:, None] * up, up, IOR)
    off = largest(_off_unit(both.refracted), _off_unit(both.reflected))
    share = both.reflectance
    total = int((share == 1).sum())
    fine = bool(np.isfinite(share).all()) and share.min() > 1 - 1e-5 and share.max() <= 1
    return Outcome(f"|t| - 1 up to {off:.1e}, share mirrored {share.min():.9f} to {share.max():.9f}, "
                   f"{total} of {len(share)} mirrored whole", fine and off <= 4e-16 and 0 < total < len(share))


@case(48, "normals of length 1 + 1e-8 in Snell's law, 30 times from air into water and back",
      "|t| = 1 after every bounce")
def normals_a_little_too_long_in_snells_law() -> Outcome:
    """Normals are made unit ones first: else |t| drifts, by the same factor at each bounce."""
    ray, worst = np.array([[0.6, 0.0, -0.8]]), 0.0
    for bounce in range(60):
        turn = 0.1 * bounce
        normal = np.array([[0.1 * math.sin(turn), 0.1 * math.cos(turn), 1.0]])
        normal *= (1 + 1e-8) / np.linalg.norm(normal)
        ray = split(ray, normal, 1 / IOR if bounce % 2 == 0 else IOR).refracted
        worst = largest(worst, _off_unit(ray))
    return Outcome(f"|t| - 1 up to {worst:.1e} in 60 bounces", worst <= 4e-16)


@case(49, "a ray that is mirrored whole at every bounce within a ball, followed 64 times",
      "it ends at the depth allowed, at most 64, which is counted; the light that leaves is all that came")
def whispering_gallery() -> Outcome:
    """Rays are followed generation by generation, so that no call stack bounds the depth.

    Nothing is absorbed, for absorption counts by the width of the box, which is 2e30 here.
    """
    scene = Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.3),), 24))
    settings = preset("best").replace(shading="water", specular=0.0, depth=64, tolerance=1e-6)
    hits = shot(scene, settings, (12.0, 12.0, 18.9), (1.0, 0.0, 0.0))
    seen = water(hits, settings, _White(np.full(3, -1e30), np.full(3, 1e30)), tracer(scene, settings))
    error = float(np.abs(seen.colour - 1).max())
    return Outcome(f"{seen.rays} rays, depth reached by {seen.deep}, faint {seen.faint}, lost {seen.lost}; "
                   f"light {seen.colour[0, 0]:.15f}", (seen.rays, seen.deep) == (64, 1) and error <= 1e-13)


@case(66, "a light at the hit point itself, 1e-320 beneath it, and one within a ball that is seen from outside",
      "they add nothing: the picture is that of the ambient light alone")
def light_at_the_hit_and_light_inside() -> Outcome:
    """A light without a direction lights nothing, and neither does one on the surface's other side."""
    at = shot(plane(), Settings(h=Length(1.0)), (0.0, 0.0, 5.0), (0.0, 0.0, -1.0))
    same = sum((_lit(at, place) == _ambient(at)).all() for place in ((0.0, 0.0, 0.0), (0.0, 0.0, -1e-320)))
    scene = Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.3),), 16))
    hits, colours = picture(scene, Settings(light=((8.0, 8.0, 8.0),), shadows=True), size=(48, 48))
    front = hits.hit & (dots(hits.normal, hits.direction) < 0)
    dark = (colours == _ambient(hits)).all(axis=2).ravel() & front
    return Outcome(f"at the hit: {same} of 2 as without light; inside: {dark.sum()} of {front.sum()} pixels of the "
                   "ball", bool(same == 2 and (at.point == 0).all() and front.sum() > 100 and (dark == front).all()))


class _White(Environment):
    """The same light from everywhere: what arrives is the energy that is left."""

    def colour(self, origin: Array, direction: Array) -> Array:
        """Linear light 1 (R, 3)."""
        return np.ones(origin.shape)


def _lit(hits: Hits, light: tuple[float, float, float]) -> Bytes:
    return shade(hits, settings=hits.settings.replace(light=(light,)))


def _ambient(hits: Hits) -> Bytes:
    return shade(hits, settings=hits.settings.replace(diffuse=0.0, specular=0.0, shadows=False))


def _off_unit(vectors: Array) -> float:
    """How far the longest or shortest of vectors (N, 3) is from length 1; NaN where one is."""
    return float(np.abs(np.sqrt(dots(vectors, vectors)) - 1).max())
