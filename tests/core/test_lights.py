"""Lights as points see them, and shadows against exact balls."""

from __future__ import annotations

import math

import numpy as np
import pytest
from exact_rays import exact_hits, shooting_at
from numpy.typing import NDArray

from jaart.core.io import load
from jaart.core.lights import lights, shadows_wanted
from jaart.core.optics import dots, unit
from jaart.core.phong import WATER, blue, phong
from jaart.core.render import render
from jaart.core.secondary import Tracer, beside, blocked, tracer
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere

Array = NDArray[np.float64]
EYE = np.array([[0.0, 0.0, 10.0]])
POINT, NORMAL = np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]])


def seen(settings: Settings, rays: Tracer | None = None) -> Array:
    """Linear light of a point at the origin that faces the viewer at EYE."""
    about = lights(settings, POINT, NORMAL, unit(EYE), EYE, rays)
    return phong(about, NORMAL, unit(EYE), settings)[0]


def test_a_light_by_hand() -> None:
    light, = lights(Settings(light=((3, 0, 4),)), POINT, NORMAL, EYE, EYE)
    assert np.allclose(light.towards, [[0.6, 0, 0.8]]) and light.distance == pytest.approx(5) and light.share == 1
    headlight, = lights(Settings(), POINT, NORMAL, EYE, EYE)
    assert headlight.towards.tolist() == [[0, 0, 1]] and headlight.distance == 10


def test_several_lights_add_up() -> None:
    first, second = (7.0, 0.0, 7.0), (-1.0, 2.0, 9.0)
    one, other, both = (seen(Settings(light=light)) for light in ((first,), (second,), (first, second)))
    assert both + 0.15 * WATER == pytest.approx(one + other, rel=1e-14)
    twice = Settings(light=(first, second))
    assert blue(lights(twice, POINT, NORMAL, EYE, EYE), NORMAL)[0].tolist() == [0, 0, 1]  # 0.71 + 0.97, no more than 1


@pytest.mark.parametrize("light", [(0, 0, 0), (0, 0, -1e-320), (1e200, 0, -1e200)])
def test_a_light_at_or_behind_the_point_adds_nothing(light: tuple[float, float, float]) -> None:
    assert seen(Settings(light=(light,))) == pytest.approx(0.15 * WATER, rel=1e-14)


def test_a_light_inside_a_ball_lights_nothing_outside() -> None:
    hits = render(load("standard"), size=(60, 60))
    middle = np.array([11.2, 11.2, 11.2])
    at = np.flatnonzero(hits.hit & (np.abs(np.linalg.norm(hits.point - middle, axis=1) - 4) < 0.5)
                        & (dots(hits.normal, hits.direction) < 0))
    normal, view = hits.normal[at], -hits.direction[at]
    about = lights(Settings(light=(tuple(middle),)), hits.point[at], normal, view, hits.origin[at])
    assert len(at) > 200
    assert np.allclose(phong(about, normal, view, Settings()), 0.15 * WATER, rtol=1e-14)


def test_an_eclipse_is_where_it_must_be() -> None:
    moon, sun = Sphere((0, 0, 5), 0.5), np.array([0.0, 0.0, 10.0])
    random = np.random.default_rng(6)
    start = np.column_stack([random.uniform(-2, 2, (4000, 2)), np.zeros(4000)])
    towards = unit(sun - start)
    rays = Tracer(shooting_at(moon), 1e-9, 1e-3)
    dark = blocked(rays, start, towards, np.zeros(4000, bool), np.linalg.norm(sun - start, axis=1))
    off_axis = np.abs(np.linalg.norm(np.cross(towards, np.array([[0, 0, 5.0]]) - start), axis=1))
    assert np.array_equal(dark, off_axis < 0.5) and 100 < dark.sum() < 3000


def test_what_stands_behind_the_light_throws_no_shadow() -> None:
    rays = Tracer(shooting_at(Sphere((0, 0, 5), 0.5)), 1e-9, 1e-3)
    start, up = np.zeros((4, 3)), np.array([[0.0, 0.0, 1.0]] * 4)
    distance = np.array([4.0, 4.6, 5.6, 20.0])
    assert blocked(rays, start, up, np.zeros(4, bool), distance).tolist() == [False, True, True, True]


def test_a_shadow_leaves_the_ambient_light_alone() -> None:
    settings = Settings(light=((0, 1, 8), (9, 0, 2)), shadows=True)
    rays = Tracer(shooting_at(Sphere((0, 0.5, 4), 0.3)), 1e-9, 1e-3)
    assert seen(settings, rays) == pytest.approx(seen(Settings(light=((9, 0, 2),))), rel=1e-14)
    blind = Tracer(shooting_at(Sphere((0, 0.5, 4), 0.3), Sphere((4.5, 0, 1), 0.3)), 1e-9, 1e-3)
    assert seen(settings, blind) == pytest.approx(0.15 * WATER, rel=1e-14)


def test_a_viewer_behind_the_surface_sees_the_shadows_there() -> None:
    rays = Tracer(shooting_at(Sphere((0, 0, 4), 0.3)), 1e-9, 1e-3)
    dark, lit = lights(Settings(light=((0, 0, 8), (9, 0, 2)), shadows=True), POINT, -NORMAL, EYE, EYE, rays)
    assert dark.share == 0 and lit.share == 1


def test_an_exact_ball_shades_only_its_far_side() -> None:
    ball = Sphere((0, 0, 0), 3)
    random = np.random.default_rng(7)
    normal = unit(random.normal(size=(2000, 3)))
    sun = np.array([20.0, 5, 9])
    towards = unit(sun - 3 * normal)
    rays = Tracer(shooting_at(ball), 1e-9, 1e-6)
    dark = blocked(rays, beside(3 * normal, normal, np.zeros(2000, bool), rays.offset), towards, np.zeros(2000, bool),
                   np.linalg.norm(sun - 3 * normal, axis=1))
    facing = dots(normal, towards)
    assert not dark[facing > 1e-4].any() and dark[facing < -1e-4].all()


@pytest.mark.parametrize("tolerance", [0.125, 1e-3, 1e-9])
def test_the_traced_ball_throws_no_shadow_on_its_lit_side(tolerance: float) -> None:
    scene, settings = load("standard"), Settings(tolerance=tolerance)
    hits = render(scene, settings, size=(150, 150))
    ball = exact_hits([Sphere((11.2, 11.2, 11.2), 4.0)], hits.origin, hits.direction).hit
    at = np.flatnonzero(hits.hit & ball)
    normal, eye = hits.normal[at], hits.origin[at]
    light, = lights(Settings(light=((30, -30, 40),), shadows=True), hits.point[at], normal, -hits.direction[at], eye,
                    tracer(scene, settings))
    facing = dots(normal, light.towards)
    assert len(at) > 1000 and (light.share[facing > 0.15] == 1).mean() > 0.99


def test_only_lights_with_a_place_throw_shadows() -> None:
    assert not shadows_wanted(Settings(shadows=True))
    assert not shadows_wanted(Settings(light=((1, 2, 3),)))
    assert shadows_wanted(Settings(light=((1, 2, 3),), shadows=True))
    assert math.isfinite(seen(Settings(shadows=True)).sum())
