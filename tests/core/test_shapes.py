"""Exact solids against closed forms and against marching along the rays."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from jaart.core.errors import SettingsError
from jaart.core.shapes import Box, Cylinder, Ellipsoid, Solid, Sphere, Torus, first_hit

SPHERE = Sphere((0.7, 0.7, 0.7), 0.25)
BOX = Box((0.3, 0.5, 0.4), (0.2, 0.4, 0.3))


def one(solids: Solid | list[Solid], origin: object, direction: object) -> tuple[float, list[float]]:
    solids = solids if isinstance(solids, list) else [solids]
    t, normal = first_hit(solids, np.array([origin], float), np.array([direction], float))
    return float(t[0]), normal[0].tolist()


def test_containment_is_closed() -> None:
    sphere, box = Sphere((1, 2, 3), 2), Box((1, 2, 3), (2, 4, 6))
    points = np.array([[1, 2, 3], [3, 2, 3], [2.999, 2, 3], [1, 2, 1], [1, 2, 0.999]])
    assert sphere.contains(points).tolist() == [True, True, True, True, False]
    assert box.contains([[1, 2, 3], [2, 2, 3], [2.001, 2, 3], [1, 2, 0], [1, 3.999, 5.999]]).tolist() == [
        True, True, False, True, True]


def test_scaling() -> None:
    assert Sphere((1, 2, 3), 0.5).scaled(4) == Sphere((4, 8, 12), 2)
    assert Box((1, 2, 3), (0.5, 1, 2)).scaled(4) == Box((4, 8, 12), (2, 4, 8))


@pytest.mark.parametrize("make", [
    lambda: Sphere((0, 0, 0), 0), lambda: Sphere((0, 0, 0), -1), lambda: Sphere((0, 0, 0), math.nan),
    lambda: Sphere((0, math.inf, 0), 1), lambda: Sphere((0, 0), 1), lambda: Box((0, 0, 0), (1, 0, 1)),
    lambda: Box((0, 0, 0), (1, 1, -1)), lambda: Box((math.nan, 0, 0), (1, 1, 1))])
def test_impossible_solids(make) -> None:
    with pytest.raises(SettingsError, match="expected"):
        make()


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("zero", [0.0, -0.0])
def test_rays_along_an_axis(axis: int, sign: float, zero: float) -> None:
    direction = [zero] * 3
    direction[axis] = sign
    for solid, half in ((Sphere((1, 2, 3), 2), [2, 2, 2]), (Box((1, 2, 3), (2, 4, 6)), [1, 2, 3])):
        outward = [0.0] * 3
        outward[axis] = -sign
        assert one(solid, np.array(solid.centre) - 10 * np.array(direction), direction) == (10 - half[axis], outward)
        outward[axis] = sign
        assert one(solid, solid.centre, direction) == (half[axis], outward)
        assert math.isnan(one(solid, np.array(solid.centre) + 10 * np.array(direction), direction)[0])
        assert math.isnan(one(solid, np.array(solid.centre) + 7 * np.roll([1, 0, 0], axis + 1), direction)[0])


def test_the_axis_that_decides_gives_a_boxs_normal() -> None:
    box = Box((0, 0, 0), (2, 2, 2))
    direction = np.array([1, 0.5, 0.25])
    assert one(box, [-3, 0, 0], direction) == (2, [-1, 0, 0])
    assert one(box, [-3, -1.25, 0], direction) == (2, [-1, 0, 0])
    assert one(box, [-2, -2, 0], direction) == (2, [0, -1, 0])
    assert one(box, [0, 0, 0], direction) == (1, [1, 0, 0])
    assert math.isnan(one(box, [-2, -2.6, 0], direction)[0])


def test_rays_through_edges_and_corners() -> None:
    box = Box((0, 0, 0), (2, 2, 2))
    t, normal = one(box, [-3, -3, 0], [1, 1, 0])
    assert t == 2 and normal in ([-1, 0, 0], [0, -1, 0])
    t, normal = one(box, [-3, -3, -3], [1, 1, 1])
    assert t == 2 and sum(np.abs(normal)) == 1
    assert one(box, [-3, 3, 0], [1, -1, 0])[0] == 2
    assert one(box, [-3, 1, 0], [1, 0, 0])[0] == 2  # in the plane of a face: it touches


def test_a_ray_on_the_surface_goes_to_the_other_side() -> None:
    box = Box((0, 0, 0), (2, 2, 2))
    assert one(box, [-1, 0, 0], [1, 0, 0]) == (2, [1, 0, 0])
    assert math.isnan(one(box, [1, 0, 0], [1, 0, 0])[0])
    assert one(Sphere((0, 0, 0), 1), [-1, 0, 0], [1, 0, 0]) == (2, [1, 0, 0])
    assert math.isnan(one(Sphere((0, 0, 0), 1), [1, 0, 0], [1, 0, 0])[0])


def test_a_sphere_from_far_away() -> None:
    sphere = Sphere((0, 0, 0), 1)
    for far in (1e3, 1e6, 1e8):
        for aside in (0.0, 0.6, 1 - 1e-9):
            t, normal = one(sphere, [-far, aside, 0], [1, 0, 0])
            depth = math.sqrt((1 - aside) * (1 + aside))
            assert t == pytest.approx(far - depth, abs=2e-16 * far)
            assert normal == pytest.approx([-depth, aside, 0], abs=1e-15)


def test_directions_need_no_unit_length() -> None:
    assert one(SPHERE, [-1, 0.7, 0.7], [4, 0, 0])[0] == pytest.approx(1.45 / 4, rel=1e-15)
    assert one(BOX, [-1, 0.5, 0.4], [4, 0, 0])[0] == pytest.approx(1.2 / 4, rel=1e-15)


@pytest.mark.parametrize("bad", [[math.nan, 0, 0], [0, 0, 0], [math.inf, 0, 0], [0, -math.inf, 1]])
def test_rays_that_are_none_meet_nothing(bad: list[float]) -> None:
    middle = (0.7, 0.7, 0.7)
    for solid in (SPHERE, BOX, Ellipsoid(middle, (1, 2, 3)), Cylinder(middle, "y", 1, 1), Torus(middle, "x", 2, 1)):
        assert math.isnan(one(solid, [0.7, 0.7, 0.7], bad)[0])
        assert np.isnan(one(solid, [0.7, 0.7, 0.7], bad)[1]).all()
    for origin in (bad[:1] * 3, [bad[0], 0.5, 0.4]):
        if not all(map(math.isfinite, origin)):
            assert math.isnan(one([SPHERE, BOX], origin, [1, 0, 0])[0])


def test_no_rays_and_no_solids() -> None:
    t, normal = first_hit([SPHERE], np.empty((0, 3)), np.empty((0, 3)))
    assert t.shape == (0,) and normal.shape == (0, 3)
    assert math.isnan(one([], [0, 0, 0], [1, 0, 0])[0])


def test_a_union_has_no_surface_inside() -> None:
    sphere, box = Sphere((0, 0, 0), 1), Box((1, 0, 0), (2, 1, 1))
    assert one([sphere, box], [-0.5, 0, 0], [1, 0, 0]) == (2.5, [1, 0, 0])
    assert one([box, sphere], [1.5, 0, 0], [-1, 0, 0]) == (2.5, [-1, 0, 0])
    assert one([box, sphere], [5, 0, 0], [-1, 0, 0]) == (3, [1, 0, 0])
    chain = [Sphere((i, 0, 0), 0.75) for i in (3, 1, 2, 0)]
    assert one(chain, [0, 0, 0], [1, 0, 0]) == (3.75, [1, 0, 0])


def test_faces_that_boxes_share_are_no_surface() -> None:
    left, right = Box((0.3, 0.5, 0.5), (0.2, 1, 1)), Box((0.45, 0.5, 0.5), (0.1, 1, 1))
    for origin in (0.25, 0.4, 0.4 - 1e-9):
        for order in ([left, right], [right, left]):
            t, normal = one(order, [origin, 0.5, 0.5], [1, 0, 0])
            assert t == pytest.approx(0.5 - origin, abs=1e-15) and normal == [1, 0, 0]


unit = st.floats(-1, 1, allow_subnormal=False)
place = st.tuples(unit, unit, unit)
axes = st.one_of(st.sampled_from("xyz"), place.filter(lambda axis: math.hypot(*axis) > 0.1))
solids = st.lists(st.one_of(
    st.builds(Sphere, place, st.floats(0.05, 0.8)),
    st.builds(Box, place, st.tuples(*[st.floats(0.05, 1.2)] * 3)),
    st.builds(Ellipsoid, place, st.tuples(*[st.floats(0.05, 0.8)] * 3)),
    st.builds(Cylinder, place, axes, st.floats(0.05, 0.8), st.floats(0.05, 1.2)),
    st.builds(Torus, place, axes, st.floats(0.2, 0.8), st.floats(0.05, 0.19))), min_size=1, max_size=4)


@given(solids, st.tuples(*[st.floats(-2, 2, allow_subnormal=False)] * 3), place)
def test_the_first_hit_is_where_containment_changes(found: list[Solid], origin, direction) -> None:
    length = math.hypot(*direction)
    assume(length > 0.1)
    along = np.array(direction) / length

    def inside(t: np.ndarray) -> np.ndarray:
        points = np.array(origin) + t[:, None] * along
        return np.logical_or.reduce([solid.contains(points) for solid in found])

    t, normal = one(found, origin, along)
    steps = np.linspace(1e-9, 8, 4001)
    changes = np.flatnonzero(np.diff(inside(steps)))
    if len(changes):
        assert t <= steps[changes[0] + 1] + 1e-9
    if not math.isnan(t):
        assert not inside(np.array([t - 1e-6, t + 1e-6])).all()  # no surface inside the union
        before = inside(np.linspace(0, t, 500)[1:-1])
        assert before.all() or not before.any()
        assert np.linalg.norm(normal) == pytest.approx(1, abs=1e-14)
        assert np.dot(normal, along) * (1 if before.all() else -1) > -1e-7


@given(place, st.floats(0.1, 1), place, place)
def test_hits_lie_on_the_sphere(centre, radius, origin, direction) -> None:
    assume(math.hypot(*direction) > 0.1)
    t, normal = one(Sphere(centre, radius), origin, direction)
    if not math.isnan(t):
        point = np.array(origin) + t * np.array(direction)
        assert np.linalg.norm(point - centre) == pytest.approx(radius, abs=1e-13)
        assert point - centre == pytest.approx(radius * np.array(normal), abs=1e-13)
