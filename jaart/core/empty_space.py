"""How far a lattice's cells are from surfels, worked out some planes of cells at a time."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.bricks import BRICK, brick_shape, numbers_of
from jaart.core.kernels import table
from jaart.core.kernels.records import Cell, Empty
from jaart.core.memory import pieces

Bytes = NDArray[np.uint8]

#: The largest distance that is told cell by cell.
FARTHEST = 255
#: Planes of cells whose distances are worked out at a time, at least, and how many beside them are looked at.
PLANES, BESIDE = 64, 16


def empty_space(cells: NDArray[np.int32], shape: Cell, most: int) -> Empty:
    """How far the cells of a lattice are from the nearest with a surfel.

    cells: (N, 3) of the surfels; most: bricks that hold a distance of so many cells or less are told cell by cell.
    """
    beside = min(max(most + BRICK - 1, BESIDE), FARTHEST - 1)
    apart = _distances(cells // BRICK, brick_shape(shape))
    bricks, near, held = np.empty(apart.size, np.int32), [np.empty(0, np.uint8)], 0
    for slab in pieces(shape[0], max(PLANES, beside // BRICK * 2 * BRICK)):
        near.append(_in_slab(cells, shape, slab, (most, beside), apart, bricks, held))
        held += len(near[-1]) // BRICK**3
    return Empty(shape, bricks, np.concatenate(near))


def _in_slab(cells: NDArray[np.int32], shape: Cell, slab: slice, reach: tuple[int, int], apart: Bytes,
             bricks: NDArray[np.int32], held: int) -> Bytes:
    """Write the bricks of some planes; returns the distances that are told cell by cell.

    reach: how far they are told so, and how many planes beside these are looked at; apart: how many bricks those with a
    surfel are away; held: how many bricks were told cell by cell before.
    """
    most, beside = reach
    begin, end = max(slab.start - beside, 0), min(slab.stop + beside, shape[0])
    some = cells[(cells[:, 0] >= begin) & (cells[:, 0] < end)] - np.array([begin, 0, 0], np.int32)
    window = _distances(some, (end - begin, *shape[1:]))
    own = slice(slab.start // BRICK, -(-slab.stop // BRICK))
    number = slice(own.start * apart[0].size, own.stop * apart[0].size)
    room = np.empty(BRICK**3 * apart[own].size, np.uint8)
    known = FARTHEST - 1 if end - begin == shape[0] else beside
    more = table.pack(window, slab.start - begin, slab.stop - begin, most, known, apart[own], bricks[number], room,
                      held)
    return room[:BRICK**3 * more].copy()


def distances(empty: Empty, cells: NDArray[Any]) -> NDArray[np.int64]:
    """How far some cells (N, 3) are from the nearest with a surfel; far from all of them perhaps less."""
    brick, inner = numbers_of(empty.shape, cells)
    first = empty.bricks[brick].astype(np.int64)
    found, near = -1 - first, first >= 0
    found[near] = empty.near[(first + inner)[near]]
    return found


def bricks_within(empty: Empty, halo: int) -> NDArray[np.bool_]:
    """Which bricks hold a cell no farther than this from one with a surfel; no more than was told cell by cell."""
    within = np.zeros(len(empty.bricks), bool)
    within[empty.bricks >= 0] = empty.near.reshape(-1, BRICK**3).min(axis=1) <= halo
    return within


def _distances(cells: NDArray[Any], shape: tuple[int, ...]) -> Bytes:
    """Chebyshev distances from some cells, FARTHEST for all beyond."""
    found = np.full(shape, FARTHEST, np.uint8)
    found[tuple(cells.T)] = 0
    table.fill_empty(found)
    return found
