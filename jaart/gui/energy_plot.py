"""The energies along the picked ray, with its steps."""

from __future__ import annotations

from qtpy.QtGui import QResizeEvent
from qtpy.QtWidgets import QToolButton, QWidget

from jaart.gui.figure_canvas import FigurePanel
from jaart.gui.model import SceneModel
from jaart.plot.energy import draw_energy


class EnergyPlot(FigurePanel):
    """e_ts, e_oc, e_M and e_angle along the picked ray."""

    message = "Click a pixel in the picture to see the energies along its ray."

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(model, parent)
        self.whole = QToolButton(self.canvas)
        self.whole.setText("whole ray")
        self.whole.setCheckable(True)
        self.whole.hide()
        self.whole.setToolTip("Show the energies from the first cell or ball to the last.\n"
                              "Wheel: zoom. Drag: move. Double click: back.")
        self.whole.toggled.connect(self.new_view)
        model.trace_changed.connect(self.new_trace)
        model.step_changed.connect(self.mark_dirty)

    def draw(self) -> None:
        """Draw the picked ray's energies."""
        trace = self.model.trace
        self.whole.setVisible(trace is not None and bool(len(trace.cells) or len(trace.balls)))
        if trace is None:
            self.canvas.say(self.message)
            return
        known = self.model.known
        self.draw_anew(lambda axes: draw_energy(axes, trace, self.model.step, self.model.theme, self.whole.isChecked(),
                                                None if known is None else known.values.level))
        self.whole.raise_()
        self._place()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the button in its corner."""
        super().resizeEvent(event)
        self._place()

    def _place(self) -> None:
        self.whole.adjustSize()
        self.whole.move(4, self.canvas.height() - self.whole.height() - 2)
