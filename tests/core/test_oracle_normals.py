"""The oracle's normals, on planes, lines and clouds whose eigenvectors are known."""

from __future__ import annotations

import math
import random

import mpmath
import numpy as np
import pytest

from tests import naive
from tests.oracle.gradients import normal_and_offset
from tests.oracle.normals import NORMALS, covariance, covariance_at_x, offset, surfel
from tests.oracle.samples import cloudlet, level, tilted_plane
from tests.oracle.vectors import along, dot, unit
from tests.oracle.weights import WEIGHTS

TILTED = unit([1.0, -2.0, 3.0])


@pytest.mark.parametrize("kind", NORMALS)
@pytest.mark.parametrize("weight", WEIGHTS)
def test_plane_from_both_sides(kind: str, weight: str) -> None:
    points, normals = tilted_plane(TILTED, [0.3, 0.1, -0.4])
    # About x, an off-centre x tilts the normal, but for those in the plane.
    for height in (0.0,) if kind == "covariance_at_x" else (-0.3, 0.0, 0.2):
        found = NORMALS[kind](along([0.3, 0.1, -0.4], TILTED, height), points, normals, 1.5, weight)
        assert found.vector == pytest.approx(TILTED, abs=2e-15)


@pytest.mark.parametrize("kind", NORMALS)
@pytest.mark.parametrize("x", [[0.1, 0.2, 0.1], [0.5, -0.3, 0.4], [0.2, 0.2, 12.0], [3.0, -40.0, 9.0]])
def test_fifty_digits_agree(kind: str, x: list[float]) -> None:
    points, normals = cloudlet()
    exact = normal_and_offset(x, points, normals, 0.8, kind=kind)
    found = NORMALS[kind](x, points, normals, 0.8)
    if exact is None:
        assert found.vector is None
    else:
        gap = found.gap or 1.0
        assert found.vector == pytest.approx([float(c) for c in exact[0]], abs=1e-14 / gap)
        assert offset(x, points, 0.8) == pytest.approx([float(c) for c in exact[1]], abs=1e-13, rel=1e-14)


def test_the_older_oracle_agrees() -> None:
    points, normals = cloudlet()
    cloud, x = naive.Cloud(points, normals, 0.8), [0.2, -0.1, 0.3]
    assert surfel(x, points, normals, 0.8).vector == pytest.approx(cloud.normal(x), abs=1e-14)
    c = offset(x, points, 0.8)
    assert c == pytest.approx([a - o for a, o in zip(cloud.barycentre(x), x, strict=True)], abs=1e-14)


def test_eigenvalues_of_a_dense_plane() -> None:
    # The spread of a Gaussian within the plane is h²/2; about x, its height's square is added across.
    points, normals = level(12, 0.5)
    about_a = covariance([0.0, 0.0, 0.3], points, normals, 1.0)
    about_x = covariance_at_x([0.0, 0.0, 0.3], points, normals, 1.0)
    assert about_a.eigenvalues == pytest.approx((0.0, 0.5, 0.5), abs=1e-14)
    assert about_x.eigenvalues == pytest.approx((0.09, 0.5, 0.5), abs=1e-14)
    assert about_x.gap == pytest.approx((0.5 - 0.09) / 0.5, rel=1e-13)


def test_about_x_the_normal_tips_over_beyond_h_by_root_two() -> None:
    points, normals = level(12, 0.5)
    below, above = (covariance_at_x([0.0, 0.0, z], points, normals, 1.0) for z in (0.70, 0.71))
    assert below.vector == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
    # Above, two directions within the plane are equally the least.
    assert above.vector is None
    assert covariance([0.0, 0.0, 0.9], points, normals, 1.0).vector == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)


@pytest.mark.parametrize("kind", ["covariance", "covariance_at_x"])
def test_points_of_a_line_have_no_normal(kind: str) -> None:
    points = [[0.1 * i, 0.0, 0.0] for i in range(10)]
    assert NORMALS[kind]([0.45, 0.0, 0.0], points, None, 0.5).vector is None


@pytest.mark.parametrize("kind", ["covariance", "covariance_at_x"])
def test_one_point_many_times_has_no_normal(kind: str) -> None:
    found = NORMALS[kind]([1.0, 2.0, 3.0], [[1.0, 2.0, 3.0]] * 5, None, 0.5)
    assert found.vector is None and found.gap == 0.0


def test_opposite_surfels_have_no_average() -> None:
    points, normals = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]], [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]
    found = surfel([0.0, 0.0, 0.0], points, normals, 1.0)
    assert found.vector is None and found.length == 0.0
    assert surfel([1e-6, 0.0, 0.0], points, normals, 1.0).vector == [0.0, 0.0, 1.0]


@pytest.mark.parametrize(("gap", "defined"), [(5e-9, False), (2e-8, True)])
@pytest.mark.parametrize("kind", ["covariance", "covariance_at_x"])
def test_where_an_eigenvector_ends(kind: str, gap: float, defined: bool) -> None:
    # Equal weights and points on the axes: the eigenvalues are in the ratio of 1 to 1/4 to 1/4 - gap.
    ends = [(1.0, 0.0, 0.0), (0.0, 0.5, 0.0), (0.0, 0.0, math.sqrt(0.25 - gap))]
    points = [[s * c for c in end] for end in ends for s in (1, -1)]
    found = NORMALS[kind]([0.0, 0.0, 0.0], points, None, 1e9)
    assert found.gap == pytest.approx(gap, abs=1e-14)
    assert (found.vector is not None) == defined


@pytest.mark.parametrize(("aside", "defined"), [(2.5e-9, False), (1e-8, True)])
def test_where_an_average_ends(aside: float, defined: bool) -> None:
    # Opposite normals at ±1 leave a share of tanh(2·aside/h²).
    points, normals = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]], [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]
    found = surfel([aside, 0.0, 0.0], points, normals, 1.0)
    assert found.length == pytest.approx(math.tanh(2 * aside), rel=1e-6)
    assert (found.vector is not None) == defined


@pytest.mark.parametrize("kind", NORMALS)
def test_duplicates_change_nothing(kind: str) -> None:
    points, normals = cloudlet()
    once = NORMALS[kind]([0.1, 0.2, 0.3], points, normals, 0.8).vector
    twice = NORMALS[kind]([0.1, 0.2, 0.3], points * 2, normals * 2, 0.8).vector
    assert once is not None and twice == pytest.approx(once, abs=1e-15)


@pytest.mark.parametrize("kind", ["covariance", "covariance_at_x"])
def test_orientation_follows_the_surfels(kind: str) -> None:
    points, normals = cloudlet()
    down = [[-c for c in n] for n in normals]
    up_side = NORMALS[kind]([0.1, 0.2, 0.1], points, normals, 0.8).vector
    down_side = NORMALS[kind]([0.1, 0.2, 0.1], points, down, 0.8).vector
    assert up_side is not None and down_side == [-c for c in up_side] and up_side[2] > 0
    bare = NORMALS[kind]([0.1, 0.2, 0.1], points, None, 0.8).vector
    assert bare is not None and abs(dot(bare, up_side)) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize("kind", NORMALS)
@pytest.mark.parametrize("weight", ["hat", "squared_hat", "wendland"])
def test_nothing_in_reach(kind: str, weight: str) -> None:
    points, normals = cloudlet()
    assert NORMALS[kind]([0.0, 0.0, 50.0], points, normals, 0.8, weight).vector is None
    assert offset([0.0, 0.0, 50.0], points, 0.8, weight) is None


def test_far_away_the_barycentre_is_the_nearest_point() -> None:
    points, normals = cloudlet()
    x = [0.0, 0.0, 1e6]
    top = max(range(len(points)), key=lambda i: points[i][2])
    c = offset(x, points, 0.8)
    assert c is not None and along(x, c, 1.0) == pytest.approx(points[top], abs=1e-9)
    assert surfel(x, points, normals, 0.8).vector == pytest.approx(normals[top], abs=1e-15)


def test_root_and_centring_theorem() -> None:
    # Where f about a is 0, the normal about x is the same, for c is then orthogonal to it.
    rng = random.Random(5)
    points, normals = tilted_plane(TILTED, [0.0, 0.0, 0.0])
    points = [along(p, TILTED, rng.gauss(0, 0.05)) for p in points]
    low, high = mpmath.mpf(-1), mpmath.mpf(1)
    with mpmath.workdps(50):
        for _ in range(100):
            middle = (low + high) / 2
            found = normal_and_offset([c * middle for c in TILTED], points, normals, 0.8, kind="covariance")
            assert found is not None
            ahead = mpmath.fsum(a * b for a, b in zip(*found, strict=True)) > 0
            low, high = (middle, high) if ahead else (low, middle)
    x = [c * float(low) for c in TILTED]
    a, b = (kind(x, points, normals, 0.8).vector for kind in (covariance, covariance_at_x))
    assert a is not None and b == pytest.approx(a, abs=1e-13)
    assert math.hypot(*a) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize("kind", NORMALS)
def test_no_points_at_all(kind: str) -> None:
    assert NORMALS[kind]([0.0, 0.0, 0.0], [], [], 1.0).vector is None
    assert surfel([0.0, 0.0, 0.0], [[0.0, 0.0, 1.0]], None, 1.0).vector is None


@pytest.mark.parametrize("kind", NORMALS)
def test_arrays_do_as_well_as_lists(kind: str) -> None:
    points, normals = cloudlet()
    lists = NORMALS[kind]([0.1, 0.2, 0.3], points, normals, 0.8)
    assert NORMALS[kind](np.array([0.1, 0.2, 0.3]), np.array(points), np.array(normals), 0.8) == lists
