"""The oracle's cylinder of Schaufler and Jensen, on cases worked out by hand."""

from __future__ import annotations

import math

import pytest

from tests.oracle.cylinder import axis_distance, cylinder_hit, first_disc, plane_hit
from tests.oracle.samples import level, spiral, tilted_plane
from tests.oracle.vectors import along, dot, unit

UP, DOWN, START = [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 0.0, 5.0]


def test_one_disc() -> None:
    hit = cylinder_hit([0.3, 0.4, 5.0], DOWN, [[0.0, 0.0, 1.0]], [UP], 0.6)
    assert (hit.status, hit.t, hit.normal, hit.first, hit.ids) == ("hit", 4.0, UP, 4.0, [0])
    # Its rim does not belong to it.
    assert cylinder_hit([0.3, 0.4, 5.0], DOWN, [[0.0, 0.0, 1.0]], [UP], 0.5).status == "background"


def test_weights_fall_linearly_from_the_axis() -> None:
    # At distances 0.25 and 0.75 of r = 1 from the axis the weights are 0.75 and 0.25.
    points = [[0.25, 0.0, 1.0], [0.0, -0.75, 1.2]]
    hit = cylinder_hit(START, DOWN, points, [UP, unit([0.0, 0.6, 0.8])], 1.0)
    assert hit.t is not None and hit.normal is not None
    second = 3.8 + 0.75 * 0.6 / 0.8
    assert hit.first == 4.0
    assert hit.t == pytest.approx(0.75 * 4.0 + 0.25 * second, rel=1e-15)
    assert hit.normal == pytest.approx(unit([0.0, 0.25 * 0.6, 0.75 + 0.25 * 0.8]), abs=1e-15)


@pytest.mark.parametrize("angle", [0.0, 0.5, 1.2, 1.5])
def test_plane_is_exact_from_any_direction(angle: float) -> None:
    n = unit([1.0, -2.0, 3.0])
    points, normals = tilted_plane(n, [0.0, 0.0, 0.0], count=300)
    across = unit([3.0, 0.0, -1.0])
    direction = unit(along([-c * math.cos(angle) for c in n], across, math.sin(angle)))
    origin = along([0.0, 0.0, 0.0], direction, -7.0)
    hit = cylinder_hit(origin, direction, points, normals, 0.5)
    assert hit.t == pytest.approx(7.0, abs=1e-12) and hit.normal == pytest.approx(n, abs=1e-12)


def test_the_second_sheet_stays_out() -> None:
    points, normals = level(2, 0.5)
    behind = [[x, y, -1.0] for x, y, _ in points]
    hit = cylinder_hit([0.1, 0.2, 5.0], DOWN, behind + points, normals + normals, 0.6)
    assert hit.t == 5.0 and hit.ids is not None and min(hit.ids) >= len(behind)
    # Within r behind the first hit it counts.
    near = [[x, y, -0.5] for x, y, _ in points]
    hit = cylinder_hit([0.1, 0.2, 5.0], DOWN, near + points, normals + normals, 0.6)
    assert hit.t == pytest.approx(5.25, abs=1e-15)


def test_a_surfel_seen_edge_on_takes_no_part() -> None:
    points, normals = [[0.0, 0.0, 0.0], [0.2, 0.0, 0.1]], [UP, unit([1.0, 0.0, 0.01])]
    hit = cylinder_hit(START, DOWN, points, normals, 0.5)
    assert hit.ids == [0] and hit.t == 5.0
    assert plane_hit(START, DOWN, points[1], [1.0, 0.0, 0.0]) is None


def test_a_surfel_beyond_the_end_takes_no_part() -> None:
    # Its plane meets the axis at 5.3, within r of the first hit at 5, but its foot is at 5.6.
    points, normals = [[0.0, 0.0, 0.0], [0.3, 0.0, -0.6]], [UP, unit([1.0, 0.0, 1.0])]
    assert cylinder_hit(START, DOWN, points, normals, 0.5).ids == [0]
    assert cylinder_hit(START, DOWN, points, normals, 0.65).ids == [0, 1]


def test_opposite_normals_leave_none() -> None:
    hit = cylinder_hit(START, DOWN, [[0.0, 0.0, 0.0], [0.0, 0.0, -0.1]], [UP, DOWN], 0.5)
    assert (hit.status, hit.t, hit.first, hit.ids) == ("undefined_normal", None, 5.0, [0, 1])


def test_both_faces_and_the_start() -> None:
    points = [[0.0, 0.0, 0.0], [0.0, 0.0, 8.0]]
    assert cylinder_hit(START, DOWN, points, [DOWN, UP], 0.5).normal == DOWN
    assert first_disc(START, DOWN, points, [UP, UP], 0.5) == 5.0
    assert first_disc(START, DOWN, points, [UP, UP], 0.5, s_min=5.5) is None
    assert cylinder_hit(START, DOWN, [], [], 0.5).status == "background"


def test_distance_from_the_axis() -> None:
    assert axis_distance([1.0, 1.0, 1.0], [0.0, 0.6, 0.8], [4.0, 1.0, 1.0]) == (0.0, 3.0)
    assert axis_distance([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [3.0, 4.0, 7.0]) == (7.0, 5.0)


def test_sphere_is_hit_a_little_before_its_surface() -> None:
    points, normals = spiral(2.0, 1500)
    for b in (0.0, 0.5, 1.0):
        hit = cylinder_hit([b, 0.0, 5.0], DOWN, points, normals, 0.3)
        assert hit.t is not None and hit.normal is not None
        x = along([b, 0.0, 5.0], DOWN, hit.t)
        # A tangent plane lies outside; at a distance d from its point by d²/(2R), here 0.0225 at the most.
        assert 2.0 < math.hypot(*x) < 2.0225
        assert dot(hit.normal, unit(x)) > math.cos(math.radians(2))
