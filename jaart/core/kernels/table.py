"""How far from surfels a lattice's cells are, and how far surfels reach."""

from __future__ import annotations

from math import ceil

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array

Ints = NDArray[np.int32]


@kernel(STRICT)
def near_box(cell: int, offset: float, radius: float, n: int) -> tuple[int, int]:
    """First and one past the last index along an axis whose cell's centre may lie within radius of a surfel."""
    return max(cell + int(ceil(offset - radius)), 0), min(cell + int(np.floor(offset + radius)) + 1, n)


@kernel(STRICT, entry=True)
def widest(cells: Ints, offsets: Array, radius: float, empty: NDArray[np.uint8], most: int) -> int:
    """The most cells that lie between one with a surfel within a radius of its centre and the nearest with one in it.

    cells, offsets: (N, 3) cell of each surfel, its position relative to that cell's centre; empty: of the lattice, as
    `fill_empty` leaves it; most: what no surfel can exceed, where the search ends.
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
                    if int(empty[i, j, k]) > found and x * x + y * y + z * z <= radius * radius:
                        found = int(empty[i, j, k])
        if found >= most:
            break
    return found


@kernel(STRICT)
def least_ahead(line: NDArray[np.uint8], i: int) -> int:
    """The least of max(line[j], |i - j|) over a line: its distances carried along the line to place i."""
    best, reach = int(line[i]), 1
    while reach < best:
        if i >= reach:
            best = min(best, max(int(line[i - reach]), reach))
        if i + reach < line.shape[0]:
            best = min(best, max(int(line[i + reach]), reach))
        reach += 1
    return best


@kernel(STRICT, entry=True, allocates=True)
def fill_empty(empty: NDArray[np.uint8]) -> None:
    """Turn 0 at cells with a surfel and 255 elsewhere into Chebyshev distances, in place.

    The distances are carried along z, then along y, then along x.
    """
    nx, ny, nz = empty.shape
    line = np.empty(max(nx, max(ny, nz)), np.uint8)
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                line[k] = empty[i, j, k]
            for k in range(nz):
                empty[i, j, k] = least_ahead(line[:nz], k)
        for k in range(nz):
            for j in range(ny):
                line[j] = empty[i, j, k]
            for j in range(ny):
                empty[i, j, k] = least_ahead(line[:ny], j)
    for j in range(ny):
        for k in range(nz):
            for i in range(nx):
                line[i] = empty[i, j, k]
            for i in range(nx):
                empty[i, j, k] = least_ahead(line[:nx], i)
