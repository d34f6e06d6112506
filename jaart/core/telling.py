"""Says what is being made and how far it is, to whoever watches: the command line, on a terminal.

Where work says how far it is, it may also be stopped. Watcher and stop belong to the thread that set them, so that
nobody else is told or stopped, and cost nothing where there are none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from threading import Event

from jaart.core.errors import Cancelled

#: Is told what is being made, how much of it is done and how much there is, 0 where nobody knows.
Watcher = Callable[[str, int, int], None]

_WATCHER: ContextVar[Watcher | None] = ContextVar("watcher", default=None)
_NOW: ContextVar[str] = ContextVar("now", default="")
_STOP: ContextVar[Event | None] = ContextVar("stop", default=None)

#: What people call the stages that a scene keeps.
STAGES = {"levels": "filling the lattice", "surfels": "surfels", "cells": "table of the cells", "mesh": "mesh",
          "faces": "tree of the triangles", "kd_tree": "tree of the points", "nearest": "nearest neighbours",
          "cover": "balls", "balls": "tree of the balls", "normals": "normals of the points"}


@contextmanager
def told(watcher: Watcher | None) -> Iterator[None]:
    """Have a watcher told of all that this thread makes in the block; None for nobody."""
    before = _WATCHER.set(watcher)
    try:
        yield
    finally:
        _WATCHER.reset(before)


@contextmanager
def stoppable(stop: Event | None) -> Iterator[None]:
    """Have what this thread makes in the block end with Cancelled soon after `stop` is set; None changes nothing."""
    before = _STOP.set(stop or _STOP.get())
    try:
        yield
    finally:
        _STOP.reset(before)


@contextmanager
def doing(what: str) -> Iterator[None]:
    """Say what is being made in the block, and after it what it is a part of; nothing new where `what` is empty."""
    _end_when_stopped()
    watcher = _WATCHER.get()
    if watcher is None or not what:
        yield
        return
    before = _NOW.set(what)
    watcher(what, 0, 0)
    try:
        yield
    finally:
        _NOW.reset(before)
        watcher(_NOW.get(), 0, 0)


def tell(done: int, total: int) -> None:
    """Say how far is what is being made. Raises Cancelled where it is to stop."""
    _end_when_stopped()
    watcher = _WATCHER.get()
    if watcher is not None and _NOW.get():
        watcher(_NOW.get(), done, total)


def watcher() -> Watcher | None:
    """Who is told now."""
    return _WATCHER.get()


def _end_when_stopped() -> None:
    stop = _STOP.get()
    if stop is not None and stop.is_set():
        raise Cancelled(f"{_NOW.get() or 'the work'} was cancelled")
