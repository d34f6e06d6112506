"""The surfels nearest to a cell of a lattice: found within a radius that grows until there are enough of them."""

from __future__ import annotations

from math import sqrt
from typing import Any

from jaart.core.kernels.address import floats_at, ids_at, points_at, wholes_at
from jaart.core.kernels.blocks import AT, free_ids, ids_in, lay
from jaart.core.kernels.cell_gather import (
    CELLS,
    COUNT,
    HALO,
    LENGTHS,
    NX,
    NY,
    OFFSETS,
    ORDER,
    ROWS,
    WANTED,
    block_with,
    find,
    first_from,
)
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Cell, Numbers

#: Where the search begins, in cells, and by what its radius grows.
_FIRST, _GROWS = 1.5, 1.4
#: More than rounding may move a distance, as a share of it.
_SLACK = 1e-12


@kernel(STRICT)
def is_near(pool: Numbers, cell: Cell) -> bool:
    """Whether a surfel lies in a cell that is no more than HALO cells away."""
    order, cells = ids_at(pool[ORDER], pool[COUNT]), ids_at(pool[CELLS], 3 * pool[COUNT])
    rows, halo = wholes_at(pool[ROWS], pool[NX] * pool[NY] + 1), pool[HALO]
    for i in range(max(cell[0] - halo, 0), min(cell[0] + halo + 1, pool[NX])):
        for j in range(max(cell[1] - halo, 0), min(cell[1] + halo + 1, pool[NY])):
            end = rows[i * pool[NY] + j + 1]
            at = first_from(cells, order, rows[i * pool[NY] + j], end, cell[2] - halo)
            if at < end and cells[3 * order[at] + 2] <= cell[2] + halo:
                return True
    return False


@kernel(STRICT)
def squared(cells: Any, offsets: Array, cell: Cell, s: int) -> float:
    """The squared distance of a surfel from a cell's centre."""
    x, y = (cells[3 * s] - cell[0]) + offsets[s, 0], (cells[3 * s + 1] - cell[1]) + offsets[s, 1]
    z = (cells[3 * s + 2] - cell[2]) + offsets[s, 2]
    return x * x + y * y + z * z


@kernel(STRICT)
def is_before(cells: Any, offsets: Array, cell: Cell, a: int, b: int) -> bool:
    """Whether surfel a is nearer to a cell's centre than b; of two that are equally far the first one is."""
    one, other = squared(cells, offsets, cell, a), squared(cells, offsets, cell, b)
    return one < other or (one == other and a < b)


@kernel(STRICT)
def select(cells: Any, offsets: Array, cell: Cell, ids: Any, size: int, k: int) -> None:
    """Put the k nearest of some surfels first, by Hoare's selection."""
    left, right = 0, size - 1
    while left < right:
        pivot, i, j = ids[(left + right) // 2], left, right
        while i <= j:
            while is_before(cells, offsets, cell, ids[i], pivot):
                i += 1
            while is_before(cells, offsets, cell, pivot, ids[j]):
                j -= 1
            if i <= j:
                ids[i], ids[j] = ids[j], ids[i]
                i, j = i + 1, j - 1
        if k - 1 <= j:
            right = j
        elif k - 1 >= i:
            left = i
        else:
            break


@kernel(STRICT)
def gather_nearest(pool: Numbers, cell: Cell) -> int:
    """Gather the surfels nearest to a cell's centre, their ids rising, and those that are but so much farther.

    Returns the block's address, 0 where there is no room.
    """
    if not is_near(pool, cell):
        return lay(pool, 0)
    lengths, k, room = floats_at(pool[LENGTHS], 3), min(pool[WANTED], pool[COUNT]), free_ids(pool)
    ids = ids_at(ids_in(pool, pool[AT]), room)
    radius, size = _FIRST, find(pool, cell, _FIRST, ids)
    while size < k:
        radius *= _GROWS
        size = find(pool, cell, radius, ids)
    if size > room:
        return lay(pool, size)
    cells, offsets = ids_at(pool[CELLS], 3 * pool[COUNT]), points_at(pool[OFFSETS], pool[COUNT])
    select(cells, offsets, cell, ids, size, k)
    if lengths[2] > 0.0:
        farthest = 0.0
        for a in range(k):
            farthest = max(farthest, squared(cells, offsets, cell, ids[a]))
        k = find(pool, cell, sqrt(farthest) * (1.0 + _SLACK) + lengths[2], ids)
    return block_with(pool, cell, k)
