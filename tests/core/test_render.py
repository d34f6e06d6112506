"""Rendering: threads, coarse pictures, cancelling, lists of rays, and what cannot be."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from jaart.core.camera import Camera
from jaart.core.errors import Cancelled, FileError, RayError
from jaart.core.io import load
from jaart.core.records import STATUS, Hits
from jaart.core.render import render
from jaart.core.scene import Scene, frozen
from jaart.core.settings import Settings
from jaart.core.tiles import coarse_passes

COLUMNS = ("t", "point", "normal", "energy", "off_centre", "iterations", "evaluations", "neighbours", "cells",
           "status")


def same(a: Hits, b: Hits) -> bool:
    return all(getattr(a, name).tobytes() == getattr(b, name).tobytes() for name in (*COLUMNS, "origin", "direction"))


@pytest.fixture(scope="module")
def standard() -> Scene:
    return load("standard")


@pytest.mark.parametrize("threads", [2, 3, 5])
def test_any_number_of_threads_gives_the_same_bits(standard: Scene, threads: int) -> None:
    assert same(render(standard, size=(97, 61), threads=1), render(standard, size=(97, 61), threads=threads))


def test_coarse_pictures_are_parts_of_the_full_one(standard: Scene) -> None:
    coarse: list[Hits] = []
    full = render(standard, size=(50, 35), picture=coarse.append)
    assert [c.size for c in coarse] == [(7, 5), (13, 9), (25, 18)]
    assert same(full, render(standard, size=(50, 35)))
    for picture, step in zip(coarse, (8, 4, 2), strict=True):
        pixels = np.arange(50 * 35).reshape(35, 50)[::step, ::step].ravel()
        for name in (*COLUMNS, "origin", "direction"):
            assert np.array_equal(getattr(picture, name), getattr(full, name)[pixels], equal_nan=name != "status")


@pytest.mark.parametrize("size", [(1, 1), (8, 8), (9, 17), (3, 40)])
def test_passes_hold_every_pixel_once(size: tuple[int, int]) -> None:
    pixels = np.concatenate([pixels for _, pixels in coarse_passes(size)])
    assert np.array_equal(np.sort(pixels), np.arange(size[0] * size[1]))


def test_a_list_of_rays_gives_the_hits_of_the_picture(standard: Scene) -> None:
    picture = render(standard, size=(40, 30))
    listed = render(standard, rays=(picture.origin, picture.direction))
    assert listed.size is None and same(picture, listed)
    longer = render(standard, rays=(picture.origin, 1e3 * picture.direction))
    assert np.allclose(longer.t, picture.t, rtol=1e-12, equal_nan=True)


def test_rays_without_meaning_are_bad_and_alone(standard: Scene) -> None:
    good = ([8.0, 8.0, 40.0], [0.0, 0.0, -1.0])
    bad = [([np.nan, 0, 0], [0, 0, 1]), ([0, 0, 0], [0, np.inf, 1]), ([8, 8, 40], [0, 0, 0]),
           ([1e300, 0, 0], [1, 0, 0]), ([8, 8, np.inf], [0, 0, -1])]
    hits = render(standard, rays=(np.array([good[0], *(o for o, _ in bad)], float),
                                  np.array([good[1], *(d for _, d in bad)], float)))
    assert (hits.status[1:] == STATUS["bad_ray"]).all() and np.isnan(hits.t[1:]).all()
    assert hits.status[0] != STATUS["bad_ray"]


def test_directions_of_extreme_length_are_normalised(standard: Scene) -> None:
    origin = np.array([[11.2, 11.2, 40.0]] * 4)
    direction = np.array([[0, 0, -1.0], [0, 0, -1e300], [0, 0, -1e-300], [0, 0, -3.0]])
    hits = render(standard, rays=(origin, direction))
    assert hits.hit.all() and len(set(hits.t.tolist())) == 1


def test_a_camera_inside_sees_the_wall(standard: Scene) -> None:
    camera = Camera(eye=(11.2, 11.2, 11.2), target=(11.2, 11.2, 16.0), up=(0, 1, 0), fov=60)
    hits = render(standard, Settings(h=0.8), camera, (9, 9))
    assert hits.hit.all() and np.allclose(hits.t, 4.0, atol=0.3)


def test_cancelling_stops_before_the_end(standard: Scene) -> None:
    cancel = threading.Event()
    seen: list[tuple[int, int]] = []

    def stop(done: int, total: int) -> None:
        seen.append((done, total))
        cancel.set()

    with pytest.raises(Cancelled):
        render(standard, size=(400, 400), cancel=cancel, progress=stop, picture=lambda _: None)
    assert seen[0][0] < seen[0][1] == 160_000


def test_progress_reaches_the_end(standard: Scene) -> None:
    seen: list[tuple[int, int]] = []
    render(standard, size=(64, 64), progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (4096, 4096)


@pytest.mark.parametrize("size", [(0, 5), (5, -1), (20_000, 5), (1.5, 2)])
def test_impossible_sizes(standard: Scene, size: tuple[int, int]) -> None:
    with pytest.raises(RayError, match="size"):
        render(standard, size=size)


def test_a_picture_beyond_memory_is_refused(standard: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("jaart.core.memory.limit", lambda: 1 << 20)
    with pytest.raises(RayError, match=r"size 100x100: needs 1\.3\d MiB"):
        render(standard, size=(100, 100))


def test_rays_of_the_wrong_shape(standard: Scene) -> None:
    with pytest.raises(RayError, match=r"expected origins and directions \(R, 3\)"):
        render(standard, rays=(np.zeros((2, 3)), np.zeros((3, 3))))


@pytest.mark.parametrize("level", [0.0, 0.5, 1.0])
def test_a_lattice_without_an_interface_is_refused(level: float) -> None:
    scene = Scene("still.npz", levels=frozen(np.full((4, 4, 4), level)))
    with pytest.raises(FileError, match=r"still\.npz: levels: no interface"):
        render(scene)


def test_a_model_changes_its_raster(standard: Scene) -> None:
    assert render(standard, Settings(raster=8), size=(8, 8)).camera != render(standard, size=(8, 8)).camera
