"""The memory that some work takes at its peak, where the system tells: Linux."""

from __future__ import annotations

import ctypes
import gc
import re
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

PROCESS = Path("/proc/self")
MIB = 1 << 20

T = TypeVar("T")


def peak(work: Callable[[], T]) -> tuple[T, float | None]:
    """What the work gave, and how many MiB the process grew by at most meanwhile; None where nobody knows.

    Memory that an earlier work gave back is handed to the system first, so that it is not taken for free.
    """
    gc.collect()
    before = _begin()
    result = work()
    return result, None if before is None else max(0.0, (_bytes("VmHWM") - before) / MIB)


def highest() -> int | None:
    """The most bytes of memory that the process had since `peak` was asked last, None where nobody knows."""
    try:
        return _bytes("VmHWM")
    except OSError:
        return None


def resident() -> int | None:
    """Bytes of memory that the process has now, None where nobody knows."""
    try:
        return _bytes("VmRSS")
    except OSError:
        return None


def _begin() -> int | None:
    """Resident bytes now; the highest mark begins anew."""
    try:
        ctypes.CDLL(None).malloc_trim(0)
        (PROCESS / "clear_refs").write_text("5")
        return _bytes("VmRSS")
    except (OSError, AttributeError, TypeError):
        return None


def _bytes(name: str) -> int:
    found = re.search(rf"^{name}:\s+(\d+) kB", (PROCESS / "status").read_text(), flags=re.M)
    if found is None:
        raise OSError(f"/proc/self/status names no {name}")
    return 1024 * int(found[1])
