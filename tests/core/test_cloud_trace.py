"""One followed ray through a cloud: the same hit as in a picture, and what its steps saw, as the oracle has it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from jaart.core.errors import RayError
from jaart.core.records import STATUS_NAMES, Trace
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.trace import trace
from tests.core.cloud_scenes import CloudOracle, cloud, fresh, rays, tracer_of
from tests.oracle.weights import normalised

SEARCHES = ("iterate", "secant", "newton", "march", "safe", "centres", "minimise")


def traced(scene: Scene, settings: Settings, count: int = 12) -> list[tuple[Trace, float, int]]:
    """Rays followed in a cloud, with t and status that a picture of it has."""
    hits = render(scene, settings, rays=rays(count))
    followed = [trace(scene, settings, o, d) for o, d in zip(hits.origin, hits.direction, strict=True)]
    return list(zip(followed, hits.t.tolist(), hits.status.tolist(), strict=True))


@pytest.mark.parametrize("search", SEARCHES)
def test_the_same_hit_as_in_a_picture_and_steps_in_balls_that_are_pierced(search: str) -> None:
    settings = Settings(search=search)
    for one, t, status in traced(cloud("bumpy", 600), settings):
        assert np.array_equal(one.t, t, equal_nan=True) and one.status == STATUS_NAMES[status]
        assert len(one.t_query) == len(one.outcome) == len(one.neighbours)
        if math.isfinite(t):
            assert one.outcome.count("converged") + one.outcome.count("floor") >= 1
            assert np.abs(one.origin + t * one.direction - one.point).max() < 1e-12
        assert (one.step_cell[:, 0] >= 0).all() and (one.step_cell[:, 0] < len(one.balls)).all()
        for k, number in enumerate(one.step_cell[:, 0]):
            if search != "centres":
                away = np.linalg.norm(one.query[k] - one.balls[number, :3])
                assert away <= one.balls[number, 3] * (1 + 1e-9)
                assert np.abs(one.query[k] - one.origin - one.t_query[k] * one.direction).max() < 1e-12


@pytest.mark.parametrize("near", ["ball", "knn"])
def test_the_surfels_that_counted_and_their_weights(near: str) -> None:
    scene, settings = fresh("torus", 400), Settings(neighbourhood=near, k=9, tolerance=1e-6)
    oracle, seen = CloudOracle.of(scene, settings), 0
    for one, _, _ in traced(scene, settings):
        for x, ids, weights in list(zip(one.query.tolist(), one.neighbours, one.weights, strict=True))[:4]:
            expected = oracle.near((0, 0, 0), x)
            shares = normalised("gaussian", x, oracle.surfels((0, 0, 0), x)[0], oracle.values.h)
            assert sorted(ids.tolist()) == expected
            assert np.abs(weights[np.argsort(ids)] - shares).max() < 1e-9
            seen += 1
    assert seen > 15


def test_the_balls_in_order_and_energies_within_them() -> None:
    scene, settings = fresh("bumpy", 600), Settings()
    for one, _, _ in traced(scene, settings, 20):
        foot = (one.balls[:, :3] - one.origin) @ one.direction
        aside = np.linalg.norm(one.balls[:, :3] - one.origin - foot[:, None] * one.direction, axis=1)
        half = np.sqrt(np.maximum(one.balls[:, 3]**2 - aside**2, 0))
        assert (aside <= one.balls[:, 3] * (1 + 1e-12)).all() and (np.diff(foot - half) >= -1e-12).all()
        for t in one.curves.t:
            away = np.linalg.norm(one.origin + t * one.direction - one.balls[:, :3], axis=1)
            assert t >= 0 and (away <= one.balls[:, 3] * (1 + 1e-9)).any()
        assert len(one.curves.t) > 0 or not len(one.balls)


def test_a_ray_from_where_there_is_no_precision_is_refused() -> None:
    scene, settings = fresh("sphere", 300), Settings()
    with pytest.raises(RayError, match="too far from the scene to have any precision"):
        trace(scene, settings, (-1e17, 0, 0), (1, 0, 0))
    assert trace(scene, settings, (-1e3, 0, 0), (1, 0, 0)).hit


def test_a_ray_that_pierces_nothing() -> None:
    scene, settings = fresh("sphere", 300), Settings()
    past = trace(scene, settings, (3, 3, 3), (1, 0, 0))
    assert (past.status, len(past.balls), len(past.t_query), len(past.curves.t)) == ("background", 0, 0, 0)
    assert tracer_of(scene, settings).gathered == 0
    inside = trace(scene, settings, (0, 0, 0), (0, 0, 1))
    assert inside.status == "converged" and 0.9 < inside.t < 1


def test_a_log_longer_than_its_room_is_whole() -> None:
    scene, settings = fresh("bumpy", 600), Settings(search="march", step=0.004)
    one = trace(scene, settings, (0, 0, 3), (0, 0, -1))
    assert len(one.t_query) > 256 and np.isfinite(one.t_query).all() and one.status == "converged"
    assert np.array_equal(one.t, render(scene, settings, rays=(one.origin[None], one.direction[None])).t[0])
