"""Surfels: where they lie, which way they point, and which cells have none."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core import plic
from jaart.core.filters import filtered
from jaart.core.io import load
from jaart.core.lattice import interface_cells
from jaart.core.placements import ALONG_NORMAL, PLACEMENTS, offsets
from jaart.core.scene import frozen
from jaart.core.settings import Settings
from jaart.core.surfels import make_surfels, stretched_shape

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


def test_order_and_form_of_the_record() -> None:
    levels = frozen(RNG.choice([0, 0.3, 0.7, 1], size=(5, 6, 7)))
    surfels = make_surfels(levels, Settings())
    numbers = np.ravel_multi_index(tuple(surfels.cells.T), levels.shape)
    assert (np.diff(numbers) > 0).all()
    assert len(surfels) + surfels.without_normal == len(interface_cells(levels))
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


GRADIENTS = ("central", "youngs", "smooth")
PAIRS = [(p, g) for p in PLACEMENTS for g in GRADIENTS]


def slab(normal: np.ndarray, at: float, shape: tuple[int, int, int], spacing: tuple[float, ...]) -> np.ndarray:
    """Exact levels below the plane <normal, x> = at, in units of the longest edge of a cell."""
    stretched = normal * np.array(spacing)
    size = np.linalg.norm(stretched)
    centres = (np.moveaxis(np.indices(shape), 0, -1) + 0.5).reshape(-1, 3)
    levels = plic.volume((at - centres @ stretched) / size, np.broadcast_to(stretched / size, centres.shape))
    return levels.reshape(shape)


@pytest.mark.parametrize(("placement", "gradient"), PAIRS)
@pytest.mark.parametrize("filter_", ["none", "thesis", "median", "gauss"])
def test_every_setting_gives_surfels(placement: str, gradient: str, filter_: str) -> None:
    settings = Settings(placement=placement, gradient=gradient, filter=filter_)
    scene = load("splash")
    assert scene.levels is not None
    levels = scene.levels[::2, ::2, ::2]
    surfels = make_surfels(levels, settings)
    kept = filtered(levels, settings)
    assert len(surfels) + surfels.without_normal == len(interface_cells(kept)) and len(surfels) > 500
    assert np.isfinite(surfels.points).all()
    assert np.allclose(np.linalg.norm(surfels.normal, axis=1), 1, rtol=0, atol=1e-15)
    expected = offsets(placement, kept[tuple(surfels.cells.T)], surfels.normal)
    assert np.array_equal(surfels.offset, expected)


@pytest.mark.parametrize("gradient", GRADIENTS)
@pytest.mark.parametrize("placement", PLACEMENTS)
@pytest.mark.parametrize("axis", range(3))
def test_flat_surfaces_of_long_cells_are_met_exactly(gradient: str, placement: str, axis: int) -> None:
    spacing = (1.0, 0.5, 0.25)
    levels = np.moveaxis(np.broadcast_to([1, 1, 1, 1, 0.5, 0, 0, 0], (6, 7, 8)), 2, axis)
    surfels = make_surfels(levels, Settings(gradient=gradient, placement=placement), spacing)
    assert np.array_equal(surfels.normal, np.tile(np.eye(3)[axis], (len(surfels), 1)))
    assert np.allclose(surfels.points[:, axis], 4.5 * spacing[axis], rtol=0, atol=1e-15)
    assert (surfels.cells >= 0).all() and (surfels.cells < stretched_shape(levels.shape, spacing)).all()


@pytest.mark.parametrize("placement", ["box", "exact", "exact_centroid"])
@pytest.mark.parametrize(("spacing", "shape"), [((1, 1, 1), (9, 10, 11)), ((0.25, 1.0, 0.5), (36, 10, 22))])
def test_a_plane_through_long_cells(placement: str, spacing: tuple[float, float, float],
                                    shape: tuple[int, int, int]) -> None:
    """Normals and points lie in one frame: the one in which the plane was asked for, not the lattice's."""
    normal = np.array([0.48, 0.6, 0.64])
    levels = slab(normal, 8.6, shape, spacing)
    surfels = make_surfels(levels, Settings(placement=placement, gradient="youngs"), spacing)
    inside = (np.abs(surfels.points - (4.5, 5, 5.5)) < 3.2).all(axis=1)
    angle = np.degrees(np.arccos(np.minimum(surfels.normal[inside] @ normal, 1)))
    assert inside.sum() > 30 and angle.mean() < 3 and angle.max() < 8
    assert np.abs(surfels.points[inside] @ normal - 8.6).max() < {"box": 0.25}.get(placement, 0.04)
    assert stretched_shape(shape, spacing) == (9, 10, 11)
    assert (surfels.cells >= 0).all() and (surfels.cells < (9, 10, 11)).all()
    if spacing != (1, 1, 1):
        assert np.array_equal(np.floor(surfels.points[inside]), surfels.cells[inside])


def test_points_of_the_exact_plane_in_long_cells() -> None:
    """Where the normal is exact the plane is met to the last bit, and the ball's cap as well as it can."""
    spacing, shape = (0.25, 1.0, 0.5), (12, 1, 1)
    levels = np.zeros(shape)
    levels[:, 0, 0] = [1] * 5 + [0.3] + [0] * 6
    for placement in (*ALONG_NORMAL, "exact_centroid"):
        surfels = make_surfels(levels, Settings(placement=placement), spacing)
        along = {"sphere", "sphere_half"} & {placement}
        assert abs(surfels.points[0, 0] - 5.3 * 0.25) < (0.02 if along else 1e-15)


def test_cubes_of_any_spacing_are_the_same_cubes() -> None:
    levels = RNG.choice([0, 0.3, 0.7, 1], size=(5, 6, 7))
    one, two = make_surfels(levels, Settings()), make_surfels(levels, Settings(), (1, 1, 1))
    assert np.array_equal(one.points, two.points) and np.array_equal(one.normal, two.normal)
    assert stretched_shape((5, 6, 7), (1, 1, 1)) == (5, 6, 7)
    assert stretched_shape((3, 10, 1), (1.0, 0.1, 0.001)) == (3, 1, 1)
