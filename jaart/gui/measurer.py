"""The errors of the full picture, measured beside the window where the exact surface is known."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from qtpy.QtCore import QObject, Signal

from jaart.core.errors import Cancelled
from jaart.core.records import Hits, Quality
from jaart.gui.worker import Job, Worker

if TYPE_CHECKING:
    from jaart.gui.model import SceneModel

#: A picture is painted and rests so long before it is measured [s].
REST = 0.05


class Measurer(QObject):
    """Follows the model: measures its full picture once, in a thread of its own, so that no ray waits for it.

    A newer picture stops what runs. progressed: how far it is, from 0 to 1.
    """

    progressed = Signal(float)

    def __init__(self, model: SceneModel) -> None:
        super().__init__(model)
        self.model, self.worker = model, Worker(self)
        self.worker.progressed.connect(self.progressed)
        self._of: Any = None
        model.hits_changed.connect(self.refresh)
        model.settings_changed.connect(self.refresh)

    def refresh(self) -> None:
        """Begin to measure the model's picture, or stop."""
        model, hits, scene = self.model, self.model.hits, self.model.scene
        if hits is None or scene is None or not scene.known or not model.complete or not model.current:
            self._of = None
            self.worker.cancel("picture")
        elif hits.t is not self._of and model.quality is None:
            self._of = hits.t
            self.worker.submit("picture", lambda job: _measured(job, hits, scene), self._done)

    def _done(self, made: tuple[Any, Quality | None]) -> None:
        of, quality = made
        if self.model.hits is not None and self.model.hits.t is of:
            self.model.show_quality(quality)


def _measured(job: Job, hits: Hits, scene: Any) -> tuple[Any, Quality | None]:
    from jaart.core.quality import quality

    if job.cancel.wait(REST):
        raise Cancelled("a newer picture came")
    return hits.t, quality(hits, scene, job.cancel, job.progress)
