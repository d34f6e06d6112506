"""The kernel of the point-set surface against the slow oracle, and pictures of it against exact solids."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from numpy.typing import NDArray

from jaart.core import prepare
from jaart.core.io import load
from jaart.core.kernels import polynomial, project, reference_plane
from jaart.core.kernels import records as r
from jaart.core.kernels.vectors import frame
from jaart.core.places import scratch
from jaart.core.quality import quality
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from tests.oracle.normals import offset
from tests.oracle.projection import plane_energy, plane_gradient
from tests.oracle.projection import project as oracle
from tests.oracle.samples import cloudlet, spiral, tilted_plane
from tests.oracle.vectors import along, dot, minus, unit
from tests.oracle.weights import normalised

Array = NDArray[np.float64]
Points = list[list[float]]

WEIGHTS = {"gaussian": r.GAUSSIAN, "hat": r.HAT, "squared_hat": r.SQUARED_HAT, "wendland": r.WENDLAND}
NORMALS = {"surfel": r.SURFEL, "covariance": r.COVARIANCE, "covariance_at_x": r.COVARIANCE_AT_X}
#: Weights with a slope that is continuous: E has no creases, and its minimum is known to rounding.
SMOOTH = ("gaussian", "wendland")
TILTED = unit([1.0, -2.0, 3.0])


def near_of(points: Points, normals: Points) -> r.Near:
    columns = np.concatenate([np.array(points).T.ravel(), np.array(normals).T.ravel()])
    return r.Near(columns, np.uint64(0), np.uint64(len(points)), np.uint64(len(points)))


def three(a: list[float]) -> r.Vector:
    return a[0], a[1], a[2]


def rule_of(h: float, weight: str, kind: str, degree: int = 2) -> r.Rule:
    return r.Rule(WEIGHTS[weight], NORMALS[kind], h, reach=math.inf, k=0, oriented=1, degree=degree, patch=0.0, c=0.25)


def evaluated(x: list[float], points: Points, normals: Points, h: float, weight: str = "gaussian", kind: str = "surfel",
              degree: int = 2) -> tuple[r.Value, Array, Array]:
    """The value at x, the scratch array and the polynomial."""
    work, coefficients = np.full_like(scratch(len(points))[0], np.nan), np.full(r.FIT_SIZE, np.nan)
    value = project.projection(near_of(points, normals), three(x), rule_of(h, weight, kind, degree), 0, work,
                               coefficients)
    return value, work, coefficients[:r.COEFFICIENTS]


def shape(name: str, seed: int) -> tuple[Points, Points, list[float], float]:
    """60 surfels, a place near their surface, and h."""
    rng = random.Random(seed)
    x = [rng.uniform(-0.4, 0.4) for _ in range(3)]
    if name == "plane":
        points, normals = tilted_plane(TILTED, [0.1, 0.0, -0.1], seed=seed)
        return points, normals, x, 1.1
    if name == "sphere":
        points, normals = spiral(1.5, 60)
        return points, normals, [c * rng.uniform(1.2, 1.7) for c in unit(x)], 0.9
    points, normals = cloudlet(60, seed, 0.1)
    return points, normals, x, rng.choice([0.8, 1.2])


@pytest.mark.parametrize("kind", NORMALS)
@pytest.mark.parametrize("weight", SMOOTH)
@pytest.mark.parametrize("name", ["plane", "sphere", "noisy"])
def test_it_is_what_the_oracle_says(name: str, weight: str, kind: str) -> None:
    defined = 0
    for seed in range(6):
        points, normals, x, h = shape(name, seed)
        expected = oracle(x, points, normals, h, 2, weight, kind)
        found, _, _ = evaluated(x, points, normals, h, weight, kind)
        assert (expected is None) == (found.state != r.CONTINUE)
        if expected is None:
            assert found.state == r.UNDEFINED_NORMAL and math.isnan(found.f)
            continue
        defined += 1
        assert found.f == pytest.approx(expected.value, abs=2e-14)
        assert found.n == pytest.approx(expected.n, abs=1e-13)
        assert along(x, found.n, found.f) == pytest.approx(expected.point, abs=1e-13)
        assert found.degree == expected.fit.degree
    assert defined >= 4


@pytest.mark.parametrize("degree", range(5))
def test_the_polynomial_counts_from_x(degree: int) -> None:
    points, normals, x, h = shape("noisy", 3)
    expected = oracle(x, points, normals, h, degree, "gaussian", "surfel")
    found, _, c = evaluated(x, points, normals, h, degree=degree)
    assert expected is not None and found.degree == expected.fit.degree == degree
    assert c[0] * h == found.f
    e1, e2 = frame(found.n)
    for u, v in ((0.0, 0.0), (0.3, -0.2), (-0.5, 0.7)):
        place = along(along(x, list(e1), u * h), list(e2), v * h)
        across = minus(place, expected.fit.origin)
        height = expected.fit.height(dot(across, expected.fit.u), dot(across, expected.fit.v))
        assert polynomial.value(c, u, v) * h == pytest.approx(expected.t + height, abs=1e-12)


@pytest.mark.parametrize("weight", WEIGHTS)
def test_weights_and_barycentre_are_those_of_x(weight: str) -> None:
    points, normals, x, h = shape("noisy", 1)
    found, work, _ = evaluated(x, points, normals, h, weight)
    assert found.off == pytest.approx(offset(x, points, h, weight), abs=1e-14)
    assert work[:60] / found.weight == pytest.approx(normalised(weight, x, points, h), abs=1e-15)


@pytest.mark.parametrize("weight", WEIGHTS)
def test_derivatives_of_the_energy(weight: str) -> None:
    points, normals = cloudlet(30)
    x, t, h, step = [0.1, 0.2, 0.3], -0.2, 1.2, 1e-6
    n = unit([0.1, 0.05, 1.0])
    u, v = frame(three(n))
    b = reference_plane.bowl(near_of(points, normals), three(x), t / h, three(n), rule_of(h, weight, "surfel"),
                             np.empty(60))

    def energy(a: float, p: float, q: float) -> float:
        turned = unit(along(along(n, list(u), p), list(v), q))
        return plane_energy(x, t + a * h, turned, points, h, weight) / (h * h)

    def gradient(a: float, p: float, q: float) -> list[float]:
        m = along(along(n, list(u), p), list(v), q)
        by_t, by_n = plane_gradient(x, t + a * h, unit(m), points, h, weight)
        return [by_t / h, dot(by_n, u) / math.hypot(*m) / (h * h), dot(by_n, v) / math.hypot(*m) / (h * h)]

    assert b.e == pytest.approx(energy(0.0, 0.0, 0.0), rel=1e-14)
    assert b.g == pytest.approx(gradient(0.0, 0.0, 0.0), abs=1e-13)
    rows = ((b.tt, b.tu, b.tv), (b.tu, b.uu, b.uv), (b.tv, b.uv, b.vv))
    for axis, row in enumerate(rows):
        move = [step * (k == axis) for k in range(3)]
        difference = np.subtract(gradient(*move), gradient(*(-m for m in move))) / (2 * step)
        assert row == pytest.approx(difference, abs=2e-8)


@pytest.mark.parametrize("weight", ["hat", "squared_hat"])
def test_a_crease_is_found_nearly(weight: str) -> None:
    """Where a surfel's weight begins E has a crease; a minimum on one is where no gradient vanishes."""
    exact, more = 0, []
    for seed in range(12):
        points, normals, x, h = shape("noisy", seed)
        expected = oracle(x, points, normals, h, 2, weight, "surfel")
        found, _, _ = evaluated(x, points, normals, h, weight)
        assert expected is not None and found.state == r.CONTINUE
        by_t, by_n = plane_gradient(x, expected.t, expected.n, points, h, weight)
        if max(abs(g) for g in (by_t, *by_n)) < 1e-10:
            exact += 1
            assert found.f == pytest.approx(expected.value, abs=1e-13)
        else:
            more.append(abs(found.f - expected.value))
    assert exact >= 6
    assert max(more, default=0.0) < 0.02


def test_scale_and_place_change_nothing() -> None:
    points, normals, x, h = shape("noisy", 4)
    once, _, _ = evaluated(x, points, normals, h)
    eightfold, _, _ = evaluated([8 * c for c in x], [[8 * c for c in p] for p in points], normals, 8 * h)
    assert (eightfold.f, eightfold.n) == (8 * once.f, once.n)


@pytest.mark.parametrize("far", [3.0, 15.0, 400.0])
def test_a_plane_is_found_from_afar(far: float) -> None:
    points, normals = tilted_plane(TILTED, [0.0, 0.0, 0.0])
    found, _, _ = evaluated(along([0.0, 0.0, 0.0], TILTED, far), points, normals, 1.0)
    assert found.state == r.CONTINUE
    assert found.f == pytest.approx(-far, rel=1e-13)
    assert found.n == pytest.approx(TILTED, abs=1e-13)


def test_where_there_is_none() -> None:
    points, normals, _, _ = shape("noisy", 0)
    assert evaluated([0.0, 0.0, 50.0], points, normals, 0.8, "wendland")[0].state == r.FEW_NEIGHBOURS
    line = [[0.1 * i, 0.0, 0.0] for i in range(10)]
    assert evaluated([0.5, 0.0, 0.0], line, normals[:10], 0.5, kind="covariance")[0].state == r.UNDEFINED_NORMAL
    sheets = [[0.5 * i, 0.5 * j, z] for i in range(-4, 5) for j in range(-4, 5) for z in (-2.0, 2.0)]
    up = [[0.0, 0.0, 1.0]] * len(sheets)
    state, _, _ = reference_plane.reference_plane(near_of(sheets, up), (0.0, 0.0, 0.0), 1.1, (0.0, 0.0, 1.0),
                                                  rule_of(1.0, "gaussian", "surfel"), np.empty(2 * len(sheets)))
    assert state == r.UNDEFINED_NORMAL


@pytest.fixture(scope="module")
def standard() -> Scene:
    return load("standard")


SHARP = Settings(raster=32, placement="exact", gradient="smooth", tolerance=1e-6)


def test_a_picture_shows_the_solids(standard: Scene) -> None:
    settings = SHARP.replace(search="safe", max_off_centre="none")
    found = {method: render(standard, settings.replace(method=method), size=(96, 96))
             for method in ("projection", "polynomial")}
    errors = {method: quality(hits, standard) for method, hits in found.items()}
    q, other = errors["projection"], errors["polynomial"]
    assert q is not None and other is not None
    assert q.relevant > 900
    assert q.false_hit + q.false_miss + q.distance_miss < 0.05 * q.relevant
    assert np.nanmedian(q.distance) < 0.02
    assert np.nanmedian(q.angle) < 1.5
    assert q.delta < 1.15 * other.delta


@pytest.mark.parametrize("search", ["iterate", "secant", "newton", "march", "safe"])
def test_every_hit_is_left_in_place(standard: Scene, search: str) -> None:
    settings = SHARP.replace(method="projection", search=search, tolerance=1e-9, max_off_centre="none", radius=4.0)
    rays = render(standard, settings, size=(12, 12))
    hits: Hits = rays if search != "march" else render(standard, settings.replace(step=0.02), size=(12, 12))
    found = prepare.surfels(standard, settings)
    points, normals = found.points, found.normal
    looked = 0
    for at in np.flatnonzero(hits.hit)[:6]:
        x = hits.point[at]
        centre = np.floor(x) + 0.5
        near = np.flatnonzero(((points - centre) ** 2).sum(axis=1) <= 16.0)
        expected = oracle(x.tolist(), points[near].tolist(), normals[near].tolist(), 0.8, 2, "gaussian", "surfel")
        assert expected is not None
        assert abs(expected.value) < (2e-4 if search == "march" else 1e-8)
        looked += 1
    assert looked == 6
