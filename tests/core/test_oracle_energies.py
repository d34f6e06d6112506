"""The oracle's energies, on planes and single surfels."""

from __future__ import annotations

import math

import pytest

from tests import naive
from tests.oracle import energies
from tests.oracle.samples import cloudlet, level, tilted_plane
from tests.oracle.vectors import along, unit

UP = [0.0, 0.0, 1.0]
ONE = [[0.0, 0.0, 0.0]]


def test_dense_plane() -> None:
    points, normals = level(12, 0.5)
    x = [0.0, 0.0, -0.3]
    assert energies.e_oc(x, points, 1.0) == pytest.approx(0.3, abs=1e-15)
    assert energies.e_angle(x, points, normals, 1.0) == pytest.approx(1.0, abs=1e-15)
    assert energies.e_ts(x, [0.6, 0.0, 0.8], points, normals, 1.0) == pytest.approx(0.375, abs=1e-15)
    # The mean square within the plane is h²/2 in each direction.
    assert energies.e_mahalanobis(x, points, normals, 1.0) == pytest.approx(0.09 + 0.25, abs=1e-14)
    assert energies.e_mahalanobis(x, points, normals, 1.0, c=0.5) == pytest.approx(0.09 + 0.5, abs=1e-14)


def test_tangent_step_leads_to_any_plane() -> None:
    n, centre, direction = unit([1.0, -2.0, 3.0]), [0.3, 0.1, -0.4], unit([0.2, 0.3, -1.0])
    points, normals = tilted_plane(n, centre)
    x = along(centre, direction, -0.7)
    assert energies.e_ts(x, direction, points, normals, 1.5) == pytest.approx(0.7, abs=1e-14)


def test_one_surfel_by_hand() -> None:
    x = [3.0, 0.0, 4.0]
    assert energies.e_mahalanobis(x, ONE, [UP], 9.0) == 16 + 0.25 * 9
    assert energies.e_oc(x, ONE, 9.0) == 5.0
    assert energies.e_angle(x, ONE, [UP], 9.0) == pytest.approx(0.8, abs=1e-16)
    assert energies.e_ts(x, [0.0, 0.0, -1.0], ONE, [UP], 9.0) == 4.0


def test_angle_at_the_barycentre_is_zero() -> None:
    assert energies.e_angle([0.0, 0.0, 0.0], ONE, [UP], 1.0) == 0.0


def test_step_along_the_plane() -> None:
    assert energies.e_ts([0.0, 0.0, 2.0], [1.0, 0.0, 0.0], ONE, [UP], 1.0) == -math.inf
    assert energies.e_ts([0.0, 0.0, -2.0], [1.0, 0.0, 0.0], ONE, [UP], 1.0) == math.inf
    assert energies.e_ts([2.0, 0.0, 0.0], [1.0, 0.0, 0.0], ONE, [UP], 1.0) is None


def test_emphasis() -> None:
    assert energies.emphasised(0.0, 0.3) == pytest.approx(0.3, abs=1e-16)
    assert energies.emphasised(0.5, 0.5) == 0.75
    assert energies.emphasised(0.0, 7.0) == energies.emphasised(0.0, -math.inf) == energies.emphasised(1.0, 0.2) == 1.0
    assert energies.emphasised(0.5, -0.5) == energies.emphasised(-0.5, 0.5) == 0.75
    assert energies.emphasised(None, 0.5) is energies.emphasised(0.5, None) is None


def test_the_older_oracle_agrees() -> None:
    points, normals = cloudlet()
    cloud, x, d = naive.Cloud(points, normals, 0.8), [0.2, -0.1, 0.3], unit([0.1, 0.2, -1.0])
    assert energies.e_oc(x, points, 0.8) == pytest.approx(cloud.off_centre(x), rel=1e-14)
    assert energies.e_ts(x, d, points, normals, 0.8) == pytest.approx(cloud.tangent_step(x, d), rel=1e-13)
    for c in (0.0, 0.25, 1.0):
        assert energies.e_mahalanobis(x, points, normals, 0.8, c) == pytest.approx(cloud.mahalanobis(x, c), rel=1e-13)


def test_factor_one_is_the_mean_square_distance() -> None:
    points, normals = cloudlet()
    turned = [normals[-1], *normals[:-1]]
    x = [0.2, -0.1, 0.3]
    assert energies.e_mahalanobis(x, points, normals, 0.8, 1.0) == pytest.approx(
        energies.e_mahalanobis(x, points, turned, 0.8, 1.0), rel=1e-14)


def test_nothing_in_reach() -> None:
    x, points, normals = [0.0, 0.0, 50.0], *cloudlet()
    assert energies.e_oc(x, points, 0.8, "hat") is energies.e_mahalanobis(x, points, normals, 0.8, weight="hat") is None
    assert energies.e_angle(x, points, normals, 0.8, "hat") is None
    assert energies.e_ts(x, UP, points, normals, 0.8, "hat") is None
    assert energies.e_mahalanobis(x, points, normals, 0.8) is not None
