"""Rows of numbers and lengths, and of the words that may stand in their place."""

from __future__ import annotations

import math
from typing import Any

from qtpy.QtCore import QSignalBlocker, Qt
from qtpy.QtWidgets import QComboBox, QSlider, QWidget

from jaart.core.parameter import Length, Parameter
from jaart.gui.row import CONTROL_WIDTH, Row
from jaart.gui.values import ValueBox, plain, slider_span, text_of, usual

#: What a list of words says for a value that is none of them.
TYPED = {"vector": "x, y, z", "vectors": "x, y, z"}


class WordRow(Row):
    """A row whose parameter may stand at a word in the place of numbers: a list of its words, and of "value"."""

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(about, parent)
        self.meant: Any = None
        self.word: QComboBox | None = None
        if about.choices:
            self.word = QComboBox(toolTip="A word that follows the scene, or a value of your own.")
            for name in about.choices:
                self.word.addItem(name, name)
            self.word.addItem(TYPED.get(about.kind, "value"), None)
            self.word.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            self.word.wheelEvent = lambda event: event.ignore()  # type: ignore[method-assign]
            self.word.activated.connect(self._chosen)
            self.grid.addWidget(self.word, 1, 0, Qt.AlignmentFlag.AlignLeft)

    def set_meant(self, value: Any) -> None:
        """The value that the word stands for at present, shown, and taken when a value is asked for; None: unknown."""
        value = None if value is None else self.about.check(value)
        changed, self.meant = value != self.meant, value
        if changed and isinstance(self.value, str):
            self.display(self.value)

    def number(self) -> Any:
        """The value, or what its word stands for; None where nobody knows."""
        return self.meant if isinstance(self.value, str) else self.value

    def first(self) -> Any:
        """The value that is taken in the place of a word."""
        return usual(self.about) if self.meant is None else self.meant

    def _chosen(self, _: int) -> None:
        assert self.word is not None
        word = self.word.currentData()
        if word is not None:
            self.enter(word)
        elif isinstance(self.value, str):
            self.enter(self.first())

    def _show_word(self, value: Any) -> None:
        if self.word is not None:
            with QSignalBlocker(self.word):
                at = self.word.findData(value) if isinstance(value, str) else self.word.count() - 1
                self.word.setCurrentIndex(at)


class NumberRow(WordRow):
    """A number, whole number or length: a box to type in and a slider, whose steps follow the unit."""

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(about, parent)
        self.scales = {"": 1.0, "s": 1.0, "d": 0.01}
        self.box = ValueBox()
        self.box.setFixedWidth(CONTROL_WIDTH)
        self.box.editingFinished.connect(self._typed)
        self.box.stepped.connect(lambda steps: self._move(self._place() + steps * about.step))
        self.low, steps = slider_span(about)
        self.slider = QSlider(Qt.Orientation.Horizontal, minimum=0, maximum=steps, pageStep=max(1, steps // 10))
        self.slider.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.slider.valueChanged.connect(lambda at: self._move(self.low + at * about.step))
        self.slider.wheelEvent = lambda event: event.ignore()  # type: ignore[method-assign]
        self.grid.addWidget(self.box, 0, 1)
        self.grid.addWidget(self.slider, 1, 1 if about.choices else 0, 1, 1 if about.choices else 2)

    def set_scene(self, spacing: float, diagonal: float) -> None:
        """How long the scene's spacing and diagonal are: a step of the slider is a share of the spacing in any unit."""
        if self.about.kind == "length" and spacing > 0 and diagonal > 0:
            scales = {"": spacing, "s": 1.0, "d": spacing / diagonal}
            changed, self.scales = scales != self.scales, scales
            if changed:
                self.display(self.value)

    def display(self, value: Any) -> None:
        """Bring the controls to a value."""
        shown = self.number()
        self.box.set_text("" if shown is None else text_of(shown))
        self._show_word(value)
        self.slider.setVisible(shown is not None)
        if shown is not None:
            at = (plain(shown) / self._scale(shown) - self.low) / self.about.step
            with QSignalBlocker(self.slider):
                self.slider.setValue(round(min(max(at, 0), self.slider.maximum())))

    def _scale(self, value: Any) -> float:
        return self.scales[value.unit] if isinstance(value, Length) else 1.0

    def _place(self) -> float:
        """The value in steps of the slider's unit."""
        value = self.number() if self.number() is not None else self.first()
        return plain(value) / self._scale(value)

    def _typed(self) -> None:
        text, shown = self.box.text().strip(), self.number()
        if text != ("" if shown is None else text_of(shown)):
            self.enter(text)
        else:
            self.refuse("")

    def _move(self, place: float) -> None:
        old = self.number() if self.number() is not None else self.first()
        number = rounded(min(max(place, self.low), self.about.high) * self._scale(old))
        self.enter(Length(number, old.unit) if isinstance(old, Length) else number)


def rounded(number: float) -> float:
    """A number to nine digits, and to nine places where it is above 1."""
    digits = 9 if number == 0 else 9 - min(0, math.floor(math.log10(abs(number))))
    return round(number, digits)
