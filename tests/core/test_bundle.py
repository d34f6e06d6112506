"""Rays of a cloud that go together end as each of them does alone, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest

import jaart
from jaart.core import prepare
from jaart.core.balls import bundle_room
from jaart.core.kernels import bundle
from jaart.core.kernels.pierce import Balls
from jaart.core.samples import bumpy_sphere
from jaart.core.scene import Scene

RNG = np.random.default_rng(5)
COLUMNS = ("t", "point", "normal", "energy", "off_centre", "iterations", "evaluations", "neighbours", "cells",
           "lowered", "gap", "status", "starts", "eigenvectors")
SHELLS = Scene("shells", points=np.concatenate([bumpy_sphere(9000).points * size for size in (1.0, 0.7, 0.4)]))
DENSE = bumpy_sphere(200_000)
SIZE = (40, 24)


def rays(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Origins and directions of a picture from close by, some of them without a meaning."""
    first = jaart.render(scene, jaart.Settings(), size=SIZE)
    origins, directions = np.array(first.origin), np.array(first.direction)
    origins[100], directions[333], directions[500] = np.nan, (0.0, 0.0, 0.0), (np.inf, 0.0, 0.0)
    return origins, directions


def assert_same(one: jaart.Hits, other: jaart.Hits, rows: np.ndarray) -> None:
    """Assert that the rows of a first list of rays ended as the second list."""
    for name in COLUMNS:
        a, b = getattr(one, name)[rows], getattr(other, name)
        assert np.array_equal(a, b, equal_nan=a.dtype == float), name


@pytest.mark.parametrize("scene", [SHELLS, DENSE], ids=["shells", "dense"])
@pytest.mark.parametrize("any_hit", [False, True], ids=["first", "any"])
@pytest.mark.parametrize("changes", [{}, {"search": "safe"}, {"search": "centres"}], ids=["iterate", "safe", "centres"])
def test_a_ray_does_not_hang_on_its_company(scene: Scene, any_hit: bool, changes: dict[str, str]) -> None:
    settings = jaart.Settings().replace(**changes)
    origins, directions = rays(scene)
    together = jaart.render(scene, settings, rays=(origins, directions), any_hit=any_hit)
    assert together.hit.sum() > 150
    mixed = RNG.permutation(len(origins))
    others = jaart.render(scene, settings, rays=(origins[mixed], directions[mixed]), any_hit=any_hit)
    assert_same(together, others, mixed)
    for row in range(0, len(origins), 37):
        alone = jaart.render(scene, settings, rays=(origins[[row]], directions[[row]]), any_hit=any_hit)
        assert_same(together, alone, np.array([row]))


def test_rays_that_part_end_as_alone() -> None:
    directions = RNG.normal(size=(500, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    settings, origins = jaart.Settings(), RNG.normal(size=(500, 3)) * 0.5
    together = jaart.render(SHELLS, settings, rays=(origins, directions))
    for row in range(0, 500, 9):
        alone = jaart.render(SHELLS, settings, rays=(origins[[row]], directions[[row]]))
        assert_same(together, alone, np.array([row]))


def balls_of(scene: Scene) -> Balls:
    """The balls of a cloud as kernels see them."""
    cloud = prepare.prepared(scene, jaart.Settings()).tracer.cloud
    x, y, z = cloud.offset.tolist()
    sites = prepare.prepared(scene, jaart.Settings()).tracer.sites
    return Balls(sites, cloud.radii, cloud.tree, cloud.leaves, 0, 0, (x, y, z), 0.0)


@pytest.mark.parametrize("wide", [0.0, 0.01])
def test_no_ball_that_a_ray_pierces_is_missed(wide: float) -> None:
    balls, room = balls_of(SHELLS), bundle_room()
    origins = np.array([-3.0, 0.1, 0.2]) + RNG.normal(size=(64, 3)) * wide
    directions = np.array([1.0, 0.0, 0.0]) + RNG.normal(size=(64, 3)) * 0.005
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    cone = bundle.cone_about.py_func(origins, directions, np.arange(64), balls.offset)
    listed, seen = bundle.nothing_listed.py_func(balls, cone, 64, room, np.empty(4096)), [0]
    while listed.nodes:
        known = bundle.horizon.py_func(room, listed)
        before, listed = listed, bundle.list_more.py_func(balls, cone, room, listed)
        assert listed.balls > before.balls or not listed.nodes
        assert bundle.horizon.py_func(room, listed) >= known
        seen.append(listed.balls)
    assert listed.balls > 0
    c = balls.sites.centres[:, None] - origins
    foot = (c * directions).sum(axis=2)
    aside = c - foot[..., None] * directions
    pierced = ((aside * aside).sum(axis=2) <= (balls.radii * balls.radii)[:, None]) & (foot > 0)
    assert set(np.flatnonzero(pierced.any(axis=1))) <= set(room.numbers[:listed.balls].tolist())
    assert len(set(room.numbers[:listed.balls].tolist())) == listed.balls < len(balls.radii) and len(seen) > 2
