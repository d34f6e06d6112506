"""A table of a lattice's cells in two levels: bricks of cells, and the cells of those bricks that anything is in."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.records import Cell

Ints = NDArray[np.int64]

#: Cells along the edge of a brick.
BRICK = 4


def bricks_of(shape: Cell, cells: NDArray[Any]) -> NDArray[np.bool_]:
    """Which bricks hold one of some cells (N, 3)."""
    held = np.zeros([-(-n // BRICK) for n in shape], bool)
    held[tuple((cells // BRICK).T)] = True
    return held


def brick_slots(shape: Cell, held: NDArray[np.bool_]) -> Ints:
    """Empty slots for the cells of some bricks."""
    slots = np.zeros(held.size + BRICK**3 * int(held.sum()), np.int64)
    slots[np.flatnonzero(held)] = held.size + BRICK**3 * np.arange(int(held.sum()))
    return slots


def slot_numbers(shape: Cell, slots: Ints, cells: NDArray[Any]) -> Ints:
    """Where in slots the blocks of some cells (N, 3) are noted, -1 for cells that no surfel is near."""
    brick, inner = cells // BRICK, cells % BRICK
    wide, deep = -(-shape[1] // BRICK), -(-shape[2] // BRICK)
    first = slots[(brick[:, 0] * wide + brick[:, 1]) * deep + brick[:, 2]]
    number: Ints = np.where(first > 0, first + (inner[:, 0] * BRICK + inner[:, 1]) * BRICK + inner[:, 2], -1)
    return number
