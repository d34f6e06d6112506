"""Rows of places x, y, z: one, or several that can be added and taken away."""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import QSignalBlocker, Signal
from qtpy.QtWidgets import QAbstractSpinBox, QHBoxLayout, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from jaart.core.parameter import Parameter
from jaart.gui.number_row import WordRow
from jaart.gui.values import ValueBox, text_of

Place = tuple[float, ...]


class Boxes(QWidget):
    """Three boxes for x, y, z. typed: their texts were changed; stepped(axis, steps): an arrow was used."""

    typed = Signal()
    stepped = Signal(int, int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.line = QHBoxLayout(self)
        self.line.setContentsMargins(0, 0, 0, 0)
        self.boxes = [ValueBox() for _ in range(3)]
        for axis, box in enumerate(self.boxes):
            box.setButtonSymbols(QAbstractSpinBox.ButtonSymbols.NoButtons)
            box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
            box.editingFinished.connect(self.typed)
            box.stepped.connect(lambda steps, axis=axis: self.stepped.emit(axis, steps))
            self.line.addWidget(box)

    def show_place(self, place: Place | None) -> None:
        """Show a place, or nothing."""
        for box, text in zip(self.boxes, _texts(place), strict=True):
            box.set_text(text)

    def texts(self) -> list[str]:
        """What stands in the boxes."""
        return [box.text().strip() for box in self.boxes]


class VectorRow(WordRow):
    """Three numbers x, y, z."""

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(about, parent)
        self.place = Boxes()
        self.boxes = self.place.boxes
        self.place.typed.connect(self._typed)
        self.place.stepped.connect(self._step)
        self.grid.addWidget(self.place, 2, 0, 1, 2)
        if self.word is not None:
            self.grid.addWidget(self.word, 0, 1)

    def display(self, value: Any) -> None:
        """Bring the controls to a value."""
        self.place.show_place(self.number())
        self.place.setVisible(not isinstance(value, str) or self.meant is not None)
        self._show_word(value)

    def _typed(self) -> None:
        if self.place.texts() != _texts(self.number()):
            self.enter(",".join(self.place.texts()))
        else:
            self.refuse("")

    def _step(self, axis: int, steps: int) -> None:
        self.enter(_moved(self.number() or self.first(), axis, steps))


class VectorsRow(WordRow):
    """Several places, one below the other, each with a button that takes it away, and one to add another."""

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(about, parent)
        self.lines: list[Boxes] = []
        body = QWidget()
        self._rows = QVBoxLayout(body)
        self._rows.setContentsMargins(0, 0, 0, 0)
        self._rows.setSpacing(1)
        self.add = QToolButton(text="+", toolTip="Add another")
        self.add.clicked.connect(self._add)
        self._rows.addWidget(self.add)
        self.grid.addWidget(body, 2, 0, 1, 2)
        if self.word is not None:
            self.grid.addWidget(self.word, 0, 1)

    def display(self, value: Any) -> None:
        """Bring the controls to a value."""
        places = self.number() or ()
        while len(self.lines) > len(places):
            gone = self.lines.pop()
            self._rows.removeWidget(gone)
            gone.hide()
            gone.deleteLater()
        while len(self.lines) < len(places):
            self._make_line()
        for line, place in zip(self.lines, places, strict=True):
            line.show_place(place)
        with QSignalBlocker(self.add):
            self.add.setEnabled(bool(places))
        self._show_word(value)

    def _make_line(self) -> None:
        line = Boxes()
        gone = QToolButton(text="−", toolTip="Take this one away")
        gone.clicked.connect(lambda: self._remove(line))
        line.line.addWidget(gone)
        line.typed.connect(lambda: self._typed(line))
        line.stepped.connect(lambda axis, steps: self._step(line, axis, steps))
        self.lines.append(line)
        self._rows.insertWidget(len(self.lines) - 1, line)

    def _add(self) -> None:
        places = self.number() or self.first()
        self.enter((*places, places[-1]))

    def _remove(self, line: Boxes) -> None:
        at = self.lines.index(line)
        rest = tuple(place for number, place in enumerate(self.number()) if number != at)
        self.enter(rest or self.about.default)

    def _typed(self, line: Boxes) -> None:
        if line not in self.lines:
            return
        places = list(self.number())
        at = self.lines.index(line)
        if line.texts() == _texts(places[at]):
            self.refuse("")
            return
        self.enter(";".join(",".join(line.texts() if n == at else map(repr, p)) for n, p in enumerate(places)))

    def _step(self, line: Boxes, axis: int, steps: int) -> None:
        at, places = self.lines.index(line), self.number()
        self.enter((*places[:at], _moved(places[at], axis, steps), *places[at + 1:]))


def _texts(place: Place | None) -> list[str]:
    return ["", "", ""] if place is None else [text_of(n) for n in place]


def _moved(place: Place, axis: int, steps: int) -> Place:
    """A place moved along an axis by steps of 1, or of a hundredth of its largest number where that is small."""
    largest = max(abs(n) for n in place)
    step = 1.0 if largest >= 2.0 or largest == 0 else 0.01 * largest
    return tuple(n + steps * step * (k == axis) for k, n in enumerate(place))
