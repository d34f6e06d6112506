"""Ctrl-C ends a command at once, whatever its threads or a library are doing."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import Future
from contextvars import copy_context
from typing import NoReturn, TypeVar

from jaart.core.unfinished import none_written

T = TypeVar("T")

#: How long some systems take to answer Ctrl-C while they wait for a thread [s].
TICK = 0.1


def beside(work: Callable[[], T]) -> T:
    """What the work returns, or raises, done in a thread of its own.

    A thread in a library's call of many seconds could not answer Ctrl-C, this one only waits. `leave` must follow.
    """
    task, context = Future[T](), copy_context()

    def run() -> None:
        try:
            task.set_result(context.run(work))
        except BaseException as error:
            task.set_exception(error)

    thread = threading.Thread(target=run, name="jaart command", daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(TICK)
    return task.result()


def leave(status: int) -> NoReturn:
    """End the process without its threads: what they do is worth nothing, and what they write is removed."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # a second Ctrl-C would leave what is half written
    with none_written():
        os._exit(status)
