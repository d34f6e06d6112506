"""The controls of a form, made from the declaration of a parameter: a row each, with its own error message."""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import QSignalBlocker, Qt, Signal
from qtpy.QtWidgets import (
    QAbstractSpinBox,
    QCheckBox,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QSizePolicy,
    QSlider,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from jaart.core.errors import SettingsError
from jaart.core.parameter import Length, Parameter
from jaart.gui.values import ValueBox, plain, slider_span, text_of, tip


class Row(QWidget):
    """One parameter: label, control, button back to the default, and a message when a value is refused."""

    entered = Signal(str, object)

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.about, self.value = about, about.default
        self.label = QLabel(f"{about.label} [{about.unit}]" if about.unit else about.label)
        self.reset = QToolButton(text="↺", objectName="reset", toolTip=f"Back to {text_of(about.default)}")
        self.reset.clicked.connect(lambda: self.enter(about.default))
        self.fault = QLabel(objectName="fault", wordWrap=True, visible=False)
        self.setToolTip(tip(about))
        self.grid = QGridLayout(self)
        self.grid.setContentsMargins(8, 2, 2, 2)
        self.grid.setHorizontalSpacing(4)
        self.grid.setVerticalSpacing(1)
        self.grid.setColumnStretch(0, 1)
        self.grid.addWidget(self.label, 0, 0)
        self.grid.addWidget(self.reset, 0, 2)
        self.grid.addWidget(self.fault, 3, 0, 1, 3)
        keep = self.reset.sizePolicy()
        keep.setRetainSizeWhenHidden(True)
        self.reset.setSizePolicy(keep)

    def enter(self, value: Any) -> None:
        """Check a value and pass it on, or say what is wrong with it and leave everything as it is."""
        try:
            checked = self.about.check(value)
        except SettingsError as error:
            self.refuse(str(error))
            return
        self.show_value(checked)
        self.entered.emit(self.about.name, checked)

    def show_value(self, value: Any) -> None:
        """Show a value without telling anyone."""
        self.value = value
        self.reset.setVisible(value != self.about.default)
        self.refuse("")
        self.display(value)

    def refuse(self, message: str) -> None:
        """Show why a value is not taken, or nothing."""
        self.fault.setText(message)
        self.fault.setVisible(bool(message))
        for box in self.findChildren(QLineEdit):
            box.setProperty("fault", bool(message))
            box.style().polish(box)

    def display(self, value: Any) -> None:
        """Bring the controls to a value."""
        raise NotImplementedError


class ChoiceRow(Row):
    """A list of names."""

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(about, parent)
        self.combo = QComboBox()
        self.combo.addItems(about.choices)
        self.combo.setMinimumWidth(CONTROL_WIDTH)
        self.combo.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.combo.activated.connect(lambda _: self.enter(self.combo.currentText()))
        self.grid.addWidget(self.combo, 0, 1)

    def display(self, value: Any) -> None:
        """Bring the controls to a value."""
        with QSignalBlocker(self.combo):
            self.combo.setCurrentText(value)


class FlagRow(Row):
    """On or off."""

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(about, parent)
        self.check = QCheckBox()
        self.check.toggled.connect(self.enter)
        self.grid.addWidget(self.check, 0, 1, Qt.AlignmentFlag.AlignLeft)

    def display(self, value: Any) -> None:
        """Bring the controls to a value."""
        with QSignalBlocker(self.check):
            self.check.setChecked(value)


class WordRow(Row):
    """A row whose parameter may stand at a word in the place of numbers: a box to tick."""

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(about, parent)
        self.meant = about.default
        self.word: QCheckBox | None = None
        if about.choices:
            self.word = QCheckBox(f"as {about.choices[0]}")
            self.word.setToolTip("Ticked: the value follows. Type or drag to set another.")
            self.word.toggled.connect(self._toggled)
            self.grid.addWidget(self.word, 1, 0)

    def set_meant(self, value: Any) -> None:
        """The number that the word stands for at present, shown, and taken when the box is cleared."""
        self.meant = self.about.check(value)
        if isinstance(self.value, str):
            self.display(self.value)

    def number(self) -> Any:
        """The value, or what its word stands for."""
        return self.meant if isinstance(self.value, str) else self.value

    def _toggled(self, checked: bool) -> None:
        self.enter(self.about.choices[0] if checked else self.meant)

    def _show_word(self, value: Any) -> None:
        if self.word is not None:
            with QSignalBlocker(self.word):
                self.word.setChecked(isinstance(value, str))


class NumberRow(WordRow):
    """A number, whole number or length: a box to type in and a slider."""

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(about, parent)
        self.box = ValueBox()
        self.box.setFixedWidth(CONTROL_WIDTH)
        self.box.editingFinished.connect(self._typed)
        self.box.stepped.connect(lambda steps: self._move(plain(self.number()) + steps * about.step))
        self.low, steps = slider_span(about)
        self.slider = QSlider(Qt.Orientation.Horizontal, minimum=0, maximum=steps, pageStep=max(1, steps // 10))
        self.slider.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.slider.valueChanged.connect(lambda at: self._move(self.low + at * about.step))
        self.slider.wheelEvent = lambda event: event.ignore()  # type: ignore[method-assign]
        self.grid.addWidget(self.box, 0, 1)
        self.grid.addWidget(self.slider, 1, 1 if about.choices else 0, 1, 1 if about.choices else 2)

    def display(self, value: Any) -> None:
        """Bring the controls to a value."""
        shown = self.number()
        self.box.set_text(text_of(shown) if not isinstance(shown, str) else "")
        self._show_word(value)
        if not isinstance(shown, str):
            with QSignalBlocker(self.slider):
                self.slider.setValue(round((plain(shown) - self.low) / self.about.step))

    def _typed(self) -> None:
        text = self.box.text().strip()
        if text != text_of(self.number()):
            self.enter(text)
        else:
            self.refuse("")

    def _move(self, number: float) -> None:
        number = round(min(max(number, self.low), self.about.high), 9)
        old = self.number()
        self.enter(Length(number, old.unit) if isinstance(old, Length) else number)


class VectorRow(WordRow):
    """Three numbers x, y, z."""

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(about, parent)
        line = QWidget()
        layout = QHBoxLayout(line)
        layout.setContentsMargins(0, 0, 0, 0)
        self.boxes = [ValueBox() for _ in range(3)]
        for axis, box in enumerate(self.boxes):
            box.setButtonSymbols(QAbstractSpinBox.ButtonSymbols.NoButtons)
            box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
            box.editingFinished.connect(self._typed)
            box.stepped.connect(lambda steps, axis=axis: self._move(axis, steps))
            layout.addWidget(box)
        if self.word is not None:
            self.grid.addWidget(self.word, 0, 1)
        self.grid.addWidget(line, 1, 0, 1, 2)

    def display(self, value: Any) -> None:
        """Bring the controls to a value."""
        shown = self.number()
        numbers = ["", "", ""] if isinstance(shown, str) else [text_of(n) for n in shown]
        for box, text in zip(self.boxes, numbers, strict=True):
            box.set_text(text)
        self._show_word(value)

    def _typed(self) -> None:
        texts = [box.text().strip() for box in self.boxes]
        if texts != [text_of(n) for n in self.number()]:
            self.enter(",".join(texts))
        else:
            self.refuse("")

    def _move(self, axis: int, steps: int) -> None:
        numbers = list(self.number())
        numbers[axis] += steps * (self.about.step or 1.0)
        self.enter(tuple(numbers))


#: Width of boxes and lists, so that they stand in one column [pixels].
CONTROL_WIDTH = 96

ROWS: dict[str, type[Row]] = {"choice": ChoiceRow, "flag": FlagRow, "vector": VectorRow, "number": NumberRow,
                              "integer": NumberRow, "length": NumberRow}


def make_row(about: Parameter) -> Row:
    """The row of a parameter, showing its default."""
    row = ROWS[about.kind](about)
    row.show_value(about.default)
    return row


def column(*widgets: QWidget) -> QVBoxLayout:
    """A tight column of widgets."""
    layout = QVBoxLayout()
    layout.setContentsMargins(0, 0, 0, 0)
    layout.setSpacing(0)
    for widget in widgets:
        layout.addWidget(widget)
    return layout
