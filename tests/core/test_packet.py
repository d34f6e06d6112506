"""Rays that walk together, and blocks of rays that begin where something may be."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core import prepare
from jaart.core.camera import Camera
from jaart.core.empty_space import distances
from jaart.core.kernels import records
from jaart.core.kernels.packet import LANES
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from jaart.core.tiles import columns_for
from jaart.core.tracers import LatticeTracer

BALLS = Scene("balls", model=Model((Sphere((0.3, 0.35, 0.4), 0.2), Sphere((0.75, 0.7, 0.65), 0.12)), 24))
CAMERAS = {
    "from outside": Camera(eye=(60.0, -40.0, 31.0), target=(12.0, 12.0, 12.0), fov=40.0),
    "from inside": Camera(eye=(14.0, 12.0, 13.0), target=(0.0, 1.0, 2.0), fov=110.0),
    "parallel": Camera(eye=(60.0, -40.0, 31.0), target=(12.0, 12.0, 12.0), ortho=40.0),
    "along an axis": Camera(eye=(12.0, 12.0, 90.0), target=(12.0, 12.0, 0.0), up=(0.0, 1.0, 0.0), ortho=26.0),
    "from far away": Camera(eye=(5e6, -4e6, 3e6), target=(12.0, 12.0, 12.0), fov=6e-4),
}
SETTINGS = {"iterate": Settings(), "safe": Settings(search="safe"), "even steps": Settings(traversal="uniform")}


def equal(a: Hits, b: Hits) -> bool:
    """Whether all columns but the visited cells have the same bits."""
    names = set(a.__dataclass_fields__) & set(records.Out._fields) - {"cells"}
    return all(np.array_equal(getattr(a, n), getattr(b, n), equal_nan=n != "status") for n in names)


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("settings", SETTINGS)
def test_a_picture_has_the_bits_of_its_rays_alone(camera: str, settings: str) -> None:
    """Neither where its block begins nor its company changes a hit."""
    chosen, size = SETTINGS[settings], (45, 37)
    picture = render(BALLS, chosen, CAMERAS[camera], size)
    alone = render(BALLS, chosen, rays=(picture.origin, picture.direction))
    assert picture.hit.any() and equal(picture, alone)
    assert picture.cells.sum() <= alone.cells.sum()
    tracer, out = prepare.prepared(BALLS, chosen).tracer, columns_for(len(picture.t))
    for row in range(0, len(picture.t), 7):
        tracer.trace(picture.origin, picture.direction, np.array([row]), out)
        assert out.status[row] == picture.status[row]
        np.testing.assert_array_equal(out.t[row], picture.t[row])


def test_no_ray_of_a_block_has_a_surfel_near_before_it_begins() -> None:
    tracer = prepare.prepared(BALLS, Settings()).tracer
    assert isinstance(tracer, LatticeTracer)
    empty = tracer.cells.empty
    for camera in CAMERAS.values():
        view = camera.view((64, 48))
        blocks = tracer.blocks(view)
        assert blocks.shape == (6, 8)
        origins, directions = camera.rays((64, 48))
        begins = blocks.repeat(8, axis=0).repeat(8, axis=1).ravel()
        for share in np.linspace(0.0, 1.0, 60):
            t = share * np.minimum(begins, np.linalg.norm(origins - 12.0, axis=1) + 30.0)
            cell = np.floor(origins + t[:, None] * directions).astype(int)
            inside = ((cell >= 0) & (cell < empty.shape)).all(axis=1)
            assert (distances(empty, cell[inside]) > 1).all()


def test_blocks_spare_cells() -> None:
    camera = CAMERAS["from outside"]
    picture = render(BALLS, Settings(), camera, (320, 320))
    alone = render(BALLS, Settings(), rays=(picture.origin, picture.direction))
    assert picture.cells.sum() < 0.85 * alone.cells.sum()


def test_rays_without_meaning_are_named_and_disturb_no_other() -> None:
    picture = render(BALLS, Settings(), CAMERAS["from outside"], (16, 16))
    origins, directions = picture.origin.copy(), picture.direction.copy()
    bad = np.arange(0, 256, 3)
    kinds = [(np.nan, 0.0, 0.0), (np.inf, 1.0, 0.0), (0.0, 0.0, 0.0), (1e300, 1e300, -1e300)]
    for i, row in enumerate(bad):
        if i % 4 == 3:
            origins[row] = kinds[3]
        else:
            directions[row] = kinds[i % 4]
    mixed = render(BALLS, Settings(), rays=(origins, directions))
    good = np.setdiff1d(np.arange(256), bad)
    assert (mixed.status[bad] == records.BAD_RAY).all()
    np.testing.assert_array_equal(mixed.t[good], picture.t[good])
    assert int(LANES) == 64
