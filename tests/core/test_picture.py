"""Whole pictures: colours with every ray that they take, several samples a pixel averaged."""

from __future__ import annotations

from threading import Event

import numpy as np
import pytest

from jaart.core.camera import Camera
from jaart.core.colours import BACKGROUND
from jaart.core.errors import Cancelled
from jaart.core.io import load
from jaart.core.picture import box_average, finish, picture, plain, takes_time
from jaart.core.render import render
from jaart.core.settings import Settings
from jaart.core.shade import shade

SIZE = (48, 32)


@pytest.fixture(scope="module")
def scene():
    return load("standard")


def light(byte):
    """Linear light of a byte of sRGB, as the standard has it."""
    value = byte / 255
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def test_one_sample_is_the_shaded_picture(scene):
    hits, colours = picture(scene, Settings(), size=SIZE)
    assert (colours == shade(hits)).all()
    assert (hits.t == render(scene, Settings(), size=SIZE).t)[hits.hit].all()


def test_several_samples_are_the_mean_light_of_a_larger_picture(scene):
    settings = Settings(samples=3)
    camera = Camera.fit(scene, size=SIZE)
    hits, colours = picture(scene, settings, camera, SIZE)
    fine = shade(render(scene, settings, camera, (3 * SIZE[0], 3 * SIZE[1]))).astype(float)
    at = [(y, x) for y in range(SIZE[1]) for x in range(SIZE[0])][::37]
    for y, x in at:
        block = fine[3 * y:3 * y + 3, 3 * x:3 * x + 3].reshape(9, 3)
        for channel in range(3):
            mean = np.mean([light(v) for v in block[:, channel]])
            assert light(colours[y, x, channel]) == pytest.approx(mean, abs=light(255) - light(254))
    assert hits.size == SIZE
    assert len(hits) == SIZE[0] * SIZE[1]


def test_an_even_ground_stays_what_it_is():
    for byte in range(256):
        assert (box_average(np.full((4, 4, 3), byte, np.uint8), 2) == byte).all()


def test_black_and_white_meet_at_half_the_light():
    board = np.zeros((2, 2, 3), np.uint8)
    board[0, 0] = board[1, 1] = 255
    assert (box_average(board, 2) == 188).all()


def test_strips_make_the_same_picture_as_one_piece(scene, monkeypatch):
    whole = picture(scene, Settings(samples=2), size=SIZE)[1]
    monkeypatch.setattr("jaart.core.picture.RAYS_AT_ONCE", 1000)
    assert (picture(scene, Settings(samples=2), size=SIZE)[1] == whole).all()


def test_edges_are_softened_and_the_ground_is_not(scene):
    one, several = (picture(scene, Settings(samples=n), size=SIZE, theme="dark")[1].reshape(-1, 3) for n in (1, 4))
    ground = (one == BACKGROUND["dark"]).all(axis=1)
    mixed = ground & (several != BACKGROUND["dark"]).any(axis=1)
    assert 0 < mixed.sum() < 0.2 * ground.sum()


def test_false_colours_are_those_of_one_ray(scene):
    hits, colours = picture(scene, Settings(samples=3), size=SIZE, map="iterations")
    assert (colours == shade(hits, "iterations")).all()
    errors = picture(scene, Settings(), size=SIZE, map="distance_error")[1]
    assert (errors != shade(hits)).any()


def test_water_is_shaded_with_the_scene(scene):
    hits, colours = picture(scene, Settings(shading="water"), size=SIZE)
    assert (colours == shade(hits, scene=scene)).all()


def test_progress_counts_every_sample_once(scene):
    told = []
    picture(scene, Settings(samples=2), size=SIZE, progress=lambda done, total: told.append((done, total)))
    total = 5 * SIZE[0] * SIZE[1]
    assert told[-1] == (total, total)
    assert all(t == total for _, t in told)
    assert [done for done, _ in told] == sorted(done for done, _ in told)


def test_a_cancelled_picture_raises(scene):
    stop = Event()
    stop.set()
    with pytest.raises(Cancelled):
        finish(render(scene, Settings(samples=2), size=SIZE), scene, cancel=stop)


@pytest.mark.parametrize(("values", "long"), [
    ({}, False), ({"samples": 2}, True), ({"shading": "water"}, True), ({"shadows": True}, False),
    ({"shadows": True, "light": "1,2,3"}, True)])
def test_what_takes_more_rays_has_a_plain_stand_in(values, long):
    settings = Settings(**values)
    assert takes_time(settings) == long
    assert not takes_time(settings, "depth")
    assert not takes_time(plain(settings))
