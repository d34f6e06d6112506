"""The parameters panel: presets and one section for each group of settings."""

from __future__ import annotations

from itertools import groupby

from qtpy.QtCore import QSignalBlocker, Qt
from qtpy.QtWidgets import QComboBox, QFormLayout, QScrollArea, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from jaart.core.parameter import Parameter
from jaart.core.settings import PARAMETERS, PRESETS, preset
from jaart.gui.form import NumberRow, Row, column, make_row
from jaart.gui.meant import meant
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
        self._marked: Row | None = None
        self.rows = {p.name: make_row(p) for p in PARAMETERS.values() if offers_choice(p)}
        for row in self.rows.values():
            row.entered.connect(self.model.set_value)
        self.sections = [Section(group, list(rows))
                         for group, rows in groupby(self.rows.values(), key=lambda row: row.about.group)]
        self.presets = QComboBox()
        self.presets.addItems(list(PRESETS))
        self.presets.setToolTip("Whole sets of values; single ones can then be changed below.\n"
                                "best: what was measured to be best; thesis, adamson-alexa: as these sources have it.")
        self.presets.activated.connect(self._choose_preset)
        self._lay_out()
        for signal in (model.settings_changed, model.scene_changed, model.camera_changed, model.known_changed,
                       model.fault_changed):
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
        """Show the model's settings; rows without a meaning beside the others or in the scene are hidden."""
        settings, kind, base = self.model.settings, self.model.kind, self.model.base
        name_at_fault, why = self.model.fault or ("", "")
        for name, row in self.rows.items():
            value = getattr(settings, name)
            row.set_base(getattr(base, name))
            self._tell_scene(row)
            if value != row.value:
                row.show_value(value)
            if name == name_at_fault or row is self._marked:
                row.refuse(why if name == name_at_fault else "")
            row.setVisible(name == name_at_fault or (row.about.matters(settings) and kind in row.about.scenes))
        self._marked = self.rows.get(name_at_fault)
        for section in self.sections:
            section.setVisible(any(not row.isHidden() for row in section.rows))
        if self._marked is not None:
            self.ensureWidgetVisible(self._marked)
        self._show_preset()

    def _tell_scene(self, row: Row) -> None:
        """What the scene has to do with a row: its units, and what its words stand for."""
        row.set_kind(self.model.kind)
        if isinstance(row, NumberRow) and self.model.known is not None:
            row.set_scene(self.model.known.spacing, self.model.known.diagonal)
        row.set_meant(meant(row.about.name, self.model))

    def _show_preset(self) -> None:
        shown = [name for name, row in self.rows.items() if self.model.kind in row.about.scenes]
        bases = {name: preset(name) for name in PRESETS} | {self.model.preset: self.model.base}
        names = [name for name, base in bases.items()
                 if all(getattr(base, n) == getattr(self.model.settings, n) for n in shown)]
        names.sort(key=lambda name: name != self.model.preset)
        with QSignalBlocker(self.presets):
            self.presets.removeItem(self.presets.findText(OWN))
            if not names:
                self.presets.addItem(OWN)
                self.presets.setCurrentText(OWN)
            else:
                self.presets.setCurrentText(names[0])

    def _choose_preset(self) -> None:
        if self.presets.currentText() in PRESETS:
            self.model.choose_preset(self.presets.currentText())


def offers_choice(about: Parameter) -> bool:
    """Whether there is anything to choose."""
    return about.kind != "choice" or len(about.choices) > 1
