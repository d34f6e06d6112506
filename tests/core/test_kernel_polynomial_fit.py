"""Fits over a plane: right to rounding, lowered degrees, patches, and which way they take."""

from __future__ import annotations

import math

import numpy as np
import pytest

from jaart.core.kernels import polynomial, polynomial_fit
from tests.core.fit_calls import POWERS, disc, exact, fitted, g


@pytest.mark.parametrize("degree", range(5))
def test_rows_of_zeros_change_nothing(degree: int) -> None:
    u, v, weight = disc(41, 3)
    height = 0.2 * u * u + 0.1 * v
    filled = (np.concatenate([column, np.zeros(7)]) for column in (u, v, height, weight))
    used, coefficients = fitted(*filled, degree)
    assert used == degree
    assert coefficients == pytest.approx(fitted(u, v, height, weight, degree)[1], rel=1e-11, abs=1e-13)


@pytest.mark.parametrize("degree", range(5))
@pytest.mark.parametrize("rows", [24, 40, 41, 100])
def test_fits_are_right_to_rounding(degree: int, rows: int) -> None:
    u, v, weight = disc(rows, rows)
    height = 0.2 * u * u - 0.1 * u * v + 0.3 * v + 0.05 * np.random.default_rng(2).normal(size=rows)
    used, c = fitted(u, v, height, weight, degree)
    assert used == degree
    terms = polynomial.terms(degree)
    assert c[0] == pytest.approx(exact(u, v, height, weight, degree)[0], abs=4e-15)
    assert c[:terms] == pytest.approx(exact(u, v, height, weight, degree), abs=1e-13)
    assert (c[terms:] == 0.0).all()


@pytest.mark.parametrize("degree", range(5))
def test_a_polynomial_is_found_again(degree: int) -> None:
    u, v, weight = disc(50, 3)
    c = np.zeros(15)
    c[:polynomial.terms(degree)] = np.random.default_rng(4).normal(size=polynomial.terms(degree))
    height = np.array([g(c, x, y) for x, y in zip(u.tolist(), v.tolist(), strict=True)])
    used, found = fitted(u, v, height, weight, degree)
    assert used == degree
    assert found == pytest.approx(c, abs=1e-13)


@pytest.mark.parametrize("scale", [1e-300, 1e-30, 1e200])
def test_the_weights_size_does_not_matter(scale: float) -> None:
    u, v, weight = disc(40, 5)
    assert fitted(u, v, np.sin(u) + v * v, weight * scale, 3)[1] == pytest.approx(
        fitted(u, v, np.sin(u) + v * v, weight, 3)[1], abs=1e-13)


def test_one_point_gives_its_height_exactly() -> None:
    rng = np.random.default_rng(6)
    for u, v, height, weight in rng.uniform(0.01, 1, (300, 4)):
        used, c = fitted(*(np.array([value]) for value in (u, v, height, weight)), 4)
        assert used == 0
        assert c.tolist() == [height] + [0.0] * 14


def test_degree_0_is_the_weighted_mean() -> None:
    u, v, weight = disc(30, 7)
    height = np.cos(3 * u) + v
    used, c = fitted(u, v, height, weight, 0)
    assert used == 0
    assert c[0] == pytest.approx(math.fsum(weight * height) / math.fsum(weight), rel=1e-15)


@pytest.mark.parametrize(("rows", "used"), [(1, 0), (4, 0), (5, 1), (8, 1), (9, 2), (14, 2), (15, 3), (22, 3), (23, 4)])
def test_the_degree_falls_below_one_and_a_half_points_a_coefficient(rows: int, used: int) -> None:
    u, v, weight = disc(rows, 11)
    height = np.sin(u) * v
    negligible = np.full(30, 0.9e-6 * weight.max())
    far_u, far_v, _ = disc(30, 12)
    found = fitted(np.append(u, far_u), np.append(v, far_v), np.append(height, far_u), np.append(weight, negligible), 4)
    assert found[0] == used
    assert fitted(u, v, height, weight, 4)[0] == used
    assert fitted(u, v, height, weight, 4)[1] == pytest.approx(fitted(u, v, height, weight, used)[1], abs=1e-14)


def test_points_that_determine_no_curvature_lower_the_degree() -> None:
    s = np.linspace(-1, 1, 40)
    ones = np.ones(40)
    assert fitted(s, 0.5 * s, s * s, ones, 3)[0] == 0  # on a line: not even a plane
    u, v, weight = disc(40, 13)
    r = np.hypot(u, v)
    used, c = fitted(u / r, v / r, 0.25 + u / r, weight, 2)  # on a circle u² + v² = 1 depends on 1
    assert used == 1
    assert c[:3] == pytest.approx([0.25, 1.0, 0.0], abs=1e-14)


def test_no_weight_gives_no_polynomial() -> None:
    zero = np.zeros(6)
    used, c = fitted(zero, zero, zero, zero, 2)
    assert used == -1
    assert np.isnan(c[0])


def test_nan_is_not_hidden() -> None:
    u, v, weight = disc(40, 14)
    height = u.copy()
    height[3] = np.nan
    assert np.isnan(fitted(u, v, height, weight, 2)[1][0])
    assert np.isnan(fitted(u, v, height, weight, 0)[1][0])


@pytest.mark.parametrize("degree", range(5))
def test_a_patch_gives_back_the_polynomial_whose_means_were_measured(degree: int) -> None:
    rng = np.random.default_rng(degree)
    many, m, h = polynomial.terms(degree), 0.13, rng.normal(size=15)
    h[many:] = 0.0
    u, v = rng.uniform(-2, 2, (2, 60))
    nodes, shares = np.polynomial.hermite_e.hermegauss(9)
    shares = shares / shares.sum()
    steps = np.sqrt(m) * nodes  # the mean over a Gaussian patch, exact for degrees up to 17
    means = np.array([sum(a * b * g(h, x + i, y + j) for a, i in zip(shares, steps, strict=True)
                          for b, j in zip(shares, steps, strict=True)) for x, y in zip(u, v, strict=True)])
    used, c = fitted(u, v, means, np.ones(60), degree, m)
    assert used == degree
    np.testing.assert_allclose(c, h, rtol=0, atol=1e-12)


def test_a_square_patch_as_wide_as_a_cell_has_a_twelfth_of_variance() -> None:
    u, v = np.random.default_rng(3).uniform(-2, 2, (2, 40))
    means = 0.5 * (u**2 + 1 / 12) - 0.25 * (v**2 + 1 / 12) + 0.1 * u * v  # of u²/2 - v²/4 + uv/10 over unit squares
    _, c = fitted(u, v, means, np.ones(40), 2, 1 / 12)
    np.testing.assert_allclose(c[:6], (0, 0, 0, 0.5, 0.1, -0.25), rtol=0, atol=1e-14)


def worked(rows: int, *columns: np.ndarray) -> np.ndarray:
    """Scratch with four columns in front, NaN behind."""
    work = np.full(polynomial_fit.SCRATCH_COLUMNS * rows, np.nan)
    work[:4 * rows] = np.concatenate(columns)
    return work


@pytest.mark.parametrize("degree", range(1, 5))
def test_points_on_all_sides_are_fitted_by_moments(degree: int) -> None:
    u, v, weight = disc(48, 21)
    weight /= weight.max()
    height, c = np.cos(u) * v, np.zeros(15)
    work = worked(48, u, v, height, weight)
    assert polynomial_fit.has_room(np.uint64(48), degree)
    assert polynomial_fit.by_moments(work, np.uint64(48), degree, c)
    assert (work[:4 * 48] == np.concatenate((u, v, height, weight))).all()  # a later fit needs them
    assert c[:polynomial.terms(degree)] == pytest.approx(exact(u, v, height, weight, degree), abs=1e-13)
    work = worked(48, u, v, height, weight)
    assert polynomial_fit.fit(work, np.uint64(48), degree, 0.0, c) == degree
    assert (work[:48] == u).all()  # reflections would have written over it


@pytest.mark.parametrize("width", [1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 1e-3, 1e-6])
@pytest.mark.parametrize("degree", [1, 2, 3])
def test_a_narrow_strip_keeps_its_digits_whichever_way_it_is_fitted(width: float, degree: int) -> None:
    rng = np.random.default_rng(22)
    u, v = rng.uniform(-2, 2, 48), width * rng.uniform(-1, 1, 48)
    weight, terms = np.exp(-u * u), polynomial.terms(degree)
    height = 0.3 * u * u - 0.2 * u + v
    used, c = fitted(u, v, height, weight, degree)
    want = exact(u, v, height, weight, used)
    assert used == degree or width < 0.01
    size = np.array([width ** -b for _, b in POWERS[:terms]])[:len(want)]
    np.testing.assert_allclose(c[:len(want)] / size, want / size, rtol=0, atol=2e-12)


def test_points_near_a_curve_are_left_to_reflections() -> None:
    u, v, weight = disc(48, 23)
    r = np.hypot(u, v) * (1 + 1e-3 * np.random.default_rng(24).normal(size=48))
    u, v, c = u / r, v / r, np.zeros(15)  # u² + v² nearly depends on 1
    height = 0.1 * u * v + 0.2 * u * u
    assert not polynomial_fit.by_moments(worked(48, u, v, height, weight), np.uint64(48), 2, c)
    assert not c.any()
    used, found = fitted(u, v, height, weight, 2)
    assert used == 2
    assert found[:6] == pytest.approx(exact(u, v, height, weight, 2), abs=1e-10)


def test_a_rough_fit_is_refined() -> None:
    u, v, weight = disc(64, 25)
    u, v = u + 6.0, v - 4.0  # far from the origin its monomials are nearly dependent: unrefined it is off by 1e-11
    height, c = np.sin(u) * v, np.zeros(15)
    assert polynomial_fit.by_moments(worked(64, u, v, height, weight), np.uint64(64), 2, c)
    assert c[:6] == pytest.approx(exact(u, v, height, weight, 2), abs=1e-12)


@pytest.mark.parametrize(("rows", "degree", "has"), [(8, 1, True), (8, 2, False), (16, 2, True), (16, 4, False),
                                                     (24, 4, True), (41, 2, False)])
def test_normal_equations_need_room_and_whole_vectors(rows: int, degree: int, has: bool) -> None:
    assert polynomial_fit.has_room(np.uint64(rows), degree) is has


@pytest.mark.parametrize(("size", "used"), [(1e-2, 2), (1e-4, 1), (1e-8, 0)])
def test_points_much_closer_than_h_lower_the_degree_as_by_reflections(size: float, used: int) -> None:
    u, v, weight = disc(48, 26)
    found = fitted(size * u, size * v, 1.0 + u, weight, 2)
    assert found[0] == used
    without_vectors = slice(0, 47)  # 47 rows are fitted by reflections
    assert fitted(size * u[without_vectors], size * v[without_vectors], u[without_vectors], weight[without_vectors],
                  2)[0] == used
