"""What the panels have in common: each is drawn again in its turn, and only while it is seen."""

from __future__ import annotations

from qtpy.QtCore import Qt
from qtpy.QtGui import QKeyEvent, QShowEvent
from qtpy.QtWidgets import QWidget

from jaart.core.records import Trace
from jaart.gui.model import SceneModel
from jaart.gui.turns import turns


class Panel(QWidget):
    """A view of the model; `draw` is made by each kind."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.model = model
        self._dirty = True
        self._seen: Trace | None = model.trace
        model.theme_changed.connect(self.mark_dirty)

    def draw(self) -> None:
        """Draw what the model holds."""
        raise NotImplementedError

    @property
    def pending(self) -> bool:
        """Whether it is seen but not yet drawn as the model is."""
        return self._dirty and self.isVisible()

    def new_view(self) -> None:
        """Draw another ray than before."""
        self.mark_dirty()

    def mark_dirty(self) -> None:
        """Draw again soon, or when shown."""
        self._dirty = True
        if self.isVisible():
            turns().ask(self._redraw)

    def new_trace(self) -> None:
        """Draw the trace; another ray is seen anew, the same with other settings stays as it is looked at."""
        same, self._seen = same_ray(self._seen, self.model.trace), self.model.trace
        if same:
            self.mark_dirty()
        else:
            self.new_view()

    def showEvent(self, event: QShowEvent) -> None:
        """Draw what changed while the panel was hidden."""
        super().showEvent(event)
        if self._dirty:
            turns().ask(self._redraw)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Step by the arrow keys."""
        if not step_by_key(self.model, event):
            super().keyPressEvent(event)

    def _redraw(self) -> None:
        if self._dirty and self.isVisible():
            self._dirty = False
            self.draw()


def step_by_key(model: SceneModel, event: QKeyEvent) -> bool:
    """Choose another step by ←, →, Home or End; whether the key was one of them."""
    last = model.trace.steps - 1 if model.trace is not None else 0
    targets = {Qt.Key.Key_Left: model.step - 1, Qt.Key.Key_Right: model.step + 1, Qt.Key.Key_Home: 0,
               Qt.Key.Key_End: last}
    if event.key() not in targets:
        return False
    model.set_step(targets[Qt.Key(event.key())])
    return True


def same_ray(one: Trace | None, other: Trace | None) -> bool:
    """Whether two traces are of the same ray, so that what is seen of it may stay."""
    return one is not None and other is not None and bool(
        (one.origin == other.origin).all() and (one.direction == other.direction).all())
