"""The oracle's neighbourhoods, on cases counted by hand."""

from __future__ import annotations

import random

from tests import naive
from tests.oracle.neighbourhoods import ball, cell_ball, cell_knn, knn

CORNERS = [[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]


def test_ball_has_its_rim() -> None:
    points = [[3.0, 4.0, 0.0], [3.0, 4.0, 1e-7], [0.0, 0.0, 0.0], [0.0, 5.0, 0.0]]
    assert ball([0.0, 0.0, 0.0], points, 5.0) == [0, 2, 3]


def test_equal_distances_go_by_id() -> None:
    assert knn([0.5, 0.5, 0.5], CORNERS, 3) == [0, 1, 2]
    assert cell_knn((0, 0, 0), CORNERS[::-1], 3) == [0, 1, 2]
    assert knn([0.9, 0.5, 0.5], CORNERS, 5) == [4, 5, 6, 7, 0]


def test_nearest_come_first() -> None:
    assert knn([0.0, 0.0, 0.0], [[3.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]], 2) == [1, 2]


def test_more_than_there_are() -> None:
    assert sorted(knn([0.1, 0.2, 0.3], CORNERS, 99)) == list(range(8))
    assert knn([0.0, 0.0, 0.0], [], 3) == ball([0.0, 0.0, 0.0], [], 1.0) == []


def test_a_rounded_sum_is_farther() -> None:
    # 0.1 + 0.2 is the float above 0.3; 0.3 and 0 are at exactly the same distance of 0.15.
    x, points = [0.15, 0.0, 0.0], [[0.1 + 0.2, 0.0, 0.0], [0.3, 0.0, 0.0], [0.0, 0.0, 0.0]]
    assert knn(x, points, 3) == [1, 2, 0]


def test_cells_count_from_their_centre() -> None:
    points = [[2.5, 3.5, 4.5], [2.5, 3.5, 6.4], [2.5, 3.5, 6.75]]
    assert cell_ball((2, 3, 4), points, 2.0) == [0, 1]
    assert cell_knn((2, 3, 6), points, 3) == [1, 2, 0]


def test_the_older_oracle_agrees() -> None:
    rng = random.Random(3)
    points = [[rng.uniform(0, 6) for _ in range(3)] for _ in range(200)]
    for cell in [(0, 0, 0), (2, 3, 4), (5, 5, 5)]:
        assert cell_ball(cell, points, 2.0) == naive.cell_ball(cell, points, 2.0)
