"""The oracle's projection onto a point set surface."""

from __future__ import annotations

import random

import mpmath
import pytest

from tests.oracle.projection import plane_energy, plane_gradient, project, reference_plane
from tests.oracle.samples import cloudlet, rings, tilted_plane
from tests.oracle.vectors import along, dot, frame, unit
from tests.oracle.weights import WEIGHTS

TILTED, CENTRE = unit([1.0, -2.0, 3.0]), [0.3, 0.1, -0.4]


@pytest.mark.parametrize("weight", WEIGHTS)
@pytest.mark.parametrize("kind", ["surfel", "covariance"])
@pytest.mark.parametrize("height", [-0.6, 0.0, 0.4])
def test_plane_gives_the_distance_and_the_foot(weight: str, kind: str, height: float) -> None:
    points, normals = tilted_plane(TILTED, CENTRE, count=40)
    found = project(along(CENTRE, TILTED, height), points, normals, 1.5, 2, weight, kind)
    assert found is not None
    assert found.value == pytest.approx(-height, abs=1e-13)
    assert found.point == pytest.approx(CENTRE, abs=1e-13)
    assert found.n == pytest.approx(TILTED, abs=1e-13)


@pytest.mark.parametrize("degree", [0, 2, 4])
def test_sphere_projects_along_its_radius(degree: int) -> None:
    points, normals = rings(1.0, 60, each=12)
    values = []
    for height in (0.95, 1.0, 1.05):
        found = project([0.0, 0.0, height], points, normals, 0.35, degree)
        assert found is not None
        assert found.n == pytest.approx([0.0, 0.0, 1.0], abs=1e-9)
        assert found.point[:2] == pytest.approx([0.0, 0.0], abs=1e-9)
        values.append(found.point[2])
    # Points of one normal line share the plane, so they go to one place: the nearer to 1 the higher the degree.
    assert values == pytest.approx([values[1]] * 3, abs=1e-9)
    assert abs(1 - values[1]) < {0: 0.07, 2: 0.01, 4: 0.002}[degree]


@pytest.mark.parametrize("weight", ["gaussian", "squared_hat", "wendland"])
@pytest.mark.parametrize("r", [[0.1, 0.2, 0.2], [-0.3, 0.1, -0.1]])
def test_plane_is_a_minimum(weight: str, r: list[float]) -> None:
    points, normals = cloudlet(40)
    h = 1.2
    found = project(r, points, normals, h, 2, weight)
    assert found is not None
    rng = random.Random(1)
    least = plane_energy(r, found.t, found.n, points, h, weight)
    by_t, by_n = plane_gradient(r, found.t, found.n, points, h, weight)
    assert max(abs(g) for g in (by_t, *by_n)) < 1e-11
    for _ in range(20):
        n = unit([c + rng.gauss(0, 1e-3) for c in found.n])
        assert plane_energy(r, found.t + rng.gauss(0, 1e-3), n, points, h, weight) > least


@pytest.mark.parametrize("weight", WEIGHTS)
def test_gradient_is_that_of_the_energy(weight: str) -> None:
    points, _ = cloudlet(12)
    r, t, n, h, step = [0.1, 0.2, 0.3], -0.2, unit([0.1, 0.05, 1.0]), 1.2, 1e-5
    by_t, by_n = plane_gradient(r, t, n, points, h, weight)
    ahead, behind = (plane_energy(r, t + s * step, n, points, h, weight) for s in (1, -1))
    assert by_t == pytest.approx((ahead - behind) / (2 * step), abs=1e-7)
    assert dot(by_n, n) == pytest.approx(0.0, abs=1e-14)
    for u in frame(n):
        ahead, behind = (plane_energy(r, t, unit(along(n, u, s * step)), points, h, weight) for s in (1, -1))
        assert dot(by_n, u) == pytest.approx((ahead - behind) / (2 * step), abs=1e-7)


def test_plane_of_fifty_digits() -> None:
    # Two unknowns by symmetry, t and the tilt about y; findroot on the derivatives by mpmath itself.
    points = [[x, y, 0.2 * x * x + 0.1 * x + 0.05 * y * y] for x in (-1.0, -0.3, 0.4, 1.1) for y in (-0.8, 0.0, 0.8)]
    r, h = [0.1, 0.0, 0.3], 1.0
    with mpmath.workdps(50):
        def energy(t: mpmath.mpf, a: mpmath.mpf) -> mpmath.mpf:
            n = (mpmath.sin(a), 0, mpmath.cos(a))
            b = [[c - o - t * m for c, o, m in zip(p, r, n, strict=True)] for p in points]
            heights = [sum(m * c for m, c in zip(n, v, strict=True)) for v in b]
            return mpmath.fsum(s * s * mpmath.exp(-sum(c * c for c in v)) for s, v in zip(heights, b, strict=True))

        step = mpmath.mpf(10) ** -18
        t, a = mpmath.findroot(lambda t, a: [(energy(t + step, a) - energy(t - step, a)) / (2 * step),
                                             (energy(t, a + step) - energy(t, a - step)) / (2 * step)],
                               (-0.2, 0.0), tol=1e-30)
    found = project(r, points, [[0.0, 0.0, 1.0]] * len(points), h, 2)
    assert found is not None
    assert found.t == pytest.approx(float(t), abs=1e-13)
    assert found.n == pytest.approx([float(mpmath.sin(a)), 0.0, float(mpmath.cos(a))], abs=1e-13)


def test_duplicates_and_scale_change_nothing() -> None:
    points, normals = cloudlet(40)
    r = [0.1, 0.2, 0.2]
    once, twice = project(r, points, normals, 1.2), project(r, points * 2, normals * 2, 1.2)
    eightfold = project([8 * c for c in r], [[8 * c for c in p] for p in points], normals, 9.6)
    assert once is not None and twice is not None and eightfold is not None
    assert twice.value == pytest.approx(once.value, abs=1e-12)
    assert eightfold.value == pytest.approx(8 * once.value, abs=1e-11)


def test_undefined_far_off_and_without_a_plane() -> None:
    points, normals = cloudlet()
    assert project([0.0, 0.0, 50.0], points, normals, 0.8, 2, "wendland") is None
    assert project([0.5, 0.0, 0.0], [[0.1 * i, 0.0, 0.0] for i in range(10)], None, 0.5) is None
    # Two sheets and a start half-way: E falls away from it on both sides beyond h/2.
    sheets = [[0.5 * i, 0.5 * j, z] for i in range(-4, 5) for j in range(-4, 5) for z in (-2.0, 2.0)]
    assert reference_plane([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], 1.1, sheets, 1.0) is None
