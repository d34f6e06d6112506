"""Elimination in a symmetric matrix, and what it says of how far columns depend on each other."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core.kernels.normal_equations import eliminate, solve_eliminated, solve_six


def eliminated(a: np.ndarray) -> tuple[float, float, np.ndarray]:
    """The least square of a sine, the least pivot's share, and the scratch: matrix, then 1/D, then room."""
    n = len(a)
    work = np.full(n * n + 2 * n, np.nan)
    work[:n * n] = np.where(np.tri(n, k=-1) > 0, np.nan, a).ravel()  # the lower triangle is nobody's
    return *eliminate(work, np.uint64(0), np.uint64(n), np.uint64(n * n)), work


@pytest.mark.parametrize("n", [1, 2, 3, 6, 10, 15])
def test_solutions_are_right(n: int) -> None:
    rng = np.random.default_rng(n)
    columns = rng.normal(size=(3 * n, n))
    a, x = columns.T @ columns, rng.normal(size=n)
    _, _, work = eliminated(a)
    work[n * n + n:] = a @ x
    solve_eliminated(work, np.uint64(0), np.uint64(n), np.uint64(n * n), np.uint64(n * n + n))
    np.testing.assert_allclose(work[n * n + n:], x, rtol=0, atol=1e-11)


def test_the_sine_is_that_between_a_column_and_those_before_it() -> None:
    rng = np.random.default_rng(4)
    columns = rng.normal(size=(12, 5))
    r = np.abs(np.diag(np.linalg.qr(columns)[1]))
    sine, least, _ = eliminated(columns.T @ columns)
    assert sine == pytest.approx(min((r / np.linalg.norm(columns, axis=0))**2), rel=1e-12)
    assert least == pytest.approx((r.min() / r.max())**2, rel=1e-12)


@pytest.mark.parametrize("spoilt", [np.nan, np.inf])
def test_what_is_no_system_is_said(spoilt: float) -> None:
    assert eliminated(np.ones((3, 3)))[:2] == (0.0, 0.0)  # each column is the first
    assert eliminated(np.zeros((3, 3)))[:2] == (0.0, 0.0)
    a = np.eye(4)
    a[2, 2] = spoilt
    assert eliminated(a)[:2] == (0.0, 0.0)


#: The moments of the products of two monomials of degree 2 or less.
PRODUCTS = [[0, 1, 2, 3, 4, 5], [1, 3, 4, 6, 7, 8], [2, 4, 5, 7, 8, 9], [3, 6, 7, 10, 11, 12], [4, 7, 8, 11, 12, 13],
            [5, 8, 9, 12, 13, 14]]


@pytest.mark.parametrize("seed", range(30))
def test_six_unknowns_are_solved_for_as_by_elimination(seed: int) -> None:
    rng = np.random.default_rng(seed)
    u, v = rng.normal(size=(2, 20)) * 10.0 ** rng.uniform(-1, 0.5, (2, 1)) + rng.uniform(-2, 2, (2, 1))
    moments = np.array([(u**(d - b) * v**b).sum() for d in range(5) for b in range(d + 1)])
    a, right = moments[PRODUCTS], rng.normal(size=6)
    work = np.concatenate((moments, right))
    found = solve_six(work, np.uint64(0), np.uint64(15))
    expected = eliminated(a)
    assert found == pytest.approx(expected[:2], rel=1e-6)
    assert (work[:15] == moments).all()
    np.testing.assert_allclose(a @ work[15:], right, rtol=0, atol=1e-11 * np.abs(a).max() * np.abs(work[15:]).max())


@pytest.mark.parametrize(("moment", "value"), [(1, 9.99), (2, 9.99), (6, 9.99), (7, 0.999), (9, 9.99)])
def test_each_coefficient_that_nearly_depends_on_one_before_it_is_seen(moment: int, value: float) -> None:
    moments = np.zeros(15)
    moments[[0, 3, 5, 10, 12, 14]] = 100.0, 1.0, 1.0, 100.0, 1.0, 100.0  # alone, they are far from it
    far = solve_six(np.append(moments, np.ones(6)), np.uint64(0), np.uint64(15))
    moments[moment] = value
    near = solve_six(np.append(moments, np.ones(6)), np.uint64(0), np.uint64(15))
    assert far[0] > 0.9 and near[0] < 0.01
    assert near == pytest.approx(eliminated(moments[PRODUCTS])[:2], rel=1e-9)
