"""A picture of the window, taken once everything in it is drawn."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from qtpy.QtCore import QObject, QTimer, Signal

from jaart.core.errors import FileError
from jaart.core.io.atomic import replacing
from jaart.gui.panel import Panel

if TYPE_CHECKING:
    from jaart.gui.main_window import MainWindow

#: Turns of the event loop without work left, after which the panels have been painted.
QUIET_TURNS = 8


class Screenshot(QObject):
    """Waits until the picture, the picked ray and the panels are there, then saves the window."""

    taken = Signal()

    def __init__(self, window: MainWindow, path: Path, picked: bool) -> None:
        super().__init__(window)
        self.window_, self.path, self.picked, self._quiet = window, path, picked, 0
        self._timer = QTimer(self, interval=20)
        self._timer.timeout.connect(self._look)
        self._timer.start()

    def _look(self) -> None:
        model = self.window_.model
        traced = model.trace is not None or not self.picked
        panels = [dock.panel for dock in self.window_.docks.values() if isinstance(dock.panel, Panel)]
        done = (traced and model.idle and model.complete and self.window_.panels_ready
                and not any(panel.pending for panel in panels))
        self._quiet = self._quiet + 1 if done else 0
        if self._quiet >= QUIET_TURNS:
            self._timer.stop()
            self._save()

    def _save(self) -> None:
        try:
            with replacing(self.path) as temporary:
                if not self.window_.grab().save(str(temporary), "PNG"):
                    raise FileError(self.path, "the picture cannot be written")
        except OSError as error:
            self.window_.model.failed.emit(f"{self.path}: cannot be written: {error.strerror or error}")
        except FileError as error:
            self.window_.model.failed.emit(str(error))
        else:
            self.taken.emit()
