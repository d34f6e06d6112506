"""Saying that a picture is being prepared when nothing of it can be shown for a while."""

from __future__ import annotations

from typing import TYPE_CHECKING

from qtpy.QtCore import QTimer

if TYPE_CHECKING:
    from jaart.gui.model import SceneModel

#: When a picture has shown nothing for so long, it is told what it does [ms].
PATIENCE_MS = 500


class Preparing(QTimer):
    """Started with each picture and stopped by its first coarse one.

    Points are sorted and given normals in that time, and kernels compiled that were never used before.
    """

    def __init__(self, model: SceneModel) -> None:
        super().__init__(model, singleShot=True, interval=PATIENCE_MS)
        self.model = model
        self.timeout.connect(self._say)

    def _say(self) -> None:
        if self.model.computing and self.model.scene is not None:
            points = self.model.scene.points
            what = "the scene" if points is None else f"{len(points):,} points".replace(",", "\N{THIN SPACE}")
            self.model.said.emit(f"Preparing {what} …")
