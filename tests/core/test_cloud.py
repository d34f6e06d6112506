"""Clouds: their frame, their spacing and their balls, against slow counts and exact answers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core import cloud
from jaart.core.io import load
from jaart.core.nearest import nearest_others
from jaart.core.samples import bumpy_sphere, fibonacci, standard_bumps
from jaart.core.scene import Scene

RNG = np.random.default_rng(5)
POINTS = RNG.normal(size=(300, 3))


def of(points: object) -> Scene:
    return Scene("points", points=np.array(points, dtype=float))


def distances(points: np.ndarray) -> np.ndarray:
    """Distances (N, N - 1) to the others, rising."""
    return np.sort(np.linalg.norm(points[:, None] - points, axis=2), axis=1)[:, 1:]


def test_bounds_and_diagonal() -> None:
    low, high = cloud.bounds(of([[1, 2, 3], [4, 6, 3], [2, 2, 3]]))
    assert (low.tolist(), high.tolist()) == ([1, 2, 3], [4, 6, 3])
    assert cloud.diagonal(of([[1, 2, 3], [4, 6, 3], [2, 2, 3]])) == 5


@given(st.integers(-30, 30), st.tuples(*[st.floats(-1e6, 1e6)] * 3))
def test_the_frame_is_exact_for_coordinates_of_single_precision(power: int, moved: tuple[float, ...]) -> None:
    points = (POINTS[:20] * 2.0**power + moved).astype(np.float32).astype(np.float64)
    scene = of(np.unique(points, axis=0))
    low, high = cloud.bounds(scene)
    local = cloud.local_points(scene)
    size = (high - low).max()
    wide = np.abs(scene.points) > 2.0**-28 * size  # the others have digits below the size's last
    assert np.array_equal((local + cloud.offset(scene))[wide], scene.points[wide])
    assert np.array_equal((scene.points - local)[wide], np.broadcast_to(cloud.offset(scene), local.shape)[wide])
    assert np.abs(local).max() <= size * (1 / 2 + cloud.GRID / 2) * (1 + 1e-15)


def test_a_cloud_about_the_origin_keeps_its_coordinates() -> None:
    scene = bumpy_sphere(500)
    assert not cloud.offset(scene).any() and np.array_equal(cloud.local_points(scene), scene.points)


def test_the_frame_moves_and_scales_with_the_cloud() -> None:
    scene = of(np.round(POINTS * 1024) / 1024)
    moved, scaled = of(scene.points + 4096.0), of(scene.points * 2.0**-60)
    assert np.array_equal(cloud.local_points(moved), cloud.local_points(scene))
    assert np.array_equal(cloud.local_points(scaled), cloud.local_points(scene) * 2.0**-60)
    assert cloud.spacing(moved) == cloud.spacing(scene) == cloud.spacing(scaled) * 2.0**60
    assert np.array_equal(cloud.ball_radii(moved, 6), cloud.ball_radii(scene, 6))


def test_nearest_others_as_all_distances_have_it() -> None:
    distance, index = cloud.nearest(of(POINTS), 5)
    assert np.abs(distance - distances(POINTS)[:, :5]).max() < 1e-14
    assert np.allclose(np.linalg.norm(POINTS[index] - POINTS[:, None], axis=2), distance, rtol=0, atol=1e-14)
    assert (index != np.arange(300)[:, None]).all()


def test_points_in_the_same_place_are_others() -> None:
    points = np.zeros((9, 3))
    points[8] = 1
    distance, index = nearest_others(points, 3)
    assert (index != np.arange(9)[:, None]).all()
    assert not distance[:8].any() and np.allclose(distance[8], math.sqrt(3))


def test_spacing_leaves_duplicates_out() -> None:
    scene = of([[0, 0, 0], [0, 0, 0], [1, 0, 0], [3, 0, 0]])
    assert cloud.spacing(scene) == pytest.approx((1 + 2) / 2)  # the two in one place say nothing
    assert cloud.spacing(of(POINTS)) == pytest.approx(distances(POINTS)[:, 0].mean())


def test_balls_reach_to_the_kth_neighbour() -> None:
    assert np.allclose(cloud.ball_radii(of(POINTS), 6), distances(POINTS)[:, 5], rtol=1e-14)


def test_more_neighbours_than_points() -> None:
    scene = of(POINTS[:4])
    assert np.allclose(cloud.ball_radii(scene, 6), distances(POINTS[:4])[:, 2], rtol=1e-14)


def test_a_single_point_has_no_spacing() -> None:
    scene = of([[1e9, 2, 3]])
    assert (cloud.spacing(scene), cloud.auto_h(scene), cloud.diagonal(scene)) == (0, 0, 0)
    assert cloud.ball_radii(scene, 6).tolist() == [0] and cloud.cover(scene, 6)[0].tolist() == [0]
    assert cloud.local_points(scene).tolist() == [[0, 0, 0]]


def test_the_square_is_that_of_a_point_whether_the_sample_is_even_or_random() -> None:
    exact = math.sqrt(4 * math.pi / 20_000)
    even, random = of(fibonacci(20_000)), RNG.normal(size=(20_000, 3))
    assert cloud.square(even) == pytest.approx(exact, rel=0.08)
    scattered = of(random / np.linalg.norm(random, axis=1)[:, None])
    assert cloud.square(scattered) == pytest.approx(exact, rel=0.03)
    assert cloud.spacing(even) > 1.8 * cloud.spacing(scattered)  # which is why h is not taken from it


def test_outliers_do_not_widen_the_square() -> None:
    scene = of(np.concatenate((fibonacci(2000), [[1e6, 0, 0], [0, -1e7, 0]])))
    assert cloud.square(scene) == pytest.approx(cloud.square(of(fibonacci(2000))), rel=0.01)


def jittered(count: int) -> np.ndarray:
    directions = fibonacci(count) + RNG.normal(size=(count, 3)) * math.sqrt(1 / count)
    return standard_bumps().points_along(directions)


def even_square(count: int) -> np.ndarray:
    """Whose balls have few different radii; without one corner, for k = 6 keeps all balls of a whole one."""
    side = np.arange(round(math.sqrt(count)), dtype=float)
    return np.stack([a.ravel() for a in np.meshgrid(side, side, 0.0)], axis=1)


@pytest.mark.parametrize("make", [lambda n: bumpy_sphere(n).points, jittered])
def test_balls_and_their_cover_hold_the_surface(make) -> None:
    from scipy.spatial import cKDTree

    scene = of(make(8000))
    places = standard_bumps().points_along(RNG.normal(size=(20_000, 3)))
    for ids, radii in ((np.arange(8000), cloud.ball_radii(scene, 6)), cloud.cover(scene, 6)):
        near, index = cKDTree(scene.points[ids]).query(places, 40)
        assert (near <= radii[index]).any(axis=1).mean() >= 0.9999


def test_the_core_of_a_ball_left_out_lies_in_one_that_is_kept() -> None:
    scene = of(jittered(3000))
    radii, (kept, grown) = cloud.ball_radii(scene, 6), cloud.cover(scene, 6)
    assert np.array_equal(grown, cloud.grown_radii(radii, 6)[kept])
    left_out = np.setdiff1d(np.arange(3000), kept)
    assert 2000 < len(left_out) < 2500
    apart = np.linalg.norm(scene.points[left_out, None] - scene.points[kept], axis=2)
    inside = apart + cloud.CORE * radii[left_out, None] <= grown * (1 + 1e-12)
    assert (inside & (radii[kept] >= radii[left_out, None])).any(axis=1).all()


def test_balls_grow_to_about_ten_neighbours_but_not_around_outliers() -> None:
    radii = np.array([1.0, 1.0, 2.0, 30.0])
    assert cloud.grown_radii(radii, 6) == pytest.approx([1.3, 1.3, 2.6, 30.0], rel=1e-12)
    assert cloud.grown_radii(radii[:3], 8) == pytest.approx(radii[:3] * math.sqrt(10.14 / 8), rel=1e-12)
    assert cloud.grown_radii(radii, 11).tolist() == radii.tolist()
    assert cloud.grown_radii(radii, 1)[0] == 1.3


def test_points_in_one_place_share_a_ball() -> None:
    scene = of(np.repeat(jittered(300), 8, axis=0))
    kept, _ = cloud.cover(scene, 6)
    assert len(kept) <= 2 * 300


@pytest.mark.parametrize("ball_k", [6, 20])
@pytest.mark.parametrize("make", [jittered, even_square])
def test_which_balls_are_kept_does_not_hang_on_the_order_of_the_points(make, ball_k) -> None:
    points = make(900)
    order = np.random.default_rng(3).permutation(len(points))
    kept, again = cloud.cover(of(points), ball_k)[0], cloud.cover(of(points[order]), ball_k)[0]
    assert len(kept) < len(points)
    assert np.array_equal(np.sort(order[again]), kept)


def test_measured_clouds(data) -> None:
    kinect = load(data("clouds/kinect_table_241407.npz"))
    assert np.array_equal(cloud.local_points(kinect) + cloud.offset(kinect), kinect.points)
    assert 0.0017 < cloud.spacing(kinect) < 0.0019
    assert 0.25 < len(cloud.cover(kinect, 6)[0]) / len(kinect.points) < 0.35
