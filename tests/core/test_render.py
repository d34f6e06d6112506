"""Rendering: threads, coarse pictures, cancelling, lists of rays, and what cannot be."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from jaart.core import prepare
from jaart.core.camera import Camera
from jaart.core.errors import Cancelled, RayError, SettingsError
from jaart.core.io import load
from jaart.core.quality import quality
from jaart.core.records import STATUS, Hits
from jaart.core.render import render
from jaart.core.scene import Model, Scene, frozen
from jaart.core.settings import Settings
from jaart.core.shapes import Box
from jaart.core.tiles import (
    LEAST,
    LONGEST,
    SHORTEST,
    STEPS,
    TILE,
    TILE_SECONDS,
    in_blocks,
    pixels_at,
    tile_of,
    tiles,
)

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


def test_coarse_pictures_are_parts_of_the_full_one(standard: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("jaart.core.render.PATIENCE", 0.0)
    coarse: list[Hits] = []
    full = render(standard, size=(50, 35), picture=coarse.append)
    assert [c.size for c in coarse] == [(7, 5), (13, 9), (25, 18)]
    assert same(full, render(standard, size=(50, 35)))
    for picture, step in zip(coarse, (8, 4, 2), strict=True):
        pixels = np.arange(50 * 35).reshape(35, 50)[::step, ::step].ravel()
        for name in (*COLUMNS, "origin", "direction"):
            assert np.array_equal(getattr(picture, name), getattr(full, name)[pixels], equal_nan=name != "status")


def test_a_quick_picture_shows_one_coarse_one(standard: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("jaart.core.render.PATIENCE", 1e9)
    coarse: list[Hits] = []
    full = render(standard, size=(50, 35), picture=coarse.append)
    assert [c.size for c in coarse] == [(7, 5)]
    assert same(full, render(standard, size=(50, 35)))


@pytest.mark.parametrize(("rays", "threads"), [(0, 2), (1, 2), (900, 2), (4096, 2), (262_144, 2), (5000, 7)])
def test_tiles_hold_every_ray_once_and_some_are_there_for_each_thread(rays: int, threads: int) -> None:
    made = tiles(np.arange(rays), threads)
    assert np.array_equal(np.concatenate([np.arange(0), *made]), np.arange(rays))
    assert all(len(tile) <= TILE for tile in made)
    assert len(made) >= threads or rays < threads * LEAST


@pytest.mark.parametrize("seconds", [0.0, 1e-9, 2.5e-7, 1e-5, 1.0])
def test_a_tile_is_whole_blocks_and_shorter_where_rays_take_longer(seconds: float) -> None:
    length = tile_of(seconds)
    assert length % 64 == 0
    assert SHORTEST <= length <= LONGEST
    assert length <= tile_of(seconds / 2)
    assert length * seconds <= TILE_SECONDS or length == SHORTEST


@pytest.mark.parametrize("size", [(1, 1), (8, 8), (9, 17), (3, 40)])
def test_passes_hold_every_pixel_once(size: tuple[int, int]) -> None:
    for order in (pixels_at, in_blocks):
        pixels = np.concatenate([order(size, step, before) for step, before in zip(STEPS, (0, *STEPS), strict=False)])
        assert np.array_equal(np.sort(pixels), np.arange(size[0] * size[1]))


def test_pixels_that_are_traced_together_are_a_block() -> None:
    x, y = in_blocks((24, 20), 1)[64:128] % 24, in_blocks((24, 20), 1)[64:128] // 24
    assert sorted(zip(x.tolist(), y.tolist(), strict=True)) == [(i, j) for i in range(8, 16) for j in range(8)]


@pytest.mark.parametrize("step", [1, 2])
def test_each_quarter_of_a_block_is_as_wide_as_high(step: int) -> None:
    pixels = in_blocks((64, 64), step).reshape(-1, 16)
    y, x = np.divmod(pixels, 64)
    assert (np.ptp(x, axis=1) == 3 * step).all() and (np.ptp(y, axis=1) == 3 * step).all()


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
    with pytest.raises(RayError, match=r"size 100x100: needs 1\.42 MiB"):
        render(standard, size=(100, 100))


def test_rays_of_the_wrong_shape(standard: Scene) -> None:
    with pytest.raises(RayError, match=r"expected origins and directions \(R, 3\)"):
        render(standard, rays=(np.zeros((2, 3)), np.zeros((3, 3))))


@pytest.mark.parametrize("neighbourhood", ["cell_ball", "ball", "cell_knn", "knn"])
@pytest.mark.parametrize("method", ["tangent", "projection", "mahalanobis"])
@pytest.mark.parametrize(("level", "says"), [(0.0, "no cell has a level between 0 and 1"),
                                            (1.0, "no cell has a level between 0 and 1"),
                                            (0.5, "64 interface cells, but the level changes at none")])
def test_a_lattice_without_a_surface_is_all_background(level: float, says: str, method: str,
                                                       neighbourhood: str) -> None:
    scene = Scene("still.npz", levels=frozen(np.full((4, 4, 4), level)))
    settings = Settings(method=method, neighbourhood=neighbourhood)
    hits = render(scene, settings, size=(8, 8))
    assert hits.counts() == {"background": 64} and not hits.evaluations.any()
    note, = prepare.surfels(scene, settings).notes
    assert note.startswith("0 surfels") and says in note


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_surfaces_on_the_outer_faces_are_hit_from_all_sides(axis: int, sign: float) -> None:
    block = Scene("block.npz", levels=frozen(np.ones((8, 8, 8))))
    origin, direction = np.array([[4.2, 4.3, 4.4]]), np.zeros((1, 3))
    origin[0, axis], direction[0, axis] = 4.0 - 20 * sign, sign
    hits = render(block, Settings(border="closed"), rays=(origin, direction))
    assert hits.hit.all() and hits.t[0] == pytest.approx(16.0, abs=1e-12)


@pytest.mark.parametrize("centre", [(0.2, 0.5, 0.5), (0.8, 0.5, 0.5)])
def test_mirrored_models_are_equally_good(centre: tuple[float, float, float]) -> None:
    scene = Scene("box", model=Model((Box(centre, (0.4, 0.5, 0.5)),), 16))
    y, z = np.meshgrid(np.linspace(6, 10, 9), np.linspace(6, 10, 9))
    outside = -9.0 if centre[0] < 0.5 else 25.0
    origins = np.stack([np.full(81, outside), y.ravel(), z.ravel()], axis=1)
    hits = render(scene, Settings(border="closed"), rays=(origins, np.tile([-np.sign(outside), 0, 0], (81, 1))))
    found = quality(hits, scene)
    assert found is not None and found.relevant == 81 and found.delta < 0.01


def test_the_precision_floor_is_a_hit(standard: Scene) -> None:
    default, exact = (render(standard, Settings(tolerance=t, max_iterations=200), size=(64, 64)) for t in (0.125, 0.0))
    assert (exact.status == STATUS["floor"]).sum() > 0.97 * default.hit.sum()
    close = exact.hit & default.hit
    assert np.abs(exact.energy[exact.status == STATUS["floor"]]).max() < 1e-13
    assert np.median(np.abs(exact.t - default.t)[close]) < 0.1


def test_h_that_is_no_length_any_more_is_refused(standard: Scene) -> None:
    with pytest.raises(SettingsError, match="h = 1e-160: too small for coordinates up to 16, expected at least"):
        render(standard, Settings(h=1e-160))


def test_h_close_to_nothing_gives_the_planes_of_the_nearest_surfels(standard: Scene) -> None:
    hits = render(standard, Settings(h=1e-90, radius=2, max_off_centre=0.3), size=(48, 48))
    surfels = prepare.surfels(standard, hits.settings)
    nearest = np.linalg.norm(hits.point[hits.hit][:, None] - surfels.points, axis=2).argmin(axis=1)
    assert hits.hit.sum() > 50 and np.isfinite(hits.point[hits.hit]).all()
    agree = np.abs((hits.normal[hits.hit] * surfels.normal[nearest]).sum(axis=1)) > 1 - 1e-12
    assert agree.mean() > 0.8


def test_a_wide_h_does_not_make_every_step_an_arrival(standard: Scene) -> None:
    found = quality(render(standard, Settings(h=50), size=(48, 48)), standard)
    assert found is not None and found.delta_p < 1.0


def test_a_table_that_does_not_fit_is_refused(standard: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("jaart.core.memory.limit", lambda: 1 << 20)
    with pytest.raises(SettingsError, match=r"radius = 5 cells: needs .* of memory"):
        render(standard, Settings(radius=5), size=(4, 4))


def test_a_radius_in_diagonals_is_held_to_the_range_of_a_radius(standard: Scene) -> None:
    with pytest.raises(SettingsError, match=r"radius = 2\.77\d*e\+06: expected"):
        render(standard, Settings(radius="1e5d"))


def test_a_table_in_the_making_is_cancelled(standard: Scene) -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(Cancelled):
        render(standard, Settings(radius=3.7), cancel=cancel)
    assert render(standard, Settings(radius=3.7), size=(4, 4)).size == (4, 4)


def test_a_model_changes_its_raster(standard: Scene) -> None:
    assert render(standard, Settings(raster=8), size=(8, 8)).camera != render(standard, size=(8, 8)).camera
