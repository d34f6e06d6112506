"""What is excluded holds no surface: against exact fractions, a dense look at f, and every root there is."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core.kernels.exclude import Bound, certainly_none, exclude, product, total, widened
from jaart.core.kernels.records import Near, Rule
from tests.core.kernel_calls import near_of, place, rule_of, weights_of
from tests.oracle.samples import cloudlet, level

H = 0.8
RULES = [("gaussian", math.inf), ("gaussian", 1.3), ("hat", math.inf), ("squared_hat", math.inf),
         ("wendland", math.inf), ("wendland", 0.9)]
numbers = st.floats(-1e6, 1e6, allow_subnormal=False)
bounds = st.tuples(numbers, numbers).map(lambda pair: Bound(min(pair), max(pair)))
shares = st.fractions(0, 1, max_denominator=64)


def within(bound: Bound, share: Fraction) -> Fraction:
    """A number of a bound, exactly."""
    return Fraction(bound.low) + share * (Fraction(bound.high) - Fraction(bound.low))


@given(bounds, bounds, shares, shares)
def test_bounds_of_products_and_sums_hold_in_exact_arithmetic(a: Bound, b: Bound, i: Fraction, j: Fraction) -> None:
    x, y = within(a, i), within(b, j)
    wider = widened(a, 0.1), x + Fraction(0.1) * (2 * j - 1)
    for found, exact in ((product(a, b), x * y), (total(a, b), x + y), wider):
        assert Fraction(found.low) <= exact <= Fraction(found.high)


def unit(v: np.ndarray) -> tuple[float, float, float]:
    return place((v / np.linalg.norm(v)).tolist())


def numerator(near: Near, x: np.ndarray, rule: Rule) -> float:
    """<Σθn, Σθ(p - x)>/(Σθ)², NaN where nothing counts: f where there is a normal, up to a positive factor."""
    w, s, _ = weights_of(near, x.tolist(), rule)
    if not s > 0:
        return math.nan
    columns = near.columns.reshape(6, -1)
    return float((columns[3:] @ w) @ ((columns[:3] - x[:, None]) @ w)) / s**2


def pieces(count: int, seed: int) -> list[tuple[Near, np.ndarray, tuple[float, float, float], float]]:
    """Surfels of a rough sheet, and pieces of rays about it: middle, direction, half a length."""
    rng, found = np.random.default_rng(seed), []
    for number in range(count):
        points, normals = cloudlet(12, seed=number)
        found.append((near_of(points, normals), rng.normal(size=3) * [1, 1, 0.7], unit(rng.normal(size=3)),
                      float(10 ** rng.uniform(-4, 0))))
    return found


@pytest.mark.parametrize(("weight", "reach"), RULES)
def test_f_keeps_its_sign_on_what_is_excluded(weight: str, reach: float) -> None:
    rule, excluded, left = rule_of(weight, h=H, reach=reach), 0, 0
    for near, x, d, half in pieces(200, 3):
        values = np.array([numerator(near, x + s * np.array(d), rule) for s in np.linspace(-half, half, 41)])
        values = values[~np.isnan(values)]
        crosses = len(values) > 0 and not (np.all(values > 0) or np.all(values < 0))
        if certainly_none(near, place(x.tolist()), d, half, rule, math.inf):
            excluded += 1
            assert not crosses
        else:
            left += crosses
    assert excluded > 80 and left > 5


@pytest.mark.parametrize(("weight", "reach"), RULES)
def test_no_piece_around_a_root_is_excluded(weight: str, reach: float) -> None:
    rule, roots = rule_of(weight, h=H, reach=reach), 0
    for near, x, d, _ in pieces(60, 4):
        ts = np.linspace(-1.5, 1.5, 61)
        values = [numerator(near, x + t * np.array(d), rule) for t in ts]
        for k in range(60):
            if values[k] * values[k + 1] < 0:
                low, high = ts[k], ts[k + 1]
                for _ in range(60):
                    middle = 0.5 * (low + high)
                    same = numerator(near, x + middle * np.array(d), rule) * values[k] > 0
                    low, high = (middle, high) if same else (low, middle)
                roots += 1
                for half in (1e-13, 1e-9, 1e-4, 0.1):
                    shifted = x + (low + 0.7 * half) * np.array(d)
                    assert not certainly_none(near, place(shifted.tolist()), d, half, rule, math.inf)
    assert roots > 15


def test_a_plane_is_told_from_a_point_beside_it_down_to_rounding() -> None:
    near, rule = near_of(*level(3, 0.7)), rule_of(h=H)
    for height, none in ((0.0, False), (1e-16, False), (1e-12, True), (-1e-12, True), (0.3, True)):
        assert certainly_none(near, (0.1, 0.2, height), (0.6, 0.0, 0.8), 1e-13, rule, math.inf) is none


def test_a_barycentre_out_of_bounds_excludes_too() -> None:
    near, rule = near_of(*level(2, 0.5)), rule_of(h=H)
    beside = (3.0, 0.0, 0.0)  # in the plane of the sheet, far from its edge
    assert not certainly_none(near, beside, (0.0, 0.0, 1.0), 0.1, rule, math.inf)
    assert certainly_none(near, beside, (0.0, 0.0, 1.0), 0.1, rule, 0.8)


def test_stretches_end_where_the_proof_does() -> None:
    near, rule = near_of(*level(3, 0.7)), rule_of(h=H)
    base, down = (0.1, 0.2, 1.0), (0.0, 0.0, -1.0)
    at, count = exclude(near, base, down, 0.0, 0.999, rule, math.inf)
    assert at != at and count < 40
    at, count = exclude(near, base, down, 0.0, 2.0, rule, math.inf)
    assert 0.999999 < at <= 1.0 and count < 100
    at, _ = exclude(near, base, (1.0, 0.0, 0.0), 0.0, 3.0, rule, math.inf)
    assert at != at


@pytest.mark.parametrize("h", [1e-3, 1e-2, 50.0])
def test_extreme_feature_sizes_leave_no_nan(h: float) -> None:
    near, rule = near_of(*level(3, 0.7)), rule_of(h=h)
    at, count = exclude(near, (0.1, 0.2, 1.0), (0.0, 0.0, -1.0), 0.0, 0.99, rule, math.inf)
    assert at != at and count < 20_000
