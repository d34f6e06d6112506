"""The Gaussian weight against exact exponentials, and the sums where all weights underflow."""

from __future__ import annotations

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest

from jaart.core.kernels.weights import exp_minus
from jaart.core.surfels import Surfels
from tests.core.kernel_calls import near_of, rule_of, value_of


def f_and_normal(found: Surfels, x: tuple[float, float, float], h: float) -> tuple[float, tuple[float, float, float]]:
    """f and n at x, relative to the centre of cell (1, 1, 1), by all surfels."""
    value = value_of(near_of((found.points - 1.5).tolist(), found.normal.tolist()), x, rule_of(h=h))
    return value.f, value.n


def test_exp_is_right_within_two_units_in_the_last_place() -> None:
    rng = np.random.default_rng(1)
    worst = 0.0
    with localcontext() as context:
        context.prec = 40
        for y in (*rng.uniform(0, 700, 4000), *rng.uniform(0, 3, 4000), *10.0 ** rng.uniform(-300, 2, 500)):
            exact = (-Decimal(float(y))).exp()
            units = (Decimal(exp_minus(float(y))) - exact) / Decimal(math.ulp(float(exact)))
            worst = max(worst, abs(float(units)))
    assert worst <= 2.0


def test_exp_at_its_ends() -> None:
    assert exp_minus(0.0) == 1.0
    assert exp_minus(1e6) == exp_minus(708.0) == pytest.approx(math.exp(-708), rel=1e-14)
    assert exp_minus(math.inf) == exp_minus(708.0)
    assert math.isnan(exp_minus(math.nan))


@pytest.mark.parametrize("h", [0.5, 0.05, 0.02, 1e-3, 1e-40, 1e-90])
def test_f_is_the_plane_of_the_nearest_surfel_at_any_distance(h: float) -> None:
    tilted = np.array([0.6, 0.0, 0.8])
    found = Surfels(np.array([[1, 1, 1], [1, 1, 2]], np.int32), np.zeros((2, 3)), np.array([[0, 0, 1.0], tilted]))
    x = (0.3, 0.2, -0.45)
    f, n = f_and_normal(found, x, h)
    if h < 0.2:  # the second surfel's share is below exp(-1.9/h²)
        assert n == pytest.approx((0, 0, 1), abs=1e-15) and f == pytest.approx(0.45, abs=1e-15)
    else:
        shares = np.exp(-np.array([sum(c * c for c in x), 0.3**2 + 0.2**2 + 1.45**2]) / h**2)
        mean = shares @ np.array([[0, 0, 1.0], tilted])
        expected = mean / np.linalg.norm(mean)
        barycentre = shares @ np.array([[0, 0, 0], [0, 0, 1.0]]) / shares.sum()
        assert n == pytest.approx(expected, abs=1e-15)
        assert f == pytest.approx(expected @ (barycentre - x), abs=1e-15)
