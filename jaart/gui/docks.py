"""Docks of the window, and the loading of the panels whose libraries take seconds to import."""

from __future__ import annotations

import importlib
import threading
from dataclasses import dataclass

from qtpy.QtCore import QObject, QSize, Qt, Signal
from qtpy.QtWidgets import QDockWidget, QLabel, QMainWindow, QStackedLayout, QWidget

from jaart.gui.panel import Panel

Area = Qt.DockWidgetArea


@dataclass(frozen=True)
class Late:
    """A panel that is built after the window is up.

    title: of its dock; module, name: the panel's class in jaart.gui; needs: what to import first;
    area: where it docks; height: share of its column.
    """

    title: str
    module: str
    name: str
    needs: tuple[str, ...]
    area: Area
    height: int


_FIGURE = ("matplotlib.figure", "matplotlib.backends.backend_qtagg")

#: In the order in which they are docked; they are loaded quickest first.
LATE = (
    Late("Steps", "step_bar", "StepBar", (), Area.RightDockWidgetArea, 60),
    Late("3D ray analyzer", "analyzer3d", "Analyzer3D", ("pyvista", "pyvistaqt"), Area.RightDockWidgetArea, 320),
    Late("2D projector", "projector2d", "Projector2D", _FIGURE, Area.RightDockWidgetArea, 300),
    Late("Energy along the ray", "energy_plot", "EnergyPlot", _FIGURE, Area.RightDockWidgetArea, 230),
    Late("Statistics", "statistics", "StatisticsPanel", _FIGURE, Area.BottomDockWidgetArea, 260),
)


class Loader(QObject):
    """Imports the panels' libraries in a thread and says when each can be built in the window's thread."""

    ready = Signal(object)
    failed = Signal(str)
    finished = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._load, name="jaart loader", daemon=True)

    def start(self) -> None:
        """Begin, if not begun already."""
        if self._thread.ident is None:
            self._thread.start()

    def stop(self) -> None:
        """Import no more and wait for the thread."""
        self._stop.set()
        if self._thread.ident is not None:
            self._thread.join()

    def _load(self) -> None:
        for late in sorted(LATE, key=lambda late: len(late.needs) and 1 + ("pyvista" in late.needs)):
            try:
                for module in (*late.needs, f"jaart.gui.{late.module}"):
                    if self._stop.is_set():
                        return
                    importlib.import_module(module)
            except Exception as error:
                self.failed.emit(f"{late.title} is not available: {error}")
            else:
                self.ready.emit(late)
        self.finished.emit()


class PanelDock(QDockWidget):
    """A dock that says "loading" until its panel is there."""

    def __init__(self, title: str, parent: QMainWindow, size: QSize) -> None:
        super().__init__(title, parent)
        self.setObjectName(title)
        self._size = size
        self._body = QWidget()
        self._stack = QStackedLayout(self._body)
        self._note = QLabel("Loading …", alignment=Qt.AlignmentFlag.AlignCenter, objectName="weak", wordWrap=True)
        self._stack.addWidget(self._note)
        self.setWidget(self._body)
        self.panel: QWidget | None = None
        self.visibilityChanged.connect(self._show_panel)

    def set_panel(self, panel: QWidget) -> None:
        """Show the panel."""
        self.panel = panel
        self._stack.addWidget(panel)
        self._show_panel(not self.visibleRegion().isEmpty())

    def _show_panel(self, seen: bool) -> None:
        """Put a panel that draws away while another tab is in front: to Qt it would be visible."""
        if self.panel is not None:
            self._stack.setCurrentWidget(self.panel if seen or not isinstance(self.panel, Panel) else self._note)

    def sizeHint(self) -> QSize:
        """The size that the dock begins with."""
        return self._size
