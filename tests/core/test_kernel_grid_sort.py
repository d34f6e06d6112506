"""Points sorted by the cells of a grid, beside numpy's stable sort."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core.kernels.grid_sort import number_cells, sort_by_key

RNG = np.random.default_rng(8)


@pytest.mark.parametrize(("count", "keys"), [(1, 1), (1, 5), (7, 2), (1000, 40), (1000, 5000)])
def test_items_stand_as_a_stable_sort_puts_them(count: int, keys: int) -> None:
    given = RNG.integers(0, keys, count)
    first, order = np.zeros(keys + 1, np.int64), np.empty(count, np.int64)
    sort_by_key(given, first, order)
    assert np.array_equal(order, np.argsort(given, kind="stable"))
    assert np.array_equal(first, np.searchsorted(given[order], np.arange(keys + 1)))


def test_cells_are_numbered_in_c_order() -> None:
    shape, low, edge = np.array([4, 7, 3]), np.array([-1.0, 2.0, 0.5]), 0.25
    cell = RNG.integers(0, shape, (300, 3))
    keys = np.empty(300, np.int64)
    number_cells(low + edge * (cell + RNG.uniform(0.1, 0.9, (300, 3))), low, edge, shape, keys)
    assert np.array_equal(keys, np.ravel_multi_index(tuple(cell.T), tuple(shape)))


def test_what_lies_on_the_last_face_is_in_the_last_cell() -> None:
    keys = np.empty(1, np.int64)
    number_cells(np.array([[1.0, 1.0, 1.0]]), np.zeros(3), 0.5, np.array([2, 2, 2]), keys)
    assert keys[0] == 7
