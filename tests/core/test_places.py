"""What rays gather: only near places they come to, the same in any room, with any number of threads at once."""

from __future__ import annotations

import gc
import itertools
import weakref
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest

from jaart.core import balls, extents, memory, places, prepare
from jaart.core.camera import Camera
from jaart.core.errors import SettingsError
from jaart.core.io import load
from jaart.core.kernels.blocks import NOWHERE
from jaart.core.kernels.guess import GUESS_WIDTH
from jaart.core.kernels.records import Sites
from jaart.core.kernels.sums import gaussian_sums
from jaart.core.places import Places, listed, listed_near, places_of, served
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.settings import Settings, preset
from jaart.core.trace import trace
from tests.core.cloud_scenes import fresh
from tests.core.kernel_calls import asked_cells, near_at, near_of

SIZE = (40, 40)
SETTINGS = {
    "best": preset("best"), "thesis": preset("thesis"), "plane": Settings(), "safe": Settings(search="safe"),
    "cylinder": Settings(method="cylinder", h=0.6), "march": Settings(search="march"),
    "polynomial": Settings(method="polynomial", search="secant"),
}
CASES = ["lattice best", "lattice thesis", "cloud best", "cloud plane"]
MORE = ["noise safe", "noise cylinder", "lattice march", "noise polynomial", "cloud safe", "cloud march",
        "cloud polynomial"]


def case(name: str) -> tuple[Scene, Settings]:
    """A scene of its own, that nothing was traced in."""
    kind, settings = name.split()
    return {"lattice": lambda: load("standard"), "noise": noise,
            "cloud": lambda: fresh("bumpy", 2000)}[kind](), SETTINGS[settings]


def noise() -> Scene:
    """A lattice whose cells are no cubes, so that surfels leave the order of their cells."""
    levels = np.random.default_rng(2).uniform(0.05, 0.95, (9, 7, 11))
    return Scene("noise", levels=levels, spacing=(1.0, 0.7, 0.4))


def sites_of(scene: Scene, settings: Settings) -> Sites:
    return prepare.prepared(scene, settings).tracer.sites


def picture(name: str, threads: int = 1) -> tuple[list[bytes], Places]:
    """The bits of a picture and what was kept for it."""
    scene, settings = case(name)
    return bits(render(scene, settings, size=SIZE, threads=threads)), places_of(sites_of(scene, settings))


def bits(hits: Hits) -> list[bytes]:
    assert hits.hit.any()
    return [getattr(hits, column).tobytes() for column in ("t", "point", "normal", "energy", "off_centre", "iterations",
                                                           "evaluations", "neighbours", "cells", "status")]


@pytest.mark.parametrize(("name", "threads"), [*itertools.product(CASES, [1, 3]), *((name, 2) for name in MORE)])
def test_a_picture_is_the_same_in_a_chunk_for_each_block(name: str, threads: int,
                                                         monkeypatch: pytest.MonkeyPatch) -> None:
    plain, roomy = picture(name)
    monkeypatch.setattr(places, "CHUNK", 8)
    monkeypatch.setattr(places, "SURFELS", 1)
    monkeypatch.setattr(balls, "HEAP", 70)
    tight, crowded = picture(name, threads)
    assert tight == plain
    assert roomy.kept.chunks < 10 and crowded.kept.chunks > 100
    assert crowded.kept.gathered == roomy.kept.gathered and crowded.kept.fits == roomy.kept.fits


@pytest.mark.parametrize("name", CASES)
def test_two_pictures_at_once_gather_what_one_does(name: str) -> None:
    alone, once = picture(name)
    scene, settings = case(name)
    sites_of(scene, settings)
    with ThreadPoolExecutor(2) as pool:
        both = list(pool.map(lambda _: bits(render(scene, settings, size=SIZE, threads=2)), range(2)))
    kept = places_of(sites_of(scene, settings)).kept
    assert both == [alone, alone]
    assert (kept.gathered, kept.fits, kept.block_bytes) == (once.kept.gathered, once.kept.fits, once.kept.block_bytes)


def test_a_ray_gathers_only_cells_that_it_crosses() -> None:
    scene, settings = case("lattice best")
    nothing = render(scene, settings, rays=(np.array([[-9.0, -9.0, 99.0]]), np.array([[0.0, 0.0, 1.0]])))
    sites = sites_of(scene, settings)
    assert not nothing.hit.any() and places_of(sites).kept[:4] == (0, 0, 0, 0) and not len(asked_cells(sites))
    x, y = (0.52 * n + 0.1 for n in sites.shape[:2])
    hit = render(scene, settings, rays=(np.array([[x, y, 99.0]]), np.array([[0.0, 0.0, -1.0]])))
    asked = asked_cells(sites)
    assert hit.hit.all() and 0 < places_of(sites).kept.gathered == len(asked) < sites.shape[2] / 2
    assert (asked[:, :2] == [int(x), int(y)]).all()


@pytest.mark.parametrize("name", CASES)
def test_what_is_kept_is_counted(name: str) -> None:
    scene, settings = case(name)
    render(scene, settings, size=SIZE)
    sites = sites_of(scene, settings)
    kept = places_of(sites).kept
    cloud = scene.kind == "cloud"
    assert kept.gathered == (np.count_nonzero(sites.slots) if cloud else len(asked_cells(sites))) > 100
    if cloud:
        assert kept.fits == kept.gathered
    else:
        assert kept.fits == 0 if name == "lattice thesis" else 0 < kept.fits <= kept.gathered
    asked = np.flatnonzero(sites.slots)[:, None] * [1, 0, 0] if cloud else asked_cells(sites)
    sizes = np.diff(listed_near(sites, asked)[0])
    words = 1 + GUESS_WIDTH * cloud + (not cloud) * ((sizes + 1) // 2) + 6 * (-(-sizes // 8) * 8)
    assert kept.block_bytes == 8 * words[(sizes > 0) | cloud].sum()
    again = render(scene, settings, size=SIZE)
    assert again.hit.any() and places_of(sites).kept == kept


@pytest.mark.parametrize("count", [0, 1, 7, 8, 9, 16, 17])
def test_columns_are_filled_up_with_surfels_that_count_nothing(count: int) -> None:
    made = np.random.default_rng(count).normal(size=(6, count))
    sites = listed((0, 0, 0), np.zeros((1, 3)), np.array([0, count]), np.arange(count, dtype=np.int32), made.ravel())
    near = served(sites, lambda own, pool: near_at(own, (0, 0, 0)))
    columns = near.columns.reshape(6, -1)
    assert near.size == count and near.wide == columns.shape[1] == -(-count // 8) * 8
    assert np.array_equal(columns[:, :count], made)
    assert (columns[:3, count:] == NOWHERE).all() and (columns[3:, count:] == 0.0).all()
    assert np.array_equal(listed_near(sites, np.zeros((1, 3), np.int64))[2], made.ravel())
    for h in (0.3, 1.0, 1e9):
        full, bare = (gaussian_sums(one, (0.1, -0.2, 0.3), h) for one in (near, near_of(made[:3].T, made[3:].T)))
        flat = [np.concatenate(([s], q, m)) for s, q, m in (full, bare)]
        assert flat[0] == pytest.approx(flat[1], rel=1e-13, abs=1e-200 if count == 0 else 1e-13 * abs(made).max())


@pytest.mark.parametrize("name", ["lattice best", "cloud best"])
def test_rays_that_ask_for_more_than_there_is_are_told(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene, settings = case(name)
    sites_of(scene, settings)
    monkeypatch.setattr(memory, "limit", lambda: 300 << 10)
    with pytest.raises(SettingsError, match=r"needs 1.* MiB of memory, more than the"):
        render(scene, settings, size=SIZE)


@pytest.mark.parametrize("name", ["lattice plane", "cloud best", "cloud plane"])
def test_what_earlier_views_asked_for_is_let_go_where_memory_ends(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene, settings = case(name)
    monkeypatch.setattr(places, "CHUNK", 1 << 14)
    first = Camera.fit(extents.bounds(scene, settings), size=SIZE)
    across = tuple(2 * t - e for e, t in zip(first.eye, first.target, strict=True))
    views = [first, Camera(across, first.target)]
    apart = [bits(render(case(name)[0], settings, view, SIZE, threads=1)) for view in views]
    render(scene, settings, first, SIZE, threads=1)
    kept = places_of(sites_of(scene, settings))
    before, most = weakref.ref(kept), sum(one.nbytes for one in kept.chunks) * 5 // 4
    del kept
    monkeypatch.setattr(memory, "limit", lambda: most)
    with uncollected():  # at once: the next would not fit beside it
        alive: list[bool] = []
        again = render(scene, settings, views[1], SIZE, threads=1, picture=lambda _: alive.append(bool(before())))
    assert bits(again) == apart[1] and alive[0] and not alive[-1] and len(alive) > 1
    assert bits(render(scene, settings, first, SIZE, threads=1)) == apart[0]
    hit = render(scene, settings, views[1], SIZE, threads=1).hit.argmax()
    o, d = (a[hit] for a in views[1].rays(SIZE))
    assert trace(scene, settings, o, d).status == "converged"


@contextmanager
def uncollected() -> Iterator[None]:
    """Without the collector of cycles, as in the window."""
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


def test_a_picture_that_is_too_large_by_itself_is_refused_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, settings = case("cloud best")
    made, seen = places_of(sites_of(scene, settings)), []
    monkeypatch.setattr(memory, "limit", lambda: 1 << 20)
    with pytest.raises(SettingsError, match="the neighbourhoods of balls: needs"):
        render(scene, settings, size=(80, 80), picture=seen.append)
    assert len(seen) <= 1 and places_of(sites_of(scene, settings)) is made


@pytest.mark.parametrize(("name", "given", "least", "said"), [
    ("lattice plane", {}, 100_000, "a surfel in each of .* interface cells: needs"),
    ("lattice plane", {"radius": 9.0}, 1 << 22, "radius = 9.* cells: needs"),
    ("lattice plane", {"neighbourhood": "cell_knn", "k": 300}, 1 << 22, "k = 300: needs"),
    ("lattice plane", {"neighbourhood": "knn", "k": 300}, 1 << 22, "k = 300: needs"),
    ("cloud plane", {}, 500_000, "a cloud of 2000 points: needs"),
    ("cloud plane", {"radius": "0.5d"}, 1 << 22, "radius = .*: needs"),
    ("cloud plane", {"neighbourhood": "knn", "k": 500}, 1 << 22, "k = 500: needs"),
    ("cloud cylinder", {"h": "0.3d"}, 1 << 22, "h = .*: needs")])
def test_what_would_not_fit_says_so_before_it_starts(name: str, given: dict[str, Any], least: int, said: str,
                                                     monkeypatch: pytest.MonkeyPatch) -> None:
    scene, settings = case(name)
    monkeypatch.setattr(memory, "limit", lambda: least)
    with pytest.raises(SettingsError, match=said + ".* of memory, more than the"):
        prepare.prepared(scene, settings.replace(**given))
