"""Values in controls: as text, on a slider, in a box that takes any text."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import QAbstractSpinBox, QWidget

from jaart.core.parameter import Length, Parameter
from jaart.gui import theme

#: Longest slider [steps]; wider ranges are typed.
SLIDER_STEPS = 400


class ValueBox(QAbstractSpinBox):
    """A spin box that takes any text, so that what is typed can be checked and refused in words."""

    stepped = Signal(int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFont(theme.tabular(self.font()))
        self.setKeyboardTracking(False)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def set_text(self, text: str) -> None:
        """Show a text without telling anyone."""
        self.lineEdit().setText(text)
        self.lineEdit().setCursorPosition(0)

    def stepBy(self, steps: int) -> None:
        """Say how many steps up or down were asked for."""
        self.stepped.emit(steps)

    def stepEnabled(self) -> QAbstractSpinBox.StepEnabledFlag:
        """Both ways at any time; what is too far is refused in words."""
        return self.StepEnabledFlag.StepUpEnabled | self.StepEnabledFlag.StepDownEnabled

    def wheelEvent(self, event: Any) -> None:
        """Leave the wheel to the form: it scrolls."""
        event.ignore()


def slider_span(about: Parameter) -> tuple[float, int]:
    """Lowest value and number of steps of a slider; open or wide ranges end at a few times the default."""
    low = about.low + about.step if about.open_low else about.low
    steps = (about.high - low) / about.step
    if steps > SLIDER_STEPS:
        usual = about.default if not isinstance(about.default, str) else 32 * about.step
        steps = (4 * plain(usual) - low) / about.step
    return low, max(1, math.floor(min(steps, SLIDER_STEPS) + 1e-9))


def plain(value: Any) -> float:
    """The number of a value, without its unit."""
    return float(value.value if isinstance(value, Length) else value)


def text_of(value: Any) -> str:
    """A value as it would be typed."""
    if isinstance(value, Length):
        return str(replace(value, value=round(value.value, 9)))
    if isinstance(value, tuple):
        return ",".join(f"{n:.5g}" for n in value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def tip(about: Parameter) -> str:
    """What a parameter means, where it comes from and what may be typed."""
    lines = [about.help, f"<i>{about.source}</i>" if about.source else "", f"Takes {escape(about.expected)}.",
             f"<code>--set {about.name}={escape(text_of(about.default))}</code>"]
    return "<qt>" + "<br>".join(escape(line) if line is about.help else line for line in lines if line) + "</qt>"


def escape(text: str) -> str:
    """Text that holds < or > for a rich label."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
