"""Values in controls: as text, on a slider, in a box that takes any text."""

from __future__ import annotations

import math
from typing import Any

from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import QAbstractSpinBox, QWidget

from jaart.core.parameter import Length, Parameter
from jaart.gui import theme

#: Longest slider [steps]; wider ranges are typed.
SLIDER_STEPS = 400
#: A slider whose range has no end below begins so many steps below 0.
LOWEST = 100


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
    low = max(about.low + about.step if about.open_low else about.low, -LOWEST * about.step)
    steps = (about.high - low) / about.step
    if steps > SLIDER_STEPS:
        steps = (4 * plain(usual(about)) - low) / about.step
    return low, max(1, math.floor(min(steps, SLIDER_STEPS) + 1e-9))


def usual(about: Parameter) -> Any:
    """A value to begin with where the default is a word: 32 steps, or the middle of a narrow range."""
    if not isinstance(about.default, str):
        return about.default
    if about.kind in ("vector", "vectors"):
        return about.check((0.0, 0.0, 0.0))
    wide = about.high - about.low > SLIDER_STEPS * about.step
    number = 32 * about.step if wide else (about.low + about.high) / 2
    return about.check(Length(number, "s") if about.kind == "length" else number)


def plain(value: Any) -> float:
    """The number of a value, without its unit."""
    return float(value.value if isinstance(value, Length) else value)


def text_of(value: Any) -> str:
    """A value as it would be typed."""
    if isinstance(value, Length):
        return f"{value.value:.6g}{value.unit}"
    if isinstance(value, tuple):
        return ";".join(map(text_of, value)) if isinstance(value[0], tuple) else ",".join(f"{n:.5g}" for n in value)
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def unit_in(about: Parameter, kind: str) -> str:
    """The unit of a parameter in a kind of scene: lengths count in cells of a lattice, in units of a cloud."""
    if kind == "cloud":
        return "h" if about.name == "step" else "units" if about.unit == "cells" else about.unit
    return "cells" if about.unit == "units" else about.unit


def tip(about: Parameter, unit: str) -> str:
    """What a parameter means, its unit, where it comes from and what may be typed."""
    source = f"<i>{escape(about.source)}</i>" if about.source else ""
    lines = [escape(about.help), f"Unit: {unit}." if unit else "", source, f"Takes {escape(about.expected)}.",
             f"<code>--set {about.name}={escape(text_of(about.default))}</code>"]
    return "<qt>" + "<br>".join(line for line in lines if line) + "</qt>"


def escape(text: str) -> str:
    """Text that holds < or > for a rich label."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
