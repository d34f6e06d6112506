"""One thread that computes for the window: the newest job of each kind wins."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from typing import Any

from qtpy.QtCore import QObject, Qt, Signal

from jaart.core.errors import Cancelled, JaartError, SettingsError
from jaart.gui.garbage import GarbageCollector

log = logging.getLogger("jaart")

#: Kinds of jobs, the most urgent first.
KINDS = ("open", "picture", "trace", "figure", "plan")
#: Those that nobody waits for once they are cancelled: a file may be read for long without a chance to stop.
LEFT = ("open",)


class Job:
    """Work to be done in the worker's thread; `done` and `partial` are called in the window's.

    kind: one of KINDS; work(job) -> result: may call job.progress and job.partial and give job.cancel on;
    brief: so short that it runs to its end even when newer work waits. Done with `told(job.watch)`, work says which
    stage it makes and stops wherever it does.
    """

    def __init__(self, worker: Worker, kind: str, work: Callable[[Job], Any], done: Callable[[Any], None],
                 partial: Callable[[Any], None] | None, brief: bool) -> None:
        self.kind, self.work, self.done, self.on_partial, self.brief = kind, work, done, partial, brief
        self.cancel, self.forgotten, self.replaced = threading.Event(), False, False
        self._post, self._superseded, self._shown, self._told = worker.posted.emit, False, False, 0.0

    def supersede(self) -> None:
        """Stop for a newer job, but not before something was shown: endless dragging must not starve the view."""
        self._superseded = not self.brief
        if self._superseded and (self._shown or self.on_partial is None):
            self.cancel.set()

    def progress(self, done: int, total: int) -> None:
        """Tell how much is done, at most ten times a second."""
        now = time.monotonic()
        if now - self._told > 0.1:
            self._told = now
            self._post(self, "progress", done / max(total, 1))

    def watch(self, stage: str, done: int, total: int) -> None:
        """Tell which stage is made and how far it is. Raises Cancelled when nobody wants it any more."""
        if self.cancel.is_set():
            raise Cancelled(f"{stage} was cancelled")
        now = time.monotonic()
        if not total or now - self._told > 0.1:
            self._told = now if total else self._told
            self._post(self, "stage", (stage, done / total if total else 0.0))

    def say(self, text: str) -> None:
        """Tell what goes on."""
        self._post(self, "said", text)

    def hand(self, take: Callable[[Any], None], result: Any) -> None:
        """Give something that is known before the result to a function, in the window's thread."""
        self._post(self, "handed", (take, result))

    def partial(self, result: Any) -> None:
        """Hand over a first, coarse result."""
        self._post(self, "partial", result)
        self._shown = True
        if self._superseded:
            self.cancel.set()


class Worker(QObject):
    """Runs jobs one after the other in a thread of its own and reports in the window's thread.

    refused: the settings of a job make no sense; failed: anything else that went wrong; staged: which stage is made
    and how much of it is done, "" and 0 where nobody knows.
    """

    progressed = Signal(float)
    staged = Signal(str, float)
    failed = Signal(str)
    refused = Signal(str)
    said = Signal(str)
    begun = Signal()
    ended = Signal()
    posted = Signal(object, str, object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._waiting: dict[str, Job] = {}
        self._running: Job | None = None
        self._open: set[Job] = set()
        self._stop = False
        self._change = threading.Condition()
        self._garbage = GarbageCollector(self)
        self.posted.connect(self._deliver, Qt.ConnectionType.QueuedConnection)
        self._begin()

    def _begin(self) -> None:
        self._thread = threading.Thread(target=self._loop, name="jaart worker", daemon=True)
        self._thread.start()

    @property
    def idle(self) -> bool:
        """Whether every job has ended and its result was delivered."""
        return not self._open

    def submit(self, kind: str, work: Callable[[Job], Any], done: Callable[[Any], None],
               partial: Callable[[Any], None] | None = None, brief: bool = False) -> None:
        """Queue a job in the place of any waiting one of its kind; a running one makes way unless it is brief."""
        job = Job(self, kind, work, done, partial, brief)
        with self._change:
            self._drop(kind)
            if self._running is not None and self._running.kind == kind:
                self._leave() if kind in LEFT else self._running.supersede()
            for other in self._open:
                other.replaced |= other.kind == kind
            self._waiting[kind] = job
            self._open.add(job)
            self._change.notify()
        self.begun.emit()

    def cancel(self, kind: str) -> None:
        """Stop the running job of a kind, forget the waiting one, and hand over nothing more of either."""
        with self._change:
            self._drop(kind)
            for job in self._open:
                job.forgotten |= job.kind == kind
            if self._running is not None and self._running.kind == kind:
                self._leave() if kind in LEFT else self._running.cancel.set()

    def _leave(self) -> None:
        """Let the running job end by itself, unheard, and go on in a new thread: what it does may not be stoppable."""
        job, self._running = self._running, None
        assert job is not None
        job.cancel.set()
        self.posted.emit(job, "cancelled", None)
        self._begin()

    def cancel_all(self) -> None:
        """Stop what runs and forget what waits."""
        for kind in KINDS:
            self.cancel(kind)

    def stop(self) -> None:
        """End the thread: cancel what runs, forget what waits, and wait for the thread."""
        with self._change:
            self._stop = True
            for kind in KINDS:
                self._drop(kind)
            if self._running is not None:
                self._running.cancel.set()
            self._change.notify()
        self._thread.join()
        self._garbage.stop()
        self._open.clear()

    def _drop(self, kind: str) -> None:
        self._open.discard(self._waiting.pop(kind, None))  # type: ignore[arg-type]

    def _loop(self) -> None:
        while (job := self._next()) is not None:
            what, result = _outcome(job)
            with self._change:
                if self._stop or self._running is not job:
                    return
                self._running = None
            self.posted.emit(job, what, result)

    def _next(self) -> Job | None:
        with self._change:
            self._change.wait_for(lambda: self._stop or self._waiting)
            if self._stop:
                return None
            self._running = self._waiting.pop(min(self._waiting, key=KINDS.index))
            return self._running

    def _deliver(self, job: Job, what: str, result: Any) -> None:
        if what in ("done", "failed", "refused", "cancelled"):
            self._open.discard(job)
        if not (self._stop or job.forgotten or (job.cancel.is_set() and what != "partial")):
            self._hand_over(job, what, result)
        if self.idle:
            self.ended.emit()

    def _hand_over(self, job: Job, what: str, result: Any) -> None:
        if what == "done":
            job.done(result)
        elif what == "partial" and job.on_partial is not None:
            job.on_partial(result)
        elif what == "handed":
            result[0](result[1])
        elif what == "failed":
            self.failed.emit(result)
        elif what == "refused" and not job.replaced:  # else the settings have changed since
            self.refused.emit(result)
        elif what == "said":
            self.said.emit(result)
        elif what == "progress":
            self.progressed.emit(result)
        elif what == "stage":
            self.staged.emit(*result)


def _outcome(job: Job) -> tuple[str, Any]:
    """Run a job: what came of it, and its result or message."""
    try:
        return "done", job.work(job)
    except Cancelled:
        return "cancelled", None
    except SettingsError as error:
        return "refused", str(error)
    except JaartError as error:
        return "failed", str(error)
    except MemoryError:
        return "failed", "not enough memory for this; choose a smaller raster or picture"
    except Exception as error:
        log.exception("%s failed", job.kind)
        return "failed", f"internal error: {type(error).__name__}: {error}"
