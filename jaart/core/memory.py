"""How much memory a computation may take, so that a huge size is refused before it is tried."""

from __future__ import annotations

import os


def limit() -> int:
    """Bytes that one array may take: half of the machine's memory, 4 GiB where that is unknown."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2
    except (AttributeError, ValueError, OSError):
        return 4 << 30


def words(size: float) -> str:
    """A number of bytes for people, such as 1.5 GiB."""
    for unit in ("bytes", "KiB", "MiB", "GiB", "TiB", "PiB"):
        if size < 1024 or unit == "PiB":
            break
        size /= 1024
    return f"{size:.3g} {unit}"
