"""Polynomials over a plane: fits, lowered degrees, values, gradients and rays through them."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray

from jaart.core.kernels import polynomial

Array = NDArray[np.float64]

#: Powers of u and v of each coefficient, in the order that the module promises.
POWERS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3),
          (4, 0), (3, 1), (2, 2), (1, 3), (0, 4)]


def fitted(u: Array, v: Array, height: Array, weight: Array, degree: int, patch: float = 0.0) -> tuple[int, Array]:
    """The degree that was used and the coefficients."""
    rows = len(u)
    work = np.full(polynomial.SCRATCH_COLUMNS * rows, np.nan)
    work[:4 * rows] = np.concatenate([u, v, height, weight])
    coefficients = np.full(polynomial.COEFFICIENTS, np.nan)
    return polynomial.fit(work, np.uint64(rows), degree, patch, coefficients), coefficients


def g(c: Array, u: float, v: float) -> float:
    """The polynomial term by term."""
    return math.fsum(ck * u**i * v**j for ck, (i, j) in zip(c.tolist(), POWERS, strict=True))


def disc(rows: int, seed: int) -> tuple[Array, Array, Array]:
    """Points u, v of a disc of 2h and their Gaussian weights."""
    rng = np.random.default_rng(seed)
    r, angle = 2 * np.sqrt(rng.uniform(size=rows)), rng.uniform(0, 2 * np.pi, rows)
    return r * np.cos(angle), r * np.sin(angle), np.exp(-r * r)


def exact(u: Array, v: Array, height: Array, weight: Array, degree: int) -> Array:
    """The fit by normal equations in eighty digits."""
    terms = polynomial.terms(degree)
    with mpmath.workdps(80):
        a = mpmath.matrix([[mpmath.mpf(x)**i * mpmath.mpf(y)**j for i, j in POWERS[:terms]]
                           for x, y in zip(u.tolist(), v.tolist(), strict=True)])
        w = mpmath.diag(weight.tolist())
        return np.array([float(x) for x in mpmath.lu_solve(a.T * w * a, a.T * (w * mpmath.matrix(height.tolist())))])


def test_terms() -> None:
    assert [polynomial.terms(degree) for degree in range(5)] == [1, 3, 6, 10, 15]


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


def test_values_and_gradients() -> None:
    rng = np.random.default_rng(15)
    for _ in range(100):
        c, (u, v) = rng.normal(size=15), rng.uniform(-2, 2, 2).tolist()
        assert polynomial.value(c, u, v) == pytest.approx(g(c, u, v), abs=1e-12)
        by_u = math.fsum(ck * i * u**(i - 1) * v**j for ck, (i, j) in zip(c, POWERS, strict=True) if i)
        by_v = math.fsum(ck * j * u**i * v**(j - 1) for ck, (i, j) in zip(c, POWERS, strict=True) if j)
        assert polynomial.gradient(c, u, v) == pytest.approx((by_u, by_v), abs=1e-12)


def test_a_ray_through_the_origin() -> None:
    rng = np.random.default_rng(16)
    for _ in range(100):
        c, d = rng.normal(size=15), rng.normal(size=3)
        powers = polynomial.ray_polynomial(c, tuple(d.tolist()))
        for s in (-1.5, 0.0, 0.3, 2.0):
            assert math.fsum(p * s**k for k, p in enumerate(powers)) == pytest.approx(
                g(c, s * d[0], s * d[1]) - s * d[2], rel=1e-12, abs=1e-12)


def test_a_ray_past_the_origin() -> None:
    rng = np.random.default_rng(17)
    for _ in range(100):
        c, base, d = rng.normal(size=15), rng.normal(size=3), rng.normal(size=3)
        powers = polynomial.line_polynomial(c, tuple(base.tolist()), tuple(d.tolist()))
        for s in (-1.5, 0.0, 0.3, 2.0):
            x = base + s * d
            assert math.fsum(p * s**k for k, p in enumerate(powers)) == pytest.approx(
                g(c, x[0], x[1]) - x[2], rel=1e-11, abs=1e-11)
        assert polynomial.line_polynomial(c, (0.0, 0.0, 0.0), tuple(d.tolist())) == pytest.approx(
            polynomial.ray_polynomial(c, tuple(d.tolist())), rel=1e-12, abs=1e-12)


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
