"""The weights of every kind and neighbourhood against the slow oracle, near and very far from the surfels."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from jaart.core.assemble import WEIGHTS
from jaart.core.kernels.select import kth_smallest
from jaart.core.kernels.weigh import any_within, slope_factor
from tests.core.kernel_calls import near_of, place, rule_of, weights_of
from tests.oracle import neighbourhoods, weights
from tests.oracle.samples import cloudlet

H = 0.8
POINTS = cloudlet(40)[0]
#: Near the surfels, among them, at one of them, and beside them.
NEAR = [[0.1, -0.2, 0.3], [0.9, 0.4, -0.1], POINTS[7], [0.0, 0.0, 1.5], [2.1, -1.7, 0.2]]
#: (reach, k): no mask, a ball, the nearest ones; a k beyond the surfels' number masks nothing.
MASKS = [(math.inf, 0), (1.1, 0), (0.4, 0), (math.inf, 1), (math.inf, 7), (math.inf, 39), (math.inf, 60)]


def counted(x: list[float], points: list[list[float]], reach: float, k: int) -> list[int]:
    """The ids that count at x, by the oracle."""
    if k:
        return sorted(neighbourhoods.knn(x, points, k))
    return neighbourhoods.ball(x, points, reach) if math.isfinite(reach) else list(range(len(points)))


def expected(name: str, x: list[float], points: list[list[float]], h: float, ids: list[int]) -> np.ndarray:
    """The oracle's normalised weights of the ids, 0 for the others; all 0 where none is in reach."""
    found = np.zeros(len(points))
    relative = weights.relative(name, x, [points[i] for i in ids], h)
    if sum(relative) > 0:
        found[ids] = np.array(relative) / math.fsum(relative)
    return found


@pytest.mark.parametrize("name", WEIGHTS)
@pytest.mark.parametrize(("reach", "k"), MASKS)
def test_weights_are_the_oracles(name: str, reach: float, k: int) -> None:
    near, rule = near_of(POINTS), rule_of(name, h=H, reach=reach, k=k)
    reached = 0
    for x in NEAR:
        w, s, shift = weights_of(near, x, rule)
        ids = counted(x, POINTS, reach, k)
        exact = expected(name, x, POINTS, H, ids)
        assert np.isfinite(w).all() and s >= 0
        assert set(np.flatnonzero(w)) <= set(ids)
        if not exact.any():
            assert s == 0 and not w.any()
            continue
        reached += 1
        assert s == pytest.approx(math.fsum(w), rel=1e-15)
        assert w / s == pytest.approx(exact, abs=1e-14)
        assert shift + math.log(s) == pytest.approx(weights.log_sum(name, x, [POINTS[i] for i in ids], H), abs=1e-13)
    assert reached >= 2


@pytest.mark.parametrize("k", [0, 3])
@pytest.mark.parametrize("far", [11.0, 13.0, 20.0, 100.0, 1e4, 1e8])
def test_far_gaussian_weights_keep_their_ratios(far: float, k: int) -> None:
    near, rule = near_of(POINTS), rule_of(h=H, k=k)
    for direction in ([0.6, 0.0, 0.8], [0.0, 0.0, -1.0], [-0.48, 0.64, 0.6]):
        x = [far * H * c for c in direction]
        w, s, shift = weights_of(near, x, rule)
        exact = expected("gaussian", x, POINTS, H, counted(x, POINTS, math.inf, k))
        assert np.isfinite(w).all() and s > 0
        assert w / s == pytest.approx(exact, rel=1e-12, abs=1e-300)
        log_sum = weights.log_sum("gaussian", x, [POINTS[i] for i in counted(x, POINTS, math.inf, k)], H)
        assert shift + math.log(s) == pytest.approx(log_sum, rel=1e-15, abs=1e-12)


@pytest.mark.parametrize("h", [1e-90, 1e-40, 1e-3, 1e3, 1e90])
def test_gaussian_weights_at_any_feature_size(h: float) -> None:
    near = near_of(POINTS)
    for x in NEAR:
        w, s, _ = weights_of(near, x, rule_of(h=h))
        assert np.isfinite(w).all()
        assert w / s == pytest.approx(expected("gaussian", x, POINTS, h, counted(x, POINTS, math.inf, 0)), abs=1e-13)


@pytest.mark.parametrize("name", ["hat", "squared_hat", "wendland"])
@pytest.mark.parametrize("far", [20.0, 100.0, 1e8])
def test_compact_weights_end(name: str, far: float) -> None:
    for k in (0, 5):
        w, s, shift = weights_of(near_of(POINTS), [0.0, 0.0, far * H], rule_of(name, h=H, k=k))
        assert s == 0 and shift == 0 and not w.any()


@pytest.mark.parametrize("name", WEIGHTS)
def test_an_empty_reach_has_no_weight(name: str) -> None:
    for x, reach in (([0.0, 0.0, 3.0], 0.5), ([0.0, 0.0, 300.0], 1.0)):
        w, s, _ = weights_of(near_of(POINTS), x, rule_of(name, h=H, reach=reach))
        assert s == 0 and not w.any()


@pytest.mark.parametrize("name", WEIGHTS)
def test_no_surfel_at_all_has_no_weight(name: str) -> None:
    assert weights_of(near_of([]), [0.1, 0.2, 0.3], rule_of(name, h=H, k=3))[1] == 0
    assert not any_within(near_of([]), (0.0, 0.0, 0.0), 1e300)


@pytest.mark.parametrize("name", WEIGHTS)
@pytest.mark.parametrize("k", range(1, 9))
def test_of_equally_far_surfels_the_first_count(name: str, k: int) -> None:
    corners = [[a, b, c] for a in (-0.25, 0.25) for b in (-0.25, 0.25) for c in (-0.25, 0.25)]
    points = [*corners[:4], [0.125, 0.0, 0.0], *corners[4:]]
    w, s, _ = weights_of(near_of(points), [0.0, 0.0, 0.0], rule_of(name, h=H, k=k))
    ids = neighbourhoods.knn([0.0, 0.0, 0.0], points, k)
    assert set(np.flatnonzero(w)) == set(ids) and s > 0


@pytest.mark.parametrize("name", WEIGHTS)
def test_a_surfel_on_the_edge_of_the_reach_counts(name: str) -> None:
    points = [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5 + 2**-50], [0.25, 0.0, 0.0]]
    w, _, _ = weights_of(near_of(points), [0.0, 0.0, 0.0], rule_of(name, h=1.0, reach=0.5))
    assert (w[[0, 1, 3]] > 0).all()


@pytest.mark.parametrize("name", WEIGHTS)
def test_slopes_are_the_oracles(name: str) -> None:
    numbers = WEIGHTS[name]
    for q in (*np.linspace(1e-6, 2.4, 50), 1e-100, 0.0):
        w = float(weights.WEIGHTS[name](q, H))
        exact = float(weights.slope(name, q, H))
        assert slope_factor(numbers, H, (q / H) * (q / H), w) == pytest.approx(exact, rel=2e-12, abs=1e-15), q


@pytest.mark.parametrize("name", WEIGHTS)
def test_slopes_are_differences_of_weights(name: str) -> None:
    q, step = 0.37, 1e-6
    theta = weights.WEIGHTS[name]
    slope = (theta(q + step, H) - theta(q - step, H)) / (2 * step)
    assert -q * slope_factor(WEIGHTS[name], H, (q / H) ** 2, theta(q, H)) == pytest.approx(slope, rel=1e-8)


def test_kth_smallest_is_that_of_sorted_numbers() -> None:
    rng = random.Random(3)
    for trial in range(300):
        n = rng.randint(1, 40)
        numbers = [float(rng.randint(0, 9)) if trial % 2 else rng.random() for _ in range(n)]
        if trial % 5 == 0:
            numbers.sort(reverse=trial % 10 == 0)
        k = rng.randint(1, n)
        a = np.array([9.0] * n + numbers)
        bound, ties = kth_smallest(a, np.uint64(n), k)
        least = sorted(numbers)[:k]
        assert (bound, ties) == (least[-1], least.count(least[-1]))
        assert (a[:n] == 9.0).all() and sorted(a[n:]) == sorted(numbers)


def test_whether_a_surfel_is_within_a_distance() -> None:
    for x in NEAR:
        distance = min(math.dist(x, p) for p in POINTS)
        assert any_within(near_of(POINTS), place(x), distance * (1 + 1e-14))
        assert distance == 0 or not any_within(near_of(POINTS), place(x), distance * (1 - 1e-14))
