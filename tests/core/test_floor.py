"""How near to the exact hit regular rays come, in how many evaluations; and what covariances from raw moments cost."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks import floor, raw_moments
from benchmarks.floor import H, Rays
from jaart.core import prepare
from jaart.core.kernels import records as r
from jaart.core.kernels.records import End, Start
from jaart.core.kernels.stepping import step_search
from jaart.core.places import listed, scratch
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.tracers import NO_LOG

#: Evaluations a ray that reaches 1e-14 h may take from h/2 above the surface.
MOST = {"newton": 4.5, "secant": 6.0, "iterate": 8.5}
SEARCHES = (*MOST, "safe")


@pytest.fixture(scope="module")
def sphere() -> Scene:
    return floor.sphere()


@pytest.fixture(scope="module", params=["surfel", "covariance"])
def regular(request: pytest.FixtureRequest, sphere: Scene) -> tuple[str, Rays]:
    return request.param, floor.regular(sphere, floor.SETTINGS.replace(normal=request.param), 40)


def searched(scene: Scene, search: str, o: np.ndarray, d: np.ndarray) -> End:
    """A search that begins at a ray's origin itself, with all surfels counted."""
    settings = floor.SETTINGS.replace(search=search, tolerance=1e-14, radius=10.0, max_off_centre="none")
    plan = prepare.prepared(scene, settings).tracer.plan
    assert scene.points is not None and scene.normals is not None
    centre = scene.points[np.argmin(((scene.points - o) ** 2).sum(axis=1))]
    columns = np.concatenate((scene.points - centre, scene.normals), axis=1).T.ravel()
    count = len(scene.points)
    sites = listed((0, 0, 0), centre[None].copy(), np.array([0, count]), np.arange(count, dtype=np.int32), columns)
    x, y, z = (o - centre).tolist()
    start = Start((0, 0, 0), (x, y, z), 0.0, 0.0, -1.0, 1.0, math.nan, 0)
    found: End = step_search(sites, plan.rule, plan.how, plan.bounds, tuple(d.tolist()), start, NO_LOG, 0,
                             *scratch(count))
    return found


@pytest.mark.parametrize("search", MOST)
def test_from_half_h_above_the_surface_so_many_evaluations_reach_the_floor(sphere: Scene, search: str,
                                                                           monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(floor, "ABOVE", 0.5)
    found = [searched(sphere, search, *ray) for ray in zip(*floor.starts(300), strict=True)]
    assert all(end.state in (r.CONVERGED, r.FLOOR) for end in found)
    assert np.mean([end.evaluations for end in found]) <= MOST[search]
    rays = floor.regular(sphere, floor.SETTINGS, 40)
    for o, d, exact in zip(rays.o, rays.d, rays.t, strict=True):
        assert abs(searched(sphere, search, o, d).t - exact) <= 1e-14 * H


@pytest.mark.parametrize("search", SEARCHES)
def test_every_regular_ray_reaches_the_floor(sphere: Scene, regular: tuple[str, Rays], search: str) -> None:
    normal, rays = regular
    hits = render(sphere, floor.SETTINGS.replace(normal=normal, search=search, tolerance=1e-14), rays=(rays.o, rays.d))
    assert hits.hit.all()
    assert rays.error(hits).max() <= 1e-14
    assert hits.evaluations.mean() <= MOST.get(search, 70)


@pytest.mark.parametrize("search", SEARCHES)
def test_errors_keep_the_tolerance_asked_for(sphere: Scene, regular: tuple[str, Rays], search: str) -> None:
    normal, rays = regular
    for tolerance in floor.TOLERANCES:
        settings = floor.SETTINGS.replace(normal=normal, search=search, tolerance=tolerance)
        assert rays.error(render(sphere, settings, rays=(rays.o, rays.d))).max() <= tolerance


@pytest.mark.parametrize("shift", floor.SHIFTS)
def test_far_from_the_origin_only_the_point_is_coarser(shift: float) -> None:
    """By half a unit in the last place of its largest coordinate; near the origin the sums' own rounding is as much."""
    scene, settings = floor.sphere(shift), floor.SETTINGS.replace(search="newton", tolerance=1e-14)
    rays = floor.regular(scene, settings, 12, shift)
    hits = render(scene, settings, rays=(rays.o, rays.d))
    assert rays.error(hits).max() <= 1e-14
    assert rays.places(hits)[1] <= (0.51 if shift else 2.0)


def test_raw_moments_break_down_where_adamson_and_alexa_do_and_the_program_does_not() -> None:
    there = raw_moments.irregular()
    far = there.moved(np.array([[2 * there.h / raw_moments.H, 0, 0]]))
    raw, local, own = raw_moments.literal(far, True), raw_moments.literal(far, False), raw_moments.program(far)
    at = {tolerance: i for i, tolerance in enumerate(raw_moments.TOLERANCES)}
    assert raw[at[1e-10]].mean() < 1.15 * local[at[1e-10]].mean()
    assert raw[at[1e-11]].mean() > 1.5 * raw[at[1e-10]].mean()
    assert (raw[at[1e-12]] > raw_moments.STEPS).mean() > 0.1
    for steps in (local, own):
        assert (steps <= raw_moments.STEPS).all()
        assert steps[at[1e-12]].mean() < steps[at[1e-10]].mean() + 1
