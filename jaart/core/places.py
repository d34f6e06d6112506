"""Where what is gathered near places is kept, in room that grows as rays ask for it.

A place is gathered by the ray that comes to it first (kernels/blocks.py). Each thread has a pool of its own. Where a
pool is short of room, the ray it was short for is traced anew when there is more; so nothing that was traced is lost,
and the result is that of any other room.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Lock
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from jaart.core import memory
from jaart.core.addresses import address_of
from jaart.core.bricks import brick_slots, bricks_of, slot_numbers
from jaart.core.errors import NoRoom
from jaart.core.kernels import blocks, call, cell_gather, gather, near
from jaart.core.kernels.guess import GUESS_WIDTH
from jaart.core.kernels.records import FIT_SIZE, Cell, Sites
from jaart.core.scene import Array

Ints = NDArray[np.int64]
T = TypeVar("T")

#: Bytes of the first chunk, unless a block is longer, and how many times as many a later one has: from 4 MiB on the
#: system may hand out large pages, of which fewer are to be cleared and entered.
CHUNK, LARGER = 1 << 20, 8
#: Scratch is for so many surfels, and the heap for so many entries, until a place or a ray needs more.
SURFELS, HEAP = 256, 4096
#: Scratch for each surfel that may be near a point: its row of a fit, its weights, its number among those with one.
SCRATCH_A_SURFEL = 25
#: Words of the block of places that no surfel is near: any number that is asked of it can be read.
_EMPTY_WORDS = 64


class Kept(NamedTuple):
    """What is kept so far.

    gathered: places that were asked for; fits: planes or polynomials at their centres; chunks: that
    blocks lie in; block_bytes: of all blocks; table_bytes: of the table of addresses and of what only is gathered from.
    """

    gathered: int
    fits: int
    chunks: int
    block_bytes: int
    table_bytes: int


class Pool:
    """The room of one thread. numbers: as kernels/blocks.py names them; work, fit: scratch; keys, items: of a heap."""

    def __init__(self, numbers: Ints) -> None:
        self.numbers = numbers
        self.keys, self.items = np.empty(0), np.empty(0, np.int64)
        self.work, self.fit = np.empty(0), np.zeros(FIT_SIZE + GUESS_WIDTH)
        self._fit_for(SURFELS)

    def short(self) -> bool:
        """Whether something did not fit."""
        return bool(self.numbers[[blocks.NEED, blocks.MORE, blocks.HEAP]].any())

    def enlarge(self, places: Places) -> None:
        """Have room for what did not fit."""
        numbers = self.numbers
        if need := int(numbers[blocks.NEED]):
            numbers[blocks.AT], numbers[blocks.LEFT] = places.chunk(need)
        if more := int(numbers[blocks.MORE]):
            self._fit_for(2 * more)
        if numbers[blocks.HEAP]:
            self.have_heap(2 * len(self.keys))
        numbers[[blocks.NEED, blocks.MORE, blocks.HEAP]] = 0

    def have_heap(self, entries: int) -> None:
        """Have room for so many entries of a heap at least."""
        if len(self.keys) < entries:
            self.keys, self.items = np.empty(entries), np.empty(entries, np.int64)

    def _fit_for(self, surfels: int) -> None:
        self.work, _ = scratch(surfels)
        self.numbers[blocks.ROOM] = surfels


class Places:
    """Places, and all that was gathered near them.

    shape, centres, slots: as of Sites; gatherer: kernel; source: numbers that it needs, `address` of arrays among them;
    parts: columns of a block; kept: numbers kept of a centre; alive: the arrays whose addresses are in the source;
    what: names in an error what asks for so much memory; listed: whether blocks keep ids, else they are found anew.
    """

    def __init__(self, shape: Cell, centres: Array, slots: Ints, gatherer: Any, source: list[int], parts: int,
                 kept: int, alive: tuple[Any, ...], what: str, listed: bool = True) -> None:
        self._numbers, self._what, self.alive = np.zeros(blocks.POOL_SIZE, np.int64), what, alive
        self.chunks: list[Array] = [np.zeros(_EMPTY_WORDS)]
        self._pools: list[Pool] = []
        self._free: list[Pool] = []
        self._lock = Lock()
        first = {blocks.GATHERER: address_of(gatherer, call.GATHER), blocks.EMPTY: address(self.chunks[0]),
                 blocks.ROOM: np.iinfo(np.int64).max, blocks.PARTS: parts, blocks.KEPT: kept,
                 blocks.LISTED: int(listed)}
        for word, value in first.items():
            self._numbers[word] = value
        self._numbers[blocks.SOURCE:blocks.SOURCE + len(source)] = source
        self._shape, self._centres, self.slots = shape, centres, slots

    @property
    def sites(self) -> Sites:
        """The places as kernels see them. The base of the pool is this object: who holds it holds all of this."""
        return Sites(self._shape, self._centres, self.slots, np.asarray(self))

    @property
    def __array_interface__(self) -> dict[str, Any]:
        """The numbers that each pool begins with."""
        return dict(self._numbers.__array_interface__)

    @contextmanager
    def pool(self) -> Iterator[Pool]:
        """A pool that no other thread has meanwhile."""
        with self._lock:
            pool = self._free.pop() if self._free else None
            if pool is None:
                pool = Pool(self._numbers.copy())
                self._pools.append(pool)
        try:
            yield pool
        finally:
            with self._lock:
                self._free.append(pool)

    def chunk(self, need: int) -> tuple[int, int]:
        """Address and bytes of one more chunk, which has room for so many. Raises NoRoom where memory ends."""
        made = np.empty(-(-max(need, CHUNK * min(len(self.chunks), LARGER)) // 8))
        with self._lock:
            size = sum(one.nbytes for one in (*self.chunks, made))
            if size > memory.limit():
                raise NoRoom(memory.too_much(size, self._what), self)
            self.chunks.append(made)
        return address(made), made.nbytes

    def count(self, word: int) -> int:
        """Sum of a number over all threads."""
        return sum(int(pool.numbers[word]) for pool in self._pools)

    @property
    def kept(self) -> Kept:
        """How much is kept so far; exact while no ray is traced."""
        table = int(self.slots.nbytes) + sum(int(one.nbytes) for one in self.alive)
        return Kept(self.count(blocks.GATHERED), self.count(blocks.FITTED), len(self.chunks) - 1,
                    self.count(blocks.BYTES), table)


def address(array: NDArray[Any]) -> int:
    """Where an array begins; it must be contiguous."""
    assert array.flags.c_contiguous
    return int(array.ctypes.data)


def places_of(sites: Sites) -> Places:
    """The places that sites were made for."""
    return cast(Places, sites.pool.base)


def served(sites: Sites, ask: Callable[[Sites, Pool], T]) -> T:
    """What a function answers that asks for what is near places, asked again until there was room for all of it."""
    places = places_of(sites)
    with places.pool() as pool:
        while True:
            answer = ask(sites._replace(pool=pool.numbers), pool)
            if not pool.short():
                return answer
            pool.enlarge(places)


def neighbours_of(sites: Sites, place: tuple[int, ...]) -> NDArray[np.int32]:
    """Ids (N,) of the surfels near a place: a cell (i, j, k) or a ball (number, 0, 0)."""
    return listed_near(sites, np.array([place]))[1]


def listed_near(sites: Sites, places: Ints) -> tuple[Ints, NDArray[np.int32], Array]:
    """The surfels near some places (P, 3).

    Returns first (P + 1,), where each one's begin; ids (M,); columns (parts·M,), for each place with N of them N times
    x, then y, z relative to its centre and the three parts of the normal, where there are normals.
    """
    first, asked = np.zeros(len(places) + 1, np.int64), np.array(places, np.int64)
    served(sites, lambda own, pool: near.read(own, asked, first, np.empty(0, np.int32), np.empty(0)))
    np.cumsum(first, out=first)
    ids, columns = np.empty(first[-1], np.int32), np.empty(int(sites.pool[blocks.PARTS]) * first[-1])
    if len(ids):
        served(sites, lambda own, pool: near.read(own, asked, first, ids, columns))
    if not sites.pool[blocks.LISTED]:
        gather.read_ids(sites.pool, np.ascontiguousarray(asked[:, 0]), first, ids)
    return first, ids, columns


def listed(shape: Cell, centres: Array, first: Ints, ids: NDArray[np.int32], columns: Array) -> Sites:
    """Places whose surfels are known: first, ids, columns as `listed_near` returns them, with normals, for every ball
    or every cell in C order.
    """
    sizes = np.diff(first)
    wide = -(-sizes // blocks.VECTOR) * blocks.VECTOR
    words = 1 + (sizes + 1) // 2 + 6 * wide
    begin = np.cumsum(words) - words
    chunk = np.zeros(max(int(words.sum()), 1))
    chunk.view(np.int64)[begin] = sizes
    each = np.repeat(np.arange(len(sizes)), sizes)
    place = np.arange(len(ids)) - first[each]
    chunk.view(np.int32)[2 * (begin[each] + 1) + place] = ids
    at = begin + 1 + (sizes + 1) // 2
    for part in range(3):
        for one in range(blocks.VECTOR - 1):
            spare = (wide - sizes) > one
            chunk[(at + (part + 1) * wide - 1 - one)[spare]] = blocks.NOWHERE
    for part in range(6):
        chunk[np.repeat(at + part * wide, sizes) + place] = columns[np.repeat(5 * first[:-1] + part * sizes, sizes)
                                                                    + np.arange(len(ids))]
    blocks_at = address(chunk) + 8 * begin
    slots = blocks_at if shape[0] == 0 else _bricked(shape, blocks_at, sizes)
    return Places(shape, centres, slots, cell_gather.gather_cell, [], 6, 0, (chunk,), "the table").sites


def _bricked(shape: Cell, at: Ints, sizes: Ints) -> Ints:
    """Slots of a lattice whose cells' blocks begin at these addresses, cells in C order."""
    some = np.argwhere(sizes.reshape(shape) > 0)
    slots = brick_slots(bricks_of(shape, some))
    everywhere = np.indices(shape).reshape(3, -1).T
    number = slot_numbers(shape, slots, everywhere)
    slots[number[number >= 0]] = at[number >= 0]
    return slots


def scratch(most: int) -> tuple[Array, Array]:
    """Room for the weights and fits of so many surfels, and for what is kept of a centre, for one thread."""
    wide = -(-max(most, 1) // blocks.VECTOR) * blocks.VECTOR
    return np.empty(SCRATCH_A_SURFEL * wide), np.zeros(FIT_SIZE + GUESS_WIDTH)
