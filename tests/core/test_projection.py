"""The plane of a step: exact numbers, and what holds where the three points are collinear."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core.projection import plane, section
from jaart.core.records import Curves, Trace
from jaart.core.settings import Settings
from jaart.core.surfels import Surfels

NOTHING = np.empty(0)


def one_step(origin, direction, t, barycentre, normal):
    """A trace of one step from origin + t·direction with the given sums."""
    origin, direction, a, n = (np.asarray(v, float) for v in (origin, direction, barycentre, normal))
    x = origin + t * direction
    energy = n @ (a - x) / (n @ direction)
    return Trace(
        origin=origin, direction=direction, t=np.nan, point=np.full(3, np.nan), normal=np.full(3, np.nan), status="cap",
        t_query=np.array([t]), query=x[None], barycentre=a[None], step_normal=n[None],
        t_next=np.array([t + energy]), next_point=(x + energy * direction)[None], energy=np.array([energy]),
        off_centre=np.array([np.linalg.norm(a - x)]), weight_sum=np.ones(1), start=np.zeros(1, np.int32),
        step_cell=np.floor(x)[None].astype(np.int32), outcome=("cap",), neighbours=(np.empty(0, np.int64),),
        weights=(NOTHING,), cells=np.empty((0, 3), np.int32), borders=NOTHING, with_surfel=np.empty(0, bool),
        surfels=Surfels(np.empty((0, 3), np.int32), np.empty((0, 3)), np.empty((0, 3))), curves=Curves(*[NOTHING] * 5),
        settings=Settings(), balls=np.empty((0, 4)),
        low=np.zeros(3), high=np.full(3, 4.0))


def test_exact_numbers():
    step = one_step((0, 1, 1), (1, 0, 0), 2.0, (2.5, 1.3, 1.4), (-1, 0, 0))
    flat = plane(step, 0)
    assert flat.through == "barycentre"
    np.testing.assert_allclose(flat.v, (0, 0.6, 0.8), atol=1e-15)
    np.testing.assert_allclose(flat.normal, (0, -0.8, 0.6), atol=1e-15)
    np.testing.assert_allclose(flat.coordinates(step.query[0]), (2, 0), atol=1e-15)
    np.testing.assert_allclose(flat.coordinates(step.barycentre[0]), (2.5, 0.5), atol=1e-15)
    np.testing.assert_allclose(flat.coordinates(step.next_point[0]), (2.5, 0), atol=1e-15)
    np.testing.assert_allclose(flat.heights(np.array([[9.0, 1.0, 2.0], [9.0, 0.0, 1.0]])), (0.6, 0.8), atol=1e-15)


def test_the_normal_is_that_of_the_source_up_to_its_sign():
    step = one_step((0.2, -1, 0.3), np.array((1, 2, 2)) / 3, 1.5, (0.9, 0.4, 1.1), np.array((2, -1, 2)) / 3)
    source = np.cross(step.next_point[0] - step.query[0], step.barycentre[0] - step.query[0])
    source /= np.linalg.norm(source)
    assert abs(plane(step, 0).normal @ source) == pytest.approx(1, abs=1e-12)


def test_the_normal_of_the_surface_does_not_point_down():
    for sign in (1.0, -1.0):
        flat = plane(one_step((0, 1, 1), (1, 0, 0), 2.0, (2.5, 1.3, 1.4), (-0.8, 0, sign * 0.6)), 0)
        assert flat.components(np.array((-0.8, 0, sign * 0.6)))[1] > 0


def test_a_collinear_barycentre_leaves_the_plane_to_the_normal():
    flat = plane(one_step((0, 1, 1), (1, 0, 0), 2.0, (2.5, 1, 1), (-0.6, 0.8, 0)), 0)
    assert flat.through == "normal"
    np.testing.assert_allclose(flat.v, (0, 1, 0), atol=1e-15)


def test_a_normal_along_the_ray_leaves_it_to_the_camera():
    step = one_step((0, 1, 1), (1, 0, 0), 2.0, (2.5, 1, 1), (-1, 0, 0))
    flat = plane(step, 0, camera_up=(0.5, 0, 2.0))
    assert flat.through == "up"
    np.testing.assert_allclose(flat.v, (0, 0, 1), atol=1e-15)


def test_a_camera_up_along_the_ray_gives_a_plane_all_the_same():
    flat = plane(one_step((0, 1, 1), (0, 0, 1), 2.0, (0, 1, 3.5), (0, 0, -1)), 0)
    assert np.linalg.norm(flat.v) == pytest.approx(1)
    assert flat.v @ flat.u == pytest.approx(0, abs=1e-15)


def test_undefined_sums_leave_it_to_the_camera():
    step = one_step((0, 1, 1), (1, 0, 0), 2.0, (np.nan,) * 3, (np.nan,) * 3)
    np.testing.assert_allclose(plane(step, 0).v, (0, 0, 1), atol=1e-15)


def test_section_through_the_middle_along_an_axis_is_a_unit_square():
    flat = plane(one_step((0, 1.5, 1.5), (1, 0, 0), 2.0, (2.5, 1.5, 1.9), (-1, 0, 0)), 0)
    corners = section(flat, (2, 1, 1))
    assert sorted(map(tuple, corners.round(12))) == [(2, -0.5), (2, 0.5), (3, -0.5), (3, 0.5)]


def test_section_in_a_face_is_the_face_and_beside_the_cell_nothing():
    flat = plane(one_step((0, 1, 1), (1, 0, 0), 2.0, (2.5, 1.0, 1.4), (-1, 0, 0)), 0)
    assert sorted(map(tuple, section(flat, (2, 1, 1)).round(12))) == [(2, 0), (2, 1), (3, 0), (3, 1)]
    assert len(section(flat, (2, 2, 1))) == 0


def test_section_across_a_diagonal_is_the_regular_hexagon():
    r = np.array((1.0, -1.0, 0.0)) / np.sqrt(2)
    flat = plane(one_step((0.5, 0.5, 0.5), r, 0.0, np.array((0.5, 0.5, 0.5)) + (0.1, 0.1, -0.2), -r), 0)
    hexagon = section(flat, (0, 0, 0))
    sides = np.linalg.norm(np.roll(hexagon, -1, axis=0) - hexagon, axis=1)
    np.testing.assert_allclose(sides, np.full(6, np.sqrt(0.5)), atol=1e-12)


numbers = st.floats(-1, 1).map(lambda v: round(v, 6))


@given(st.tuples(*[numbers] * 6))
def test_sections_are_convex_and_inside_their_cell(n):
    r = np.array(n[:3]) + (0, 0, 1.5)
    r /= np.linalg.norm(r)
    flat = plane(one_step((0.5, 0.5, 0.5), r, 0.1, np.array(n[3:]) + 0.5, -r), 0)
    polygon = section(flat, (0, 0, 0))
    assert len(polygon) >= 3
    back = flat.origin + polygon @ np.stack([flat.u, flat.v])
    assert (back > -1e-9).all()
    assert (back < 1 + 1e-9).all()
    ahead = np.roll(polygon, -1, axis=0) - polygon
    turn = ahead[:, 0] * np.roll(ahead, -1, axis=0)[:, 1] - ahead[:, 1] * np.roll(ahead, -1, axis=0)[:, 0]
    assert (turn > -1e-9).all()
