"""How a picture is looked at: which of its numbers, and in which theme."""

from __future__ import annotations

from qtpy.QtCore import QObject, Signal


class Look(QObject):
    """The map that is shown and the theme; nothing is computed anew for them but colours."""

    map_changed = Signal()
    theme_changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.map, self.theme = "shaded", "light"

    def set_map(self, name: str) -> None:
        """Choose what the picture shows: a name of jaart.core.shade.MAPS."""
        if name != self.map:
            self.map = name
            self.map_changed.emit()

    def set_theme(self, name: str) -> None:
        """Choose "light" or "dark"."""
        if name != self.theme:
            self.theme = name
            self.theme_changed.emit()
