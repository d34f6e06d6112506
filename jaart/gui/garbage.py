"""Python's garbage is collected in the window's thread alone.

The collector runs in whatever thread happens to allocate; when it frees a Qt object in the worker's, the
program crashes. While a collector of this module lives, Python's own does not run.
"""

from __future__ import annotations

import gc

from qtpy.QtCore import QObject, QTimer

_INTERVAL_MS = 500


class GarbageCollector(QObject):
    """Collects now and then by Python's own thresholds, in the thread that made it."""

    _living = 0

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        GarbageCollector._living += 1
        gc.disable()
        self._timer = QTimer(self, interval=_INTERVAL_MS)
        self._timer.timeout.connect(self._collect)
        self._timer.start()

    def stop(self) -> None:
        """Leave the collecting to Python again, after the last of these."""
        if not self._timer.isActive():
            return
        self._timer.stop()
        GarbageCollector._living -= 1
        if not GarbageCollector._living:
            gc.enable()

    def _collect(self) -> None:
        due = [g for g, (count, limit) in enumerate(zip(gc.get_count(), gc.get_threshold(), strict=True))
               if count > limit]
        if due:
            gc.collect(due[-1])


def set_aside() -> None:
    """Let later collections pass over all that lives now, modules above all; for a program with one window."""
    gc.collect()
    gc.freeze()
