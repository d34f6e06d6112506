"""δ, δ_p and δ_n of hits made by hand, and of a scene with exact solids."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from jaart.core import cloud, prepare
from jaart.core.quality import against, angles, quality
from jaart.core.records import STATUS, Hits, Quality
from jaart.core.samples import bumpy_sphere
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere, first_hit

Array = NDArray[np.float64]
DOWN = (0.0, 0.0, -1.0)
UP = (0.0, 0.0, 1.0)


def make_hits(t: list[float], normal: list[tuple[float, float, float]] | Array, origin: Array | None = None,
              direction: Array | None = None, status: list[str] | None = None) -> Hits:
    """Hits of rays that look down from (0, 0, 10), NaN = background."""
    n = len(t)
    direction = np.tile(DOWN, (n, 1)) if direction is None else direction
    origin = np.tile([0.0, 0.0, 10.0], (n, 1)) if origin is None else origin
    at = np.array(t)
    names = status or ["background" if math.isnan(x) else "converged" for x in t]
    zeros = np.zeros(n, np.int32)
    return Hits(origin, direction, at, origin + at[:, None] * direction, np.array(normal, dtype=float), at * 0, at * 0,
                zeros, zeros, zeros, zeros, zeros, at * np.nan, np.array([STATUS[name] for name in names], np.uint8),
                zeros, zeros, zeros, Settings())


def one(t: float, normal: tuple[float, float, float], exact_t: float,
        exact_normal: tuple[float, float, float]) -> Quality:
    """The quality of a single ray."""
    return against(make_hits([t], [normal]), np.array([exact_t]), np.array([exact_normal]))


def test_a_perfect_hit_has_no_error() -> None:
    q = one(4.0, UP, 4.0, UP)
    assert (q.delta, q.delta_p, q.delta_n, q.relevant) == (0, 0, 0, 1)
    assert (q.distance[0], q.angle[0]) == (0, 0)


def test_a_distance_alone_counts_where_the_surface_is_seen_flat() -> None:
    q = one(4.25, UP, 4.0, UP)
    assert (q.delta_p, q.delta_n, q.distance[0]) == (0.25, 0, 0.25)
    assert q.delta == 0  # |<n, r>| = 1 leaves only the normal's share
    aslant = (0.8, 0.0, 0.6)
    assert one(4.25, aslant, 4.0, aslant).delta == pytest.approx(0.4 * 0.25)


def test_a_tilted_normal() -> None:
    tilted = (0.6, 0.0, 0.8)
    q = one(4.5, tilted, 4.0, UP)
    assert q.delta_n == pytest.approx(0.2)
    assert q.delta_p == pytest.approx(0.5)
    assert q.delta == pytest.approx(0.8 * 0.2 + 0.2 * 0.5)
    assert q.angle[0] == pytest.approx(math.degrees(math.atan2(0.6, 0.8)))


def test_both_normals_are_turned_to_the_viewer_first() -> None:
    for found in (UP, DOWN):
        for exact in (UP, DOWN):
            q = one(4.0, found, 4.0, exact)
            assert (q.delta, q.delta_n, q.angle[0]) == (0, 0, 0)


def test_each_penalty_is_one() -> None:
    none = (math.nan,) * 3
    false_hit = one(4.0, UP, math.nan, none)
    assert (false_hit.false_hit, false_hit.delta, false_hit.delta_p, false_hit.delta_n) == (1, 1, 1, 1)
    assert math.isnan(false_hit.distance[0]) and math.isnan(false_hit.angle[0])
    false_miss = one(math.nan, none, 4.0, UP)
    assert (false_miss.false_miss, false_miss.delta, false_miss.relevant) == (1, 1, 1)
    far = one(5.5, (0.6, 0.0, 0.8), 4.0, UP)
    assert (far.distance_miss, far.delta, far.delta_p, far.delta_n) == (1, 1, 1, 1)
    assert far.distance[0] == 1.5
    assert one(5.0, UP, 4.0, UP).distance_miss == 0


def test_a_picture_is_averaged_over_the_rays_that_are_not_background() -> None:
    nan, none = math.nan, (math.nan,) * 3
    hits = make_hits([4.25, 4.0, nan, 7.0, nan, 4.0], [UP, UP, none, UP, none, (0.6, 0, 0.8)])
    q = against(hits, np.array([4.0, nan, 4.0, 4.0, nan, 4.0]), np.array([UP, none, UP, UP, none, UP]))
    assert (q.relevant, q.false_hit, q.false_miss, q.distance_miss) == (5, 1, 1, 1)
    assert q.delta_p == pytest.approx((0.25 + 3) / 5)
    assert q.delta_n == pytest.approx((0.2 + 3) / 5)
    assert q.delta == pytest.approx((0.8 * 0.2 + 3) / 5)
    assert np.isnan(q.distance).tolist() == [False, True, True, False, True, False]


def test_without_a_relevant_ray_there_is_no_delta() -> None:
    q = against(make_hits([math.nan], [(math.nan,) * 3]), np.array([math.nan]), np.full((1, 3), math.nan))
    assert q.relevant == 0
    assert all(math.isnan(d) for d in (q.delta, q.delta_p, q.delta_n))


def test_a_hit_at_the_precision_floor_is_a_hit() -> None:
    hits = make_hits([4.0], [UP], status=["floor"])
    assert against(hits, np.array([4.0]), np.array([UP])).delta == 0


@settings(max_examples=40, deadline=None)
@given(st.floats(0, math.pi), st.floats(0, 2 * math.pi))
def test_angles_are_exact_also_near_0_and_180(angle: float, turn: float) -> None:
    a = np.array([[math.cos(turn), math.sin(turn), 0.0]])
    b = math.cos(angle) * a + math.sin(angle) * np.array([[0.0, 0.0, 1.0]])
    assert angles(a, b)[0] == pytest.approx(math.degrees(angle), rel=1e-12, abs=1e-13)


def test_a_scene_without_solids_has_no_quality() -> None:
    scene = Scene("levels", levels=np.zeros((4, 4, 4)))
    assert quality(make_hits([4.0], [UP]), scene) is None


def test_against_a_scenes_own_solids_exact_hits_are_perfect() -> None:
    scene = Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.25),), 16))
    rng = np.random.default_rng(4)
    target = rng.uniform(2, 14, (400, 3))
    direction = rng.normal(size=(400, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    origin = target - 30 * direction
    solids = prepare.solids(scene, Settings())
    assert solids is not None
    t, normal = first_hit(solids, origin, direction)
    assert 0 < np.isfinite(t).sum() < 400
    q = quality(make_hits(list(t), normal, origin, direction), scene)
    assert q is not None
    assert q.relevant == np.isfinite(t).sum()
    assert (q.delta, q.delta_p, q.delta_n) == (0, 0, 0)
    moved = quality(make_hits(list(t + 0.125), -normal, origin, direction), scene)
    assert moved is not None
    assert moved.delta_p == pytest.approx(0.125)
    assert moved.delta_n == 0


def test_bad_rays_are_left_out() -> None:
    scene = Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.25),), 16))
    origin = np.array([[8.0, 8.0, 30.0], [math.nan, 8.0, 30.0]])
    hits = make_hits([18.0, math.nan], [UP, (math.nan,) * 3], origin, status=["converged", "bad_ray"])
    q = quality(hits, scene)
    assert q is not None
    assert (q.relevant, q.false_miss, q.delta) == (1, 0, 0)


def test_a_cloud_is_measured_in_its_spacings() -> None:
    scene = bumpy_sphere(2000)
    rng = np.random.default_rng(5)
    direction = rng.normal(size=(300, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    origin = rng.uniform(-1.2, 1.2, (300, 3)) - 5 * direction
    assert scene.exact is not None
    t, normal = scene.exact.hit(origin, direction)
    assert 50 < np.isfinite(t).sum() < 300
    exact = quality(make_hits(list(t), normal, origin, direction), scene)
    assert exact is not None and (exact.delta, exact.relevant) == (0, np.isfinite(t).sum())
    moved = quality(make_hits(list(t + 0.25 * cloud.spacing(scene)), normal, origin, direction), scene)
    assert moved is not None and moved.delta_p == pytest.approx(0.25)
    assert quality(make_hits(list(t), normal, origin, direction), Scene("x", points=scene.points)) is None
