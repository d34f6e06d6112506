"""The oracle against the closed forms of densely sampled surfaces: how far sphere, cylinder and slab shrink."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from scipy import special

from tests.oracle.energies import e_oc
from tests.oracle.gradients import tangent_gradient
from tests.oracle.normals import offset
from tests.oracle.samples import rings, slab, spiral, tube
from tests.oracle.searches import first_sign_change
from tests.oracle.surfaces import tangent
from tests.oracle.vectors import Vector, times, unit

Function = Callable[[float], float]


def height(direction: Vector, points: list[list[float]], normals: list[list[float]], h: float) -> Function:
    """f along a line through the origin."""
    def f(r: float) -> float:
        value = tangent(times(direction, r), points, normals, h)
        assert value is not None
        return value

    return f


def sphere_barycentre(r: float, radius: float, h: float) -> float:
    """Height of a(x) for |x| = r in a dense sphere: R(coth q - 1/q), q = 2rR/h²."""
    q = 2 * r * radius / (h * h)
    return radius * (1 / math.tanh(q) - 1 / q)


def shrunk_sphere(h: float) -> float:
    """Radius of the surface of a dense unit sphere."""
    return float(first_sign_change(lambda r: sphere_barycentre(r, 1.0, h) - r, 0.02, 1.2, 100))


def crosses(f: Function, root: float, margin: float) -> None:
    """f goes from above 0 to below 0 within the margin of the root."""
    assert f(root - margin) > 0 > f(root + margin)


def never_positive(f: Function) -> bool:
    """Whether f is below 0 on all of a scan outwards from the middle."""
    return all(f(r) < 0 for r in (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2))


@pytest.mark.parametrize("h", [0.4, 0.7, 1.0])
@pytest.mark.parametrize("r", [0.3, 0.9, 1.3])
def test_barycentre_in_a_dense_sphere(r: float, h: float) -> None:
    # The midpoint rule: four times closer with twice the rings.
    exact, errors = sphere_barycentre(r, 1.0, h), []
    for count in (100, 200):
        c = offset([0.0, 0.0, r], rings(1.0, count, each=2)[0], h)
        assert c is not None and c[:2] == pytest.approx([0.0, 0.0], abs=1e-15)
        errors.append(r + c[2] - exact)
    assert abs(errors[1]) < 5e-4
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=0.02)
    assert (4 * errors[1] - errors[0]) / 3 == pytest.approx(0.0, abs=2e-6)


@pytest.mark.parametrize("h", [0.3, 0.6])
def test_dense_sphere_shrinks_as_predicted(h: float) -> None:
    exact = shrunk_sphere(h)
    crosses(height([0.0, 0.0, 1.0], *rings(1.0, 1000, each=2), h), exact, 1e-5)
    assert 1 - exact == pytest.approx(h * h / 2, rel=h * h)


def test_a_sphere_smaller_than_root_three_halves_h_is_gone() -> None:
    points, normals = rings(1.0, 400, each=2)
    h = 1 / math.sqrt(1.5)
    crosses(height([0.0, 0.0, 1.0], points, normals, 0.98 * h), shrunk_sphere(0.98 * h), 1e-3)
    assert never_positive(height([0.0, 0.0, 1.0], points, normals, 1.02 * h))


def test_spiral_sphere_from_any_direction() -> None:
    points, normals = spiral(1.0, 1500)
    for direction in (unit([1.0, 2.0, 3.0]), unit([-0.3, 0.1, 0.0])):
        crosses(height(direction, points, normals, 0.4), shrunk_sphere(0.4), 2e-5)


@pytest.mark.parametrize("h", [0.4, 0.7])
def test_dense_cylinder_shrinks_as_predicted(h: float) -> None:
    # r = R I1(q)/I0(q), q = 2rR/h². Lattices sum a Gaussian to the last bit.
    points, normals = tube(1.0, 60, 14, h / 2)
    exact = shrunk_cylinder(h)
    for turn in (0.0, 0.02):
        crosses(height([math.cos(turn), math.sin(turn), 0.0], points, normals, h), exact, 2e-14)


def shrunk_cylinder(h: float) -> float:
    """Radius of the surface of a dense unit cylinder."""
    def f(r: float) -> float:
        q = 2 * r / (h * h)
        return float(special.ive(1, q) / special.ive(0, q)) - r

    return float(first_sign_change(f, 0.02, 1.2, 100))


def test_a_cylinder_thinner_than_h_is_gone() -> None:
    points, normals = tube(1.0, 30, 12, 0.5)
    crosses(height([1.0, 0.0, 0.0], points, normals, 0.98), shrunk_cylinder(0.98), 1e-12)
    assert never_positive(height([1.0, 0.0, 0.0], points, normals, 1.02))


def shrunk_slab(s: float) -> float:
    """Half the thickness of the surface of a dense slab of thickness 2s, for h = 1."""
    return float(first_sign_change(lambda z: s * math.tanh(2 * s * z) - z, 0.02, 2.0, 100))


@pytest.mark.parametrize("s", [0.8, 1.0, 1.5])
def test_dense_slab_thins_as_predicted(s: float) -> None:
    points, normals = slab(12, 0.5, s)
    exact = shrunk_slab(s)
    crosses(height([0.0, 0.0, 1.0], points, normals, 1.0), exact, 1e-14)
    assert e_oc([0.0, 0.0, exact], points, 1.0) == pytest.approx(0.0, abs=1e-14)


def test_a_slab_thinner_than_root_two_h_is_gone() -> None:
    half = math.sqrt(0.5)
    crosses(height([0.0, 0.0, 1.0], *slab(12, 0.5, 1.02 * half), 1.0), shrunk_slab(1.02 * half), 1e-12)
    assert never_positive(height([0.0, 0.0, 1.0], *slab(12, 0.5, 0.98 * half), 1.0))


def test_contraction_on_a_dense_sphere() -> None:
    # The iteration's factor is 1 + <∇f, n>, close to h²/(2R²) where h is small against R.
    h = 0.4
    exact = shrunk_sphere(h)
    q = 2 * exact / (h * h)
    slope = 2 / (h * h) * (1 / (q * q) - 1 / math.sinh(q) ** 2)
    gradient = tangent_gradient([0.0, 0.0, exact], *rings(1.0, 200), h)
    assert gradient is not None
    assert 1 + gradient[2] == pytest.approx(slope, rel=2e-3)
    assert slope == pytest.approx(h * h / 2, rel=0.25)
