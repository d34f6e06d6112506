"""Errors and notes in words: a bar above the picture that blocks nothing, and the log."""

from __future__ import annotations

from html import escape

from qtpy.QtCore import QTime
from qtpy.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QTextBrowser, QToolButton, QWidget

from jaart.gui import theme
from jaart.gui.model import SceneModel


class MessageBar(QFrame):
    """The newest error, until it is closed or something else is opened or set."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("messages")
        self.text = QLabel(wordWrap=True)
        self.text.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        close = QToolButton(text="✕", toolTip="Close this message")
        close.clicked.connect(self.hide)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(10, 6, 6, 6)
        layout.addWidget(self.text, 1)
        layout.addWidget(close)
        self.hide()
        model.failed.connect(self.tell)
        model.scene_changed.connect(self.hide)
        model.settings_changed.connect(self.hide)

    def tell(self, message: str) -> None:
        """Show an error."""
        self.text.setText(message)
        self.show()


class Log(QTextBrowser):
    """Everything that was said, with the time of day."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setPlaceholderText("Messages appear here.")
        self.model, self.lines = model, []  # type: tuple[SceneModel, list[tuple[str, str, bool]]]
        model.said.connect(lambda text: self._add(text, False))
        model.failed.connect(lambda text: self._add(text, True))
        model.theme_changed.connect(self._show)

    def _add(self, text: str, alarm: bool) -> None:
        self.lines.append((QTime.currentTime().toString("HH:mm:ss"), text, alarm))
        del self.lines[:-500]
        self._show()

    def _show(self) -> None:
        colours = theme.COLOURS[self.model.theme]
        self.setHtml("".join(
            f'<div><span style="color:{colours["weak"]}">{when}</span>&nbsp;&nbsp;'
            f'<span style="color:{colours["alarm" if alarm else "text"]}">{escape(text)}</span></div>'
            for when, text, alarm in self.lines))
        self.verticalScrollBar().setValue(self.verticalScrollBar().maximum())
