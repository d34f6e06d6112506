"""The heap of what waits along a ray gives its items in the order of a sorted list."""

from __future__ import annotations

import heapq

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from jaart.core.kernels.heap import pop, push

KEYS = st.one_of(st.integers(-3, 3).map(float), st.floats(allow_nan=False))


def room(count: int) -> tuple[np.ndarray, np.ndarray]:
    return np.full(count, np.nan), np.full(count, -99, np.int64)


@given(st.lists(st.tuples(KEYS, st.integers(-5, 5)), max_size=60))
def test_all_items_come_in_the_order_of_key_then_item(entries: list[tuple[float, int]]) -> None:
    keys, items = room(len(entries) + 1)
    size = 0
    for key, item in entries:
        size = push(keys, items, size, key, item)
    assert size == len(entries)
    for expected in sorted(entries):
        size = pop(keys, items, size)
        assert (keys[size], items[size]) == expected
    assert size == 0 and np.isnan(keys[-1]) and items[-1] == -99


@given(st.lists(st.one_of(st.none(), st.tuples(KEYS, st.integers(-5, 5))), max_size=80))
def test_pushes_and_pops_in_any_order(steps: list[tuple[float, int] | None]) -> None:
    """None stands for a pop."""
    (keys, items), size, waiting = room(len(steps) + 1), 0, []
    for step in steps:
        if step is not None:
            size = push(keys, items, size, *step)
            heapq.heappush(waiting, step)
        elif waiting:
            size = pop(keys, items, size)
            assert (keys[size], items[size]) == heapq.heappop(waiting)
        assert size == len(waiting)
        assert not waiting or (keys[0], items[0]) == waiting[0]
