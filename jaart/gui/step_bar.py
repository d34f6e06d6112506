"""The bar that steps through the iterations of the picked ray, with the legend of the ray panels."""

from __future__ import annotations

from qtpy.QtCore import Qt, QTimer
from qtpy.QtGui import QKeyEvent, QResizeEvent
from qtpy.QtWidgets import QBoxLayout, QHBoxLayout, QLabel, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from jaart.gui.model import SceneModel
from jaart.gui.panel import step_by_key
from jaart.gui.theme import tabular
from jaart.plot.style import LEGEND, OUTCOMES, THEMES

_PLAY_MS = 700
#: A long text of how a start ended.
_LONG = f"start 10 of 10: {OUTCOMES['left_trust']}"


class StepBar(QWidget):
    """First, back, forward, last and play; which step and start it is; what the signs mean."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.model = model
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.first = self._button("|◀", "First step (Home)", lambda: model.set_step(0))
        self.back = self._button("◀", "Step back (←)", lambda: model.set_step(model.step - 1))
        self.forward = self._button("▶", "Step forward (→)", lambda: model.set_step(model.step + 1))
        self.last = self._button("▶|", "Last step (End)", lambda: model.set_step(self._last()))
        self.play = self._button("▷ play", "Go through the steps", self._toggle)
        self.play.setCheckable(True)
        self.position, self.state, self.signs = QLabel(), QLabel(), QLabel()
        self._arrange()
        self._timer = QTimer(self, interval=_PLAY_MS)
        self._timer.timeout.connect(self._tick)
        for signal in (model.trace_changed, model.step_changed, model.theme_changed):
            signal.connect(self.refresh)
        model.trace_changed.connect(self.stop)
        self.refresh()

    def refresh(self) -> None:
        """Show the model's step."""
        trace, step, last = self.model.trace, self.model.step, self._last()
        for button, able in ((self.first, step > 0), (self.back, step > 0), (self.forward, step < last),
                             (self.last, step < last), (self.play, last > 0)):
            button.setEnabled(able)
        steps = 0 if trace is None else trace.steps
        self.position.setText(f"step {step + 1 if steps else 0} / {steps}")
        self.state.setText(self._state())
        self.state.setToolTip(self.state.text())
        colours = THEMES[self.model.theme]
        self.signs.setText("&nbsp; ".join(
            f'<span style="color:{getattr(colours, kind)}">{sign}</span>&nbsp;{name.replace(" ", "&nbsp;")}'
            for kind, sign, name in LEGEND))

    def stop(self) -> None:
        """End the play."""
        self._timer.stop()
        self.play.setChecked(False)
        self.play.setText("▷ play")

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Step by the arrow keys."""
        if not step_by_key(self.model, event):
            super().keyPressEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Put how a start ended below the buttons where it would be cut beside them."""
        super().resizeEvent(event)
        narrow = self.width() < self._line.itemAt(0).sizeHint().width() + self._longest + 20
        self._line.setDirection(QBoxLayout.Direction.TopToBottom if narrow else QBoxLayout.Direction.LeftToRight)
        self.setMinimumHeight(self.layout().totalHeightForWidth(self.width()))

    def _state(self) -> str:
        trace = self.model.trace
        if trace is None:
            return "click a pixel in the picture"
        if not trace.steps:
            return OUTCOMES[trace.status] + self._behind()
        step = self.model.step
        last = self._behind() if step == self._last() else ""
        return f"start {trace.start[step] + 1} of {trace.start[-1] + 1}: {OUTCOMES[trace.outcome[step]]}{last}"

    def _behind(self) -> str:
        """Whether the ray meets the surface from within, where normals say what that is."""
        trace, known = self.model.trace, self.model.known
        sided = trace is not None and trace.hit and known is not None and known.sided
        return ", from behind" if sided and trace.normal @ trace.direction > 0 else ""

    def _last(self) -> int:
        return max(0, self.model.trace.steps - 1) if self.model.trace is not None else 0

    def _toggle(self) -> None:
        if not self.play.isChecked():
            self.stop()
            return
        if self.model.step == self._last():
            self.model.set_step(0)
        self.play.setText("■ stop")
        self._timer.start()

    def _tick(self) -> None:
        self.model.set_step(self.model.step + 1)
        if self.model.step == self._last():
            self.stop()

    def _button(self, text: str, tip: str, slot: object) -> QToolButton:
        button = QToolButton(self)
        button.setText(text)
        button.setToolTip(tip)
        button.setAutoRaise(True)
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        button.clicked.connect(slot)
        return button

    def _arrange(self) -> None:
        self.position.setFont(tabular(self.position.font()))
        self.state.setObjectName("weak")
        self._longest = self.state.fontMetrics().horizontalAdvance(_LONG)
        for label in (self.state, self.signs):
            label.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.signs.setWordWrap(True)
        self._line = QBoxLayout(QBoxLayout.Direction.LeftToRight)
        self._line.setSpacing(2)
        buttons = QHBoxLayout()
        buttons.setSpacing(2)
        for widget in (self.first, self.back, self.position, self.forward, self.last, self.play):
            buttons.addWidget(widget)
        buttons.addStretch(0)
        self._line.addLayout(buttons)
        self._line.addWidget(self.state, 1)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(6, 3, 6, 3)
        rows.setSpacing(2)
        rows.addLayout(self._line)
        rows.addWidget(self.signs)
