"""The surfels near a place, gathered when they are asked for first, and one number of one of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import blocks as b
from jaart.core.kernels.address import fetch, floats_at, ids_at, load, wholes_at
from jaart.core.kernels.call import gather_at
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Cell, Near, Numbers, Sites, Unsigned, Vector

_ZERO, _THREE = np.uint64(0), np.uint64(3)
#: So much of a block is fetched ahead; what follows comes by itself, one line after the other.
_LINES = 16


@kernel(STRICT, inline=True)
def place_number(sites: Sites, cell: Cell) -> int:
    """Where the address of a cell's or a ball's block stands in slots, -1 for a cell that no surfel is near."""
    if sites.shape[0] == 0:
        return cell[0]
    wide, deep = (sites.shape[1] + 3) >> 2, (sites.shape[2] + 3) >> 2
    first = load(sites.slots, ((cell[0] >> 2) * wide + (cell[1] >> 2)) * deep + (cell[2] >> 2))
    return first + (((cell[0] & 3) << 4) | ((cell[1] & 3) << 2) | (cell[2] & 3)) if first > 0 else -1


@kernel(STRICT)
def gathered(sites: Sites, cell: Cell, number: int) -> int:
    """Address of the block of a place that has none yet; that of the empty one where the pool is short.

    Only a ray's driver publishes a block in which something of the centre is to be kept, for it knows what.
    """
    pool = sites.pool
    address = gather_at(pool[b.GATHERER], pool, cell) if pool[b.NEED] == 0 else 0
    if address == 0:
        return pool[b.EMPTY]
    return b.publish(sites.slots, number, address, pool) if pool[b.KEPT] == 0 else address


@kernel(STRICT, inline=True)
def block_of(sites: Sites, cell: Cell) -> int:
    """Address of a place's block."""
    number = place_number(sites, cell)
    if number < 0:
        return sites.pool[b.EMPTY]
    address = load(sites.slots, number)
    return gathered(sites, cell, number) if address == 0 else address


@kernel(STRICT, inline=True)
def near_in(pool: Numbers, address: int) -> Near:
    """The surfels in a block; none, and the pool says so, where there are more than the scratch has room for."""
    size = wholes_at(address, 1)[0]
    if size > pool[b.ROOM]:
        pool[b.MORE] = max(pool[b.MORE], size)
        address, size = pool[b.EMPTY], 0
    wide = b.wide_of(size)
    columns = floats_at(b.columns_in(pool, address, size), pool[b.PARTS] * wide)
    return Near(columns, _ZERO, np.uint64(size), np.uint64(wide))


@kernel(STRICT, inline=True)
def surfels_near(sites: Sites, cell: Cell) -> Near:
    """The surfels near a cell of a lattice or in a ball's neighbourhood, relative to its centre.

    There are none, and the pool says so, where it is short of room for them.
    """
    return near_in(sites.pool, block_of(sites, cell))


@kernel(STRICT, inline=True)
def fetch_near(sites: Sites, cell: Cell) -> None:
    """Fetch ahead what was gathered near a cell of a lattice."""
    number = place_number(sites, cell)
    if number >= 0:
        address = load(sites.slots, number)
        for line in range(_LINES):
            fetch(wholes_at(address, 1), line * b.LINE)


@kernel(STRICT, inline=True)
def point(near: Near, i: Unsigned) -> Vector:
    """Position of surfel i, relative to the place's centre."""
    at, n = near.base + i, near.wide
    return near.columns[at], near.columns[at + n], near.columns[at + n + n]


@kernel(STRICT, inline=True)
def normal(near: Near, i: Unsigned) -> Vector:
    """Unit normal of surfel i."""
    at, n = near.base + _THREE * near.wide + i, near.wide
    return near.columns[at], near.columns[at + n], near.columns[at + n + n]


@kernel(STRICT, entry=True)
def read(sites: Sites, places: NDArray[np.int64], first: Numbers, ids: NDArray[np.int32], columns: Array) -> None:
    """Gather what is near some places (P, 3), and count it or copy it.

    first: (P + 1,) where each one's begin in ids, and as many times that in columns as there are; ids: (0,) to
    put the number of place p's surfels into first[p + 1]; they are written where blocks keep them.
    """
    pool = sites.pool
    for p in range(places.shape[0]):
        address = block_of(sites, (places[p, 0], places[p, 1], places[p, 2]))
        if b.is_short(pool):
            return
        size = wholes_at(address, 1)[0]
        if ids.shape[0] == 0:
            first[p + 1] = size
            continue
        own, wide = ids_at(b.ids_in(pool, address), size), b.wide_of(size)
        values = floats_at(b.columns_in(pool, address, size), pool[b.PARTS] * wide)
        for i in range(size):
            if pool[b.LISTED] == 1:
                ids[first[p] + i] = own[i]
            for part in range(pool[b.PARTS]):
                columns[pool[b.PARTS] * first[p] + part * size + i] = values[part * wide + i]
