"""A table of a lattice's cells in two levels: bricks of cells, and the cells of those bricks that anything is in."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.records import Cell

Ints = NDArray[np.int64]

#: Cells along the edge of a brick.
BRICK = 4


def brick_shape(shape: Cell) -> tuple[int, int, int]:
    """How many bricks a lattice has along each axis."""
    x, y, z = (-(-n // BRICK) for n in shape)
    return x, y, z


def bricks_of(shape: Cell, cells: NDArray[Any]) -> NDArray[np.bool_]:
    """Which bricks hold one of some cells (N, 3)."""
    held = np.zeros(brick_shape(shape), bool)
    held[tuple((cells // BRICK).T)] = True
    return held


def numbers_of(shape: Cell, cells: NDArray[Any]) -> tuple[Ints, Ints]:
    """The number of the brick that each of some cells (N, 3) lies in, and the cell's number in it."""
    brick, inner = cells.astype(np.int64) // BRICK, cells % BRICK
    _, wide, deep = brick_shape(shape)
    return ((brick[:, 0] * wide + brick[:, 1]) * deep + brick[:, 2],
            (inner[:, 0] * BRICK + inner[:, 1]) * BRICK + inner[:, 2])


def brick_slots(held: NDArray[np.bool_]) -> Ints:
    """Empty slots for the cells of some bricks."""
    slots = np.zeros(held.size + BRICK**3 * int(held.sum()), np.int64)
    slots[np.flatnonzero(held)] = held.size + BRICK**3 * np.arange(int(held.sum()))
    return slots


def slot_numbers(shape: Cell, slots: Ints, cells: NDArray[Any]) -> Ints:
    """Where in slots the blocks of some cells (N, 3) are noted, -1 for cells that no surfel is near."""
    brick, inner = numbers_of(shape, cells)
    first = slots[brick]
    number: Ints = np.where(first > 0, first + inner, -1)
    return number
