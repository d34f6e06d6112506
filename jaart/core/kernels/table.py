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
def carry(empty: Distances, row: Distances, i: int, j: int) -> None:
    """Lessen the distances of a row along z to one more than those of its neighbours in row (i, j), if there is one.

    row: (nz + 2,), with an end on each side that is no cell.
    """
    if not (0 <= i < empty.shape[0] and 0 <= j < empty.shape[1]):
        return
    other, last = empty[i, j], empty.shape[2] - 1
    for k in range(last + 1):
        nearest = min(min(other[max(k - 1, 0)], other[k]), other[min(k + 1, last)])
        row[k + 1] = min(int(row[k + 1]), int(nearest) + 1)


@kernel(STRICT)
def sweep(empty: Distances, row: Distances, i: int, j: int, way: int) -> None:
    """Lessen the distances of a row by those of the rows, and then the cells, before it; way: -1 or 1 to those."""
    n = empty.shape[2]
    for k in range(n):
        row[k + 1] = empty[i, j, k]
    for beside in range(-1, 2):
        carry(empty, row, i + way, j + beside)
    carry(empty, row, i, j + way)
    for step in range(n):
        k = step + 1 if way < 0 else n - step
        row[k] = min(int(row[k]), int(row[k + way]) + 1)
    for k in range(n):
        empty[i, j, k] = row[k + 1]


@kernel(STRICT, entry=True, allocates=True)
def fill_empty(empty: Distances) -> None:
    """Turn 0 at cells with a surfel and 255 elsewhere into Chebyshev distances, in place, 255 for all beyond.

    Each cell takes one more than its nearest neighbour of those before it, then of those behind it: two sweeps are
    enough for this distance [Rosenfeld & Pfaltz 1966].
    """
    nx, ny, nz = empty.shape
    row = np.full(nz + 2, _FARTHEST, np.uint8)
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
