"""Work in pieces over a pool of threads, which ends early when it is stopped."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from threading import Event
from typing import TypeVar

from jaart.core.errors import Cancelled

Piece = TypeVar("Piece")


def do_each(work: Callable[[Piece], None], pieces: Sequence[Piece], threads: int | None = None,
            cancel: Event | None = None, progress: Callable[[int, int], None] | None = None) -> None:
    """Do the work of every piece.

    threads: as many as the machine has when None; progress(done, all pieces) is called from the caller's thread; what
    it raises ends the work after the pieces that are under way, as an interrupt does. Raises Cancelled after cancel
    was set.
    """
    with ThreadPoolExecutor(threads or os.cpu_count() or 1) as pool:
        tasks = [pool.submit(work, piece) for piece in pieces]
        try:
            for done, task in enumerate(tasks, 1):
                task.result()
                if cancel is not None and cancel.is_set():
                    raise Cancelled("the work was cancelled")
                if progress is not None:
                    progress(done, len(tasks))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
