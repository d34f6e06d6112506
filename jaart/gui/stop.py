"""The button that stops what takes long."""

from __future__ import annotations

from qtpy.QtCore import QTimer
from qtpy.QtWidgets import QToolButton, QWidget

from jaart.gui.model import SceneModel

#: What is done sooner shows no button [ms].
PATIENCE_MS = 500


class StopButton(QToolButton):
    """Appears when work has gone on for a moment, and stops it; what is shown stays."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.model = model
        self.setText("Stop")
        self.setToolTip("Stop what is being read, traced, shaded or measured; what is shown stays.")
        self.setAutoRaise(True)
        self.hide()
        self._later = QTimer(self, singleShot=True, interval=PATIENCE_MS)
        self._later.timeout.connect(lambda: self.setVisible(model.computing))
        self.clicked.connect(model.stop)
        model.begun.connect(self._begin)
        model.settled.connect(self._end)

    def _begin(self) -> None:
        if self.isHidden() and not self._later.isActive():
            self._later.start()

    def _end(self) -> None:
        self._later.stop()
        self.hide()
