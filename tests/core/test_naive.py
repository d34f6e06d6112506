"""The oracle itself, against numbers worked out by hand."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from tests import naive, naive_cells
from tests.naive import Cloud, Rules, Search

UP = (0.0, 0.0, 1.0)


def plane(size: int, z: float) -> tuple[list[list[float]], list[list[float]]]:
    """Surfels with upward normals in the middle of each cell of a level layer."""
    points = [[i + 0.5, j + 0.5, z] for i in range(size) for j in range(size)]
    return points, [list(UP) for _ in points]


def plane_search(z: float = 3.3, size: int = 7, **rules: float) -> Search:
    """The search on such a layer."""
    points, normals = plane(size, z)
    return Search(points, normals, {naive.cell_of(p) for p in points}, (size,) * 3, Rules(**rules))  # type: ignore[arg-type]


def sphere_search(rules: Rules, radius: float = 3.0, count: int = 1500) -> Search:
    """The search on evenly spread surfels of a sphere about (4, 4, 4)."""
    golden, normals = math.pi * (3 - math.sqrt(5)), []
    for i in range(count):
        z = 1 - (2 * i + 1) / count
        across = math.sqrt(1 - z * z)
        normals.append([across * math.cos(i * golden), across * math.sin(i * golden), z])
    points = [naive.along((4.0, 4.0, 4.0), n, radius) for n in normals]
    return Search(points, normals, {naive.cell_of(p) for p in points}, (8, 8, 8), rules)


def test_one_surfel_is_its_plane() -> None:
    cloud = Cloud([(1.0, 2.0, 3.0)], [UP], h=0.5)
    x = (1.0, 2.3, 3.4)
    assert cloud.weights(x) == [pytest.approx(math.exp(-1.0))]
    assert cloud.barycentre(x) == pytest.approx([1, 2, 3])
    assert cloud.f(x) == pytest.approx(-0.4)
    assert cloud.off_centre(x) == pytest.approx(0.5)
    assert cloud.tangent_step(x, (0.0, 0.6, -0.8)) == pytest.approx(0.5)
    assert cloud.mahalanobis(x) == pytest.approx(0.16 + 0.25 * 0.09)


def test_two_surfels_are_blended_by_their_weights() -> None:
    cloud = Cloud([(0.0, 0.0, 0.0), (2.0, 0.0, 0.0)], [UP, (1.0, 0.0, 0.0)], h=1.0)
    ratio = math.exp(-1.44) / math.exp(-0.64)  # at distances 1.2 and 0.8
    x = (1.2, 0.0, 0.0)
    assert cloud.barycentre(x) == pytest.approx([2 / (1 + ratio), 0, 0])
    length = math.hypot(1, ratio)
    assert cloud.normal(x) == pytest.approx([1 / length, 0, ratio / length])
    assert cloud.f(x) == pytest.approx((2 / (1 + ratio) - 1.2) / length)
    # 1.44·(0 + c) from the first plane, 0.64·(1 + 0) from the second
    assert cloud.mahalanobis(x, c=0.5) == pytest.approx((ratio * 0.72 + 0.64) / (1 + ratio))


def test_three_surfels_about_a_middle_cancel() -> None:
    corners = [(math.cos(a), math.sin(a), 0.0) for a in (0.0, 2 * math.pi / 3, 4 * math.pi / 3)]
    cloud = Cloud(corners, corners, h=2.0)
    assert cloud.barycentre((0, 0, 5)) == pytest.approx([0, 0, 0])
    assert math.hypot(*cloud.mean_normal((0, 0, 5))) < 1e-15
    assert cloud.off_centre((0, 0, 5)) == pytest.approx(5)


def test_cell_ball_is_about_the_cells_centre() -> None:
    points = [(0.5, 0.5, 0.5), (2.5, 0.5, 0.5), (2.51, 0.5, 0.5)]
    assert naive.cell_ball((0, 0, 0), points, 2.0) == [0, 1]
    assert naive.cell_of((1.0, 0.999, -0.1)) == (1, 0, -1)


def test_crossed_cells_of_a_slanted_ray() -> None:
    cells = naive_cells.crossed_cells((-1.0, 0.25, 0.5), (1.0, 0.5, 0.0), (2, 2, 2))
    assert [c.cell for c in cells] == [(0, 0, 0), (0, 1, 0), (1, 1, 0)]
    assert [c.enter for c in cells] == [Fraction(1), Fraction(3, 2), Fraction(2)]
    assert cells[-1].leave == 3


def test_a_diagonal_ray_crosses_few_cells_and_touches_many() -> None:
    cells = naive_cells.crossed_cells((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (2, 2, 2))
    assert [c.cell for c in cells] == [(0, 0, 0), (1, 1, 1)]
    assert len(naive_cells.touched_cells((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (2, 2, 2))) == 8


def test_a_ray_in_a_face_belongs_to_the_upper_cells() -> None:
    cells = naive_cells.crossed_cells((1.0, 0.5, 5.0), (0.0, 0.0, -1.0), (2, 1, 2))
    assert [c.cell for c in cells] == [(1, 0, 1), (1, 0, 0)]
    assert naive_cells.touched_cells((1.0, 0.5, 5.0), (0.0, 0.0, -1.0), (2, 1, 2)) == {
        (0, 0, 0), (0, 0, 1), (1, 0, 0), (1, 0, 1)}
    assert naive_cells.crossed_cells((2.0, 0.5, 5.0), (0.0, 0.0, -1.0), (2, 1, 2)) == []


def test_a_ray_from_inside_begins_at_its_origin() -> None:
    cells = naive_cells.crossed_cells((1.5, 0.5, 0.5), (-1.0, 0.0, 0.0), (3, 1, 1))
    assert [(c.cell, c.enter) for c in cells] == [((1, 0, 0), 0), ((0, 0, 0), Fraction(1, 2))]


@pytest.mark.parametrize("direction", [(0.0, 0.0, -1.0), (0.6, 0.0, -0.8), (0.36, 0.48, -0.8)])
def test_a_plane_is_hit_exactly_in_two_steps(direction: tuple[float, float, float]) -> None:
    origin = naive.along((3.2, 3.4, 3.3), direction, -4.0)
    end = plane_search(max_off_centre=0.7).run(origin, direction)
    assert end.status == "converged"
    assert end.t == pytest.approx(4.0, abs=1e-13)
    assert end.normal == pytest.approx(UP)
    assert [len(steps) for steps in end.starts] == [2]


def test_a_ray_beside_everything_is_background() -> None:
    end = plane_search().run((-1.0, 3.5, 6.5), (1.0, 0.0, 0.0))
    assert (end.status, end.starts, end.t) == ("background", [], None)


def test_a_ray_along_the_plane_is_parallel_in_every_start() -> None:
    end = plane_search().run((-1.0, 3.5, 3.7), (1.0, 0.0, 0.0))
    assert end.status == "parallel"
    assert len(end.starts) == 7


def test_a_hit_far_from_its_barycentre_is_bounded() -> None:
    search = plane_search(max_off_centre=0.05)
    assert search.run((0.05, 3.5, 6.9), (0.0, 0.0, -1.0)).status == "bounded"  # the layer ends at 0.5
    assert search.run((3.5, 3.5, 6.9), (0.0, 0.0, -1.0)).status == "converged"


def test_the_trust_region_ends_a_search() -> None:
    end = plane_search(trust=0.5).run((3.5, 3.5, 6.9), (0.0, 0.0, -1.0))
    assert end.status == "left_trust"
    assert end.starts[0][0].t_next == pytest.approx(3.6)


def test_a_surface_behind_the_origin_is_not_hit() -> None:
    assert plane_search().run((3.5, 3.5, 3.2), (0.0, 0.0, -1.0)).status == "left_trust"


def test_a_ray_within_a_face_starts_in_the_cell_that_has_the_surfel() -> None:
    points, normals = [(1.5, 1.5, 1.25)], [UP]
    search = Search(points, normals, {(1, 1, 1)}, (3, 3, 3), Rules(max_off_centre=1.0))
    end = search.run((2.0, 1.5, 9.0), (0.0, 0.0, -1.0))
    assert (end.status, end.starts[0][0].cell) == ("converged", (1, 1, 1))
    assert end.starts[0][1].cell == (2, 1, 1)


def test_growth_ends_a_search_whose_f_grows() -> None:
    search = sphere_search(Rules(radius=3.5, trust=3.5, tolerance=1e-6, growth=True))
    end = search.run((4.0, 6.95, -2.0), (0.0, 0.0, 1.0))  # passes just outside the shrunken sphere
    steps = next(steps for steps in end.starts if steps[-1].outcome == "cap")
    assert 1 < len(steps) < 20
    assert abs(steps[-1].f) > abs(steps[-2].f)


def test_few_steps_end_in_cap() -> None:
    end = plane_search(max_iterations=1).run((3.5, 3.5, 6.9), (0.0, 0.0, -1.0))
    assert (end.status, end.evaluations) == ("cap", [1])


def test_two_facing_surfels_have_no_normal() -> None:
    points, normals = [(1.5, 1.5, 1.25), (1.5, 1.5, 1.75)], [UP, (0.0, 0.0, -1.0)]
    search = Search(points, normals, {(1, 1, 1)}, (3, 3, 3), Rules())
    end = search.run((-1.0, 1.5, 1.5), (1.0, 0.0, 0.0))
    assert end.status == "undefined_normal"


def test_a_sphere_of_surfels_is_hit_near_its_shrunken_radius() -> None:
    """A dense sphere's surface has r = R(coth q - 1/q), q = 2rR/h²."""
    radius, h = 3.0, 0.8
    search = sphere_search(Rules(h=h, radius=3.5, trust=3.5, tolerance=1e-6))
    shrunken = radius
    for _ in range(50):
        q = 2 * shrunken * radius / h**2
        shrunken = radius * (1 / math.tanh(q) - 1 / q)
    direction = (-0.48, 0.6, -0.64)
    end = search.run(naive.along((4.0, 4.0, 4.0), direction, -9.0), direction)
    assert end.status == "converged" and end.t is not None and end.normal is not None
    assert 9 - end.t == pytest.approx(shrunken, abs=2e-3)
    assert naive.dot(end.normal, direction) == pytest.approx(-1, abs=1e-3)
