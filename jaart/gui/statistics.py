"""The statistics of the picture, and their export."""

from __future__ import annotations

import csv
from pathlib import Path

from qtpy.QtGui import QResizeEvent
from qtpy.QtWidgets import QFileDialog, QToolButton, QWidget

from jaart.core.errors import FileError
from jaart.core.io.atomic import replacing
from jaart.core.statistics import Statistics, statistics, table
from jaart.gui.figure_canvas import FigurePanel
from jaart.gui.model import SceneModel
from jaart.plot.statistics import draw_statistics, statistics_figure


class StatisticsPanel(FigurePanel):
    """Histograms of the picture's rays, their end states and errors."""

    message = "Statistics of the picture appear here when it is done."

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(model, parent)
        self.buttons = [self._button(kind) for kind in ("svg", "csv")]
        self.canvas.resized.connect(self.mark_dirty)
        model.hits_changed.connect(self.mark_dirty)

    def draw(self) -> None:
        """Draw the statistics of a full picture; a coarse one leaves the last standing."""
        current = self._current()
        for button in self.buttons:
            button.setEnabled(current is not None)
        if current is not None:
            figure = self.canvas.figure
            draw_statistics(figure, current, self.model.theme)
            self.canvas.show_figure()
            self._place()
        elif self.model.hits is None:
            self.canvas.say(self.message)

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
        """Keep the buttons in their corner."""
        super().resizeEvent(event)
        self._place()

    def _place(self) -> None:
        """Export buttons at the right edge, one below the other."""
        for row, button in enumerate(self.buttons):
            button.move(self.width() - button.width() - 6, 6 + row * (button.height() + 4))
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
