"""Memory of pictures that were let go, used for the next ones.

A system clears every page that it hands out and enters it on first use, which takes a tenth of a quick picture's time.
"""

from __future__ import annotations

import math
from typing import Any
from weakref import finalize

import numpy as np
from numpy.typing import NDArray

from jaart.core import memory

#: Smaller arrays are as quickly made anew. Of what was let go so many bytes are kept at most, and no more than this
#: share of what one array may take.
LEAST, MOST, SHARE = 1 << 20, 512 << 20, 0.125

Bytes = NDArray[np.uint8]


class Shelf:
    """Rooms that nobody uses, the one let go last at the end.

    Each step is a single one of a dictionary: any thread may come, and an array may be let go at any moment.
    """

    def __init__(self) -> None:
        self._free: dict[int, Bytes] = {}

    @property
    def kept(self) -> int:
        """Bytes that lie here."""
        return sum(room.nbytes for room in tuple(self._free.values()))

    def put(self, room: Bytes) -> None:
        """Keep a room; those let go first are given up where all are too much."""
        self._free[id(room)] = room
        while self.kept > min(MOST, SHARE * memory.limit()):
            self._free.pop(next(iter(tuple(self._free)), 0), None)  # another thread may have taken the last

    def take(self, size: int) -> Bytes:
        """Room of just so many bytes, from here where there is one."""
        for number, room in tuple(self._free.items()):
            if room.nbytes == size and self._free.pop(number, None) is not None:
                return room
        return np.empty(size, np.uint8)


class _Lent:
    """What an array that is made of a room holds on to."""

    def __init__(self, room: Bytes) -> None:
        self._room = room

    @property
    def __array_interface__(self) -> dict[str, Any]:
        return dict(self._room.__array_interface__)


SHELF = Shelf()


def lent(shape: tuple[int, ...], kind: type[Any] = np.float64) -> NDArray[Any]:
    """An array of anything, as numpy.empty makes, in memory that comes back when the last view of it is let go."""
    size = math.prod(shape) * np.dtype(kind).itemsize
    if size < LEAST:
        return np.empty(shape, kind)
    room = SHELF.take(size)
    holder = _Lent(room)
    finalize(holder, SHELF.put, room).atexit = False
    array: NDArray[Any] = np.asarray(holder).view(kind).reshape(shape)
    return array
