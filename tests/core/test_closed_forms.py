"""Densely sampled sphere, cylinder and slab shrink exactly as predicted, by the kernels' own f."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from scipy import optimize, special

from jaart.core.kernels import records as r
from jaart.core.kernels.records import Near, Rule
from tests.core.kernel_calls import fitted_value, near_of, rule_of, value_of
from tests.oracle.samples import rings, slab, tube

Function = Callable[[float], float]
#: What the finite sampling leaves.
CLOSE = 2e-5


def height(near: Near, rule: Rule, axis: tuple[float, float, float]) -> Function:
    """f at a distance from the middle along an axis, seen from outside."""
    def f(distance: float) -> float:
        x = [c * distance for c in axis]
        found = fitted_value(near, x, rule)[0] if rule.degree else value_of(near, x, rule)
        assert found.state == r.CONTINUE
        return found.f if sum(n * c for n, c in zip(found.n, axis, strict=True)) > 0 else -found.f

    return f


def bisected(f: Function, low: float, high: float) -> float:
    """The root between two places, f above 0 at the lower and below 0 at the higher one."""
    assert f(low) > 0 > f(high)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if f(middle) > 0 else (low, middle)
    return low


def predicted(barycentre: Function, low: float, high: float) -> float:
    """Where the barycentre of a dense sheet is x itself."""
    return float(optimize.brentq(lambda x: barycentre(x) - x, low, high, xtol=1e-15))


def in_sphere(h: float) -> Function:
    """Height of a(x) in a dense unit sphere: coth q - 1/q, q = 2r/h²."""
    return lambda x: 1 / math.tanh(2 * x / (h * h)) - h * h / (2 * x)


def in_cylinder(h: float) -> Function:
    """Height of a(x) in a dense cylinder of radius 1: I1(q)/I0(q)."""
    return lambda x: float(special.ive(1, 2 * x / (h * h)) / special.ive(0, 2 * x / (h * h)))


def in_slab(h: float) -> Function:
    """Height of a(x) between dense planes at 1 and -1: tanh(2x/h²)."""
    return lambda x: math.tanh(2 * x / (h * h))


@pytest.mark.parametrize(("per_h", "normal"), [(1.25, "surfel"), (1.5, "surfel"), (2.0, "surfel"), (4.0, "surfel"),
                                               (2.0, "covariance"), (4.0, "covariance")])
def test_a_dense_sphere_shrinks_as_predicted(per_h: float, normal: str) -> None:
    h = 1 / per_h
    exact = predicted(in_sphere(h), 0.05, 1.0)
    near = near_of(*rings(1.0, 1200, each=4))
    assert bisected(height(near, rule_of("gaussian", normal, h), (0.0, 0.0, 1.0)), 0.9 * exact, 1.2) == pytest.approx(
        exact, abs=CLOSE)
    table = {1.25: 0.3191, 1.5: 1.0136, 2.0: 1.7071, 4.0: 3.8708}
    assert exact * per_h == pytest.approx(table[per_h], abs=1e-4)


@pytest.mark.parametrize("per_h", [1.05, 1.5, 3.0])
def test_a_dense_cylinder_shrinks_as_predicted(per_h: float) -> None:
    h = 1 / per_h
    exact = predicted(in_cylinder(h), 0.05, 1.0)
    near = near_of(*tube(1.0, 60, int(6 * h / (0.15 * h)), 0.15 * h))
    for axis in ((1.0, 0.0, 0.0), (math.cos(0.3), math.sin(0.3), 0.0)):
        found = bisected(height(near, rule_of(h=h), axis), 0.9 * exact, 1.2)
        assert found == pytest.approx(exact, abs=1e-12)  # even samples of a periodic function converge at once
    assert exact * per_h == pytest.approx({1.05: 0.4386, 1.5: 1.2869, 3.0: 2.9129}[per_h], abs=1e-4)


@pytest.mark.parametrize("thickness", [1.44, 1.6, 2.0, 3.0])
def test_a_dense_slab_shrinks_as_predicted(thickness: float) -> None:
    h = 2 / thickness
    exact = predicted(in_slab(h), 0.05, 1.0)
    near = near_of(*slab(14, 0.45 * h, 1.0))
    found = bisected(height(near, rule_of(h=h), (0.0, 0.0, 1.0)), 0.9 * exact, 1.2)
    assert found == pytest.approx(exact, abs=1e-14)
    table = {1.44: 0.2316, 1.6: 0.5891, 2.0: 0.9575, 3.0: 1.4996}
    assert exact / h == pytest.approx(table[thickness], abs=1e-4)


@pytest.mark.parametrize(("samples", "gone", "left"), [
    (rings(1.0, 500, each=4), 1 / math.sqrt(1.5), in_sphere), (tube(1.0, 60, 60, 0.1), 1.0, in_cylinder),
    (slab(16, 0.5, 1.0), math.sqrt(2), in_slab)])
def test_round_and_thin_things_are_gone_beyond_their_limits(samples: tuple[list[list[float]], list[list[float]]],
                                                            gone: float, left: Callable[[float], Function]) -> None:
    """Sphere: R < √1.5 h; cylinder: R < h; slab: 2s < √2 h. Just before, there is still the surface predicted."""
    near, axis = near_of(*samples), (0.0, 0.0, 1.0) if left is not in_cylinder else (1.0, 0.0, 0.0)
    f = height(near, rule_of(h=1.02 * gone), axis)
    assert all(f(x) < 0 for x in (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2))
    exact = predicted(left(0.98 * gone), 0.02, 1.0)
    found = bisected(height(near, rule_of(h=0.98 * gone), axis), 0.5 * exact, 1.2)
    assert found == pytest.approx(exact, abs=1e-3)


@pytest.mark.parametrize("h", [0.2, 0.3])
def test_a_polynomial_of_degree_2_shrinks_a_sphere_far_less(h: float) -> None:
    """The plane loses h²/2R; a parabola follows the sphere to fourth order."""
    near = near_of(*rings(1.0, 500, each=16))
    axis = (0.6, 0.0, 0.8)
    found = bisected(height(near, rule_of(h=h, degree=2), axis), 0.9, 1.1)
    assert abs(1 - found) < 0.25 * h**4 + 2e-4
    assert 1 - bisected(height(near, rule_of(h=h), axis), 0.9, 1.1) == pytest.approx(h * h / 2, rel=0.1)
