"""The oracle's weights against 50 digits and numbers worked out by hand."""

from __future__ import annotations

import math

import mpmath
import pytest

from tests.oracle import weights
from tests.oracle.weights import WEIGHTS, normalised, relative, slope


def test_values_by_hand() -> None:
    assert weights.gaussian(2.0, 2.0) == math.exp(-1)
    assert [weights.hat(q, 2.0) for q in (0.0, 0.5, 2.0, 3.0)] == [1, 0.75, 0, 0]
    assert [weights.squared_hat(q, 2.0) for q in (0.0, 1.0, 2.0, 3.0)] == [1, 0.75, 0, 0]
    reach = 2.653 * 0.8
    assert [weights.wendland(q, 0.8) for q in (0.0, reach, 9.0)] == [1, 0, 0]
    assert weights.wendland(reach / 2, 0.8) == pytest.approx(3 / 16, rel=1e-15)


def test_wendland_has_the_half_width_of_the_gaussian() -> None:
    q = math.sqrt(math.log(2))
    assert weights.gaussian(q, 1.0) == pytest.approx(0.5, rel=1e-15)
    assert weights.wendland(q, 1.0) == pytest.approx(0.5, abs=1e-4)


@pytest.mark.parametrize("name", WEIGHTS)
@pytest.mark.parametrize("q", [0.1, 0.4, 0.79, 1.1, 1.9, 2.5])
def test_slope_is_the_derivative_in_fifty_digits(name: str, q: float) -> None:
    with mpmath.workdps(50):
        step = mpmath.mpf(10) ** -15
        rise = WEIGHTS[name](q + step, mpmath.mpf(0.8)) - WEIGHTS[name](q - step, mpmath.mpf(0.8))
        expected = float(-rise / (2 * step) / q)
    assert slope(name, q, 0.8) == pytest.approx(expected, rel=1e-13, abs=1e-20)


@pytest.mark.parametrize("name", ["gaussian", "squared_hat", "wendland"])
def test_slope_is_smooth_at_the_point_itself(name: str) -> None:
    assert slope(name, 0.0, 0.8) == pytest.approx(slope(name, 1e-9, 0.8), rel=1e-8)
    assert slope("hat", 0.0, 0.8) == 0.0


@pytest.mark.parametrize("away", [0.0, 3.0, 20.0, 30.0, 1e3])
def test_gaussian_ratios_are_right_at_any_distance(away: float) -> None:
    points = [[0.1, 0.2, 0.3], [0.15, 0.21, 0.29], [-0.3, 0.4, 0.1]]
    x = [away, 0.3, -0.2]
    with mpmath.workdps(60):
        exact = [mpmath.exp(-mpmath.fsum((mpmath.mpf(c) - o) ** 2 for c, o in zip(p, x, strict=True))
                            / mpmath.mpf(0.7) ** 2) for p in points]
        ratios = [float(e / max(exact)) for e in exact]
        shares = [float(e / mpmath.fsum(exact)) for e in exact]
    # One rounding of an exponent of up to 1000, then one of exp.
    assert relative("gaussian", x, points, 0.7) == pytest.approx(ratios, rel=2e-13, abs=1e-300)
    assert normalised("gaussian", x, points, 0.7) == pytest.approx(shares, rel=2e-13, abs=1e-300)


def test_plain_weights_underflow_where_the_ratios_do_not() -> None:
    points = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    assert weights.theta("gaussian", [40.0, 0.5, 0.0], points, 1.0) == [0.0, 0.0]
    assert normalised("gaussian", [40.0, 0.5, 0.0], points, 1.0) == [0.5, 0.5]


@pytest.mark.parametrize("name", ["hat", "squared_hat", "wendland"])
def test_out_of_reach_the_nearest_gets_one(name: str) -> None:
    points = [[0.0, 0.0, 9.0], [0.0, 0.0, 8.0], [0.0, 8.0, 0.0]]
    assert normalised(name, [0.0, 0.0, 0.0], points, 1.0) == [0.0, 1.0, 0.0]
    assert not weights.in_reach(name, [0.0, 0.0, 0.0], points, 1.0)
    assert weights.in_reach("gaussian", [0.0, 0.0, 0.0], points, 1.0)
    assert weights.log_sum(name, [0.0, 0.0, 0.0], points, 1.0) == -math.inf


@pytest.mark.parametrize("name", WEIGHTS)
def test_normalised_weights_sum_to_one_and_keep_their_ratios(name: str) -> None:
    points = [[0.1, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.7], [0.2, 0.2, 0.2]]
    x = [0.05, 0.02, 0.01]
    shares, plain = normalised(name, x, points, 0.8), weights.theta(name, x, points, 0.8)
    assert math.fsum(shares) == pytest.approx(1.0, abs=1e-15)
    assert shares == pytest.approx([w / math.fsum(plain) for w in plain], rel=1e-14)
    assert weights.log_sum(name, x, points, 0.8) == pytest.approx(math.log(math.fsum(plain)), abs=1e-14)


def test_log_sum_far_away() -> None:
    assert weights.log_sum("gaussian", [100.0, 0.0, 0.0], [[0.0] * 3, [0.0] * 3], 1.0) == math.log(2) - 1e4


@pytest.mark.parametrize("h", [1e-200, 1e200])
def test_extreme_feature_sizes(h: float) -> None:
    shares = normalised("gaussian", [0.0, 0.0, 0.0], [[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]], h)
    assert shares == ([1.0, 0.0] if h < 1 else [0.5, 0.5])
