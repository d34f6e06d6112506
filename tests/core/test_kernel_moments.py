"""Weighted sums of monomials."""

from __future__ import annotations

import math

import numpy as np
import pytest

from jaart.core.kernels import moments


def test_numbers_go_by_degree_and_falling_powers_of_u() -> None:
    assert [moments.number_of(np.uint64(d), np.uint64(b)) for d in range(9) for b in range(d + 1)] == list(range(45))


@pytest.mark.parametrize("degree", range(1, 5))
@pytest.mark.parametrize("rows", [8, 24, 56])
def test_every_moment_a_degree_takes_is_right(degree: int, rows: int) -> None:
    rng = np.random.default_rng(rows)
    u, v, w = rng.uniform(-2, 2, rows), rng.uniform(-2, 2, rows), rng.uniform(0, 1, rows)
    scratch = 3 * rows
    to = scratch + rows + moments.TO_FOURTH
    work = np.full(to + moments.TO_EIGHTH, np.nan)
    work[:scratch] = np.concatenate((u, v, w))
    moments.sum_moments(work, np.uint64(2 * rows), np.uint64(rows), degree, np.uint64(scratch), np.uint64(to))
    assert (work[:scratch] == np.concatenate((u, v, w))).all()
    for d in range(2 * degree + 1):
        for b in range(d + 1):
            each = w * u**(d - b) * v**b
            assert work[to + d * (d + 1) // 2 + b] == pytest.approx(math.fsum(each), abs=1e-14 * np.abs(each).sum())
