"""How far from surfels a lattice's cells are, and how far surfels reach."""

from __future__ import annotations

from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.empty_space import away
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Empty

Ints = NDArray[np.int32]
Distances = NDArray[np.uint8]
_BEFORE: Any = np.int64(-1)
_BEHIND: Any = np.int64(1)
_ONE, _TWO = np.uint64(1), np.uint64(2)


@kernel(STRICT)
def near_box(cell: int, offset: float, radius: float, n: int) -> tuple[int, int]:
    """First and one past the last index along an axis whose cell's centre may lie within radius of a surfel."""
    return max(cell + int(ceil(offset - radius)), 0), min(cell + int(np.floor(offset + radius)) + 1, n)


@kernel(STRICT, entry=True)
def widest(cells: Ints, offsets: Array, radius: float, empty: Empty, most: int) -> int:
    """The most cells that lie between one with a surfel within a radius of its centre and the nearest with one in it.

    cells, offsets: (N, 3) cell of each surfel, its position relative to that cell's centre; empty: of the lattice, told
    cell by cell up to most, which no surfel can exceed; there the search ends.
    """
    found = 0
    for s in range(cells.shape[0]):
        i0, i1 = near_box(cells[s, 0], offsets[s, 0], radius, empty.shape[0])
        j0, j1 = near_box(cells[s, 1], offsets[s, 1], radius, empty.shape[1])
        k0, k1 = near_box(cells[s, 2], offsets[s, 2], radius, empty.shape[2])
        for i in range(i0, i1):
            x = (cells[s, 0] - i) + offsets[s, 0]
            for j in range(j0, j1):
                y = (cells[s, 1] - j) + offsets[s, 1]
                for k in range(k0, k1):
                    z = (cells[s, 2] - k) + offsets[s, 2]
                    if x * x + y * y + z * z <= radius * radius:
                        found = max(found, away(empty, (i, j, k)))
        if found >= most:
            break
    return found


#: The largest distance there is.
_FARTHEST = 255


@kernel(STRICT)
def lessen(beside: Distances, empty: Distances, i: int, j: int) -> None:
    """Lessen the distances of a row along z to those of row (i, j), if there is one; beside: (nz + 2,)."""
    if not (0 <= i < empty.shape[0] and 0 <= j < empty.shape[1]):
        return
    other = empty[i, j]
    for k in range(np.uint64(other.shape[0])):
        beside[k + _ONE] = min(beside[k + _ONE], other[k])


@kernel(STRICT)
def carry(own: Distances, beside: Distances) -> None:
    """Lessen the distances of a row to one more than the least of those beside it."""
    for k in range(np.uint64(own.shape[0])):
        least = min(min(beside[k], beside[k + _ONE]), beside[k + _TWO])
        own[k] = min(own[k], np.uint8(least + (least < _FARTHEST)))


@kernel(STRICT)
def sweep(empty: Distances, beside: Distances, i: int, j: int, way: int) -> None:
    """Lessen the distances of a row by those of the rows, and then the cells, before it; way: -1 or 1 to those.

    beside: (nz + 2,) scratch.
    """
    own, n = empty[i, j], empty.shape[2]
    for k in range(np.uint64(n + 2)):
        beside[k] = _FARTHEST
    for aside in range(-1, 2):
        lessen(beside, empty, i + way, j + aside)
    lessen(beside, empty, i, j + way)
    carry(own, beside)
    last = _FARTHEST
    for step in range(n):
        k = step if way < 0 else n - 1 - step
        last = min(int(own[k]), last + 1)
        own[k] = last


@kernel(STRICT, entry=True, allocates=True)
def fill_empty(empty: Distances) -> None:
    """Turn 0 at cells with a surfel and 255 elsewhere into Chebyshev distances, in place, 255 for all beyond.

    Each cell takes one more than its nearest neighbour of those before it, then of those behind it: two sweeps are
    enough for this distance [Rosenfeld & Pfaltz 1966].
    """
    nx, ny, nz = empty.shape
    row = np.empty(nz + 2, np.uint8)
    for i in range(nx):
        for j in range(ny):
            sweep(empty, row, i, j, _BEFORE)
    for i in range(nx - 1, -1, -1):
        for j in range(ny - 1, -1, -1):
            sweep(empty, row, i, j, _BEHIND)


@kernel(STRICT, inline=True)
def least_in(window: Distances, first: int, end: int, j: int, k: int) -> int:
    """The least distance of a brick's cells, which begins in cell (first, j, k) and ends before plane `end`."""
    least = _FARTHEST
    for x in range(first, min(first + 4, end)):
        for y in range(j, min(j + 4, window.shape[1])):
            for z in range(k, min(k + 4, window.shape[2])):
                least = min(least, int(window[x, y, z]))
    return least


@kernel(STRICT, inline=True)
def copy_brick(window: Distances, first: int, end: int, j: int, k: int, near: Distances, at: int) -> None:
    """Write down a brick's distances; cells beyond the lattice are far."""
    for x in range(4):
        for y in range(4):
            for z in range(4):
                held = first + x < end and j + y < window.shape[1] and k + z < window.shape[2]
                near[at + 16 * x + 4 * y + z] = window[first + x, j + y, k + z] if held else _FARTHEST


@kernel(STRICT, entry=True)
def pack(window: Distances, first: int, end: int, most: int, known: int, apart: Distances, bricks: Ints,
         near: Distances, before: int) -> int:
    """Write down the bricks of the planes first … end of a window of distances; returns how many cell by cell.

    Those are the ones that hold a distance of `most` or less. known: distances beyond it are but known to be greater;
    apart: (b, c, d) of the planes' bricks, how many bricks the nearest with a surfel is away; bricks: (b·c·d,) of
    Empty; near: room; before: how many were written cell by cell before these.
    """
    held, at = 0, 0
    for a in range(apart.shape[0]):
        for b in range(apart.shape[1]):
            for c in range(apart.shape[2]):
                least = least_in(window, first + 4 * a, end, 4 * b, 4 * c)
                if least <= most:
                    copy_brick(window, first + 4 * a, end, 4 * b, 4 * c, near, 64 * held)
                    bricks[at] = 64 * (before + held)
                    held += 1
                else:
                    bricks[at] = -1 - (least if least <= known else max(known + 1, 4 * int(apart[a, b, c]) - 3))
                at += 1
    return held
