"""What a person sees on a terminal while work takes over a second; nothing in a pipe."""

from __future__ import annotations

import shutil
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from jaart.core.telling import doing, told, watcher

#: Work that is done sooner shows nothing [s]; a bar is drawn anew so often [s].
QUIET, TICK = 1.0, 0.25
#: How a stage is shown of which nobody knows how much there is.
_ENDLESS = "{desc} {elapsed}"


class Bar:
    """One line on stderr: what is being made, how far it is, and for how long.

    A thread draws it, so that it moves also while a library works and says nothing.
    """

    def __init__(self) -> None:
        self._bar: Any = None
        self._now: tuple[str, int, int] = ("", 0, 0)
        self._since = time.monotonic()
        self._stop, self._lock = threading.Event(), threading.Lock()
        self._thread = threading.Thread(target=self._draw, name="jaart bar", daemon=True)
        self._thread.start()

    def tell(self, what: str, done: int, total: int) -> None:
        """Show this from now on; see `telling.Watcher`."""
        with self._lock:
            if what != self._now[0]:
                self._clear()
                self._since = time.monotonic()
            self._now = what, done, total

    def close(self) -> None:
        """Leave the line empty."""
        self._stop.set()
        self._thread.join()
        self._clear()

    def _draw(self) -> None:
        while not self._stop.wait(TICK):
            with self._lock:
                if self._now[0] and time.monotonic() - self._since > QUIET:
                    self._show(*self._now)

    def _show(self, what: str, done: int, total: int) -> None:
        from tqdm import tqdm

        if self._bar is not None and bool(self._bar.total) != bool(total):
            self._clear()
        if self._bar is None:
            columns, rows = shutil.get_terminal_size()  # 80 and 24 for a terminal that does not tell
            self._bar = tqdm(desc=what, total=total or None, unit_scale=True, leave=False, delay=TICK,
                             ncols=columns, nrows=rows, bar_format=None if total else _ENDLESS)
            self._bar.start_t -= time.monotonic() - self._since
        self._bar.total, self._bar.n = total or None, done
        self._bar.refresh()

    def _clear(self) -> None:
        if self._bar is not None:
            self._bar.close()
            self._bar = None


@contextmanager
def shown() -> Iterator[None]:
    """Show on a terminal what is made in the block."""
    if not sys.stderr.isatty():
        yield
        return
    bar = Bar()
    try:
        with told(bar.tell):
            yield
    finally:
        bar.close()


@contextmanager
def counted(what: str, alone: bool = False) -> Iterator[Callable[[int, int], None] | None]:
    """A function (done, all) that shows how far this work is, None where nobody looks.

    alone: what is made meanwhile is not shown.
    """
    tell = watcher()
    if tell is None:
        yield None
        return
    with doing(what), told(None if alone else tell):
        yield lambda done, total: tell(what, done, total)
