"""Files that are being written, for a process that has to end before they are whole."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

#: Temporary files, and whose turn it is to begin or to finish one.
PARTS: set[Path] = set()
TURN = threading.Lock()


@contextmanager
def none_written() -> Iterator[None]:
    """Remove what is being written; no file is begun or finished in the block. For a process that ends in it."""
    with TURN:
        for part in list(PARTS):
            with suppress(OSError):  # some systems keep a file that is open
                part.unlink(missing_ok=True)
        yield
