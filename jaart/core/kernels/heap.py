"""A binary heap of numbered items, the least key first."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array

Ints = NDArray[np.int64]


@kernel(STRICT)
def before(keys: Array, items: Ints, i: int, j: int) -> bool:
    """Whether entry i comes before entry j: by key, then by item, so that the order is one only."""
    return keys[i] < keys[j] or (keys[i] == keys[j] and items[i] < items[j])


@kernel(STRICT)
def swap(keys: Array, items: Ints, i: int, j: int) -> None:
    """Exchange two entries."""
    keys[i], keys[j] = keys[j], keys[i]
    items[i], items[j] = items[j], items[i]


@kernel(STRICT)
def push(keys: Array, items: Ints, size: int, key: float, item: int) -> int:
    """Add an item; returns the new size. There must be room."""
    keys[size], items[size] = key, item
    i = size
    while i > 0 and before(keys, items, i, (i - 1) // 2):
        swap(keys, items, i, (i - 1) // 2)
        i = (i - 1) // 2
    return size + 1


@kernel(STRICT)
def pop(keys: Array, items: Ints, size: int) -> int:
    """Move the first item behind the others, where keys[size - 1] and items[size - 1] hold it; returns size - 1."""
    last = size - 1
    swap(keys, items, 0, last)
    i = 0
    while True:
        child = 2 * i + 1
        if child >= last:
            return last
        if child + 1 < last and before(keys, items, child + 1, child):
            child += 1
        if not before(keys, items, child, i):
            return last
        swap(keys, items, i, child)
        i = child
