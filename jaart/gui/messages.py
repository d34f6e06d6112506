"""Errors and notes in words: bars above the picture that block nothing, and the log."""

from __future__ import annotations

from html import escape

from qtpy.QtCore import Qt, QTime
from qtpy.QtGui import QShowEvent
from qtpy.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QTextBrowser, QToolButton, QWidget

from jaart.gui import theme
from jaart.gui.model import SceneModel

#: So many notes are shown above the picture; the log has all.
MOST = 4


class Bar(QFrame):
    """A text over the whole width, with a button to close it."""

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.text = QLabel(wordWrap=True, textFormat=Qt.TextFormat.PlainText)
        self.text.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self.button = QToolButton(text="✕", toolTip="Close this message")
        self.button.clicked.connect(self.hide)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(10, 6, 6, 6)
        layout.addWidget(self.text, 1)
        layout.addWidget(self.button)
        self.hide()

    def tell(self, message: str) -> None:
        """Show a text."""
        self.text.setText(message)
        self.show()


class MessageBar(Bar):
    """The newest error, until it is closed or something else is opened or set."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__("messages", parent)
        model.failed.connect(self.tell)
        model.scene_changed.connect(self.hide)
        model.settings_changed.connect(self.hide)


class NoteBar(Bar):
    """The notes that hold, until they are closed or hold no more; one that comes back is shown again."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__("notes", parent)
        self.model, self._closed = model, set()  # type: tuple[SceneModel, set[str]]
        self.button.clicked.connect(lambda: self._closed.update(model.notes.now))
        model.notes.changed.connect(self.refresh)

    def refresh(self) -> None:
        """Show what holds and was not closed."""
        self._closed &= set(self.model.notes.now)
        lines = [f"Note: {note}" for note in self.model.notes.now if note not in self._closed]
        if len(lines) > MOST:
            lines[MOST - 1:] = [f"{len(lines) - MOST + 1} more notes are under Messages"]
        self.tell("\n".join(lines))
        self.setVisible(bool(lines))


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

    def showEvent(self, event: QShowEvent) -> None:
        """Show what was said while the log was hidden."""
        super().showEvent(event)
        self._show()

    def _show(self) -> None:
        if not self.isVisible():
            return
        colours = theme.COLOURS[self.model.theme]
        self.setHtml("".join(
            f'<div><span style="color:{colours["weak"]}">{when}</span>&nbsp;&nbsp;'
            f'<span style="color:{colours["alarm" if alarm else "text"]}">{escape(text)}</span></div>'
            for when, text, alarm in self.lines))
        self.verticalScrollBar().setValue(self.verticalScrollBar().maximum())
