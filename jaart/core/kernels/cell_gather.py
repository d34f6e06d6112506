"""The surfels near a cell of a lattice: those within a radius of its centre, or the nearest to it [T §3.1.3]."""

from __future__ import annotations

from typing import Any

from jaart.core.kernels.address import floats_at, ids_at, points_at, wholes_at
from jaart.core.kernels.blocks import AT, SOURCE, columns_in, fill_up, free_ids, ids_in, lay, wide_of
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Cell, Numbers

#: What a pool knows: cells along x and y; how many surfels; addresses of where each row of cells along z begins in
#: the order of the cells, that order, the surfels' cells, offsets and normals, and of the radius with the largest part
#: of an offset and how much farther than the nearest others may be; how many of the nearest are wanted; how far, in
#: cells, a cell that has any may be from one with a surfel.
(NX, NY, COUNT, ROWS, ORDER, CELLS, OFFSETS, NORMALS, LENGTHS, WANTED, HALO) = range(SOURCE, SOURCE + 11)
#: Cells along an axis from which on all are looked through.
_WIDEST = 1e9


@kernel(STRICT)
def first_from(cells: Any, order: Any, begin: int, end: int, k: int) -> int:
    """Where the first surfel of a row whose cell is k or more stands in the order."""
    low, high = begin, end
    while low < high:
        middle = (low + high) // 2
        if cells[3 * order[middle] + 2] < k:
            low = middle + 1
        else:
            high = middle
    return low


@kernel(STRICT)
def sort(ids: Any, size: int) -> None:
    """Put a few numbers that are nearly so in rising order."""
    for i in range(1, size):
        one, at = ids[i], i
        while at > 0 and ids[at - 1] > one:
            ids[at] = ids[at - 1]
            at -= 1
        ids[at] = one


@kernel(STRICT)
def find(pool: Numbers, cell: Cell, radius: float, ids: Any) -> int:
    """Write down the surfels within a radius of a cell's centre, as many as there is room for; returns how many."""
    order, cells = ids_at(pool[ORDER], pool[COUNT]), ids_at(pool[CELLS], 3 * pool[COUNT])
    rows, offsets = wholes_at(pool[ROWS], pool[NX] * pool[NY] + 1), points_at(pool[OFFSETS], pool[COUNT])
    most, found = floats_at(pool[LENGTHS], 3)[1], 0
    wide = int(min(radius + most, _WIDEST))
    for i in range(max(cell[0] - wide, 0), min(cell[0] + wide + 1, pool[NX])):
        for j in range(max(cell[1] - wide, 0), min(cell[1] + wide + 1, pool[NY])):
            across, along = max(abs(i - cell[0]) - most, 0.0), max(abs(j - cell[1]) - most, 0.0)
            if across * across + along * along > radius * radius * 1.000001:
                continue
            row = i * pool[NY] + j
            end = rows[row + 1]
            for at in range(first_from(cells, order, rows[row], end, cell[2] - wide), end):
                s = order[at]
                if cells[3 * s + 2] > cell[2] + wide:
                    break
                x, y = (i - cell[0]) + offsets[s, 0], (j - cell[1]) + offsets[s, 1]
                z = (cells[3 * s + 2] - cell[2]) + offsets[s, 2]
                if x * x + y * y + z * z <= radius * radius:
                    if found < ids.shape[0]:
                        ids[found] = s
                    found += 1
    return found


@kernel(STRICT)
def write_columns(pool: Numbers, cell: Cell, ids: Any, size: int, columns: Array) -> None:
    """The columns of a block, in the order of its ids."""
    cells, offsets = ids_at(pool[CELLS], 3 * pool[COUNT]), points_at(pool[OFFSETS], pool[COUNT])
    normals, wide = points_at(pool[NORMALS], pool[COUNT]), wide_of(size)
    fill_up(columns, 6, size)
    for a in range(size):
        s = ids[a]
        for axis in range(3):
            columns[axis * wide + a] = (cells[3 * s + axis] - cell[axis]) + offsets[s, axis]
            columns[(3 + axis) * wide + a] = normals[s, axis]


@kernel(STRICT)
def block_with(pool: Numbers, cell: Cell, size: int) -> int:
    """The block of a cell whose so many surfels' ids were written down where the next block's begin."""
    address = lay(pool, size)
    if address == 0 or size == 0:
        return address
    ids = ids_at(ids_in(pool, address), size)
    sort(ids, size)
    write_columns(pool, cell, ids, size, floats_at(columns_in(pool, address, size), 6 * wide_of(size)))
    return address


@kernel(STRICT)
def gather_cell(pool: Numbers, cell: Cell) -> int:
    """Gather the surfels near a cell, their ids rising; returns the block's address, 0 where there is no room."""
    radius = floats_at(pool[LENGTHS], 3)[0]
    return block_with(pool, cell, find(pool, cell, radius, ids_at(ids_in(pool, pool[AT]), free_ids(pool))))
