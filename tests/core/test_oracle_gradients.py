"""The oracle's gradients, against the closed forms of a plane, a sheet and surfels by hand."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from tests.oracle.gradients import exact_tangent, tangent_gradient
from tests.oracle.normals import NORMALS
from tests.oracle.samples import cloudlet, level, slab, tilted_plane
from tests.oracle.surfaces import tangent
from tests.oracle.vectors import along, unit
from tests.oracle.weights import WEIGHTS

TILTED = unit([1.0, -2.0, 3.0])


@pytest.mark.parametrize("weight", WEIGHTS)
@pytest.mark.parametrize("kind", ["surfel", "covariance"])
def test_plane_has_minus_its_normal(weight: str, kind: str) -> None:
    points, normals = tilted_plane(TILTED, [0.3, 0.1, -0.4], count=20)
    x = along([0.31, 0.12, -0.37], TILTED, 0.1)
    gradient = tangent_gradient(x, points, normals, 1.5, weight, kind)
    # The points themselves are rounded, by less than 1e-15 across the plane.
    assert gradient == pytest.approx([-c for c in TILTED], abs=1e-14)


def test_one_surfel_whatever_the_distance() -> None:
    for x in ([0.2, 0.1, 0.4], [3.0, 40.0, -200.0]):
        assert tangent_gradient(x, [[0.0, 0.0, 0.0]], [[0.6, 0.0, 0.8]], 0.5) == [-0.6, 0.0, -0.8]


@pytest.mark.parametrize("s", [0.3, 0.5, math.sqrt(0.5)])
def test_thick_sheet_loses_its_slope(s: float) -> None:
    # Two dense layers at ±s with equal normals: ∇f = -(1 - 2 s²/h²) n in the middle, 0 at s = h/√2.
    points, normals = slab(7, 0.6, s)
    gradient = tangent_gradient([0.0, 0.0, 0.0], points, [[0.0, 0.0, 1.0] for _ in normals], 1.0)
    assert gradient == pytest.approx([0.0, 0.0, -(1 - 2 * s * s)], abs=1e-14)


@pytest.mark.parametrize("weight", WEIGHTS)
@pytest.mark.parametrize("kind", NORMALS)
def test_coarse_differences_of_floats_agree(weight: str, kind: str) -> None:
    points, normals = cloudlet()
    x, step = [0.13, 0.21, 0.11], 1e-5
    gradient = tangent_gradient(x, points, normals, 0.9, weight, kind)
    assert gradient is not None
    for k in range(3):
        ahead, behind = ([c + s * step * (i == k) for i, c in enumerate(x)] for s in (1, -1))
        high, low = (tangent(y, points, normals, 0.9, weight, kind) for y in (ahead, behind))
        assert high is not None and low is not None
        assert gradient[k] == pytest.approx((high - low) / (2 * step), abs=1e-6)


def test_closed_form_for_surfels() -> None:
    # ∇f = (2/h²)Σθ_N(<n_i, τ>/|m| + <n, b_i>) b_i - n with b_i = q_i - c and τ = c - f n, in 50 digits.
    points, normals = cloudlet()
    x, h = [0.13, 0.21, 0.11], mpmath.mpf("0.75")
    with mpmath.workdps(50):
        q = [[mpmath.mpf(a) - b for a, b in zip(p, x, strict=True)] for p in points]
        weights = [mpmath.exp(-sum(c * c for c in v) / h**2) for v in q]
        shares = [w / sum(weights) for w in weights]
        c, m = ([sum(w * v[k] for w, v in zip(shares, vs, strict=True)) for k in range(3)] for vs in (q, normals))
        length = mpmath.sqrt(sum(v * v for v in m))
        n = [v / length for v in m]
        f = sum(a * b for a, b in zip(n, c, strict=True))
        tau = [a - f * b for a, b in zip(c, n, strict=True)]
        total = [-v for v in n]
        for w, v, normal in zip(shares, q, normals, strict=True):
            b = [a - o for a, o in zip(v, c, strict=True)]
            factor = sum(a * t for a, t in zip(normal, tau, strict=True)) / length
            factor += sum(a * t for a, t in zip(n, b, strict=True))
            total = [t + 2 / h**2 * w * factor * a for t, a in zip(total, b, strict=True)]
        expected = [float(t) for t in total]
    assert tangent_gradient(x, points, normals, 0.75) == pytest.approx(expected, rel=1e-15)


def test_bare_points_keep_the_side_they_are_given() -> None:
    points, normals = cloudlet()
    x = [0.13, 0.21, 0.11]
    up = tangent_gradient(x, points, normals, 0.9, kind="covariance")
    bare = tangent_gradient(x, points, None, 0.9, kind="covariance", like=[0.0, 0.0, 1.0])
    down = tangent_gradient(x, points, None, 0.9, kind="covariance", like=[0.0, 0.0, -1.0])
    assert up is not None and bare == up and down == [-c for c in up]


def test_undefined_normals_have_no_gradient() -> None:
    points, normals = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]], [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]
    assert tangent_gradient([0.0, 0.0, 0.0], points, normals, 1.0) is None
    assert exact_tangent([0.0, 0.0, 9.0], points, normals, 1.0, "hat") is None
    assert tangent_gradient([0.0, 0.5, 0.0], points, None, 1.0, kind="covariance") is None


def test_weights_that_no_float_can_hold() -> None:
    points, normals = level(2, 1.0)
    assert abs(exact_tangent([0.3, 0.2, 1e6], points, normals, 1.0) + 1000000) < 1e-40


def test_arrays_do_as_well_as_lists() -> None:
    points, normals = cloudlet()
    x, arrays = [0.13, 0.21, 0.11], (np.array(points), np.array(normals))
    assert tangent_gradient(np.array(x), *arrays, 0.9) == tangent_gradient(x, points, normals, 0.9)
