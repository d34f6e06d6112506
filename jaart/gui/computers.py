"""The threads that compute for a window, taken together."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from jaart.gui.worker import Worker

if TYPE_CHECKING:
    from jaart.gui.model import SceneModel


class Computers:
    """A model's workers, whose reports go to it.

    rays: traces rays; painter: only draws, so that nobody waits for it; refuse(message), ended(): what the model does
    when settings make no sense, and when a worker has nothing left to do.
    """

    def __init__(self, model: SceneModel, rays: Worker, painter: Worker, refuse: Callable[[str], None],
                 ended: Callable[[], None]) -> None:
        self.workers, self.painter = (rays, model.shader.worker, model.measurer.worker), painter
        painter.failed.connect(model.failed)
        for worker in self.workers:
            worker.begun.connect(model.begun)
            worker.failed.connect(model.failed)
            worker.refused.connect(refuse)
            worker.said.connect(model.said)
            worker.ended.connect(ended)
        rays.staged.connect(model.staged)
        for worker in self.workers[:2]:
            worker.progressed.connect(model.progressed)

    @property
    def computing(self) -> bool:
        """Whether any of them has work."""
        return not all(worker.idle for worker in self.workers)

    def cancel(self) -> None:
        """Stop what they do and forget what waits."""
        for worker in self.workers:
            worker.cancel_all()

    def close(self) -> None:
        """End the threads."""
        for worker in (*self.workers, self.painter):
            worker.stop()
