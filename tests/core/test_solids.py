"""Torus, cylinder and ellipsoid: closed forms, grazing rays, rays from far away and from inside."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from numpy.typing import NDArray

from jaart.core.errors import SettingsError
from jaart.core.shapes import Box, Cylinder, Ellipsoid, Solid, Sphere, Torus, first_hit

Array = NDArray[np.float64]
AXIS = (2 / 7, 3 / 7, 6 / 7)
C = (0.3, -0.2, 0.1)
RING = Torus((0, 0, 0), "z", 2, 0.5)
EVERY = [Sphere(C, 0.7), Box(C, (0.5, 0.9, 1.3)), Ellipsoid(C, (0.3, 0.9, 0.6)), Cylinder(C, AXIS, 0.5, 1.2),
         Cylinder(C, "y", 0.9, 0.1), Torus(C, AXIS, 0.7, 0.2), Torus(C, "x", 0.5, 0.49), Torus(C, "z", 0.9, 1e-2)]


def one(solids: Solid | list[Solid], origin: object, direction: object) -> tuple[float, list[float]]:
    solids = solids if isinstance(solids, list) else [solids]
    t, normal = first_hit(solids, np.array([origin], float), np.array([direction], float))
    return float(t[0]), normal[0].tolist()


def rays(count: int, seed: int, far: float = 3.0) -> tuple[Array, Array]:
    """Rays from a sphere around C to points in a cube about C."""
    rng = np.random.default_rng(seed)
    origin = rng.normal(size=(count, 3))
    origin *= far / np.linalg.norm(origin, axis=1, keepdims=True)
    direction = rng.uniform(-0.9, 0.9, (count, 3)) - origin
    return origin + C, direction / np.linalg.norm(direction, axis=1, keepdims=True)


@pytest.mark.parametrize("solid", EVERY, ids=repr)
def test_ends_of_intervals_lie_on_the_surface_with_its_normals(solid: Solid) -> None:
    origin, direction = rays(20_000, 5)
    met = 0
    for span in solid.intervals(origin, direction):
        for t, normal, sign in zip((span.entry, span.exit), span.normals(), (-1, 1), strict=True):
            hit = np.isfinite(t)
            point, normal = origin[hit] + t[hit, None] * direction[hit], normal[hit]
            met += hit.sum()
            assert np.abs(solid.distance(point)).max(initial=0) < 4e-15
            assert np.abs(np.linalg.norm(normal, axis=1) - 1).max(initial=0) < 1e-14
            facing = (normal * direction[hit]).sum(axis=1) * sign
            assert facing.min(initial=0) > -1e-7
            step = 1e-5
            steep = facing > 0.02  # elsewhere a step of this size leaves the other side of a thin solid
            assert (solid.distance(point + step * normal)[steep] > 0).all()
            assert not solid.contains(point + step * normal)[steep].any()
            assert solid.contains(point - step * normal)[steep].all()
    assert met > 200


@pytest.mark.parametrize("solid", EVERY[2:], ids=repr)
def test_intervals_against_marching(solid: Solid) -> None:
    """What the intervals hold is what `holds` holds, at every step of a fine march."""
    origin, direction = rays(400, 6)
    steps = np.linspace(0, 6, 3001)
    spans = solid.intervals(origin, direction)
    for ray in range(len(origin)):
        held = solid.contains(origin[ray] + steps[:, None] * direction[ray])
        said = np.zeros(len(steps), bool)
        for span in spans:
            said |= (span.entry[ray] <= steps) & (steps <= span.exit[ray])
        assert np.array_equal(held, said)


@pytest.mark.parametrize("solid", EVERY, ids=repr)
@pytest.mark.parametrize("far", [1e3, 1e6])
def test_far_origins_lose_only_their_own_digits(solid: Solid, far: float) -> None:
    origin, direction = rays(2000, 7)
    moved = origin - far * direction
    near, at_near = first_hit([solid], moved + far * direction, direction)
    t, _ = first_hit([solid], moved, direction)
    # the nearer the surface to the ray's direction, the more a shift of it moves the crossing
    square = np.isfinite(t) & (np.abs((at_near * direction).sum(axis=1)) > 0.1)
    assert square.sum() > 10 and np.abs(t - near - far)[square].max() < 5e-15 * far
    assert np.isfinite(near[square]).all()


def test_a_torus_along_its_axis_and_through_its_hole() -> None:
    assert one(RING, [2, 0, 5], [0, 0, -1]) == (4.5, [0, 0, 1])
    t, normal = one(RING, [0, 1.7, -9], [0, 0, 3])
    assert t == pytest.approx((9 - 0.4) / 3, abs=1e-15) and normal == pytest.approx([0, -0.6, -0.8], abs=1e-14)
    assert math.isnan(one(RING, [0, 0, 5], [0, 0, -1])[0])
    assert math.isnan(one(RING, [1.2, 0.8, 5], [0, 0, -1])[0])


def test_a_ray_in_the_plane_of_a_torus_is_inside_twice() -> None:
    for start, expected, facing in ((-5, 2.5, -1), (-2, 0.5, 1), (0, 1.5, -1), (2, 0.5, 1)):
        assert one(RING, [start, 0, 0], [1, 0, 0]) == (pytest.approx(expected, abs=1e-14), [facing, 0, 0])
    first, second = RING.intervals(np.array([[-5.0, 0, 0]]), np.array([[1.0, 0, 0]]))
    found = [first.entry[0], first.exit[0], second.entry[0], second.exit[0]]
    assert found == pytest.approx([2.5, 3.5, 6.5, 7.5], abs=4e-15)


@pytest.mark.parametrize("gap", [1e-2, 1e-5, 1e-9, 1e-12])
def test_rays_that_graze_a_torus(gap: float) -> None:
    """Along y at the outer rim and over the top, just in and just out."""
    reach = 2.5 - gap
    t, _ = one(RING, [reach, -9, 0], [0, 1, 0])
    # chord of the outer circle, which in the ring's plane is exact
    assert 9 - t == pytest.approx(math.sqrt((2.5 - reach) * (2.5 + reach)), abs=1e-7 if gap < 1e-9 else 1e-11)
    assert math.isnan(one(RING, [2.5 + gap, -9, 0], [0, 1, 0])[0])
    t, _ = one(RING, [-9, 0, 0.5 - gap], [1, 0, 0])
    half = math.sqrt(gap * (1 - gap))
    assert 9 - t == pytest.approx(2 + half, abs=1e-7 if gap < 1e-9 else 1e-11)
    assert math.isnan(one(RING, [-9, 0, 0.5 + gap], [1, 0, 0])[0])


def test_rays_that_touch_the_inner_rim_and_cross_the_bitangent_plane() -> None:
    first, second = RING.intervals(np.array([[1.5, -9, 0]]), np.array([[0.0, 1, 0]]))
    assert first.entry[0] == pytest.approx(9 - 2, abs=1e-14)  # sqrt(2.5² - 1.5²)
    assert np.nanmax([first.exit[0], second.exit[0]]) == pytest.approx(9 + 2, abs=1e-14)
    # a plane that touches the tube twice cuts a torus in Villarceau's circles, of radius 2
    slope = math.asin(0.5 / 2)
    across, up = np.array([0.0, math.cos(slope), math.sin(slope)]), np.array([1.0, 0, 0])
    for angle in (0.3, 1.1, 2.0):
        point = 0.5 * up + 2 * (math.cos(angle) * up + math.sin(angle) * across)
        middle = np.array([point[0], point[1], 0]) * 2 / math.hypot(point[0], point[1])
        assert one(RING, middle, point - middle)[0] == pytest.approx(1, abs=1e-14)
        assert RING.distance(point[None])[0] == pytest.approx(0, abs=1e-15)


def test_a_cylinder_by_side_and_ends() -> None:
    pipe = Cylinder((0, 0, 0), "z", 1, 4)
    assert one(pipe, [0.5, 0.5, 9], [0, 0, -1]) == (7, [0, 0, 1])
    assert one(pipe, [-9, 0, 1], [1, 0, 0]) == (8, [-1, 0, 0])
    assert one(pipe, [0, 0, 1], [0, 2, 0]) == (0.5, [0, 1, 0])
    assert one(pipe, [0, 0, 0], [0, 0, 1]) == (2, [0, 0, 1])
    assert math.isnan(one(pipe, [1.001, 0, 9], [0, 0, -1])[0])
    assert math.isnan(one(pipe, [-9, 0, 2.001], [1, 0, 0])[0])
    t, normal = one(pipe, [-3, 0, 4], [1, 0, -0.9])
    assert t == pytest.approx(2 / 0.9) and normal == [0, 0, 1]
    t, normal = one(pipe, [-3, 0, 3], [1, 0, -0.9])
    assert (t, normal) == (pytest.approx(2), pytest.approx([-1, 0, 0]))


def test_an_ellipsoid_against_its_closed_form() -> None:
    egg = Ellipsoid((1, 2, 3), (0.5, 1, 2))
    assert one(egg, [1, 2, 9], [0, 0, -1]) == (4, [0, 0, 1])
    t, normal = one(egg, [-9, 2.6, 3], [1, 0, 0])
    expected = np.array([-0.4 / 0.25, 0.6, 0])
    assert t == pytest.approx(10 - 0.4, abs=1e-14)
    assert normal == pytest.approx(list(expected / np.linalg.norm(expected)), abs=1e-14)
    ball, same = Sphere(C, 0.7), Ellipsoid(C, (0.7, 0.7, 0.7))
    for a, b in zip(first_hit([ball], *rays(500, 8)), first_hit([same], *rays(500, 8)), strict=True):
        assert np.allclose(a, b, rtol=0, atol=1e-12, equal_nan=True)


def test_a_union_of_different_solids_has_no_surface_inside() -> None:
    ball, pipe = Sphere((2, 0, 0), 0.7), Cylinder((0, 0, 0), "x", 0.3, 5)
    for order in itertools.permutations([RING, ball, pipe]):
        assert one(list(order), [0, 0, 0], [1, 0, 0]) == (pytest.approx(2.7), pytest.approx([1, 0, 0]))
        assert one(list(order), [-9, 0, 0], [1, 0, 0]) == (6.5, [-1, 0, 0])
        assert one(list(order), [-2, 0, 0], [1, 0, 0]) == (pytest.approx(4.7), pytest.approx([1, 0, 0]))
        assert one(list(order), [0, 0, 9], [0, 0, -1]) == (pytest.approx(8.7), pytest.approx([0, 0, 1]))


def test_faces_that_cylinders_share_are_no_surface() -> None:
    lower, upper = Cylinder((0, 0, 0.3), "z", 0.5, 0.6), Cylinder((0, 0, 0.75), "z", 0.5, 0.3)
    for order in ([lower, upper], [upper, lower]):
        assert one(order, [0.1, 0.2, 0.1], [0, 0, 1]) == (pytest.approx(0.8, abs=1e-15), [0, 0, 1])


@pytest.mark.parametrize("solid", EVERY, ids=repr)
def test_bounds_and_scaling(solid: Solid) -> None:
    low, high = solid.bounds
    points = np.random.default_rng(9).uniform(-1.5, 1.5, (100_000, 3)) + C
    held = points[solid.contains(points)]
    assert (held >= low - 1e-12).all() and (held <= high + 1e-12).all()
    for axis, side in itertools.product(range(3), (low, high)):
        assert np.abs(solid.extremes()[:, axis] - side[axis]).min() == 0
    assert np.abs(solid.distance(solid.extremes())).min() < 1e-15
    large = solid.scaled(8)
    assert type(large) is type(solid) and np.allclose(large.bounds, np.multiply(solid.bounds, 8), rtol=1e-15)
    assert np.array_equal(large.contains(8 * points), solid.contains(points))


@pytest.mark.parametrize("solid", EVERY, ids=repr)
@pytest.mark.parametrize("edge", [0.05, 0.4])
def test_cubes_said_to_be_on_one_side_are(solid: Solid, edge: float) -> None:
    low = np.random.default_rng(10).uniform(-1.3, 1.2, (4000, 3)) + C
    full, empty = solid.sides(low, edge)
    inner = np.random.default_rng(11).uniform(0, edge, (60, 3))
    held = solid.contains((low[:, None] + inner).reshape(-1, 3)).reshape(len(low), -1)
    assert held[full].all() and not held[empty].any() and empty.any()


@pytest.mark.parametrize("make", [
    lambda: Torus(C, "z", 0.3, 0.3), lambda: Torus(C, "z", 0.3, 0), lambda: Torus(C, "w", 0.3, 0.1),
    lambda: Torus(C, (0, 0, 0), 0.3, 0.1), lambda: Torus(C, "z", math.inf, 0.1), lambda: Cylinder(C, "z", 0, 1),
    lambda: Cylinder(C, "z", 1, -1), lambda: Cylinder(C, (1, math.nan, 0), 1, 1), lambda: Cylinder((0, 1), "z", 1, 1),
    lambda: Ellipsoid(C, (1, 0, 1)), lambda: Ellipsoid(C, (1, 1)), lambda: Ellipsoid((0, 0, math.inf), (1, 1, 1))])
def test_impossible_solids(make) -> None:
    with pytest.raises(SettingsError, match="expected"):
        make()


def test_axes_by_name_and_by_direction() -> None:
    assert Cylinder(C, "y", 1, 2) == Cylinder(C, (0, 5, 0), 1, 2)
    assert Torus(C, (1e200, 0, 0), 2, 1).axis == (1, 0, 0)
    tilted = Torus(C, (1, 2, 3), 2, 1)
    assert tilted.scaled(3).axis == tilted.axis
