"""What runs and what is left out: a line in the status bar that opens the whole list, each stage with its reason."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from qtpy.QtCore import Qt, QTimer, Signal
from qtpy.QtWidgets import QDialog, QHeaderView, QToolButton, QTreeWidget, QTreeWidgetItem, QVBoxLayout, QWidget

from jaart.gui.model import SceneModel

if TYPE_CHECKING:
    from jaart.core.camera import Camera
    from jaart.core.plan import Plan, Value
    from jaart.core.records import Hits
    from jaart.core.scene import Scene
    from jaart.core.settings import Settings

#: How long settings must rest before the plan follows them [ms].
REST = 150


class PlanLine(QToolButton):
    """The plan in some words; a click opens all of it.

    plan: that of the settings which are shown, None where there is none; dialog: the whole list once it was opened.
    """

    changed = Signal()

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.model = model
        self.plan: Plan | None = None
        self.dialog: PlanDialog | None = None
        self.setObjectName("plan")
        self.setAutoRaise(True)
        self.setToolTip("What runs and what is left out, and why")
        self.clicked.connect(self.open)
        self.hide()
        self._rest = QTimer(self, singleShot=True, interval=REST)
        self._rest.timeout.connect(self._ask)
        for signal in (model.scene_changed, model.settings_changed, model.fault_changed, model.hits_changed):
            signal.connect(self._rest.start)

    def open(self) -> None:
        """Show all of the plan in a window that holds nothing up."""
        if self.dialog is None:
            self.dialog = PlanDialog(self, self.window())
        self.dialog.show()
        self.dialog.raise_()

    def _ask(self) -> None:
        """Have the plan made in a thread; what rays make may have to be waited for."""
        model = self.model
        scene, settings, camera, size = model.scene, model.settings, model.camera, model.size
        if scene is None or camera is None or not model.complete:
            return
        model.draw_later(lambda: made(scene, settings, camera, size), self._show, "plan")

    def _show(self, plan: Plan | None) -> None:
        self.plan = plan
        self.setVisible(plan is not None)
        if plan is not None:
            self.setText(line(plan, self.model.hits))
        self.changed.emit()


class PlanDialog(QDialog):
    """All stages in three groups, which follow the settings: what runs, what is left out, what `auto` came to."""

    def __init__(self, source: PlanLine, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.source = source
        self.setWindowTitle("What runs and what is left out")
        self.list = QTreeWidget(rootIsDecorated=False, alternatingRowColors=True, wordWrap=True)
        self.list.setHeaderLabels(["", "Why", "Decided by"])
        self.list.setVerticalScrollMode(QTreeWidget.ScrollMode.ScrollPerPixel)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.list)
        self.resize(980, 760)
        source.changed.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Show the plan that holds now."""
        self.list.clear()
        plan = self.source.plan
        if plan is None:
            return
        for title, stages in (("Runs", plan.runs), ("Left out", plan.left_out)):
            self._group(title, [(s.name, s.reason, ", ".join(f"{name} = {value}" for name, value in
                                                             plan.deciding(s).items())) for s in stages])
        self._group("Values", [(v.name, f"{number(v)}: {v.origin}", "") for v in plan.values])
        header = self.list.header()
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.Stretch)

    def _group(self, title: str, rows: list[tuple[str, str, str]]) -> None:
        group = QTreeWidgetItem(self.list, [f"{title} ({len(rows)})"])
        font = group.font(0)
        font.setBold(True)
        group.setFont(0, font)
        for row in rows:
            item = QTreeWidgetItem(group, list(row))
            for column, text in enumerate(row):
                item.setToolTip(column, text)
                item.setTextAlignment(column, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
        group.setFirstColumnSpanned(True)
        group.setExpanded(True)


def made(scene: Scene, settings: Settings, camera: Camera, size: tuple[int, int]) -> Plan | None:
    """The plan; None for settings that are refused, which the window says elsewhere."""
    from jaart.core.errors import SettingsError
    from jaart.core.plan import plan

    try:
        return plan(scene, settings, camera, size)
    except SettingsError:
        return None


def line(plan: Plan, hits: Hits | None) -> str:
    """A plan in some words: method, surfels that an evaluation weighs, eigenvectors, and what is left out."""
    words = [plan.settings.method]
    if hits is not None and hits.evaluations.any():
        words.append(f"{hits.neighbours.sum() / hits.evaluations.sum():.0f} near")
    if not plan["covariance and eigenvector"].runs:
        words.append("no eigenvectors")
    elif hits is not None:
        words.append(f"{int(hits.eigenvectors.sum())} eigenvectors")
    return f"{', '.join(words)}; {len(plan.left_out)} left out"


def number(value: Value) -> str:
    """A value with its unit as it is read."""
    if isinstance(value.value, str):
        return value.value
    return "none" if math.isinf(value.value) else f"{value.value:.6g} {value.unit}".rstrip()
