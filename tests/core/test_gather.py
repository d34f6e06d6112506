"""What is gathered near a ball is what a look at every point finds, in columns as the sums take them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core.balls import Cloud, CloudTracer
from jaart.core.cloud_surfels import _grid
from jaart.core.kernels.gather import Grid, cells_of
from jaart.core.places import listed_near
from jaart.core.tree import ball_tree

RNG = np.random.default_rng(3)
CLOUDS = {
    "even": RNG.uniform(-1, 1, (400, 3)),
    "lattice": np.stack(np.meshgrid(*[np.arange(7.0)] * 3), axis=-1).reshape(-1, 3),
    "flat": RNG.uniform(-1, 1, (300, 3)) * [1, 1, 0],
    "line": RNG.uniform(-1, 1, (100, 3)) * [0, 1, 0],
    "one": np.array([[3.0, -2.0, 5.0]]),
    "in one place": np.ones((40, 3)),
    "duplicates": np.repeat(RNG.uniform(-1, 1, (60, 3)), 4, axis=0),
    "far one": np.concatenate((RNG.uniform(-1, 1, (200, 3)), [[3e3, 3e3, 3e3]])),
}
EDGES = {"one cell": 1e9, "many": 0.3, "tiny": 1e-7}


def normals(count: int) -> np.ndarray:
    made = np.random.default_rng(count).normal(size=(count, 3))
    return made / np.linalg.norm(made, axis=1, keepdims=True)


def cloud_of(points: np.ndarray, centres: np.ndarray, radii: np.ndarray, edge: float) -> Cloud:
    return Cloud(_grid(points, normals(len(points)), edge), centres, radii, radii, ball_tree(centres, radii),
                 np.zeros(3))


def gathered(made: Cloud, balls: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What is near some balls, as rays gather it."""
    sites = CloudTracer(made, None, True, False).sites  # type: ignore[arg-type]
    return listed_near(sites, np.column_stack((balls, np.zeros((len(balls), 2), np.int64))))


def within(points: np.ndarray, centre: np.ndarray, radius: float) -> set[int]:
    """Every point looked at."""
    away = points - centre
    return set(np.flatnonzero((away * away).sum(axis=1) <= radius * radius).tolist())


@pytest.mark.parametrize("edge", EDGES.values(), ids=EDGES)
@pytest.mark.parametrize("name", CLOUDS)
def test_the_points_within_each_ball_and_their_columns(name: str, edge: float) -> None:
    points = CLOUDS[name]
    some = np.arange(0, len(points), max(len(points) // 25, 1))
    centres = np.concatenate((points[some], points[some] + 0.25, [points.max(axis=0) + 9.0]))
    radii = np.resize([0.0, 0.25, 0.75, 1.0, 2.0, 1e4], len(centres))
    radii[-1] = 0.5
    made = cloud_of(points, centres, radii, edge)
    first, ids, columns = gathered(made, np.arange(len(centres)))
    assert first[0] == 0 and len(ids) == first[-1] and len(columns) == 6 * first[-1]
    for ball, (centre, radius) in enumerate(zip(centres, radii, strict=True)):
        its = ids[first[ball]:first[ball + 1]]
        assert set(its.tolist()) == within(points, centre, radius) and len(set(its.tolist())) == len(its)
        rows = columns[6 * first[ball]:6 * first[ball + 1]].reshape(6, -1).T
        assert np.array_equal(rows[:, :3], points[its] - centre)
        assert np.array_equal(rows[:, 3:], normals(len(points))[its])
    assert first[-1] == first[-2]  # none is near the last


def test_only_the_balls_that_are_asked_for_in_the_order_that_is_asked_for() -> None:
    points, asked = CLOUDS["even"], np.array([7, 2, 100])
    made = cloud_of(points, points, np.full(len(points), 0.5), 0.4)
    first, ids, _ = gathered(made, asked)
    for i, ball in enumerate(asked):
        assert set(ids[first[i]:first[i + 1]].tolist()) == within(points, points[ball], 0.5)


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("edge", EDGES.values(), ids=EDGES)
def test_the_grid_is_sorted_and_holds_every_point_once(name: str, edge: float) -> None:
    grid = _grid(CLOUDS[name], normals(len(CLOUDS[name])), edge)
    assert (np.diff(grid.keys) >= 0).all() and sorted(grid.ids) == list(range(len(CLOUDS[name])))
    assert np.array_equal(grid.points, CLOUDS[name][grid.ids])
    assert grid.keys[0] >= 0 and grid.keys[-1] < int(grid.shape[0]) * int(grid.shape[1]) * int(grid.shape[2])


@given(st.floats(0, 1e12), st.tuples(*[st.floats(-1e12, 1e12)] * 3))
def test_no_ball_looks_through_more_rows_of_cells_than_there_are_points(radius: float,
                                                                        centre: tuple[float, float, float]) -> None:
    points = CLOUDS["far one"]
    grid: Grid = _grid(points, points, 1e-3)
    assert int(grid.shape.min()) > 1_000_000
    assert cells_of(grid, centre, radius)[2] <= len(points)
    made = Cloud(grid, np.array([centre]), np.array([radius]), np.array([radius]),
                 ball_tree(np.zeros((1, 3)), np.ones(1)), np.zeros(3))
    assert set(gathered(made, np.zeros(1, np.int64))[1].tolist()) == within(points, np.array(centre), radius)
