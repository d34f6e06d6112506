"""Pictures of water: lights and their shadows, floor and sky, themes, cancelling."""

from __future__ import annotations

import dataclasses
import threading

import numpy as np
import pytest
from exact_rays import exact_hits, shooting_at

from jaart.core.camera import Camera
from jaart.core.environment import Environment, sky
from jaart.core.errors import Cancelled, SettingsError
from jaart.core.io import load
from jaart.core.optics import unit
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.secondary import Tracer, shooter
from jaart.core.settings import Settings
from jaart.core.shade import needs_scene, shade
from jaart.core.shapes import Sphere
from jaart.core.water import water
from tests.core.water_scenes import BALL, PLAIN, WIDE, White, exact


def test_highlights_of_lights_and_their_shadows() -> None:
    hits = exact_hits([BALL], np.array([[0.0, 0, 9]]), np.array([[0.0, 0, -1]]))
    plain = water(hits, PLAIN, White(*WIDE), exact()).colour[0]
    two = PLAIN.replace(specular=0.25, light=((0, 0, 20), (0, 0, 30)), shadows=True)
    assert water(hits, two, White(*WIDE), exact()).colour[0] == pytest.approx(plain + 0.5, abs=1e-12)
    assert water(hits, PLAIN.replace(specular=0.25), White(*WIDE), exact()).colour[0] == pytest.approx(plain + 0.25)
    shaded = Tracer(shooting_at(BALL, Sphere((0, 0, 25), 1)), 1e-13, 1e-6)
    once = two.replace(depth=0)  # the mirrored ray is not traced, the shadow rays are
    assert water(hits, once, White(*WIDE), shaded).colour[0] == pytest.approx(plain + 0.25, abs=1e-12)


def test_the_floor_lies_under_a_lattice_and_under_a_cloud() -> None:
    around = Environment(np.array([-1.0, -1, 3]), np.array([1.0, 1, 5]))
    down = np.array([[0.0, 0, -1]])
    assert around.colour(np.array([[0.3, 0.2, 9]]), down) == pytest.approx(around.floor(np.array([[0.3, 0.2]])))
    below = around.colour(np.array([[0.3, 0.2, 2.9]]), down)
    assert below == pytest.approx(around.colour(np.array([[0.3, 0.2, 9]]), -down), abs=1e-3) and below[0, 2] > 0.5
    light = around.colour(np.random.default_rng(1).normal(size=(500, 3)) * 9,
                          unit(np.random.default_rng(2).normal(size=(500, 3))))
    assert np.isfinite(light).all() and light.min() > 0
    assert not around.in_water(np.zeros((3, 3))).any()


def test_the_sky_is_bright_about_the_sun_and_at_the_horizon() -> None:
    sun = np.array([[-0.48, 0.6, 0.64]])
    about = unit(sun + [[0.3, 0.2, 0]])
    assert sky(sun).min() > 1 and (sky(about) > sky(about * [[-1, -1, 1]]) + 0.02).all()
    assert (sky(np.array([[1.0, 0, 0]])) > sky(np.array([[0.0, 0, 1]]))).all()


def test_pictures_of_water_and_shadows_need_the_scene() -> None:
    scene = load("standard")
    hits = render(scene, size=(40, 40))
    for about, why in ((PLAIN, "shading = water"), (Settings(shadows=True, light=((40, -9, 40),)), "shadows = true")):
        assert needs_scene(about)
        with pytest.raises(SettingsError, match=f"{why}: needs rays from the surface on; expected the scene"):
            shade(hits, settings=about)
        picture = shade(hits, settings=about, scene=scene)
        assert picture.shape == (40, 40, 3) and len(np.unique(picture.reshape(-1, 3), axis=0)) > 50
        shade(hits, "iterations", settings=about)
    assert not needs_scene(Settings(shadows=True)) and not needs_scene(Settings(light=((1, 2, 3),)))


def test_water_shows_what_is_around_it_whatever_the_theme() -> None:
    scene = load("standard")
    hits = render(scene, size=(40, 40))
    pictures = [shade(hits, theme=theme, settings=PLAIN, scene=scene) for theme in ("light", "dark")]
    assert np.array_equal(*pictures)
    background = pictures[0].reshape(-1, 3)[~hits.hit]
    assert len(np.unique(background, axis=0)) > 50


def test_shadows_darken_and_brighten_nothing() -> None:
    scene = load("standard")
    hits = render(scene, camera=Camera(eye=(8, -40, 30), target=(8, 8, 8)), size=(80, 80))
    for shading in ("phong", "diffuse"):
        lit = Settings(shading=shading, light=((24, 20, 24),))
        without, cast = shade(hits, settings=lit), shade(hits, settings=lit.replace(shadows=True), scene=scene)
        assert (cast <= without).all() and (cast < without).any(axis=2).sum() > 20


def test_a_picture_can_be_cancelled() -> None:
    scene = load("standard")
    hits, cancel = render(scene, size=(40, 40)), threading.Event()
    cancel.set()
    with pytest.raises(Cancelled):
        shade(hits, settings=PLAIN, scene=scene, cancel=cancel)


def test_rays_of_a_picture_without_hits_and_of_none() -> None:
    scene = load("standard")
    away = render(scene, rays=(np.array([[0.0, 0, 30]]), np.array([[0.0, 0, 1]])))
    assert shade(away, settings=PLAIN, scene=scene).shape == (1, 1, 3)
    none = dataclasses.replace(away, **{f.name: getattr(away, f.name)[:0] for f in dataclasses.fields(Hits)
                                        if isinstance(getattr(away, f.name), np.ndarray)})
    assert shade(none, settings=PLAIN, scene=scene).shape == (1, 0, 3)
    found = shooter(scene, PLAIN)(np.array([[11.2, 11.2, 30]]), np.array([[0.0, 0, -1]]), False)
    assert found.hit.all()
