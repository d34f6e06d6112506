"""Ctrl-C ends a command and every thread that works for it."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event

from jaart.core.errors import Cancelled


@contextmanager
def interruptible() -> Iterator[Event]:
    """An event that Ctrl-C sets before it is raised, so that no thread works on."""
    cancel = Event()

    def stop(*_: object) -> None:
        cancel.set()
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, stop)
    try:
        yield cancel
    except Cancelled:
        raise KeyboardInterrupt from None
    finally:
        signal.signal(signal.SIGINT, before)
