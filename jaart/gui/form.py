"""The controls of a form, made from the declaration of a parameter: a row each, with its own error message."""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import QSignalBlocker, Qt
from qtpy.QtWidgets import QCheckBox, QComboBox, QWidget

from jaart.core.parameter import Parameter
from jaart.gui.number_row import NumberRow, WordRow
from jaart.gui.row import Row, column
from jaart.gui.vector_rows import VectorRow, VectorsRow

__all__ = ["ChoiceRow", "FlagRow", "NumberRow", "Row", "VectorRow", "VectorsRow", "WordRow", "column", "make_row"]

#: Width of a list of names, which may say what "auto" stands for [pixels].
LIST_WIDTH = 128


class ChoiceRow(Row):
    """A list of names; the one that leaves the choice to the program says what it stands for."""

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(about, parent)
        self.combo = QComboBox()
        for name in about.choices:
            self.combo.addItem(name, name)
        self.combo.setFixedWidth(LIST_WIDTH)
        self.combo.view().setMinimumWidth(LIST_WIDTH + 40)
        self.combo.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.combo.wheelEvent = lambda event: event.ignore()  # type: ignore[method-assign]
        self.combo.activated.connect(lambda _: self.enter(self.combo.currentData()))
        self.grid.addWidget(self.combo, 0, 1)

    def set_meant(self, value: Any) -> None:
        """Show what "auto" stands for at present."""
        if "auto" in self.about.choices:
            self.combo.setItemText(self.combo.findData("auto"), "auto" if value is None else f"auto: {value}")

    def display(self, value: Any) -> None:
        """Bring the controls to a value."""
        with QSignalBlocker(self.combo):
            self.combo.setCurrentIndex(self.combo.findData(value))


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


ROWS: dict[str, type[Row]] = {
    "choice": ChoiceRow, "flag": FlagRow, "vector": VectorRow, "vectors": VectorsRow, "number": NumberRow,
    "integer": NumberRow, "length": NumberRow}


def make_row(about: Parameter) -> Row:
    """The row of a parameter, showing its default."""
    row = ROWS[about.kind](about)
    row.show_value(about.default)
    return row
