"""The finished picture: water, shadows and several samples a pixel, made in a thread while plain Phong is shown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from qtpy.QtCore import QObject, Signal

from jaart.core.colours import Bytes
from jaart.gui.worker import Job, Worker

if TYPE_CHECKING:
    from jaart.gui.model import SceneModel


class Shader(QObject):
    """Follows the model: whenever its full picture takes more rays to be shaded, they are traced.

    A newer picture stops what runs; while the same one is shaded otherwise, the last colours stay.
    """

    changed = Signal()

    def __init__(self, model: SceneModel) -> None:
        super().__init__(model)
        self.model, self.worker = model, Worker(self)
        self._asked: tuple[Any, ...] = ()
        self._of: Any = None
        self._colours: Bytes | None = None
        for signal in (model.hits_changed, model.settings_changed, model.theme_changed, model.map_changed):
            signal.connect(self.refresh)

    @property
    def colours(self) -> Bytes | None:
        """Finished colours (h, w, 3) of the model's hits, None where there are none yet or none are needed."""
        hits = self.model.hits
        return self._colours if hits is not None and hits.t is self._of and self._needed() else None

    def refresh(self) -> None:
        """Begin to shade the model's picture, or stop."""
        model, hits = self.model, self.model.hits
        if hits is None or not model.complete or not self._needed() or not model.current:
            self._asked = ()
            self.worker.cancel("picture")
            return
        if self._asked and self._asked[0] is hits.t and self._asked[1:] == (model.settings, model.theme):
            return
        self._asked = (hits.t, model.settings, model.theme)
        scene, settings, theme = model.scene, model.settings, model.theme
        assert scene is not None

        def work(job: Job) -> tuple[Any, Bytes]:
            from jaart.core.picture import finish

            job.say("Shading …")
            return hits.t, finish(hits, scene, "shaded", None, theme, settings, job.cancel, job.progress)

        self.worker.submit("picture", work, self._done)

    def _needed(self) -> bool:
        from jaart.core.picture import takes_time

        return takes_time(self.model.settings, self.model.map)

    def _done(self, made: tuple[Any, Bytes]) -> None:
        self._of, self._colours = made
        self.changed.emit()
