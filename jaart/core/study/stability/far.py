"""Rows 1 to 7: h far below or above all distances."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from jaart.core.notes import notes
from jaart.core.render import render
from jaart.core.samples import fibonacci
from jaart.core.scene import Array, Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from jaart.core.study.stability.case import Outcome, case, counted, error_of, largest
from jaart.core.study.stability.scenes import cloud, plane, shot, sphere
from jaart.core.trace import trace

#: What a hit far from its surfels needs: a neighbourhood that reaches them, and no bound on their distance.
FREE = Settings(max_nearest="none", max_off_centre="none")
DOWN = (0.0, 0.0, -1.0)
H_MUST = "h must be a finite number above 0, said in one line"


@case(1, "h = 0.02 spacings, rays from 5 away", "the plane of the nearest surfel: its t, to 1e-15 of it")
def h_of_a_fiftieth_spacing() -> Outcome:
    """Surfels at different heights, each 18 h from its ray.

    All other weights are below exp(-1000) of its own, so the nearest surfel alone says where the surface is. With
    the radius that is taken when nobody says, 4 h, the same rays end without a hit, as few_neighbours: a hole.
    """
    i, j = (a.ravel() for a in np.meshgrid(np.arange(-3, 4), np.arange(-3, 4), indexing="ij"))
    points = np.column_stack((i, j, 0.125 * ((i + 2 * j) % 3)))
    scene = cloud(points, np.tile((0.0, 0.0, 1.0), (len(points), 1)))
    aimed = points[np.abs(points[:, :2]).max(axis=1) <= 1]
    rays = aimed * (1, 1, 0) + (0.3, 0.2, 5.0)
    errors, settings = [], FREE.replace(h=0.02, radius=5.0, tolerance=1e-12)
    for search in ("iterate", "safe", "newton"):
        hits = shot(scene, settings.replace(search=search), rays, np.tile(DOWN, (len(rays), 1)))
        errors.append(float(np.abs(hits.t / (5.0 - aimed[:, 2]) - 1.0).max()))
    holes = shot(scene, Settings().replace(h=0.02), rays, np.tile(DOWN, (len(rays), 1))).counts()
    return Outcome(f"{len(rays)} rays, 3 searches: largest error of t {largest(errors):.1e} of it; with the usual "
                   f"radius {counted(holes)}",
                   largest(errors) <= 1e-15 and holes == {"few_neighbours": len(rays)})


@case(2, "f at 15.5, 21 and 22 cells from a plane, h = 0.8: up to 27.5 h", "f = -15.5, -21, -22, to 2 ulp of t")
def f_beyond_where_gaussians_underflow() -> Outcome:
    """f = -e_ts of a ray that goes straight down; exp(-756), the weight of the nearest at 27.5 h, is no float64."""
    got = {distance: _f_above(distance, level) for distance, level in ((15.5, 0.5), (21.0, 1.0), (22.0, 1.0))}
    shown = ", ".join(f"{value:.16g}" for value in got.values())
    return Outcome(f"f = {shown}", all(abs(value + distance) <= 1e-14 for distance, value in got.items()))


def _f_above(distance: float, level: float) -> float:
    """f so far above a level sea of fill levels, whose highest cells are filled to a level."""
    levels = np.zeros((9, 9, 40))
    levels[:, :, :8], levels[:, :, 8] = 1.0, level
    settings = FREE.replace(h=0.8, radius=40.0, search="safe")
    followed = trace(Scene("sea", levels=levels), settings, (4.5, 4.5, 40.0), DOWN)
    at = int(np.nanargmin(np.abs(followed.curves.t - (40.0 - 8.0 - level - distance))))
    return -float(followed.curves.tangent[at])


@case(3, "h = 1e-160", "one error: h is too small for the coordinates")
def h_too_small_for_its_square() -> Outcome:
    """(q/h)² would overflow; 1e-99, which is just allowed, still gives the plane exactly."""
    message = error_of(lambda: shot(plane(), Settings().replace(h=1e-160), (0, 0, 5), DOWN))
    least = shot(plane(), FREE.replace(h=1e-99, radius=5.0), (0.3, 0.2, 5), DOWN)
    return Outcome(f"{message}; h = 1e-99: t = {least.t[0]:.16g}",
                   message.startswith("h = 1e-160: too small for coordinates") and least.t[0] == 5.0)


@case(4, "h = 0, NaN, infinity", H_MUST)
def h_that_is_no_length() -> Outcome:
    """Refused where settings are made, before anything is computed."""
    return _refused_h(0, math.nan, math.inf, "nan", "0s")


@case(5, "h = -0.8", H_MUST)
def h_below_0() -> Outcome:
    """h² would be that of 0.8, so a slip of the pen would not be seen."""
    return _refused_h(-0.8, "-0.8", "-1d")


def _refused_h(*values: float | str) -> Outcome:
    def typed(value: float | str) -> Callable[[], object]:
        return lambda: Settings().replace(h=value)

    messages = [error_of(typed(value)) for value in values]
    clear = [m.startswith("h = ") and "a finite number > 0" in m and "\n" not in m
             for m in messages]
    return Outcome(f"{sum(clear)} of {len(values)} refused; {messages[0]}", all(clear))


@case(6, "h = 1000, a sphere of radius 1", "a note that h is larger than all the points, and no hit")
def h_of_a_thousand_models() -> Outcome:
    """Points in opposite pairs, whose normals cancel but for what the weights differ: |Σθn| is about 1e-6 of Σθ.

    In an unpaired sample the little that does not cancel is the same everywhere: f = 0 on a plane through the middle,
    which is that sample's true surface. So the note speaks of a flat one.
    """
    around = fibonacci(1000)
    scene, (origins, directions) = cloud(np.vstack((around, -around)), np.vstack((around, -around))), _past(1.0, 200)
    settings = Settings().replace(h=1000.0)
    hits = sum(np.count_nonzero(shot(scene, settings.replace(search=search), origins, directions).hit)
               for search in ("iterate", "safe"))
    said = notes(scene, settings)
    return Outcome(f"{hits} of 400 rays hit; {said[0] if said else 'no note'}",
                   hits == 0 and len(said) == 1 and said[0].startswith("h = 1000 is larger than all the points"))


@case(7, "spheres of 1.0, 1.1, 1.2 and 1.22 h, and a model's sphere of 1.1 h",
      "no hit, and of the model a note that names the radius √1.5 h = 1.2247 h at which spheres collapse")
def spheres_too_small_for_h() -> Outcome:
    """Rays at 0.05 to 1 h from the middle. Nearer to it an uneven sample leaves a speck of f = 0: of 400 points, 1.22 h
    in radius, one of 0.014 h.
    """
    origins, directions = _past(1.0, 200, least=0.05)
    hits = [int(shot(sphere(400, radius), FREE.replace(h=1.0, search="safe", ball_k=100), origins,
                     directions).hit.sum()) for radius in (1.0, 1.1, 1.2, 1.22)]
    model = Scene("case", model=Model((Sphere((0.5, 0.5, 0.5), 3 / 24),), 24))
    settings = Settings().replace(h=3 / 1.1, search="safe")
    seen, said = int(render(model, settings, size=(48, 48)).hit.sum()), notes(model, settings)
    return Outcome(f"{sum(hits)} of 800 rays hit, {seen} of 2304 pixels; {'; '.join(said)}",
                   not any(hits) and seen == 0 and len(said) == 1
                   and f"spheres below {math.sqrt(1.5) * 3 / 1.1:.4g} (1.225 h) collapse" in said[0])


def _past(radius: float, count: int, least: float = 0.0) -> tuple[Array, Array]:
    """Rays from all around that pass the middle of a sphere at distances from the least up to its radius."""
    directions = fibonacci(count)
    aside = np.cross(directions, np.roll(directions, 1, axis=1))
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    return np.linspace(least, radius, count)[:, None] * aside - 5 * radius * directions, directions
