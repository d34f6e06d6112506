"""Which cells a ray crosses: the compiled traversal against a brute-force list in exact arithmetic."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from jaart.core import prepare
from jaart.core.kernels import records, traversal
from jaart.core.render import render
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from jaart.core.tiles import columns_for
from jaart.core.tracers import NO_LOG, LatticeTracer
from tests import naive_cells

Array = NDArray[np.float64]
Vector = Sequence[float]
Cell = tuple[int, int, int]

SHAPE = (6, 5, 7)


def crossed(origin: Vector, direction: Vector, shape: Cell = SHAPE) -> tuple[list[Cell], list[float]]:
    """The cells that the compiled traversal visits, and their borders."""
    room = sum(shape) + 3
    cells, borders = np.full((room, 3), -7, np.int32), np.full(room + 1, np.nan)
    n = traversal.crossed(np.array(origin, dtype=float), np.array(direction, dtype=float), shape, cells, borders)
    return [(int(i), int(j), int(k)) for i, j, k in cells[:n]], borders[:n + 1].tolist() if n else []


def of_some_length(origin: Vector, direction: Vector, shape: Cell = SHAPE) -> list[Cell]:
    """The visited cells without one that the ray only touches where it enters or begins."""
    cells, borders = crossed(origin, direction, shape)
    kept = [cell for cell, a, b in zip(cells, borders, borders[1:], strict=False) if b > a]
    assert len(cells) - len(kept) <= 1
    return kept


def brute_force(origin: Vector, direction: Vector, shape: Cell = SHAPE) -> list[Cell]:
    """The cells crossed; the far faces of the lattice belong to its last cells."""
    inside = [n - 0.5 if d == 0 and o == n else o for o, d, n in zip(origin, direction, shape, strict=True)]
    return [c.cell for c in naive_cells.crossed_cells(inside, direction, shape)]


def test_an_axis_ray_from_a_face() -> None:
    assert crossed((5, 2.5, 2.5), (-1, 0, 0), (8, 8, 8))[0] == [(i, 2, 2) for i in (4, 3, 2, 1, 0)]
    assert crossed((5, 2.5, 2.5), (1, 0, 0), (8, 8, 8))[0] == [(i, 2, 2) for i in (5, 6, 7)]
    assert crossed((5, 2.5, 2.5), (-1, 0, 0), (8, 8, 8))[1] == [0, 1, 2, 3, 4, 5]


@pytest.mark.parametrize("length", [1.0, 1 / math.sqrt(3)])
def test_diagonals_through_corners(length: float) -> None:
    down = crossed((8, 8, 8), (-length,) * 3, (8, 8, 8))[0]
    assert down == [(i, i, i) for i in range(7, -1, -1)]
    assert crossed((-3, -3, -3), (length,) * 3, (8, 8, 8))[0] == down[::-1]
    assert crossed((-1, 9, 3.5), (length, -length, 0), (8, 8, 8))[0] == [(i, 7 - i, 3) for i in range(8)]


@pytest.mark.parametrize("zero", [0.0, -0.0, 1e-300])
def test_zeros_of_either_sign_move_nothing(zero: float) -> None:
    for origin in ((3.0, 2.0, 9.0), (3.0, 2.5, 9.0), (0.0, 0.0, 9.0)):
        cells, borders = crossed(origin, (zero, zero, -1))
        assert cells == [(int(origin[0]), int(origin[1]), k) for k in range(6, -1, -1)]
        assert borders == [2, 3, 4, 5, 6, 7, 8, 9]
    assert crossed((-1e-9, 2, 9), (zero, zero, -1))[0] == []


def test_far_origins_lose_no_cell() -> None:
    cells, borders = crossed((2.5, 2.5, 1e9), (0, 0, -1))
    assert cells == [(2, 2, k) for k in range(6, -1, -1)]
    assert borders[0] == 1e9 - 7


def test_2000_random_rays_step_to_neighbours_and_end() -> None:
    rng = np.random.default_rng(3)
    shape = (40, 30, 20)
    for _ in range(2000):
        origin = rng.uniform(-20, 60, 3)
        direction = rng.uniform((0, 0, 0), shape) - origin
        direction /= np.linalg.norm(direction)
        cells, borders = crossed(origin.tolist(), direction.tolist(), shape)
        steps = np.abs(np.diff(np.array(cells), axis=0)).sum(axis=1)
        assert 1 <= len(cells) <= sum(shape) + 3
        assert (steps == 1).all()
        assert (np.diff(borders) >= 0).all()
        leaving = origin + borders[-1] * direction
        assert np.minimum(np.abs(leaving), np.abs(leaving - shape)).min() < 1e-9


def test_random_rays_cross_what_brute_force_finds() -> None:
    rng = np.random.default_rng(8)
    checked = 0
    for _ in range(400):
        origin = (rng.uniform(-0.5, 1.5, 3) * SHAPE).tolist()
        direction = rng.normal(size=3).tolist()
        expected = naive_cells.crossed_cells(origin, direction, SHAPE)
        cells, borders = crossed(origin, direction)
        assert cells == [c.cell for c in expected]
        for c, enter, leave in zip(expected, borders, borders[1:], strict=False):
            assert (enter, leave) == pytest.approx((float(c.enter), float(c.leave)), abs=1e-12, rel=1e-12)
            checked += 1
    assert checked > 400


#: Halves of cells and these directions make every t exact, so that edges and corners are met exactly.
at = st.integers(-6, 20).map(lambda i: i / 2)
towards = st.sampled_from([0.0, -0.0, 1.0, -1.0, 2.0, -2.0, 0.5, -0.5])


@settings(max_examples=200, deadline=None)
@given(st.tuples(at, at, at), st.tuples(towards, towards, towards).filter(any))
def test_rays_in_faces_edges_and_corners_cross_what_brute_force_finds(
        origin: tuple[float, float, float], direction: tuple[float, float, float]) -> None:
    assert of_some_length(origin, direction) == brute_force(origin, direction)
    touched = naive_cells.touched_cells(origin, direction, SHAPE)
    assert set(crossed(origin, direction)[0]) <= touched


def noise(seed: int, share: float = 0.15) -> Scene:
    """A lattice of mostly empty cells with a few scattered partly filled ones."""
    rng = np.random.default_rng(seed)
    levels = np.where(rng.uniform(size=(14, 11, 17)) < share, rng.uniform(0.1, 0.9, (14, 11, 17)), 0.0)
    return Scene("noise", levels=levels)


def lattice_of(ready: prepare.Prepared) -> records.Cells:
    """The cells that rays of a prepared lattice cross."""
    assert isinstance(ready.tracer, LatticeTracer)
    return ready.tracer.cells


def cell_by_cell(empty: records.Empty) -> records.Empty:
    """Distances that let no more than one cell be skipped."""
    return empty._replace(bricks=np.maximum(empty.bricks, -2), near=np.minimum(empty.near, 1))


def traced(tracer: LatticeTracer, origin: Vector, direction: Vector,
           rows: Array = NO_LOG) -> tuple[dict[str, NDArray[Any]], int]:
    """How a ray ends, column by column, and the rows of the log it wrote."""
    out = columns_for(1)
    written = tracer.trace(np.array([origin], float), np.array([direction], float), np.zeros(1, np.int64), out, rows)
    return {name: column[0] for name, column in out._asdict().items()}, written


def starts(ready: prepare.Prepared, cells: records.Cells, origin: Vector, direction: Vector) -> list[tuple[float, ...]]:
    """(t, cell) of every start on a ray on which each start fails at once."""
    plan = ready.tracer.plan
    fail = plan._replace(how=plan.how._replace(cap=1, arrived=0.0), bounds=plan.bounds._replace(off_centre=0.0))
    rows = np.empty((200, records.LOG_WIDTH))
    written = traced(LatticeTracer(lambda: cells, fail), origin, direction, rows)[1]
    logged = rows[:written, [records.T, records.CELL_I, records.CELL_J, records.CELL_K]]
    return [(t, i, j, k) for t, i, j, k in logged.tolist()]


@pytest.mark.parametrize("seed", range(3))
def test_skipping_empty_space_starts_where_stepping_through_it_does(seed: int) -> None:
    scene, rng = noise(seed), np.random.default_rng(seed)
    ready = prepare.prepared(scene, Settings(border="closed"))
    shape = (14, 11, 17)
    fast = lattice_of(ready)
    slow = fast._replace(empty=cell_by_cell(fast.empty))
    assert fast.empty.bricks.min() <= -4 or fast.empty.near.max() >= 3
    surfel_cells = {tuple(c) for c in ready.surfels.cells.tolist()}
    found = 0
    for kind in range(600):
        origin = rng.uniform(-1, 2, 3) * shape
        if kind % 3:
            origin = np.round(origin * 2) / 2
            direction = rng.integers(-2, 3, 3).astype(float) if kind % 3 == 1 else np.eye(3)[kind % 9 // 3]
        else:
            direction = rng.uniform(0, 1, 3) * shape - origin
        if not direction.any():
            continue
        direction /= np.linalg.norm(direction)
        skipped, stepped = (starts(ready, cells, origin.tolist(), direction.tolist()) for cells in (fast, slow))
        assert skipped == stepped
        found += len(skipped)
        if kind % 12 == 0:
            expected = naive_cells.crossed_cells(origin.tolist(), direction.tolist(), shape)
            assert [s[1:] for s in skipped] == [c.cell for c in expected if c.cell in surfel_cells]
    assert found > 300


def test_skipping_visits_fewer_cells() -> None:
    scene = Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.1),), 32))
    ready = prepare.prepared(scene, Settings(subdivision=4))
    fast = lattice_of(ready)
    slow = fast._replace(empty=cell_by_cell(fast.empty))
    o, d = (-5.0, 15.2, 16.3), (1.0, 0.0, 0.0)
    fast_end, slow_end = (traced(LatticeTracer(lambda cells=cells: cells, ready.tracer.plan), o, d)[0]
                          for cells in (fast, slow))
    assert fast_end["status"] == records.CONVERGED
    for name in fast_end.keys() - {"cells"}:
        np.testing.assert_array_equal(fast_end[name], slow_end[name])
    assert fast_end["cells"] < slow_end["cells"] / 1.5


@pytest.mark.parametrize("whole", [(0,), (1,), (0, 1)])
def test_a_ray_in_a_face_or_an_edge_hits_like_its_neighbours(whole: tuple[int, ...]) -> None:
    """No hit may depend on which of the touching cells owns the face."""
    scene = Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.25),), 16))
    rng = np.random.default_rng(2)
    for _ in range(20):
        origin = rng.uniform(6, 10, 3)
        origin[list(whole)] = np.round(origin[list(whole)])
        origin[2] = 30.0
        shifts = np.zeros((3, 3))
        shifts[1, list(whole)], shifts[2, list(whole)] = 1e-9, -1e-9
        hits = render(scene, Settings(subdivision=4), rays=(origin + shifts, np.tile([0.0, 0.0, -1.0], (3, 1))))
        assert hits.hit.all()
        assert np.ptp(hits.t) < 0.05


@pytest.mark.parametrize("level", [0.5, 0.99])
def test_a_ray_between_a_cell_with_a_surfel_and_one_without_starts_in_it(level: float) -> None:
    levels = np.zeros((5, 5, 5))
    levels[1, 2, 2], levels[1, 2, 1] = level, 1.0
    scene = Scene("one", levels=levels)
    for x in (1.0, 2.0):  # both faces of the only cell
        hits = render(scene, Settings(), rays=(np.array([[x, 2.5, 9.0]]), np.array([[0.0, 0.0, -1.0]])))
        assert hits.evaluations[0] >= 1
