"""A matplotlib canvas that is made when first needed and redraws on request; panels that draw into it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from qtpy.QtCore import QEvent, QPoint, Qt, Signal
from qtpy.QtWidgets import QLabel, QStackedLayout, QToolTip, QVBoxLayout, QWidget

from jaart.gui.model import SceneModel
from jaart.gui.panel import Panel
from jaart.gui.turns import turns
from jaart.plot.style import THEMES, Spot, emptied, place

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: How near (pixels) the mouse must come to a spot.
_REACH = 9.0


class FigureCanvas(QWidget):
    """A figure with wheel zoom, drag to pan, double click to reset, and spots that answer the mouse.

    Until there is something to draw it shows a message, and matplotlib is not loaded.
    """

    #: A spot with a step was clicked.
    stepped = Signal(int)
    #: The view was reset and must be drawn again.
    reset = Signal()

    def __init__(self, message: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._canvas: Any = None
        self._spots: list[Spot] = []
        self._axes: Axes | None = None
        self._grip: tuple[float, float, tuple[float, float], tuple[float, float]] | None = None
        self._moved = self.zoomed = False
        self._message = QLabel(message)
        self._message.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._message.setWordWrap(True)
        self._message.setMargin(12)
        self._message.setObjectName("weak")
        self._layout = QStackedLayout(self)
        self._layout.addWidget(self._message)

    @property
    def figure(self) -> Figure:
        """The figure; makes the canvas on first use."""
        if self._canvas is None:
            self._make()
        figure: Figure = self._canvas.figure
        return figure

    def say(self, message: str) -> None:
        """Show a message instead of the figure."""
        self._message.setText(message)
        self._layout.setCurrentWidget(self._message)

    def show_figure(self, axes: Axes | None = None, spots: Iterable[Spot] = ()) -> None:
        """Show what was drawn; axes: the one that zooms and holds the spots."""
        self._axes, self._spots = axes, list(spots)
        if axes is not None:
            place(self._canvas.figure)
        self._layout.setCurrentWidget(self._canvas)
        self._canvas.draw_idle()

    def _make(self) -> None:
        from matplotlib.backends.backend_qtagg import FigureCanvasQTAgg
        from matplotlib.figure import Figure

        self._canvas = FigureCanvasQTAgg(Figure(dpi=100))
        # matplotlib's own delayed drawing outlives the widget and would then fail.
        self._canvas.draw_idle = self._ask
        self._canvas.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._canvas.setMinimumSize(0, 0)
        self._canvas.figure.set_size_inches(max(self.width(), 10) / 100, max(self.height(), 10) / 100, forward=False)
        self._layout.addWidget(self._canvas)
        for name, slot in (("scroll_event", self._zoom), ("button_press_event", self._press),
                           ("button_release_event", self._release), ("motion_notify_event", self._move),
                           ("resize_event", self._place)):
            self._canvas.mpl_connect(name, slot)

    def _ask(self) -> None:
        turns().ask(self._paint)

    def _paint(self) -> None:
        self._canvas.draw()

    def _place(self, event: Any = None) -> None:
        """Keep the margins of a single axes when the size changes."""
        if self._axes is not None:
            place(self._canvas.figure)

    def spot_at(self, x: float, y: float) -> Spot | None:
        """The spot nearest to a place of the canvas (matplotlib pixels, from the lower left), if near enough."""
        if self._axes is None or not self._spots:
            return None
        pixels = self._axes.transData.transform([(s.x, s.y) for s in self._spots])
        away = ((pixels - (x, y)) ** 2).sum(axis=1)
        order = min(range(len(away)), key=lambda i: (away[i], self._spots[i].step is None))
        return self._spots[order] if away[order] <= _REACH**2 else None

    def _zoom(self, event: Any) -> None:
        if event.inaxes is None or event.inaxes is not self._axes:
            return
        factor = 0.8**event.step
        axes, x, y = self._axes, event.xdata, event.ydata
        axes.set_xlim(*(x + (edge - x) * factor for edge in axes.get_xlim()), auto=None)
        axes.set_ylim(*(y + (edge - y) * factor for edge in axes.get_ylim()), auto=None)
        self.zoomed = True
        self._canvas.draw_idle()

    def _press(self, event: Any) -> None:
        if event.dblclick:
            self.zoomed = False
            self._grip = None
            self.reset.emit()
        elif event.inaxes is not None and event.inaxes is self._axes:
            self._grip = (event.x, event.y, self._axes.get_xlim(), self._axes.get_ylim())
            self._moved = False

    def _release(self, event: Any) -> None:
        held, self._grip = self._grip, None
        if held is not None and not self._moved:
            spot = self.spot_at(event.x, event.y)
            if spot is not None and spot.step is not None:
                self.stepped.emit(spot.step)

    def _move(self, event: Any) -> None:
        if self._grip is not None:
            self._pan(event.x, event.y)
            return
        spot = self.spot_at(event.x, event.y)
        if spot is None:
            QToolTip.hideText()
            return
        ratio = self._canvas.device_pixel_ratio
        place = QPoint(int(event.x / ratio), int(self._canvas.height() - event.y / ratio))
        hint = "\nclick to choose this step" if spot.step is not None else ""
        QToolTip.showText(self._canvas.mapToGlobal(place), spot.text + hint, self._canvas)

    def _pan(self, x: float, y: float) -> None:
        assert self._axes is not None
        assert self._grip is not None
        x0, y0, xlim, ylim = self._grip
        if not self._moved and abs(x - x0) + abs(y - y0) < 4:
            return
        self._moved = self.zoomed = True
        box = self._axes.bbox
        dx, dy = (x0 - x) / box.width * (xlim[1] - xlim[0]), (y0 - y) / box.height * (ylim[1] - ylim[0])
        self._axes.set_xlim(xlim[0] + dx, xlim[1] + dx, auto=None)
        self._axes.set_ylim(ylim[0] + dy, ylim[1] + dy, auto=None)
        self._canvas.draw_idle()


class FigurePanel(Panel):
    """A panel with one figure."""

    message = ""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(model, parent)
        self.canvas = FigureCanvas(self.message, self)
        self.canvas.stepped.connect(model.set_step)
        self.canvas.reset.connect(self.mark_dirty)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.rows = QVBoxLayout(self)
        self.rows.setContentsMargins(0, 0, 0, 0)
        self.rows.setSpacing(0)
        self.rows.addWidget(self.canvas, 1)

    def new_view(self) -> None:
        """Draw something else: what was zoomed into is gone."""
        self.canvas.zoomed = False
        self.mark_dirty()

    def draw_anew(self, draw: Callable[[Axes], list[Spot]]) -> None:
        """Draw into the emptied axes of the theme; what was zoomed into stays in view."""
        figure = self.canvas.figure
        kept = (figure.axes[0].get_xlim(), figure.axes[0].get_ylim()) if self.canvas.zoomed and figure.axes else None
        axes = emptied(figure, THEMES[self.model.theme])
        spots = draw(axes)
        if kept is not None:
            axes.set_xlim(kept[0], auto=None)
            axes.set_ylim(kept[1], auto=None)
        self.canvas.show_figure(axes, spots)

    def changeEvent(self, event: QEvent) -> None:
        """Follow a change of the screen's resolution."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.DevicePixelRatioChange:
            self.mark_dirty()
