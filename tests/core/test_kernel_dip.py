"""A search for a root ends where its ray passes by the surface, and only there."""

from __future__ import annotations

from math import inf, isnan, nan

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from benchmarks import vectors
from jaart.core import prepare
from jaart.core.kernels import records as r
from jaart.core.kernels.dip import Dip, nothing_known, passes_by, tells_sides, with_look
from jaart.core.records import STATUS
from jaart.core.render import render
from jaart.core.samples import fibonacci
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from jaart.core.trace import trace

CENTRE, RADIUS, RAYS = (0.5, 0.5, 0.5), 0.3, 600
SCENE = Scene("ball", model=Model((Sphere(CENTRE, RADIUS),), 24))
PLACES = st.lists(st.tuples(st.floats(-9, 9), st.floats(-9, 9)), min_size=1, max_size=9, unique_by=lambda look: look[0])


def after(looks: list[tuple[float, float]]) -> Dip:
    dip = nothing_known()
    for s, f in looks:
        dip = with_look(dip, s, f)
    return dip


@given(PLACES)
def test_the_least_value_and_its_neighbours_are_kept(looks: list[tuple[float, float]]) -> None:
    dip = after(looks)
    assert (dip.s, dip.f) == min(looks, key=lambda look: abs(look[1]))  # the first of equal ones
    for place, f, side in ((dip.before, dip.f_before, -1), (dip.behind, dip.f_behind, 1)):
        there = [look for look in looks if side * (look[0] - dip.s) > 0]
        assert ((place, f) in there) if not isnan(place) else isnan(f)
        since = [look for look in there if looks.index(look) > looks.index((dip.s, dip.f))]
        assert all(abs(place - dip.s) <= abs(look[0] - dip.s) for look in since)  # none of them is forgotten


@given(st.floats(0.1, 5), st.floats(-3, 3), st.floats(-2, 2), st.sampled_from((-1.0, 1.0)),
       st.lists(st.integers(-40, 40), min_size=3, max_size=3, unique=True))
def test_a_parabola_is_passed_by_where_half_of_the_least_value_is_left(bend: float, lowest: float, least: float,
                                                                      side: float, steps: list[int]) -> None:
    places = [step / 10 for step in steps]
    looks = [(s, side * (bend * (s - lowest)**2 + least)) for s in places]
    dip = after(looks)
    values = [f * side for _, f in sorted(looks)]
    inner = values[1]
    assume(abs(least - 0.5 * inner) > 1e-6 and all(abs(f) > 1e-6 for f in values))
    known = not isnan(dip.before) and not isnan(dip.behind)
    assert passes_by(dip) == (known and min(values) > 0 and least > 0.5 * inner)


@pytest.mark.parametrize("dip", [
    Dip(nan, inf, nan, nan, nan, nan), Dip(0.0, 1.0, nan, nan, 1.0, 2.0), Dip(0.0, 1.0, -1.0, 2.0, nan, nan),
    Dip(0.0, 1.0, -1.0, -2.0, 1.0, 2.0), Dip(0.0, 1.0, -1.0, 2.0, 1.0, -2.0), Dip(0.0, 0.0, -1.0, 1.0, 1.0, 1.0),
    Dip(0.0, 1.0, -1.0, nan, 1.0, 2.0)])
def test_nothing_is_concluded_from_one_side_from_a_change_of_sign_or_from_no_number(dip: Dip) -> None:
    assert not passes_by(dip)


@pytest.mark.parametrize(("settings", "told"), [
    (Settings(search="iterate"), False), (Settings(search="secant"), True), (Settings(search="newton"), True),
    (Settings(search="secant", normal="covariance"), True)])
def test_surfels_normals_tell_the_sides(settings: Settings, told: bool) -> None:
    plan = prepare.prepared(SCENE, settings).tracer.plan  # type: ignore[attr-defined]
    assert tells_sides(plan.how, plan.rule) == told


def test_bare_points_tell_no_sides() -> None:
    bare = Scene("bare", points=fibonacci(500))
    plan = prepare.prepared(bare, Settings(search="secant", normal="covariance")).tracer.plan  # type: ignore[attr-defined]
    assert plan.rule.normal == r.COVARIANCE and not tells_sides(plan.how, plan.rule)


def rays(low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Rays from all sides that pass by the ball at distances in cells; below 0 they meet it."""
    rng = np.random.default_rng(7)
    d, other = (vectors.unit(rng.normal(size=(RAYS, 3))) for _ in range(2))
    aside = vectors.unit(np.cross(d, other)) * (24 * RADIUS + rng.uniform(low, high, RAYS))[:, None]
    return 24 * np.asarray(CENTRE) + aside - 20 * d, d


@pytest.mark.parametrize(("method", "search", "most"), [
    ("tangent", "secant", 5), ("tangent", "newton", 4), ("polynomial", "secant", 6), ("polynomial", "newton", 12)])
def test_rays_beside_a_ball_are_done_soon(method: str, search: str, most: float) -> None:
    hits = render(SCENE, Settings(method=method, search=search, tolerance=1e-6), rays=rays(0.1, 0.4))
    assert not hits.hit.any() and hits.starts.sum() > RAYS
    assert (hits.status == STATUS["cap"]).sum() < 0.02 * RAYS
    assert hits.evaluations.sum() < most * hits.starts.sum()  # twice to three times as many where each goes on


@pytest.mark.parametrize("search", ["secant", "newton"])
@pytest.mark.parametrize("method", ["tangent", "polynomial"])
def test_what_grazes_a_ball_is_hit_where_a_safe_search_hits(method: str, search: str) -> None:
    settings = Settings(method=method, search=search, tolerance=1e-6)
    hits, safe = (render(SCENE, one, rays=rays(-0.4, 0.1)) for one in (settings, settings.replace(search="safe")))
    assert 0.6 * RAYS < safe.hit.sum() < 0.95 * RAYS and (hits.hit != safe.hit).sum() <= 2


def test_a_followed_ray_says_that_it_passes_by() -> None:
    settings = Settings(method="polynomial", search="secant", tolerance=1e-6)
    hits = render(SCENE, settings, rays=rays(0.1, 0.4))
    i = np.flatnonzero((hits.evaluations > 2) & (hits.starts == 1) & (hits.status == STATUS["background"]))[0]
    told = trace(SCENE, settings, hits.origin[i], hits.direction[i])
    assert told.status == "background" and told.outcome[-1] == "background"
    assert told.steps == hits.evaluations[i] and np.isfinite(told.step_normal).all()
