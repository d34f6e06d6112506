"""Surfels: where they lie, which way they point, and which cells have none."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core.io import load
from jaart.core.lattice import interface_cells
from jaart.core.scene import frozen
from jaart.core.settings import Settings
from jaart.core.surfels import box_placement, make_surfels

RNG = np.random.default_rng(5)


@pytest.mark.parametrize("level", [0.1, 0.25, 0.5, 1.0])
@pytest.mark.parametrize("axis", range(3))
def test_a_flat_surface_is_met_exactly(level: float, axis: int) -> None:
    levels = np.ones((4, 5, 6))
    moved = np.moveaxis(levels, axis, 2)
    moved[:, :, 2], moved[:, :, 3:] = level, 0
    surfels = make_surfels(levels, Settings())
    assert (surfels.cells[:, axis] == 2).all()
    assert np.allclose(surfels.points[:, axis], 2 + level, rtol=0, atol=1e-15)
    expected = np.zeros(3)
    expected[axis] = 1
    assert np.array_equal(surfels.normal, np.tile(expected, (len(surfels), 1)))


def test_placement_reaches_the_cells_faces() -> None:
    normal = RNG.normal(size=(200, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    for level, at in ((0.0, -0.5), (0.5, 0.0), (1.0, 0.5)):
        offset = box_placement(np.full(200, level), normal)[:, None] * normal
        largest = np.abs(normal).argmax(axis=1)
        reached = offset[np.arange(200), largest] * np.sign(normal[np.arange(200), largest])
        assert np.allclose(reached, at, rtol=0, atol=1e-15)
        assert (np.abs(offset) <= 0.5 + 1e-15).all()


def test_order_and_form_of_the_record() -> None:
    levels = frozen(RNG.choice([0, 0.3, 0.7, 1], size=(5, 6, 7)))
    surfels = make_surfels(levels, Settings())
    numbers = np.ravel_multi_index(tuple(surfels.cells.T), levels.shape)
    assert (np.diff(numbers) > 0).all()
    assert len(surfels) + surfels.without_normal == interface_cells(levels).sum()
    assert surfels.cells.dtype == np.int32
    for array in (surfels.cells, surfels.offset, surfels.normal):
        assert array.flags.c_contiguous and not array.flags.writeable
    assert np.allclose(np.linalg.norm(surfels.normal, axis=1), 1, rtol=0, atol=1e-15)


def test_cells_without_a_gradient_are_counted() -> None:
    levels = np.zeros((5, 5, 5))
    levels[2, 2, 2] = 0.5
    surfels = make_surfels(levels, Settings())
    assert (len(surfels), surfels.without_normal) == (0, 1)
    assert surfels.points.shape == (0, 3)
    for empty in (np.zeros((3, 3, 3)), np.ones((3, 3, 3))):
        assert (len(make_surfels(empty, Settings())), make_surfels(empty, Settings()).without_normal) == (0, 0)


def test_tiny_gradients_keep_their_direction() -> None:
    levels = np.zeros((3, 3, 3))
    levels[:, 1, 1] = 1e-200, 2e-200, 5e-200
    surfels = make_surfels(levels, Settings())
    assert surfels.without_normal == 0 and (surfels.normal == [-1, 0, 0]).all()


def test_the_border_decides_about_the_walls() -> None:
    basin = np.zeros((4, 4, 4))
    basin[:, :, :2] = 1
    assert (make_surfels(basin, Settings(border="open")).normal == [0, 0, 1]).all()
    assert len(make_surfels(basin, Settings(border="open"))) == 16
    closed = make_surfels(basin, Settings(border="closed"))
    assert len(closed) == 32 and (closed.normal[closed.cells[:, 2] == 0][:, 2] <= 0).all()


def test_surfels_of_a_model_lie_near_its_surface() -> None:
    from jaart.core.model import fill
    from jaart.core.scene import Model
    from jaart.core.shapes import Sphere

    sphere = Sphere((0.5, 0.5, 0.5), 0.3)
    surfels = make_surfels(fill(Model((sphere,), 32), 32, "corners", 20), Settings())
    outward = surfels.points - 16
    distance = np.linalg.norm(outward, axis=1)
    assert np.abs(distance - 0.3 * 32).max() < 0.4
    assert np.abs(distance - 0.3 * 32).mean() < 0.1
    assert (outward * surfels.normal).sum(axis=1).min() > 0.95 * distance.min()


def test_the_real_splash() -> None:
    scene = load("splash")
    assert scene.levels is not None
    surfels = make_surfels(scene.levels, Settings())
    assert 5_000 < len(surfels) < 15_000
    assert np.isfinite(surfels.points).all() and np.isfinite(surfels.normal).all()
    assert (np.abs(surfels.offset) <= 0.5 + 1e-15).all()
