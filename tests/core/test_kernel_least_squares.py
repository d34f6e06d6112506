"""Least squares by reflections against eighty digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray

from jaart.core.kernels.least_squares import factorise, rank_ratio, solve, substitute

Array = NDArray[np.float64]


def solved(matrix: Array, right: Array, base: int = 0) -> tuple[Array, float]:
    """The kernel's solution and its ratio: the system stands from `base` on, with room for a column, between 7s."""
    rows, count = matrix.shape
    work = np.full(base + rows * (count + 2) + 3, 7.0)
    work[base:base + rows * (count + 1)] = np.concatenate([matrix.T.ravel(), right])
    x = np.full(count + 1, 7.0)
    ratio = solve(work, np.uint64(base), np.uint64(rows), np.uint64(count), x)
    assert (work[:base] == 7.0).all() and (work[-3:] == 7.0).all() and x[-1] == 7.0
    return x[:-1], ratio


def exact(matrix: Array, right: Array) -> Array:
    """The solution of the normal equations in eighty digits."""
    with mpmath.workdps(80):
        a, b = mpmath.matrix(matrix.tolist()), mpmath.matrix(right.tolist())
        return np.array([float(value) for value in mpmath.lu_solve(a.T * a, a.T * b)])


def monomials(u: Array, v: Array, degree: int) -> Array:
    """The matrix of a fit, a column each of u^(d-j)·v^j."""
    return np.stack([u**(d - j) * v**j for d in range(degree + 1) for j in range(d + 1)], axis=1)


@pytest.mark.parametrize(("rows", "count"), [(1, 1), (2, 1), (4, 3), (6, 6), (17, 6), (40, 10), (41, 15), (300, 15)])
def test_random_systems(rows: int, count: int) -> None:
    rng = np.random.default_rng(rows)
    matrix, right = rng.normal(size=(rows, count)), rng.normal(size=rows)
    x, _ = solved(matrix, right, base=rows)
    assert x == pytest.approx(exact(matrix, right), rel=1e-13 * np.linalg.cond(matrix), abs=1e-14)


@pytest.mark.parametrize(("rows", "degree", "bound"), [(40, 2, 2e-15), (40, 3, 2e-15), (40, 4, 4e-15), (16, 2, 2e-15),
                                                        (16, 3, 2e-14), (16, 4, 2e-12)])
def test_weighted_fits_of_heights_keep_nearly_all_digits(rows: int, degree: int, bound: float) -> None:
    """Points in a disc of 2h: the worst constant term; normal equations lose 1e-11 of 16 points at degree 4."""
    rng = np.random.default_rng(rows + degree)
    for _ in range(6):
        r, angle = 2 * np.sqrt(rng.uniform(size=rows)), rng.uniform(0, 2 * np.pi, rows)
        u, v = r * np.cos(angle), r * np.sin(angle)
        root = np.exp(-r * r / 2)
        matrix = monomials(u, v, degree) * root[:, None]
        right = (0.3 + 0.2 * v - 0.1 * u * u + 0.05 * rng.normal(size=rows)) * root
        assert abs(solved(matrix, right)[0][0] - exact(matrix, right)[0]) <= bound


def test_an_exact_system_is_met_by_its_unknowns() -> None:
    rng = np.random.default_rng(0)
    matrix, x = rng.integers(-4, 5, (12, 4)).astype(float), np.array([1.0, -2.0, 0.5, 3.0])
    assert solved(matrix, matrix @ x)[0] == pytest.approx(x, abs=1e-14)


def test_rows_of_zeros_change_nothing() -> None:
    rng = np.random.default_rng(1)
    matrix, right = rng.normal(size=(9, 3)), rng.normal(size=9)
    padded, longer = np.zeros((16, 3)), np.zeros(16)
    padded[::2][:8], longer[::2][:8], padded[1], longer[1] = matrix[:8], right[:8], matrix[8], right[8]
    assert solved(padded, longer)[0] == pytest.approx(solved(matrix, right)[0], rel=1e-13)


def test_the_ratio_tells_dependent_columns() -> None:
    rng = np.random.default_rng(3)
    matrix, right = rng.normal(size=(20, 4)), rng.normal(size=20)
    assert solved(matrix, right)[1] == pytest.approx(
        (lambda d: d.min() / d.max())(np.abs(np.diag(np.linalg.qr(matrix)[1]))), rel=1e-12)
    for size in (1e-9, 1e-12):
        nearly = matrix.copy()
        nearly[:, 3] = matrix[:, 0] - matrix[:, 1] + size * matrix[:, 3]
        assert 0.05 * size < solved(nearly, right)[1] < 5 * size
    zero = matrix.copy()
    zero[:, 2] = 0.0
    assert solved(zero, right)[1] == 0.0


def test_too_few_rows_are_told() -> None:
    x, ratio = solved(np.ones((2, 3)), np.ones(2))
    assert np.isnan(x).all() and ratio == 0.0


def test_leading_columns_are_solved_from_the_same_factors() -> None:
    rng = np.random.default_rng(5)
    matrix, right = rng.normal(size=(30, 6)), rng.normal(size=30)
    work = np.concatenate([matrix.T.ravel(), right, np.empty(30)])
    base, rows = np.uint64(0), np.uint64(30)
    factorise(work, base, rows, np.uint64(6), np.uint64(7 * 30))
    for count in (1, 3, 6):
        x = np.zeros(6)
        substitute(work, base, rows, np.uint64(count), np.uint64(6 * 30), x)
        assert x[:count] == pytest.approx(np.linalg.lstsq(matrix[:, :count], right)[0], rel=1e-12)
        assert rank_ratio(work, base, rows, np.uint64(count)) == pytest.approx(
            solved(matrix[:, :count], right)[1], rel=1e-12)


def test_nan_stays_nan() -> None:
    matrix = np.random.default_rng(7).normal(size=(10, 3))
    right = np.ones(10)
    right[4] = np.nan
    assert np.isnan(solved(matrix, right)[0]).all()
