"""What is gathered near a place lies in a block; blocks lie one behind another in chunks, each filled by one thread.

A block: how many surfels; what is kept of the place's centre, where anything is; their ids, where these are kept; then
x, y, z of all of them relative to the centre, and the parts of the normals where there are any, each contiguous. Each
column is filled up to whole vectors with surfels that count nothing: sums may run over them, and no loop over what a
vector leaves is needed. They are so far away that their weight is 3e-308, which no sum that counts can tell from 0.

A thread has a pool of numbers that say where its next block goes, what it lacked, and what blocks are gathered from.
Two threads that gather the same place at once write two equal blocks; the first one's stays, the other takes its own
back.
"""

from __future__ import annotations

from jaart.core.kernels.address import fetch, set_once, wholes_at
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Numbers

#: A pool. GATHERER: address of the kernel that gathers; EMPTY: that of a block without surfels; AT: where the next
#: block goes; LEFT: bytes from there on; NEED: of a block that did not fit; ROOM: surfels that the scratch is for;
#: MORE: of a place that has more; HEAP: 1 where a heap was full; GATHERED, FITTED: places so far, and those whose
#: centre is kept; BYTES: of all blocks; PARTS: columns; KEPT: numbers kept of a centre; ASKED, ROWS: addresses of
#: what says whether a cell's centre is kept, and of what is (first_guess.py); LISTED: 1 where ids are kept, else 0;
#: from SOURCE on: what the gatherer needs to know.
(GATHERER, EMPTY, AT, LEFT, NEED, ROOM, MORE, HEAP, GATHERED, FITTED, BYTES, PARTS, KEPT, ASKED, ROWS, LISTED,
 SOURCE) = range(17)
#: Words of a pool.
POOL_SIZE = SOURCE + 12
_WORD = 8
#: Words that come from memory at a time.
LINE = 8
#: A column is as long as a multiple of this, and what fills it up is so far from every centre.
VECTOR, NOWHERE = 8, 1e120


@kernel(STRICT)
def is_short(pool: Numbers) -> bool:
    """Whether something did not fit, so that what was computed since does not count."""
    return pool[NEED] > 0 or pool[MORE] > 0 or pool[HEAP] > 0


@kernel(STRICT)
def kept_in(address: int) -> int:
    """Where in a block begins what it keeps of the place's centre."""
    return address + _WORD


@kernel(STRICT, inline=True)
def fetch_centre(address: int) -> None:
    """Fetch ahead what a block keeps of its place's centre, up to a polynomial of degree 2."""
    for line in range(3):
        fetch(wholes_at(address, 1), line * LINE)


@kernel(STRICT, inline=True)
def fetch_surfels(address: int) -> None:
    """Fetch ahead most of what a block of usual size holds of surfels."""
    for line in range(4, 36):
        fetch(wholes_at(address, 1), line * LINE)


@kernel(STRICT)
def ids_in(pool: Numbers, address: int) -> int:
    """Where in a block the ids begin."""
    return address + _WORD * (1 + pool[KEPT])


@kernel(STRICT)
def columns_in(pool: Numbers, address: int, size: int) -> int:
    """Where in a block of so many surfels the columns begin."""
    return address + _WORD * (1 + pool[KEPT] + pool[LISTED] * ((size + 1) // 2))


@kernel(STRICT)
def free_ids(pool: Numbers) -> int:
    """How many ids the next block has room for at most."""
    return max((pool[LEFT] - _WORD * (1 + pool[KEPT])) // 4, 0)


@kernel(STRICT)
def spare_ids(pool: Numbers) -> tuple[int, int]:
    """Address of the farther half of this thread's room, where ids that are not kept are written down, and how many."""
    count = pool[LEFT] // _WORD
    return pool[AT] + pool[LEFT] - 4 * count, count


@kernel(STRICT)
def wide_of(size: int) -> int:
    """How long the columns of so many surfels are."""
    return (size + VECTOR - 1) // VECTOR * VECTOR


@kernel(STRICT)
def fill_up(columns: Array, parts: int, size: int) -> None:
    """Write what follows so many surfels in each column."""
    wide = wide_of(size)
    for part in range(parts):
        for i in range(part * wide + size, (part + 1) * wide):
            columns[i] = NOWHERE if part < 3 else 0.0


@kernel(STRICT)
def lay(pool: Numbers, size: int) -> int:
    """Address of the next block, which has so many surfels; 0 where there is no room."""
    if size == 0 and pool[KEPT] == 0:
        return pool[EMPTY]
    length = columns_in(pool, 0, size) + _WORD * pool[PARTS] * wide_of(size)
    spare = 0 if pool[LISTED] == 1 else 4 * spare_ids(pool)[1]
    if length > pool[LEFT] - spare:
        pool[NEED] = max(pool[NEED], length if pool[LISTED] == 1 else 2 * length)
        return 0
    address = pool[AT]
    wholes_at(address, 1)[0] = size
    pool[AT] += length
    pool[LEFT] -= length
    pool[BYTES] += length
    return address


@kernel(STRICT)
def take_back(pool: Numbers, address: int) -> None:
    """Have the room of this thread's last block again."""
    if address != pool[EMPTY]:
        pool[LEFT] += pool[AT] - address
        pool[BYTES] -= pool[AT] - address
        pool[AT] = address


@kernel(STRICT)
def publish(slots: Numbers, number: int, address: int, pool: Numbers) -> int:
    """Let all threads know where a place's block lies, this thread's last; returns the one that they all use."""
    before = set_once(slots, number, address)
    if before == 0:
        pool[GATHERED] += 1
        return address
    take_back(pool, address)
    return before
