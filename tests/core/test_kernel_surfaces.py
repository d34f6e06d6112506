"""Every evaluator at single points, against the slow oracle and against 50 digits; then the stiff and extreme cases."""

from __future__ import annotations

import math
import random
from itertools import product

import numpy as np
import pytest

from jaart.core.assemble import NORMALS, WEIGHTS
from jaart.core.kernels import records as r
from jaart.core.kernels.judge import angle_energy
from jaart.core.kernels.polynomial import value as height
from jaart.core.kernels.vectors import frame
from tests.core.kernel_calls import fitted_value, near_of, rule_of, value_of
from tests.oracle import normals as oracle_normals
from tests.oracle import weights
from tests.oracle.gradients import tangent_gradient
from tests.oracle.normals import NORMALS as ORACLE_NORMALS
from tests.oracle.normals import offset
from tests.oracle.samples import cloudlet, tilted_plane
from tests.oracle.surfaces import polynomial_fit, powers, tangent
from tests.oracle.vectors import along, dot

H = 0.8
POINTS, AHEAD = cloudlet(60)
NEAR = near_of(POINTS, AHEAD)
PLACES = [[0.1, -0.2, 0.3], [0.9, 0.4, -0.1], [-0.7, 0.6, 0.15]]
UP = [0.0, 0.0, 1.0]
#: Every weight with every normal.
EVERY = [*product(WEIGHTS, NORMALS)]


@pytest.mark.parametrize(("weight", "normal"), EVERY)
def test_tangent_surfaces_are_the_oracles(weight: str, normal: str) -> None:
    rule = rule_of(weight, normal, H)
    for x in PLACES:
        found = value_of(NEAR, x, rule)
        exact = ORACLE_NORMALS[normal](x, POINTS, AHEAD, H, weight)
        assert found.state == r.CONTINUE and found.degree == 0
        assert found.n == pytest.approx(exact.vector, abs=2e-13)
        assert found.off == pytest.approx(offset(x, POINTS, H, weight), abs=1e-14)
        assert found.f == pytest.approx(tangent(x, POINTS, AHEAD, H, weight, normal), abs=1e-13)
        assert found.shift + math.log(found.weight) == pytest.approx(weights.log_sum(weight, x, POINTS, H), abs=1e-13)
        assert np.isnan(found.gradient).all()


@pytest.mark.parametrize(("weight", "normal"), EVERY)
def test_gradients_in_closed_form_are_those_of_50_digits(weight: str, normal: str) -> None:
    rule = rule_of(weight, normal, H)
    for x in PLACES[:2]:
        exact = tangent_gradient(x, POINTS, AHEAD, H, weight, normal)
        assert exact is not None
        found = value_of(NEAR, x, rule, gradient=True)
        assert np.subtract(found.gradient, exact) / math.hypot(*exact) == pytest.approx(np.zeros(3), abs=2e-12)
        assert found[:6] == value_of(NEAR, x, rule)[:6]


@pytest.mark.parametrize(("normal", "k"), [*product(NORMALS, [12, 25])])
def test_gradients_hold_where_only_the_nearest_count(normal: str, k: int) -> None:
    x = PLACES[0]
    ids = sorted(range(len(POINTS)), key=lambda i: math.dist(x, POINTS[i]))[:k]
    points, ahead = [POINTS[i] for i in ids], [AHEAD[i] for i in ids]
    exact = tangent_gradient(x, points, ahead, H, "gaussian", normal)
    found = value_of(NEAR, x, rule_of("gaussian", normal, H, k=k), gradient=True)
    assert found.gradient == pytest.approx(exact, rel=1e-11, abs=1e-11)


@pytest.mark.parametrize("far", [5.0, 14.0, 30.0])
def test_gradients_hold_far_away(far: float) -> None:
    """The Gaussians are divided by the nearest one's there; so are their slopes."""
    x = [0.3 * far * H, 0.2 * far * H, 0.9 * far * H]
    for normal in ("surfel", "covariance_at_x"):
        exact = tangent_gradient(x, POINTS, AHEAD, H, "gaussian", normal)
        if exact is None:
            assert value_of(NEAR, x, rule_of("gaussian", normal, H), gradient=True).state == r.UNDEFINED_NORMAL
        else:
            found = value_of(NEAR, x, rule_of("gaussian", normal, H), gradient=True)
            assert found.gradient == pytest.approx(exact, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(("weight", "normal"), EVERY)
def test_an_unoriented_eigenvector_is_the_same_up_to_its_sign(weight: str, normal: str) -> None:
    for x in PLACES:
        turned = value_of(NEAR, x, rule_of(weight, normal, H), gradient=True)
        free = value_of(NEAR, x, rule_of(weight, normal, H, oriented=0), gradient=True)
        sign = 1.0 if dot(turned.n, free.n) > 0 else -1.0
        assert np.multiply(free.n, sign).tolist() == list(turned.n)
        assert np.multiply(free.gradient, sign) == pytest.approx(turned.gradient, rel=1e-12, abs=1e-13)
        assert free.f * sign == turned.f


@pytest.mark.parametrize(("weight", "normal"), EVERY)
def test_polynomials_are_the_oracles(weight: str, normal: str) -> None:
    h = H if weight in ("gaussian", "wendland") else 1.2
    for degree, x in product(range(5), PLACES):
        found, fit = fitted_value(NEAR, x, rule_of(weight, normal, h, degree=degree))
        exact = polynomial_fit(x, POINTS, AHEAD, h, degree, weight, normal)
        assert exact is not None and (found.state, found.degree) == (r.CONTINUE, exact.degree)
        assert found.f == pytest.approx(exact.value, abs=1e-13 / exact.ratio)
        assert found.n == pytest.approx(exact.n, abs=2e-13)
        for a, b in ((0.3, -0.2), (-0.5, 0.4)):
            e1, e2 = (np.array(e) for e in frame(found.n))
            ahead = a * np.array(exact.u) + b * np.array(exact.v)
            u, v = float(ahead @ e1) / h, float(ahead @ e2) / h
            assert height(fit, u, v) * h == pytest.approx(exact.height(a, b), abs=2e-12 / exact.ratio)


@pytest.mark.parametrize(("weight", "normal"), EVERY)
def test_degree_0_is_the_tangent_surface(weight: str, normal: str) -> None:
    for x in PLACES:
        plain = value_of(NEAR, x, rule_of(weight, normal, H))
        found, fit = fitted_value(NEAR, x, rule_of(weight, normal, H, degree=0))
        assert found.f == pytest.approx(plain.f, abs=2e-15)
        assert (found.state, found.n, found.off, found.weight) == (plain.state, plain.n, plain.off, plain.weight)
        assert not fit[1:].any()


def sheet(degree: int, count: int, seed: int = 4) -> tuple[list[list[float]], list[list[float]]]:
    """Points of z = a polynomial of a degree with no term of degree 1, with normals (0, 0, 1)."""
    rng = random.Random(seed)
    coefficients = [(p, rng.uniform(-0.3, 0.3)) for p in powers(degree) if sum(p) != 1]
    places = [(rng.uniform(-1, 1), rng.uniform(-1, 1)) for _ in range(count)]
    return [[a, b, math.fsum(c * a**i * b**j for (i, j), c in coefficients)] for a, b in places], [UP] * count


@pytest.mark.parametrize("degree", range(2, 5))
def test_a_polynomial_of_enough_degrees_is_found_exactly(degree: int) -> None:
    points, ahead = sheet(degree, 60)
    constant = random.Random(4).uniform(-0.3, 0.3)
    found, _ = fitted_value(near_of(points, ahead), [0.0, 0.0, 0.05], rule_of(h=H, degree=degree))
    assert found.degree == degree and found.f == pytest.approx(constant - 0.05, abs=1e-13)


@pytest.mark.parametrize(("count", "degree"), [(1, 0), (4, 0), (5, 1), (8, 1), (9, 2), (14, 2), (15, 3),
                                               (22, 3), (23, 4)])
def test_the_degree_is_lowered_where_points_are_scarce(count: int, degree: int) -> None:
    points, ahead = sheet(4, count)
    found, fit = fitted_value(near_of(points, ahead), [0.0, 0.0, 0.05], rule_of(h=2.0, degree=4))
    assert (found.state, found.degree) == (r.CONTINUE, degree)
    assert np.isfinite(fit).all() and not fit[(degree + 1) * (degree + 2) // 2:].any()
    exact = polynomial_fit([0.0, 0.0, 0.05], points, ahead, 2.0, 4)
    assert exact is not None and exact.degree == degree
    assert found.f == pytest.approx(exact.value, abs=1e-12)


def test_the_degree_is_lowered_where_points_lie_in_lines() -> None:
    points = [[0.1 * i, 0.0, 0.01 * i] for i in range(-10, 11)]
    found, _ = fitted_value(near_of(points, [UP] * 21), [0.0, 0.0, 0.0], rule_of(h=H, degree=4))
    assert (found.state, found.degree) == (r.CONTINUE, 0)
    points = [[0.1 * i, 0.5 * j, 0.1] for i in range(-10, 11) for j in (-1, 1)]
    found, _ = fitted_value(near_of(points, [UP] * 42), [0.0, 0.0, 0.0], rule_of(h=H, degree=4))
    assert (found.state, found.degree) == (r.CONTINUE, 1) and found.f == pytest.approx(0.1, abs=1e-14)


# Cases of the catalogue of extremes that are about evaluators, by their numbers.

def test_1_a_tiny_h_gives_the_plane_of_the_nearest_surfel() -> None:
    points, ahead = tilted_plane([0.0, 0.0, 1.0], [0.0, 0.0, 0.0])
    points.append([0.0, 0.0, 0.25])
    found = value_of(near_of(points, [*ahead, [0.6, 0.0, 0.8]]), [0.0, 0.0, 5.25], rule_of(h=0.02))
    assert found.n == pytest.approx([0.6, 0.0, 0.8], abs=1e-15)
    assert found.f == pytest.approx(-5 * 0.8, abs=1e-15)


@pytest.mark.parametrize("normal", ["surfel", "covariance"])
@pytest.mark.parametrize("far", [15.5, 21.0, 22.0, 1e3, 1e6])
def test_2_f_is_exact_however_far(far: float, normal: str) -> None:
    points = [[0.5 * i, 0.5 * j, 0.0] for i in range(-3, 4) for j in range(-3, 4)]
    found = value_of(near_of(points, [UP] * 49), [0.125, 0.0625, far], rule_of("gaussian", normal, H))
    assert found.f == pytest.approx(-far, rel=5e-16) and found.n == pytest.approx((0.0, 0.0, 1.0), abs=1e-16)


def test_14_opposite_surfels_leave_no_normal() -> None:
    sheet_points = [[0.5 * i, 0.5 * j, z] for z in (-0.5, 0.5) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    ahead = [[0.0, 0.0, math.copysign(1, p[2])] for p in sheet_points]
    for found in (value_of(near_of(sheet_points, ahead), [0.1, 0.0, 0.0], rule_of(h=H), gradient=True),
                  fitted_value(near_of(sheet_points, ahead), [0.1, 0.0, 0.0], rule_of(h=H, degree=2))[0]):
        assert found.state == r.UNDEFINED_NORMAL and math.isnan(found.f)
        assert np.isnan(found.n).all() and np.isnan(found.gradient).all()
        assert found.off == pytest.approx([-0.1, 0.0, 0.0], abs=0.2) and found.weight > 0
    aside = value_of(near_of(sheet_points, ahead), [0.1, 0.0, 1e-6], rule_of(h=H))
    assert aside.state == r.CONTINUE and aside.n == pytest.approx(UP, abs=1e-12)


def test_15_one_surfel_is_its_plane() -> None:
    d = (math.sqrt(0.5), 0.0, -math.sqrt(0.5))
    found = value_of(near_of([[0.0, 0.0, 0.0]], [UP]), [-1.0, 0.0, 1.0], rule_of(h=H))
    assert found.f / dot(found.n, d) == pytest.approx(math.sqrt(2), abs=2.3e-16)


@pytest.mark.parametrize("normal", ["covariance", "covariance_at_x"])
@pytest.mark.parametrize("points", [
    [[0.0, 0.0, 0.0], [0.3, 0.1, 0.2]],                               # 18: two points
    [[0.1 * i, 0.2 * i, -0.1 * i] for i in range(7)],                 # 18: a line
    [[0.2, 0.1, 0.3]] * 6,                                            # 19: one point again and again
    [[0.2, 0.1, 0.3]],
])
def test_18_19_a_line_or_a_point_leaves_no_normal(points: list[list[float]], normal: str) -> None:
    x = [float(c) for c in np.mean(points, axis=0)]
    for rule in (rule_of("gaussian", normal, H), rule_of("gaussian", normal, H, degree=2)):
        for found in (value_of(near_of(points), x, rule, gradient=True), fitted_value(near_of(points), x, rule)[0]):
            assert found.state == r.UNDEFINED_NORMAL
            assert math.isnan(found.f) and np.isnan(found.n).all() and np.isnan(found.gradient).all()


@pytest.mark.parametrize(("weight", "normal"), EVERY)
def test_20_coplanar_points_are_their_plane(weight: str, normal: str) -> None:
    n = [2 / 7, 3 / 7, 6 / 7]
    points, ahead = tilted_plane(n, [0.3, -0.1, 0.2])
    for d in (-0.2, 0.0, 0.15) if normal != "covariance_at_x" else (0.0,):  # off the plane it tilts, about x
        x, exact = along(along([0.3, -0.1, 0.2], n, d), [3 / 7, -2 / 7, 0.0], 0.1), -d
        exact -= dot(n, [3 / 7, -2 / 7, 0.0]) * 0.1
        found = value_of(near_of(points, ahead), x, rule_of(weight, normal, 1.0), gradient=True)
        assert found.f == pytest.approx(exact, abs=2e-15)
        assert found.n == pytest.approx(n, abs=3e-15)
        size = 1.0 if normal != "covariance_at_x" else math.hypot(*found.gradient)
        assert found.gradient == pytest.approx([-size * c for c in n], abs=1e-14)
        for degree in range(5):
            fitted, _ = fitted_value(near_of(points, ahead), x, rule_of(weight, normal, 1.0, degree=degree))
            assert fitted.f == pytest.approx(exact, abs=1e-13)


def test_21_about_x_the_normal_flips_and_about_a_never() -> None:
    """A dense plane has the spread h²/2 within it, so about x the flip is at h/√2."""
    points = [[0.1 * i, 0.1 * j, 0.0] for i in range(-45, 46) for j in range(-45, 46)]
    near = near_of(points)
    for distance, flipped in ((0.70, False), (0.72, True)):
        x = [0.01, 0.02, distance]
        about_x = value_of(near, x, rule_of("gaussian", "covariance_at_x", 1.0))
        if about_x.state == r.CONTINUE:
            assert abs(about_x.n[2]) == pytest.approx(0.0 if flipped else 1.0, abs=1e-9)
        else:
            assert flipped  # any direction within the plane is as good
    for distance in (0.1, 0.72, 3.0):
        about_a = value_of(near, [0.01, 0.02, distance], rule_of("gaussian", "covariance", 1.0))
        assert about_a.n == pytest.approx(UP, abs=1e-15) and about_a.f == pytest.approx(-distance, abs=1e-15)


@pytest.mark.parametrize("weight", ["hat", "squared_hat", "wendland"])
@pytest.mark.parametrize("normal", NORMALS)
def test_30_nothing_in_reach_is_no_surface(weight: str, normal: str) -> None:
    rule = rule_of(weight, normal, H, degree=2)
    for near in (NEAR, near_of([])):
        x = [9.0, 0.0, 0.0]
        for found in (value_of(near, x, rule, gradient=True), fitted_value(near, x, rule)[0]):
            assert found.state == r.FEW_NEIGHBOURS and found.weight == 0
            assert math.isnan(found.f) and np.isnan(found.n).all() and np.isnan(found.off).all()


@pytest.mark.parametrize("normal", NORMALS)
def test_30_no_surfel_at_all_is_no_surface(normal: str) -> None:
    found = value_of(near_of([]), [0.0, 0.0, 0.0], rule_of("gaussian", normal, H), gradient=True)
    assert found.state == r.FEW_NEIGHBOURS and math.isnan(found.f)


def test_31_the_angle_energy_is_0_at_the_barycentre() -> None:
    corners = [[a, b, 0.0] for a in (-0.5, 0.5) for b in (-0.5, 0.5)]
    found = value_of(near_of(corners, [UP] * 4), [0.0, 0.0, 0.0], rule_of(h=H))
    assert found.off == (0.0, 0.0, 0.0) and angle_energy(found.n, found.off) == 0.0


@pytest.mark.parametrize("power", [-300, -40, 7, 200])
def test_27_scaling_by_a_power_of_two_changes_no_bit(power: int) -> None:
    s = 2.0**power
    near = near_of([[c * s for c in p] for p in POINTS], AHEAD)
    for normal, x in product(NORMALS, PLACES):
        one = value_of(NEAR, x, rule_of("gaussian", normal, H), gradient=True)
        other = value_of(near, [c * s for c in x], rule_of("gaussian", normal, H * s), gradient=True)
        assert (other.f, other.n, other.weight) == (one.f * s, one.n, one.weight)
        assert other.gradient == pytest.approx(one.gradient, rel=1e-14)


def test_the_sampling_gap_is_the_oracles() -> None:
    from jaart.core.kernels.normals import sampling_gap
    from tests.core.kernel_calls import place, weights_of

    for weight, x in product(WEIGHTS, PLACES):
        w, s, _ = weights_of(NEAR, x, rule_of(weight, h=H))
        off = value_of(NEAR, x, rule_of(weight, h=H)).off
        exact = oracle_normals.covariance(x, POINTS, AHEAD, H, weight).gap
        assert sampling_gap(NEAR, place(x), s, off, w) == pytest.approx(exact, abs=1e-13)
