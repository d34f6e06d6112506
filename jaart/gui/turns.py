"""Drawing in turns: one piece of work at each turn of the event loop, so that the window answers in between."""

from __future__ import annotations

from collections.abc import Callable

from qtpy.compat import isalive
from qtpy.QtCore import QCoreApplication, QObject, QTimer

Work = Callable[[], None]

class Turns(QObject):
    """A queue of methods of objects; asked for twice before its turn, a method runs once."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._waiting: dict[Work, None] = {}
        self._timer = QTimer(self, singleShot=True, interval=0)
        self._timer.timeout.connect(self._next)

    def ask(self, work: Work) -> None:
        """Run a bound method soon, if its object still lives then."""
        self._waiting[work] = None
        self._timer.start()

    def _next(self) -> None:
        work = next(iter(self._waiting))
        del self._waiting[work]
        if self._waiting:
            self._timer.start()
        if isalive(work.__self__):  # type: ignore[attr-defined]
            work()


def turns() -> Turns:
    """The queue of this application."""
    application = QCoreApplication.instance()
    assert application is not None
    found = application.findChild(Turns)
    return found if found is not None else Turns(application)
