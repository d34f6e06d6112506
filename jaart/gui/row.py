"""What the rows of a form have in common: a label, a way back to the preset's value, and room for an error message."""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import Signal
from qtpy.QtWidgets import QGridLayout, QLabel, QLineEdit, QToolButton, QVBoxLayout, QWidget

from jaart.core.errors import SettingsError
from jaart.core.parameter import Parameter
from jaart.gui.values import text_of, tip, unit_in

#: Width of boxes and lists, so that they stand in one column [pixels].
CONTROL_WIDTH = 96


class Row(QWidget):
    """One parameter: label, control, button back to the preset's value, and a message when a value is refused."""

    entered = Signal(str, object)

    def __init__(self, about: Parameter, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.about, self.value, self.base = about, about.default, about.default
        self.label = QLabel(wordWrap=True)
        self.label.setMinimumWidth(60)
        self.reset = QToolButton(text="↺", objectName="reset", toolTip=f"Back to {text_of(self.base)}")
        self.reset.clicked.connect(lambda: self.enter(self.base))
        self.fault = QLabel(objectName="fault", wordWrap=True, visible=False)
        self.grid = QGridLayout(self)
        self.grid.setContentsMargins(8, 2, 2, 2)
        self.grid.setHorizontalSpacing(4)
        self.grid.setVerticalSpacing(1)
        self.grid.setColumnStretch(0, 1)
        self.grid.addWidget(self.label, 0, 0)
        self.grid.addWidget(self.reset, 0, 2)
        self.grid.addWidget(self.fault, 9, 0, 1, 3)
        keep = self.reset.sizePolicy()
        keep.setRetainSizeWhenHidden(True)
        self.reset.setSizePolicy(keep)
        self.kind = ""
        self.set_kind("lattice")

    def set_kind(self, kind: str) -> None:
        """Say the unit that the parameter has in a kind of scene."""
        if kind == self.kind:
            return
        self.kind = kind
        unit = unit_in(self.about, kind)
        self.label.setText(f"{self.about.label} [{unit}]" if unit else self.about.label)
        self.setToolTip(tip(self.about, unit))

    def set_base(self, value: Any) -> None:
        """Set the value that the button goes back to: the chosen preset's."""
        if value != self.base:
            self.base = value
            self.reset.setToolTip(f"Back to {text_of(value)}")
        self.reset.setVisible(self.value != value)

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
        self.reset.setVisible(value != self.base)
        self.refuse("")
        self.display(value)

    def refuse(self, message: str) -> None:
        """Show why a value is not taken, or nothing."""
        if message == self.fault.text():
            return
        self.fault.setText(message)
        self.fault.setVisible(bool(message))
        for box in (self.label, *self.findChildren(QLineEdit)):
            box.setProperty("fault", bool(message))
            box.style().polish(box)

    def set_meant(self, value: Any) -> None:
        """Show what a word stands for at present, None where nobody knows; rows without words have no use for it."""

    def display(self, value: Any) -> None:
        """Bring the controls to a value."""
        raise NotImplementedError


def column(*widgets: QWidget) -> QVBoxLayout:
    """A tight column of widgets."""
    layout = QVBoxLayout()
    layout.setContentsMargins(0, 0, 0, 0)
    layout.setSpacing(0)
    for widget in widgets:
        layout.addWidget(widget)
    return layout
