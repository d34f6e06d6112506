"""The statistics of the picture, and their export."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from qtpy.QtCore import Qt, QTimer
from qtpy.QtGui import QImage, QPixmap, QResizeEvent
from qtpy.QtWidgets import QFileDialog, QLabel, QToolButton, QWidget

from jaart.core.errors import FileError
from jaart.core.io.atomic import replacing
from jaart.core.statistics import Statistics, statistics, table
from jaart.gui.model import SceneModel
from jaart.gui.panel import Panel
from jaart.plot.statistics import statistics_figure, statistics_pixels

#: Milliseconds that a picture must stand before its statistics are drawn.
PAUSE_MS = 500


class StatisticsPanel(Panel):
    """Histograms of the picture's rays, their end states and errors, drawn in the worker's thread."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(model, parent)
        self.picture = QLabel("Statistics of the picture appear here when it is done.", self)
        self.picture.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.picture.setObjectName("weak")
        self.buttons = [self._button(kind) for kind in ("svg", "csv")]
        self._later = QTimer(self, singleShot=True, interval=PAUSE_MS)
        self._later.timeout.connect(super().mark_dirty)
        model.hits_changed.connect(self.mark_dirty)
        model.settled.connect(self._say_if_stopped)

    def mark_dirty(self) -> None:
        """Draw again once the picture has stood for a moment: the panels of the ray go first."""
        self._later.start()

    @property
    def pending(self) -> bool:
        """Whether it is seen but not yet drawn as the model is."""
        return super().pending or self._later.isActive()

    def draw(self) -> None:
        """Have the statistics of a full picture drawn; a coarse one leaves the last standing."""
        hits, errors = self.model.hits, self.model.quality
        ready = hits is not None and self.model.complete
        for button in self.buttons:
            button.setEnabled(ready)
        if hits is not None and ready:
            size, ratio, theme = (self.width(), self.height()), self.devicePixelRatioF(), self.model.theme
            self.model.draw_later(lambda: statistics_pixels(statistics(hits, errors), theme, size, ratio), self._show)

    def _say_if_stopped(self) -> bool:
        """Take away the statistics of an older picture where a coarse one stays on show."""
        coarse = self.model.halted and not self.model.complete
        if coarse:
            self.picture.setText("The picture was stopped. Its statistics appear here when one is done.")
        return coarse

    def _show(self, pixels: NDArray[np.uint8]) -> None:
        if self._say_if_stopped():
            return
        height, width, _ = pixels.shape
        image = QImage(pixels.tobytes(), width, height, 4 * width, QImage.Format.Format_RGBA8888)
        image.setDevicePixelRatio(self.devicePixelRatioF())
        self.picture.setPixmap(QPixmap.fromImage(image))

    def export(self, path: str | Path) -> None:
        """Write the statistics as .svg or .csv.

        Errors: FileError when the ending is another, there is no picture, or the file cannot be written.
        """
        path, current = Path(path), self._current()
        if current is None:
            raise FileError(path, "there is no picture yet whose statistics could be written")
        writers = {".svg": _write_svg, ".csv": _write_csv}
        if path.suffix.lower() not in writers:
            raise FileError(path, "expected a name that ends in .svg or .csv")
        with replacing(path) as temporary:
            writers[path.suffix.lower()](temporary, current)
        self.model.said.emit(f"Statistics written to {path}")

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Draw for the new size; the export buttons stay in the upper right corner, above titles."""
        super().resizeEvent(event)
        self.picture.setGeometry(self.rect())
        self.mark_dirty()
        left = self.width() - 6
        for button in reversed(self.buttons):
            left -= button.width()
            button.move(left, 2)
            button.raise_()

    def _button(self, kind: str) -> QToolButton:
        button = QToolButton(self)
        button.setText(f"{kind.upper()} …")
        button.setToolTip(f"Export the statistics as {kind.upper()}")
        button.adjustSize()
        button.setEnabled(False)
        button.clicked.connect(lambda: self._ask(kind))
        return button

    def _ask(self, kind: str) -> None:
        name, _ = QFileDialog.getSaveFileName(self, "Export statistics", f"statistics.{kind}", f"*.{kind}")
        if not name:
            return
        try:
            self.export(name if Path(name).suffix else f"{name}.{kind}")
        except FileError as error:
            self.model.failed.emit(str(error))

    def _current(self) -> Statistics | None:
        hits = self.model.hits
        return statistics(hits, self.model.quality) if hits is not None and self.model.complete else None


def _write_svg(path: Path, current: Statistics) -> None:
    statistics_figure(current).savefig(path, format="svg")


def _write_csv(path: Path, current: Statistics) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(table(current))
