"""Rays through clouds: hits satisfy the oracle's equation and are the first, whoever traces them in whatever order."""

from __future__ import annotations

import math

import numpy as np
import pytest

from jaart.core import prepare
from jaart.core.records import STATUS_NAMES, Hits
from jaart.core.render import render
from jaart.core.samples import fibonacci
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Torus, first_hit
from jaart.core.trace import trace
from tests.core.cloud_scenes import CloudOracle, cloud, fresh, looked, rays, tracer_of
from tests.oracle.surfaces import polynomial_fit
from tests.oracle.vectors import dot, minus

COLUMNS = ("t", "point", "normal", "energy", "off_centre", "iterations", "evaluations", "neighbours", "cells",
           "lowered", "gap", "status")
EXACT = Settings(tolerance=1e-10, max_iterations=60)
SEARCHES = ("iterate", "secant", "newton", "safe")
FITS = {"tangent": {"method": "tangent"}, "polynomial": {"method": "polynomial", "degree": 3, "ball_k": 12}}


def same(one: Hits, other: Hits, columns: tuple[str, ...] = COLUMNS) -> bool:
    """Whether all columns have the same bits."""
    return all(np.array_equal(getattr(one, c), getattr(other, c), equal_nan=getattr(one, c).dtype.kind == "f")
               for c in columns)


@pytest.mark.parametrize("bare", [False, True], ids=["surfels", "bare"])
@pytest.mark.parametrize("fit", FITS)
@pytest.mark.parametrize("search", SEARCHES)
def test_hits_satisfy_the_oracles_equation_with_all_points(search: str, fit: str, bare: bool) -> None:
    scene, settings = cloud("bumpy", 700, bare), EXACT.replace(search=search, **FITS[fit])
    hits, oracle = render(scene, settings, rays=rays(40)), CloudOracle.of(scene, settings)
    assert hits.hit.sum() >= 20
    for x in hits.point[hits.hit][:12].tolist():
        f = oracle.f((0, 0, 0), x)
        assert f is not None and abs(f) < 1e-8 * oracle.values.h
        assert oracle.off_centre((0, 0, 0), x) <= oracle.values.off_centre * (1 + 1e-9)


@pytest.mark.parametrize("fit", FITS)
def test_what_the_radius_cuts_off_is_nothing(fit: str) -> None:
    scene, settings = cloud("bumpy", 1500), EXACT.replace(search="safe", **FITS[fit])
    h = prepare.prepared(scene, settings).values.h
    near, all_of_them = (render(scene, settings.replace(radius=r * h), rays=rays(60)) for r in (4, 6))
    both = near.hit & all_of_them.hit
    facing = np.abs((near.normal * near.direction).sum(axis=1)) > 0.3
    assert (near.hit == all_of_them.hit)[facing | ~near.hit].all() and both.sum() >= 30
    assert np.abs(near.t - all_of_them.t)[both & facing].max() < 1e-6


@pytest.mark.parametrize("inside", [False, True], ids=["outside", "inside"])
@pytest.mark.parametrize("name", ["sphere", "torus", "sheets"])
def test_the_first_hit_is_that_of_a_look_everywhere(name: str, inside: bool) -> None:
    scene, along = cloud(name, 800), rays(50, inside)
    expected = looked(scene, EXACT, along)
    assert np.isfinite(expected).sum() >= 15
    safe = render(scene, EXACT.replace(search="safe"), rays=along)
    grazing = np.abs((safe.normal * safe.direction).sum(axis=1)) < 0.1  # there steps may go to and fro for ever
    for search in (*SEARCHES, "march"):
        settings = EXACT.replace(search=search, step=0.2, tolerance=1e-3 if search == "march" else 1e-10)
        hits, asked = render(scene, settings, rays=along), ~grazing | (search == "safe")
        assert np.array_equal(hits.hit[asked], np.isfinite(expected)[asked]), search
        assert np.nanmax(np.abs(hits.t - expected)[asked]) < (1e-3 if search == "march" else 1e-9), search
        assert (hits.t[hits.hit] > 0).all()


def test_a_dense_sphere_shrinks_as_it_should() -> None:
    """The surface's radius r of a sphere R densely sampled: r = R·L(2rR/h²), L Langevin's function."""
    scene, along = cloud("sphere", 3000), rays(80)
    h, r = prepare.prepared(scene, EXACT).values.h, 1.0
    for _ in range(100):
        k = 2 * r / h**2
        r = 1 / math.tanh(k) - 1 / k
    foot = -(along[0] * along[1]).sum(axis=1)
    aside = np.linalg.norm(along[0] + foot[:, None] * along[1], axis=1)
    hits = render(scene, EXACT.replace(search="safe"), rays=along)
    clear = np.abs(aside - r) > 1e-3
    assert np.array_equal(hits.hit[clear], (aside < r)[clear])
    with np.errstate(invalid="ignore"):
        expected = foot - np.sqrt(r * r - aside * aside)
    met = hits.hit & (aside < 0.9)
    assert met.sum() > 30 and np.abs(hits.t - expected)[met].max() < 2e-4 < 0.1 * (1 - r)
    assert np.abs((hits.normal * hits.point).sum(axis=1)[met] / r - 1).max() < 1e-4


@pytest.mark.parametrize("inside", [False, True], ids=["outside", "inside"])
def test_a_polynomial_meets_the_torus_that_was_sampled(inside: bool) -> None:
    scene, along = cloud("torus", 2000), rays(150, inside, seed=4)
    exact = first_hit([Torus((0, 0, 0), "z", 1.0, 0.4)], *along)[0]
    hits = render(scene, EXACT.replace(method="polynomial", degree=4, ball_k=24), rays=along)
    facing = np.abs((hits.normal * hits.direction).sum(axis=1)) > 0.4
    assert (hits.hit == np.isfinite(exact)).mean() > 0.97
    assert np.isfinite(exact[hits.hit & facing]).all() and (hits.hit & facing).sum() > 60
    assert np.abs(hits.t - exact)[hits.hit & facing].max() < 5e-4


def test_nothing_is_hit_in_empty_space_or_behind() -> None:
    scene = cloud("sphere", 800)
    eyes = 3 * fibonacci(200)
    for search in (*SEARCHES, "march", "minimise", "centres"):
        settings = Settings(search=search)
        away = render(scene, settings, rays=(eyes, eyes))
        assert not away.hit.any() and (away.status == 1).all() and not away.evaluations.any() and not away.cells.any()
        assert tracer_of(scene, settings).gathered == 0
        beside = np.cross(eyes, [0.3, -0.2, 0.9])
        past = render(scene, settings, rays=(eyes * 0.5, beside))  # passes the sphere at half its radius
        assert not past.hit.any()


@pytest.mark.parametrize("search", [*SEARCHES, "centres"])
@pytest.mark.parametrize("fit", FITS)
def test_the_same_bits_whoever_asks_and_whatever_was_gathered_before(fit: str, search: str,
                                                                    monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("jaart.core.tiles.TILE", 37)  # many tiles, whose rays ask for the same balls at once
    settings, along = Settings(tolerance=1e-3, search=search, **FITS[fit]), rays(1500)
    once = fresh("bumpy", 1000)
    first = render(once, settings, rays=along, threads=1)
    counted = tracer_of(once, settings).gathered, tracer_of(once, settings).fits
    assert 0 < counted[0] < 1000 and counted[1] == (0 if search == "safe" else counted[0])
    assert same(first, render(once, settings, rays=along, threads=2))  # nothing more is gathered
    for threads in (2, 4):
        other = fresh("bumpy", 1000)
        assert same(first, render(other, settings, rays=along, threads=threads))
        assert (tracer_of(other, settings).gathered, tracer_of(other, settings).fits) == counted
    other, order = fresh("bumpy", 1000), np.random.default_rng(8).permutation(1500)
    render(other, settings, rays=rays(300, inside=True), threads=1)
    turned = render(other, settings, rays=(along[0][order], along[1][order]), threads=2)
    for name in COLUMNS:
        assert np.array_equal(getattr(turned, name), getattr(first, name)[order],
                              equal_nan=getattr(first, name).dtype.kind == "f"), name


def test_a_ray_gathers_only_balls_that_it_pierces() -> None:
    settings, along = Settings(), rays(1)
    scene = fresh("bumpy", 2000)
    hit = render(scene, settings, rays=along)
    tracer = tracer_of(scene, settings)
    centres, radii = tracer.ball(tracer.asked)
    foot = (centres - along[0]) @ along[1][0]
    aside = np.linalg.norm(centres - along[0] - foot[:, None] * along[1], axis=1)
    assert 0 < tracer.gathered <= 25 and (aside <= radii).all()
    assert tracer.gathered >= hit.cells[0] > 0


@pytest.mark.parametrize("inside", [False, True], ids=["outside", "inside"])
@pytest.mark.parametrize("fit", FITS)
def test_any_hit_is_found_where_the_first_is(fit: str, inside: bool) -> None:
    along = rays(400, inside)
    for search in (*SEARCHES, "march", "centres"):
        settings = Settings(tolerance=1e-3, search=search, **FITS[fit])
        first = render(cloud("bumpy", 1000), settings, rays=along)
        some = render(cloud("bumpy", 1000), settings, rays=along, any_hit=True)
        assert np.array_equal(first.hit, some.hit), search
        h = prepare.prepared(cloud("bumpy", 1000), settings).values.h
        assert (some.t[some.hit] >= first.t[some.hit] - 0.25 * h).all(), search


def test_a_ray_that_begins_on_a_plane_does_not_hit_it() -> None:
    scene, h = cloud("sheets", 800), 0.2
    o, d = np.zeros((4, 3)), np.array([[0, 0, 1.0], [0, 0, -1.0], [0.6, 0, 0.8], [0.6, 0, -0.8]])
    for any_hit in (False, True):
        hits = render(scene, Settings(h=h), rays=(o, d), any_hit=any_hit)
        assert hits.hit.tolist() == [True, False, True, False]
        assert hits.t[hits.hit] == pytest.approx([1.0, 1.25], abs=1e-12)


@pytest.mark.parametrize("search", ["iterate", "newton", "safe"])
@pytest.mark.parametrize("fit", FITS)
def test_a_cloud_far_from_the_origin(fit: str, search: str) -> None:
    points = np.round(fresh("bumpy", 800).points * 2.0**20) / 2.0**20
    settings, moved = Settings(tolerance=1e-9, search=search, **FITS[fit]), 2.0**20 * np.array([1, -1, 1])
    o, d = rays(100)
    o = np.round(o * 2.0**20) / 2.0**20
    here = render(Scene("here", points=points), settings, rays=(o, d))
    there = render(Scene("there", points=points + moved), settings, rays=(o + moved, d))
    assert here.hit.sum() > 40
    assert same(here, there, tuple(c for c in COLUMNS if c != "point"))
    off = np.abs(there.point - moved - here.point)[here.hit]
    assert off.max() <= 2.0**-32  # half a unit in the last place of 2^20


@pytest.mark.parametrize("power", [-300, -30, 30, 300])
@pytest.mark.parametrize("search", ["iterate", "safe"])
@pytest.mark.parametrize("fit", FITS)
def test_a_cloud_of_any_size(fit: str, search: str, power: int) -> None:
    scene, scale = cloud("bumpy", 800), 2.0**power
    settings, (o, d) = Settings(tolerance=1e-6, search=search, **FITS[fit]), rays(60)
    one = render(scene, settings, rays=(o, d))
    other = render(Scene("scaled", points=scene.points * scale, normals=scene.normals), settings, rays=(o * scale, d))
    assert one.hit.sum() > 20
    assert same(one, other, ("normal", "evaluations", "iterations", "neighbours", "cells", "lowered", "status"))
    assert np.array_equal(one.t * scale, other.t, equal_nan=True)
    assert np.array_equal(one.point * scale, other.point, equal_nan=True)


@pytest.mark.parametrize("fit", FITS)
def test_centres_alone_are_met(fit: str) -> None:
    """Each hit lies on the plane or polynomial that the oracle fits at the centre of its ball."""
    scene, settings = cloud("bumpy", 700), EXACT.replace(search="centres", **FITS[fit])
    hits, oracle = render(scene, settings, rays=rays(30)), CloudOracle.of(scene, settings)
    assert hits.hit.sum() >= 15
    for i in np.flatnonzero(hits.hit)[:10]:
        recorded = trace(scene, settings, hits.origin[i], hits.direction[i])
        last = next(k for k, name in enumerate(recorded.outcome) if name == STATUS_NAMES[0])
        *centre, radius = recorded.balls[recorded.step_cell[last, 0]].tolist()
        away = minus(hits.point[i].tolist(), centre)
        assert math.hypot(*away) <= radius * (1 + 1e-9)
        if fit == "tangent":
            assert abs(dot(oracle.n((0, 0, 0), centre), away) - oracle.f((0, 0, 0), centre)) < 1e-9
            continue
        plane = polynomial_fit(centre, *oracle.surfels((0, 0, 0), centre), oracle.values.h, 3)
        assert abs(plane.height(dot(away, plane.u), dot(away, plane.v)) - dot(away, plane.n)) < 1e-8
