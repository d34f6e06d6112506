"""Normals of bare points: right on exact surfaces, to one side, and what cannot be known is counted."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core import cloud
from jaart.core.io import load
from jaart.core.orient import estimated, normals_of, oriented, parts, spanning_tree, towards
from jaart.core.samples import fibonacci, standard_bumps
from jaart.core.scene import Scene

RNG = np.random.default_rng(7)


def sphere(count: int) -> tuple[np.ndarray, np.ndarray]:
    return fibonacci(count), fibonacci(count)


def torus(count: int) -> tuple[np.ndarray, np.ndarray]:
    around, across = RNG.uniform(0, 2 * np.pi, (2, count))
    ring = np.stack((np.cos(around), np.sin(around), np.zeros(count)), axis=1)
    normal = np.cos(across)[:, None] * ring + np.sin(across)[:, None] * np.array([0, 0, 1.0])
    return ring + 0.35 * normal, normal


def bumpy(count: int) -> tuple[np.ndarray, np.ndarray]:
    points = standard_bumps().points_along(fibonacci(count))
    return points, standard_bumps().exact_normal(points)


@pytest.mark.parametrize(("surface", "degrees"), [(sphere, 0.6), (torus, 4), (bumpy, 2)])
def test_every_normal_points_outwards(surface, degrees: float) -> None:
    points, exact = surface(6000)
    found = oriented(points)
    assert ((found.normal * exact).sum(axis=1) > 0).all()
    assert np.degrees(np.arccos(np.clip((found.normal * exact).sum(axis=1), -1, 1))).mean() < degrees
    assert (found.components, found.undefined, found.notes) == (1, 0, ())
    assert found.agreeing == 1
    assert oriented(points, "none").agreeing < 0.99


@pytest.mark.parametrize("moved", [np.zeros(3), np.array([1e6, 0, -1e6])])
@pytest.mark.parametrize("scale", [1.0, 1e-90, 1e90])
def test_neither_place_nor_size_matters(scale: float, moved: np.ndarray) -> None:
    points, exact = sphere(500)
    found = oriented((points + moved) * scale)
    assert ((found.normal * exact).sum(axis=1) > 0.99).all()


def test_each_part_is_turned_by_itself_and_said() -> None:
    points, exact = sphere(800)
    found = oriented(np.concatenate((points, points + [5, 0, 0], 0.2 * points - [5, 0, 0])))
    assert found.components == 3
    assert "3 parts" in found.notes[0]
    assert ((found.normal * np.tile(exact, (3, 1))).sum(axis=1) > 0.99).all()


def test_towards_a_viewpoint() -> None:
    points, exact = sphere(1000)
    eye = np.array([0.0, 3, 4])
    found = oriented(points, (0.0, 3.0, 4.0))
    assert ((found.normal * (eye - points)).sum(axis=1) >= 0).all()
    seen = ((eye - points) * exact).sum(axis=1) > 0.05
    assert ((found.normal * exact).sum(axis=1)[seen] > 0.99).all()
    assert np.array_equal(towards(points, exact, np.array([0.0, 0, 0])), -exact)


def test_normals_of_a_scene_are_kept_and_take_the_viewpoint_in_its_own_coordinates() -> None:
    points, exact = sphere(500)
    scene = Scene("far", points=points + 1e5)
    outwards, inwards = normals_of(scene, "spanning_tree").normal, normals_of(scene, (1e5, 1e5, 1e5))
    assert ((outwards * exact).sum(axis=1) > 0.99).all() and not outwards.flags.writeable
    assert ((inwards.normal * exact).sum(axis=1) < -0.99).all()
    assert normals_of(scene, (1e5, 1e5, 1e5)) is inwards


def test_points_of_a_plane_have_its_normal_to_the_last_bits() -> None:
    a, b, n = np.array([2.0, 1, 0]), np.array([-1.0, 2, 2]), np.array([2.0, -4, 5])
    points = RNG.normal(size=(200, 2)) @ np.stack((a, b)) + 1e3 * n
    found = oriented(points)
    assert np.abs(np.abs(found.normal @ n) / np.linalg.norm(n) - 1).max() < 1e-12
    assert found.agreeing == 1


@pytest.mark.parametrize("points", [
    np.outer(np.arange(40.0), [1, 2, 3]), np.zeros((40, 3)), np.array([[0.0, 0, 0], [1, 1, 1]])])
def test_a_line_and_a_point_have_no_normal(points: np.ndarray) -> None:
    found = oriented(points)
    assert found.undefined == len(points)
    assert "undefined" in found.notes[-1]
    assert np.abs(np.linalg.norm(found.normal, axis=1) - 1).max() < 1e-12


def test_a_single_point() -> None:
    found = oriented(np.ones((1, 3)))
    assert (found.components, found.undefined, found.agreeing) == (1, 1, 1)
    assert found.normal.shape == (1, 3)


def test_how_well_a_normal_is_defined() -> None:
    flat = np.concatenate((np.zeros((1, 3)), np.eye(3)[:2], -np.eye(3)[:2]))
    index = np.array([[1, 2, 3, 4]] * 5)
    normal, gap = estimated(flat, index)
    assert abs(normal[0, 2]) == 1 and gap[0] == pytest.approx(1)


def test_parts_of_the_neighbour_graph() -> None:
    neighbours = np.array([[1], [0], [3], [2], [2]])
    assert parts(spanning_tree(np.tile((0.0, 0.0, 1.0), (5, 1)), neighbours)).tolist() == [0, 0, 1, 1, 1]


@pytest.mark.parametrize("orient", ["spanning_tree", "none"])
def test_parts_are_counted_with_a_side_or_without(orient: str) -> None:
    points = np.concatenate([sphere(200)[0] + (9.0 * i, 0, 0) for i in range(4)])
    assert oriented(points, orient).components == 4


def test_the_dragon_is_turned_outwards(data) -> None:
    scene = load(data("clouds/dragon_full.npz"))
    points = cloud.local_points(scene)
    found = oriented(points)
    assert found.components == 1 and found.agreeing > 0.998
    area = np.pi * cloud.ball_radii(scene, 12) ** 2 / 12
    box = np.prod(cloud.bounds(scene)[1] - cloud.bounds(scene)[0])
    assert 0.1 < (points * found.normal).sum(axis=1) @ area / 3 / box < 0.3
