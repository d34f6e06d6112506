"""Elimination in a symmetric matrix, and what it says of how far columns depend on each other."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core.kernels.normal_equations import eliminate, solve_eliminated


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
