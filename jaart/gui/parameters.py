"""The parameters panel: presets and one section for each group of settings."""

from __future__ import annotations

from collections.abc import Callable
from itertools import groupby
from typing import Any

from qtpy.QtCore import QSignalBlocker, Qt
from qtpy.QtWidgets import QComboBox, QFormLayout, QScrollArea, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from jaart.core.parameter import Parameter
from jaart.core.settings import PARAMETERS, PRESETS, preset
from jaart.gui.form import Row, WordRow, column, make_row
from jaart.gui.model import SceneModel

#: What is shown when the values are those of no preset.
OWN = "own values"


class Section(QWidget):
    """A heading that folds its rows away."""

    def __init__(self, title: str, rows: list[Row], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.rows, self.title = rows, title
        self.heading = QToolButton(text=title, objectName="section", checkable=True, checked=True)
        self.heading.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.heading.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.body = QWidget()
        self.body.setLayout(column(*rows))
        self.heading.toggled.connect(self._fold)
        self._fold(True)
        self.setLayout(column(self.heading, self.body))

    def _fold(self, opened: bool) -> None:
        self.heading.setArrowType(Qt.ArrowType.DownArrow if opened else Qt.ArrowType.RightArrow)
        self.body.setVisible(opened)


class Parameters(QScrollArea):
    """The form of the settings; follows the model and writes to it."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.model = model
        self.rows = {p.name: make_row(p) for p in PARAMETERS.values() if offers_choice(p)}
        for row in self.rows.values():
            row.entered.connect(self.model.set_value)
        self.sections = [Section(group, list(rows))
                         for group, rows in groupby(self.rows.values(), key=lambda row: row.about.group)]
        self._preset = next(iter(PRESETS))
        self.presets = QComboBox()
        self.presets.addItems(list(PRESETS))
        self.presets.setToolTip("Whole sets of values; single ones can then be changed below.\n"
                                "thesis: as its source has it; best: what was measured to be best, so far the same.")
        self.presets.activated.connect(self._choose_preset)
        self._lay_out()
        for signal in (model.settings_changed, model.scene_changed, model.camera_changed):
            signal.connect(self.refresh)
        self.refresh()

    def _lay_out(self) -> None:
        body = QWidget()
        layout = QVBoxLayout(body)
        layout.setContentsMargins(4, 6, 6, 6)
        layout.setSpacing(2)
        top = QFormLayout()
        top.setContentsMargins(8, 0, 26, 4)
        top.addRow("Preset", self.presets)
        layout.addLayout(top)
        for section in self.sections:
            layout.addWidget(section)
        layout.addStretch(1)
        self.setWidget(body)
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)

    def refresh(self) -> None:
        """Show the model's settings; rows without a meaning beside the others are hidden."""
        settings = self.model.settings
        for name, row in self.rows.items():
            value = getattr(settings, name)
            if isinstance(row, WordRow) and name in MEANT:
                row.set_meant(MEANT[name](self.model))
            if value != row.value:
                row.show_value(value)
            row.setVisible(row.about.matters(settings))
        for section in self.sections:
            section.setVisible(section.title != "Model" or self._is_model())
        self._show_preset()

    def _is_model(self) -> bool:
        return self.model.scene is not None and self.model.scene.model is not None

    def _show_preset(self) -> None:
        shown = [name for name, row in self.rows.items() if row.about.group != "Model" or self._is_model()]
        names = [name for name in PRESETS
                 if all(getattr(preset(name), n) == getattr(self.model.settings, n) for n in shown)]
        names.sort(key=lambda name: name != self._preset)
        with QSignalBlocker(self.presets):
            self.presets.removeItem(self.presets.findText(OWN))
            if not names:
                self.presets.addItem(OWN)
                self.presets.setCurrentText(OWN)
            else:
                self.presets.setCurrentText(names[0])

    def _choose_preset(self) -> None:
        if self.presets.currentText() in PRESETS:
            self._preset = self.presets.currentText()
            self.model.set_settings(preset(self.presets.currentText()))


def offers_choice(about: Parameter) -> bool:
    """Whether there is anything to choose."""
    return about.kind != "choice" or len(about.choices) > 1


def _raster(model: SceneModel) -> int:
    known = model.scene.model if model.scene is not None else None
    return known.raster if known is not None else 16


def _light(model: SceneModel) -> tuple[float, float, float]:
    return tuple(round(n, 2) for n in model.camera.eye) if model.camera is not None else (0.0, 0.0, 0.0)


#: What the words of some parameters stand for.
MEANT: dict[str, Callable[[SceneModel], Any]] = {
    "trust": lambda model: model.settings.radius, "raster": _raster, "light": _light}
