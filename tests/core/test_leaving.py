"""Rays that start on the surface, just above it, or within the object."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from jaart.core.records import STATUS, Hits
from jaart.core.render import render
from jaart.core.samples import fibonacci
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from jaart.core.trace import trace

EXACT = ("iterate", "secant", "newton", "safe")
FINE = Settings(tolerance=1e-12, max_iterations=100)


@cache
def scene(name: str) -> Scene:
    around = fibonacci(400)
    return {"cloud": Scene("cloud", points=around, normals=around),
            "far": Scene("far", points=around + 1e6, normals=around),
            "lattice": Scene("lattice", model=Model((Sphere((0.5, 0.5, 0.5), 0.25),), 16))}[name]


def frame(name: str) -> tuple[float, float, Settings]:
    """Middle, radius and settings of the sphere."""
    if name == "lattice":
        return 8.0, 4.0, FINE.replace(h=0.8, radius=6)
    return (1e6 if name == "far" else 0.0), 1.0, FINE.replace(h="0.1d")


def on_surface(name: str) -> Hits:
    middle, radius, settings = frame(name)
    around = fibonacci(40)
    hits = render(scene(name), settings.replace(search="newton", tolerance=0),
                  rays=(middle + 3 * radius * around, -around))
    assert hits.hit.all()
    return hits


@pytest.mark.parametrize("search", EXACT)
@pytest.mark.parametrize("name", ["cloud", "far", "lattice"])
def test_a_ray_does_not_meet_the_surface_that_it_starts_on(name: str, search: str) -> None:
    on, (_, radius, settings) = on_surface(name), frame(name)
    settings = settings.replace(search=search)
    assert not render(scene(name), settings, rays=(on.point, on.normal)).hit.any()
    inwards = render(scene(name), settings, rays=(on.point, -on.normal))
    assert (inwards.t > 1.5 * radius).all()


@pytest.mark.parametrize("tolerance", [1e-12, 1e-2, 0.125])
@pytest.mark.parametrize("search", EXACT)
@pytest.mark.parametrize("name", ["cloud", "lattice"])
def test_a_surface_just_ahead_is_met_however_near_it_is(name: str, search: str, tolerance: float) -> None:
    on, (_, _, settings) = on_surface(name), frame(name)
    settings = settings.replace(search=search, tolerance=tolerance)
    for height in (1e-2, 1e-6, 1e-9):
        hits = render(scene(name), settings, rays=(on.point + height * on.normal, -on.normal))
        assert hits.hit.all(), height
        assert hits.t == pytest.approx(np.full(40, height), abs=tolerance), height


@pytest.mark.parametrize("method", ["tangent", "off_centre", "mahalanobis"])
def test_an_energys_minimum_is_not_met_again(method: str) -> None:
    around = fibonacci(60)
    settings = FINE.replace(h="0.1d", search="minimise", method=method, max_off_centre="none", max_nearest="none")
    on = render(scene("cloud"), settings.replace(tolerance=1e-14), rays=(3 * around, 0.2 - around))
    assert on.hit.sum() >= 20
    back = on.point[on.hit], -on.direction[on.hit]  # along the same line, the only one whose minimum it is
    assert not render(scene("cloud"), settings, rays=back).hit.any()


def test_the_look_at_the_origin_is_counted_and_only_taken_where_a_hit_is_near() -> None:
    on, (_, _, settings) = on_surface("lattice"), frame("lattice")
    for height, looks in ((1e-3, 1), (0.5, 0)):
        hits = render(scene("lattice"), settings.replace(search="secant"),
                      rays=(on.point + height * on.normal, -on.normal))
        steps = [trace(scene("lattice"), hits.settings, *ray).steps for ray in zip(hits.origin, hits.direction,
                                                                                   strict=True)]
        assert hits.hit.all() and (hits.evaluations - steps == looks).all()


def test_the_side_that_a_ray_sees_is_known() -> None:
    around = fibonacci(30)
    settings = frame("cloud")[2]
    within = render(scene("cloud"), settings, rays=(0 * around, around))
    outside = render(scene("cloud"), settings, rays=(3 * around, -around))
    beside = render(scene("cloud"), settings, rays=(3 * around, around))
    assert within.from_behind.all() and not outside.from_behind.any() and not beside.from_behind.any()
    assert (beside.status == STATUS["background"]).all()


def test_a_trace_of_a_ray_from_the_surface_is_the_renders() -> None:
    on, (_, _, settings) = on_surface("cloud"), frame("cloud")
    hits = render(scene("cloud"), settings, rays=(on.point, -on.normal))
    for i in (0, 11, 31):
        assert trace(scene("cloud"), settings, on.point[i], -on.normal[i]).t == hits.t[i]
