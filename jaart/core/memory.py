"""How much memory a computation may take, so that a huge size is refused before it is tried."""

from __future__ import annotations

import math
import mmap
import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.errors import SettingsError

#: Items that are worked on at a time where each takes much more room than what is kept of it.
PIECE = 1 << 12
#: Bytes that a surfel or a point of a cloud takes while rays are made ready, at most.
ITEM = 300
#: A picture asks for about one place a pixel; what is near so many of them is counted before it begins.
ASKED, COUNTED = 1 << 18, 16


def pieces(count: int, size: int = PIECE) -> Iterator[slice]:
    """Slices of so many items, one after another: what each needs meanwhile is not needed for all at once."""
    return (slice(begin, min(begin + size, count)) for begin in range(0, count, size))


def limit() -> int:
    """Bytes that one array may take: half of the machine's memory, 4 GiB where that is unknown."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2
    except (AttributeError, ValueError, OSError):
        return 4 << 30


def sparse(shape: tuple[int, ...], what: str, kind: type[Any] = np.float64) -> NDArray[Any]:
    """Zeros, of which only those pages take memory that are used: not the many that the system would take at once.

    what: names in an error what asks for them. Raises SettingsError where the system refuses.
    """
    count = math.prod(shape)
    size = max(count * np.dtype(kind).itemsize, 1)
    try:
        room = mmap.mmap(-1, size)
    except (OSError, OverflowError, ValueError):
        raise SettingsError(f"{what}: the system gives no room of {words(size)}") from None
    with suppress(AttributeError, OSError):  # only where the system has larger pages
        room.madvise(mmap.MADV_NOHUGEPAGE)
    return np.frombuffer(room, kind, count).reshape(shape)


def words(size: float) -> str:
    """A number of bytes for people, such as 1.5 GiB."""
    for unit in ("bytes", "KiB", "MiB", "GiB", "TiB", "PiB"):
        if size < 1024 or unit == "PiB":
            break
        size /= 1024
    return f"{size:.3g} {unit}"


def check(needed: float, what: str) -> None:
    """Raise SettingsError where something needs more bytes than it may take."""
    if needed > limit():
        raise SettingsError(too_much(needed, what))


def too_much(needed: float, what: str) -> str:
    """What to say of something that needs more bytes than it may take."""
    return f"{what}: needs {words(needed)} of memory, more than the {words(limit())} it may take"


def room_for_all(count: int, parts: int) -> bool:
    """Whether there is room even if all of so many surfels were near each place that a picture asks for."""
    return min(count, ASKED) * count * (8 * parts + 4) <= limit()


def check_near(sizes: Sequence[int], places: int, parts: int, what: str) -> None:
    """Raise SettingsError where what is near the places that a picture asks for would not fit.

    sizes: how many surfels are near some places; places: how many there are; parts: numbers kept of each surfel.
    """
    check(sum(sizes) / max(len(sizes), 1) * min(places, ASKED) * (8 * parts + 4), what)
