"""The oracle's tangent and polynomial surfaces, on planes, paraboloids and degenerate clouds."""

from __future__ import annotations

import math
import random

import pytest

from tests import naive
from tests.oracle.gradients import exact_tangent
from tests.oracle.normals import NORMALS
from tests.oracle.samples import cloudlet, level, rings, tilted_plane
from tests.oracle.surfaces import fit_over, polynomial, polynomial_fit, powers, tangent
from tests.oracle.vectors import along, dot, minus, unit
from tests.oracle.weights import WEIGHTS

TILTED, CENTRE = unit([1.0, -2.0, 3.0]), [0.3, 0.1, -0.4]
UP = [0.0, 0.0, 1.0]


@pytest.mark.parametrize("kind", ["surfel", "covariance"])
@pytest.mark.parametrize("weight", WEIGHTS)
@pytest.mark.parametrize("height", [-0.4, 0.0, 0.3])
def test_plane_gives_the_distance(kind: str, weight: str, height: float) -> None:
    points, normals = tilted_plane(TILTED, CENTRE)
    x = along(CENTRE, TILTED, height)
    assert tangent(x, points, normals, 1.5, weight, kind) == pytest.approx(-height, abs=2e-15)
    for degree in range(5):
        assert polynomial(x, points, normals, 1.5, degree, weight, kind) == pytest.approx(-height, abs=1e-14)


@pytest.mark.parametrize("height", [-0.4, 0.0, 0.3])
def test_symmetric_plane_about_x(height: float) -> None:
    points, normals = level(8, 0.5)
    x = [0.0, 0.0, height]
    assert tangent(x, points, normals, 1.0, kind="covariance_at_x") == pytest.approx(-height, abs=1e-15)
    for degree in range(5):
        f = polynomial(x, points, normals, 1.0, degree, kind="covariance_at_x")
        assert f == pytest.approx(-height, abs=2e-15)


@pytest.mark.parametrize("kind", NORMALS)
@pytest.mark.parametrize("weight", WEIGHTS)
def test_degree_zero_is_the_tangent_surface(kind: str, weight: str) -> None:
    points, normals = cloudlet(40)
    for x in ([0.1, 0.2, 0.1], [-0.4, 0.3, -0.2], [0.2, 0.1, 0.5]):
        flat, f = polynomial(x, points, normals, 0.9, 0, weight, kind), tangent(x, points, normals, 0.9, weight, kind)
        assert flat == pytest.approx(f, abs=4e-16)


@pytest.mark.parametrize("kind", NORMALS)
@pytest.mark.parametrize("x", [[0.1, 0.2, 0.1], [0.5, -0.3, 0.4], [1.0, 0.2, 30.0]])
def test_fifty_digits_agree(kind: str, x: list[float]) -> None:
    points, normals = cloudlet()
    f, exact = tangent(x, points, normals, 0.8, kind=kind), exact_tangent(x, points, normals, 0.8, kind=kind)
    assert (f is None) == (exact is None)
    if f is not None:
        assert f == pytest.approx(float(exact), rel=1e-13, abs=1e-14)


def test_the_older_oracle_agrees() -> None:
    points, normals = cloudlet()
    assert tangent([0.2, -0.1, 0.3], points, normals, 0.8) == pytest.approx(
        naive.Cloud(points, normals, 0.8).f([0.2, -0.1, 0.3]), abs=1e-15)


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_a_polynomial_sheet_is_found_again(degree: int) -> None:
    rng = random.Random(degree)
    true = {power: rng.uniform(-0.5, 0.5) for power in powers(degree)}
    places = [(rng.uniform(-2, 2), rng.uniform(-2, 2)) for _ in range(60)]
    points = [[u, v, sum(c * u**i * v**j for (i, j), c in true.items())] for u, v in places]
    fit = fit_over([0.0, 0.0, 0.0], UP, points, 1.3, degree, "gaussian")
    assert fit.degree == degree
    assert fit.value == pytest.approx(true[0, 0], abs=1e-13)
    for s, t in ((0.3, -0.2), (1.0, 0.5)):
        # The frame has its own turn about the normal.
        x, y, _ = along(along([0.0, 0.0, 0.0], fit.u, s), fit.v, t)
        assert fit.height(s, t) == pytest.approx(sum(c * x**i * y**j for (i, j), c in true.items()), abs=1e-12)


@pytest.mark.parametrize("degree", [1, 2, 3])
@pytest.mark.parametrize("weight", WEIGHTS)
def test_what_is_left_is_orthogonal_to_every_term(degree: int, weight: str) -> None:
    # The weighted least squares fit is the one with Σθ_i (g - f_i) u^i v^j = 0 for every term.
    points, normals = cloudlet(60)
    x, h = [0.1, 0.2, 0.15], 1.1
    fit = polynomial_fit(x, points, normals, h, degree, weight)
    assert fit is not None and fit.degree == degree
    away = [minus(p, x) for p in points]
    left = [fit.height(dot(q, fit.u), dot(q, fit.v)) - dot(q, fit.n) for q in away]
    thetas = [WEIGHTS[weight](math.hypot(*q), h) for q in away]
    assert math.fsum(w * e * e for w, e in zip(thetas, left, strict=True)) > 1e-3
    for i, j in powers(degree):
        terms = [w * e * dot(q, fit.u) ** i * dot(q, fit.v) ** j for w, e, q in zip(thetas, left, away, strict=True)]
        assert math.fsum(terms) == pytest.approx(0.0, abs=1e-13)


def test_powers_by_hand() -> None:
    assert powers(2) == [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
    assert [len(powers(d)) for d in range(5)] == [1, 3, 6, 10, 15]


@pytest.mark.parametrize(("count", "degree"), [(1, 0), (4, 0), (5, 1), (8, 1), (9, 2), (15, 3), (22, 3), (23, 4)])
def test_degree_follows_the_number_of_points(count: int, degree: int) -> None:
    rng = random.Random(7)
    points = [[rng.uniform(-1, 1), rng.uniform(-1, 1), 0.1] for _ in range(count)]
    # Points whose weight is below 1e-6 of the largest do not count: exp(-14.4) is less, at 3.8 h.
    points += [[4.5 + 0.1 * i, 0.3 * i, 0.1] for i in range(9)]
    fit = fit_over([0.0, 0.0, 0.0], UP, points, 1.0, 4, "gaussian")
    assert fit.degree == degree
    assert fit.value == pytest.approx(0.1, abs=1e-13)


def test_points_of_a_line_lower_the_degree_to_zero() -> None:
    points = [[0.1 * i - 1, 0.05 * i, 0.2] for i in range(30)]
    fit = fit_over([0.0, 0.0, 0.0], UP, points, 1.0, 4, "gaussian")
    assert fit.degree == 0 and fit.value == pytest.approx(0.2, abs=1e-15)


def test_points_of_a_circle_lower_the_degree_to_one() -> None:
    # u² + v² is constant on them, which no quadratic can tell from 1.
    points = [[math.cos(0.3 * i), math.sin(0.3 * i), 0.2] for i in range(20)]
    fit = fit_over([0.0, 0.0, 0.0], UP, points, 1.0, 2, "gaussian")
    assert fit.degree == 1 and fit.value == pytest.approx(0.2, abs=1e-15)


def test_higher_degrees_come_closer_to_a_sphere() -> None:
    points, normals = rings(1.0, 100, each=16)
    errors = []
    for degree in (0, 2, 4):
        f = polynomial([0.0, 0.0, 1.0], points, normals, 0.3, degree)
        assert f is not None
        errors.append(abs(f))
    # Degree 0 shrinks by h²/(2R) = 0.045, the others by ever higher powers of h/R.
    assert errors[0] == pytest.approx(0.045, rel=0.03)
    assert errors[1] < 0.1 * errors[0] and errors[2] < 0.2 * errors[1]


@pytest.mark.parametrize("degree", [0, 1, 2, 3, 4])
def test_scale_and_duplicates(degree: int) -> None:
    points, normals = cloudlet(60)
    x = [0.1, 0.2, 0.15]
    f = polynomial(x, points, normals, 0.9, degree)
    scaled = polynomial([c * 8 for c in x], [[c * 8 for c in p] for p in points], normals, 7.2, degree)
    assert f is not None and scaled == pytest.approx(8 * f, rel=1e-12)
    assert polynomial(x, points * 2, normals * 2, 0.9, degree) == pytest.approx(f, rel=1e-11)


def test_ray_meets_the_fit() -> None:
    rng = random.Random(2)
    places = [(rng.uniform(-2, 2), rng.uniform(-2, 2)) for _ in range(60)]
    # A paraboloid z = 1 - x² - y²: the x axis at height 0 meets it at both of x = ±1, at height 2 never.
    points = [[x, y, 1 - x * x - y * y] for x, y in places]
    fit = fit_over([0.0, 0.0, 0.0], UP, points, 1.0, 2, "gaussian")
    assert fit.crossings([-3.0, 0.0, 0.0], [1.0, 0.0, 0.0]) == pytest.approx([2.0, 4.0], abs=1e-12)
    assert fit.crossings([-3.0, 0.0, 2.0], [1.0, 0.0, 0.0]) == []
    assert fit.crossings([0.0, 0.0, 5.0], [0.0, 0.0, -1.0]) == pytest.approx([4.0], abs=1e-12)
    level_fit = fit_over([0.0, 0.0, 0.0], UP, [[x, y, 0.5] for x, y in places], 1.0, 0, "gaussian")
    assert level_fit.crossings([0.0, 0.0, 0.5], [1.0, 0.0, 0.0]) == []
    assert level_fit.crossings([0.0, 0.0, 1.5], [0.6, 0.0, -0.8]) == pytest.approx([1.25], abs=1e-15)


@pytest.mark.parametrize("weight", ["hat", "squared_hat", "wendland"])
def test_no_surface_out_of_reach(weight: str) -> None:
    points, normals = cloudlet()
    assert tangent([0.0, 0.0, 50.0], points, normals, 0.8, weight) is None
    assert polynomial([0.0, 0.0, 50.0], points, normals, 0.8, 2, weight) is None


def test_far_away_the_nearest_surfel_is_the_plane() -> None:
    points, normals = [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]], [UP, [1.0, 0.0, 0.0]]
    assert tangent([0.0, 0.0, 500.0], points, normals, 1.0) == -499.0
    fit = polynomial_fit([0.0, 0.0, 500.0], points, normals, 1.0, 4)
    assert fit is not None and (fit.degree, fit.value) == (0, -499.0)
