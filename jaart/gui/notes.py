"""What a person should know of the scene, settings and picture that are shown: all that holds now, a line each."""

from __future__ import annotations

from typing import TYPE_CHECKING

from qtpy.QtCore import QObject, Signal

from jaart.core.records import Hits
from jaart.core.scene import Scene
from jaart.plot.style import OUTCOMES

if TYPE_CHECKING:
    from jaart.gui.model import SceneModel


class Notes(QObject):
    """The notes that hold now; the model says each of them when it begins to hold.

    now: those to show; what was repaired on reading a sample is said, not shown.
    """

    changed = Signal()

    def __init__(self, model: SceneModel) -> None:
        super().__init__(model)
        self.model = model
        self.now: tuple[str, ...] = ()
        self._empty: tuple[str, ...] = ()
        self._said: tuple[str, ...] = ()
        model.scene_changed.connect(self._begin)
        model.known_changed.connect(self.refresh)
        model.hits_changed.connect(self.refresh)

    def refresh(self) -> None:
        """Gather the notes anew; of the picture once it is a full one."""
        scene, known, hits = self.model.scene, self.model.known, self.model.hits
        if hits is not None and self.model.complete:
            self._empty = empty(hits)
        read = scene.notes if scene is not None else ()
        gathered = tuple(dict.fromkeys((*read, *(known.notes if known is not None else ()), *self._empty)))
        for note in gathered:
            if note not in self._said:
                self.model.said.emit(note)
        ours = read if scene is not None and _built_in(scene) else ()  # nobody's file: not worth a bar
        old, self._said, self.now = self.now, gathered, tuple(note for note in gathered if note not in ours)
        if self.now != old:
            self.changed.emit()

    def _begin(self) -> None:
        """Nothing holds of a new scene but what is known of itself; all is said again."""
        self.now = self._empty = self._said = ()
        self.changed.emit()
        self.refresh()


def _built_in(scene: Scene) -> bool:
    from jaart.core.io import BUILT_IN

    return scene.source in BUILT_IN


def empty(hits: Hits) -> tuple[str, ...]:
    """Why a picture has no hit, where rays did not simply miss."""
    ends = [OUTCOMES[name] for name in hits.counts() if name != "background"]
    if not ends or hits.hit.any():
        return ()
    return (f"no ray of this picture meets the surface; those that come near end so: {', '.join(ends)}",)
