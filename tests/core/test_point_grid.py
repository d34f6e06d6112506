"""Points in the cells of a grid."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core import point_grid

RNG = np.random.default_rng(12)


@pytest.mark.parametrize("edge", [0.004, 0.05, 0.3, 7.0])
def test_points_stand_by_cells_as_a_stable_sort_puts_them(edge: float) -> None:
    points = RNG.uniform(-1.0, 2.0, (500, 3))
    low, high = point_grid.corners(points)
    assert np.array_equal((low, high), (points.min(axis=0), points.max(axis=0)))
    keys, shape = point_grid.cell_numbers(points, low, high, edge)
    cells = np.minimum(((points - low) / edge).astype(np.int64), shape - 1)
    assert np.array_equal(keys, np.ravel_multi_index(tuple(cells.T), tuple(shape)))
    assert np.array_equal(point_grid.order_of(keys, shape), np.argsort(keys, kind="stable"))


def test_a_grid_with_more_cells_than_memory_could_count_sorts_too() -> None:
    keys = np.array([5, 2**60, 5, 0])
    assert point_grid.order_of(keys, np.array([1 << 20, 1 << 20, 1 << 20])).tolist() == [3, 0, 2, 1]
