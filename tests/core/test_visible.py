"""The tolerance that is chosen from what can be seen."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import jaart
from jaart.core import prepare, visible
from jaart.core.camera import Camera
from jaart.core.chosen import COARSE, LATTICE_RADIUS, arrival, chosen
from jaart.core.extents import bounds
from jaart.core.picture import finish
from jaart.core.plan import plan
from jaart.core.render import render
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from jaart.core.trace import trace
from tests.core.cloud_scenes import fresh

AUTO = Settings(tolerance="auto")


def ball(raster: int = 12) -> Scene:
    return Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.3),), raster))


def test_a_pixel_is_as_wide_as_what_two_rays_are_apart_where_the_scene_is_nearest() -> None:
    scene, size = ball(), (40, 30)
    across = Camera(eye=(6.0, -20.0, 6.0), target=(6.0, 6.0, 6.0), fov=40.0)
    origin, direction = across.rays(size)
    middle = 15 * 40 + 20
    apart = np.linalg.norm(direction[middle] - direction[middle - 1]) * 20.0  # the box begins at y = 0
    assert visible.pixel(scene, AUTO, across, size) == pytest.approx(apart, rel=1e-3)
    flat = across.replace(ortho=10.0)
    origin, _ = flat.rays(size)
    assert visible.pixel(scene, AUTO, flat, size) == pytest.approx(np.linalg.norm(origin[1] - origin[0]), rel=1e-12)
    assert visible.pixel(scene, AUTO, across.replace(eye=(6.0, 1.0, 6.0)), size) == 0.0


@pytest.mark.parametrize("made", [ball, lambda: fresh("sphere", 300)])
@pytest.mark.parametrize("method", ["tangent", "polynomial"])
def test_it_is_a_power_of_two_no_more_than_a_tenth_of_what_is_seen_and_falls_with_the_pixel(made: Any,
                                                                                            method: str) -> None:
    scene, settings = made(), AUTO.replace(method=method)
    values, found = chosen(scene, settings), []
    unit = min(values.h, values.radius)
    for width in (4, 64, 512, 4096, 16384):
        camera = Camera.fit(bounds(scene, settings), size=(width, width))
        number, why = visible.for_picture(scene, settings, camera, (width, width))
        edge = visible.pixel(scene, settings, camera, (width, width))
        largest = max(edge, visible.model_error(scene, settings, values.h))
        assert math.frexp(number)[0] == 0.5 and why
        if scene.kind == "cloud":
            assert number * unit <= 0.1 * largest
            assert number == visible.COARSEST or number * unit > 0.05 * largest
        assert COARSE <= number <= 0.125 if scene.kind != "cloud" else number <= 0.125
        assert visible.seen(scene, settings, camera, (width, width)) == settings.replace(tolerance=number)
        found.append(number)
    assert found == sorted(found, reverse=True) and found[0] == 0.125 > found[-1]
    assert values.tolerance <= found[-1]  # without a camera the model's error decides


def test_what_is_set_stays_and_where_it_means_nothing_nothing_is_chosen() -> None:
    scene, camera = ball(), Camera.fit((12.0, 12.0, 12.0))
    for settings in (Settings(), Settings(tolerance=1e-9), AUTO.replace(method="cylinder"),
                     AUTO.replace(method="fill_level"), AUTO.replace(search="march")):
        assert visible.seen(scene, settings, camera, (64, 64)) is settings
    assert visible.seen(scene, AUTO, None, None) is AUTO


def test_the_radius_does_not_grow_for_what_nobody_sees() -> None:
    assert chosen(ball(), AUTO).radius == LATTICE_RADIUS * 0.8
    assert chosen(ball(), Settings(tolerance=1e-6)).radius > LATTICE_RADIUS * 0.8


@pytest.mark.parametrize("made", [ball, lambda: fresh("sphere", 300)])
def test_a_picture_is_that_of_the_number_and_a_picked_ray_has_its_bits(made: Any) -> None:
    scene, size = made(), (32, 32)
    settings = AUTO.replace(shading="water", search="secant")
    camera = Camera.fit(bounds(scene, settings), size=size)
    number = visible.for_picture(scene, settings, camera, size)[0]
    auto = render(scene, settings, camera, size)
    fixed = render(scene, settings.replace(tolerance=number), camera, size)
    np.testing.assert_array_equal(auto.t, fixed.t)
    assert auto.settings == settings and visible.of_hits(scene, auto) == fixed.settings
    np.testing.assert_array_equal(finish(auto, scene), finish(fixed, scene))  # and so are the rays behind it
    ray = int(np.argmax(auto.hit))
    followed = trace(scene, visible.seen(scene, settings, camera, size), auto.origin[ray], auto.direction[ray])
    assert followed.t == auto.t[ray]


def test_a_list_of_rays_has_the_tolerance_of_the_model_alone() -> None:
    scene, rays = fresh("sphere", 300), (np.array([[0.0, 0.0, 5.0]]), np.array([[0.0, 0.0, -1.0]]))
    values = chosen(scene, AUTO)
    assert arrival(values) < 0.1 * visible.model_error(scene, AUTO, values.h)
    found = render(scene, AUTO, rays=rays)
    assert found.t[0] == render(scene, Settings(tolerance=values.tolerance), rays=rays).t[0]


def test_hits_at_auto_are_within_a_tenth_of_a_pixel_of_the_exact_ones() -> None:
    scene, size = fresh("sphere", 2000), (48, 48)
    camera = Camera.fit(bounds(scene, AUTO), size=size)
    auto, exact = render(scene, AUTO, camera, size), render(scene, Settings(tolerance=1e-12), camera, size)
    both = auto.hit & exact.hit
    assert both.sum() > 500 and (auto.hit != exact.hit).sum() <= 2
    wide = camera.view(size).pixel * exact.t[both]
    assert np.quantile(np.abs(auto.t - exact.t)[both] / wide, 0.99) < 0.1
    assert auto.evaluations.sum() < 0.5 * exact.evaluations.sum()


def test_the_plan_says_it() -> None:
    scene, size = ball(), (64, 64)
    camera = Camera.fit(bounds(scene, AUTO), size=size)
    said = {value.name: value for value in plan(scene, AUTO, camera, size).values}
    number, why = visible.for_picture(scene, AUTO, camera, size)
    ready = prepare.prepared(scene, AUTO.replace(tolerance=number))
    assert said["tolerance"].value == ready.tracer.plan.how.arrived
    assert said["tolerance"].origin == f"{number:g} h, {why}" and "pixel" in why
    assert said["radius"].origin == "3.125 h, as no more can be seen"
    assert {v.name: v.origin for v in jaart.plan(scene).values}["tolerance"] == "0.01 h, as set"
