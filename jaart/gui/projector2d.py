"""The chosen step of the picked ray in its plane [T §3.4]."""

from __future__ import annotations

from qtpy.QtWidgets import QWidget

from jaart.gui.figure_canvas import FigurePanel
from jaart.gui.model import SceneModel
from jaart.plot.projection import draw_projection


class Projector2D(FigurePanel):
    """The plane through the query, its barycentre and the next point."""

    message = "Click a pixel in the picture to see how its ray finds the surface."

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(model, parent)
        model.trace_changed.connect(self.new_trace)
        model.step_changed.connect(self.mark_dirty)

    def draw(self) -> None:
        """Draw the chosen step."""
        trace, camera = self.model.trace, self.model.camera
        if trace is None:
            self.canvas.say(self.message)
            return
        up = (0.0, 0.0, 1.0) if camera is None else tuple(camera.frame()[1])
        self.draw_anew(lambda axes: draw_projection(axes, trace, self.model.step, self.model.theme, up))
