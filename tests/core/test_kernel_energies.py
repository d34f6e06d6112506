"""The energies against the slow oracle, and their slopes in closed form against 50 digits."""

from __future__ import annotations

import math
from itertools import product

import pytest

from jaart.core.assemble import NORMALS, WEIGHTS
from jaart.core.kernels import records as r
from jaart.core.kernels.energy import energy, energy_slope, has_slope, plain_energy
from tests.core.exact_slopes import exact_slope
from tests.core.kernel_calls import near_of, place, rule_of, value_of, weights_of
from tests.oracle import energies
from tests.oracle.samples import cloudlet
from tests.oracle.surfaces import tangent

H, C = 0.8, 0.25
POINTS, AHEAD = cloudlet(40)
NEAR = near_of(POINTS, AHEAD)
PLACES = [[0.1, -0.2, 0.3], [0.9, 0.4, -0.1], [-0.7, 0.6, 0.5]]
DIRECTION = (2 / 7, -3 / 7, -6 / 7)
EVERY = [*product(WEIGHTS, NORMALS)]


def of_kernel(kind: int, x: list[float], weight: str, normal: str, emphasise: int = 0, c: float = C) -> float:
    """An energy by the kernels."""
    rule = rule_of(weight, normal, H, c=c)
    w, _, _ = weights_of(NEAR, x, rule)
    found: float = energy(kind, emphasise, NEAR, place(x), DIRECTION, value_of(NEAR, x, rule), c, w)
    return found


def of_oracle(kind: int, x: list[float], weight: str, normal: str, c: float = C) -> float:
    """An energy by the oracle, never negative."""
    if kind == r.OFF_CENTRE:
        found = energies.e_oc(x, POINTS, H, weight)
    elif kind == r.MAHALANOBIS:
        found = energies.e_mahalanobis(x, POINTS, AHEAD, H, c, weight)
    elif kind == r.ANGLE:
        found = energies.e_angle(x, POINTS, AHEAD, H, weight, normal)
    elif kind == r.TANGENT:
        found = tangent(x, POINTS, AHEAD, H, weight, normal)
    else:
        found = energies.e_ts(x, DIRECTION, POINTS, AHEAD, H, weight, normal)
    assert found is not None
    return abs(found)


@pytest.mark.parametrize(("weight", "normal"), EVERY)
@pytest.mark.parametrize("kind", range(5))
def test_energies_are_the_oracles(kind: int, weight: str, normal: str) -> None:
    for x in PLACES:
        assert of_kernel(kind, x, weight, normal) == pytest.approx(of_oracle(kind, x, weight, normal), rel=1e-11)


@pytest.mark.parametrize(("weight", "normal"), EVERY)
@pytest.mark.parametrize("kind", [r.TANGENT_STEP, r.OFF_CENTRE, r.MAHALANOBIS, r.TANGENT])
def test_emphasised_energies_are_the_oracles(kind: int, weight: str, normal: str) -> None:
    for x in (*PLACES, [0.2, 0.1, 1.9]):
        if weight in ("hat", "squared_hat") and x[2] > 1:
            continue  # nothing is in reach
        angle = energies.e_angle(x, POINTS, AHEAD, H, weight, normal)
        exact = energies.emphasised(angle, of_oracle(kind, x, weight, normal))
        assert of_kernel(kind, x, weight, normal, emphasise=1) == pytest.approx(exact, rel=1e-11, abs=1e-12)
        assert 0 <= of_kernel(kind, x, weight, normal, emphasise=1) <= 1


@pytest.mark.parametrize("c", [0.0, 0.25, 1.0])
def test_mahalanobis_with_any_share_across(c: float) -> None:
    for x in PLACES:
        exact = energies.e_mahalanobis(x, POINTS, AHEAD, H, c)
        assert of_kernel(r.MAHALANOBIS, x, "gaussian", "surfel", c=c) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("far", [12.0, 20.0, 1e4])
def test_energies_far_away_are_finite(far: float) -> None:
    x = [0.1, 0.2, far * H]
    for kind in range(5):
        assert of_kernel(kind, x, "gaussian", "surfel") == pytest.approx(of_oracle(kind, x, "gaussian", "surfel"),
                                                                         rel=1e-11)


@pytest.mark.parametrize("weight", WEIGHTS)
@pytest.mark.parametrize(("kind", "c"), [(r.OFF_CENTRE, 0.25), (r.MAHALANOBIS, 0.25), (r.MAHALANOBIS, 0.0),
                                         (r.MAHALANOBIS, 1.0)])
def test_slopes_in_closed_form_are_those_of_50_digits(kind: int, c: float, weight: str) -> None:
    rule = rule_of(weight, h=H, c=c)
    for x in PLACES:
        w, _, _ = weights_of(NEAR, x, rule)
        v = value_of(NEAR, x, rule)
        e = plain_energy(kind, NEAR, place(x), DIRECTION, v, c, w)
        found = energy_slope(kind, NEAR, place(x), DIRECTION, rule, v, e, w)
        exact = exact_slope(kind, weight, x, DIRECTION, POINTS, AHEAD, H, c)
        assert found == pytest.approx(exact, rel=1e-11, abs=1e-12)


def test_slopes_far_away_are_right() -> None:
    x, rule = [0.4, 0.2, 14 * H], rule_of(h=H)
    w, _, shift = weights_of(NEAR, x, rule)
    assert shift < 0
    for kind in (r.OFF_CENTRE, r.MAHALANOBIS):
        v = value_of(NEAR, x, rule)
        e = plain_energy(kind, NEAR, place(x), DIRECTION, v, C, w)
        found = energy_slope(kind, NEAR, place(x), DIRECTION, rule, v, e, w)
        assert found == pytest.approx(exact_slope(kind, "gaussian", x, DIRECTION, POINTS, AHEAD, H, C), rel=1e-9)


def test_other_energies_have_no_slope_in_closed_form() -> None:
    rule = rule_of(h=H)
    w, _, _ = weights_of(NEAR, PLACES[0], rule)
    v = value_of(NEAR, PLACES[0], rule)
    for kind in range(5):
        known = kind in (r.OFF_CENTRE, r.MAHALANOBIS)
        assert has_slope(kind, 0) == known and not has_slope(kind, 1)
        slope = energy_slope(kind, NEAR, place(PLACES[0]), DIRECTION, rule, v, 0.1, w)
        assert math.isnan(slope) != known
