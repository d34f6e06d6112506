"""SceneModel: the one shared state of the window; panels listen to it and write to it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from qtpy.QtCore import QObject, Signal

from jaart.core.camera import Camera
from jaart.core.records import Hits, Quality, Trace
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.gui import tasks
from jaart.gui.tasks import Extent
from jaart.gui.worker import Worker

if TYPE_CHECKING:
    from os import PathLike

#: While the camera is dragged, pictures are made smaller until one takes about this long [s].
DRAG_SECONDS = 0.03

#: Size of a picture in pixels when nobody says.
PICTURE = (512, 512)


class SceneModel(QObject):
    """Scene, settings, camera, picture, picked ray and theme, and the work that follows their changes.

    Pixels (x, y) count from the top left of the full picture of `size` (width, height). Files are
    read, and pictures and traces made, in a worker thread; results arrive as signals.
    """

    scene_changed = Signal()
    settings_changed = Signal()
    camera_changed = Signal()
    hits_changed = Signal()
    map_changed = Signal()
    picked_changed = Signal()
    trace_changed = Signal()
    step_changed = Signal()
    theme_changed = Signal()
    progressed = Signal(float)
    settled = Signal()
    failed = Signal(str)
    said = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.scene: Scene | None = None
        self.settings = Settings()
        self.camera: Camera | None = None
        self.extent: Extent = (1.0, 1.0, 1.0)
        self.size = PICTURE
        self.hits: Hits | None = None
        self.quality: Quality | None = None
        self.map = "shaded"
        self.picked: tuple[int, int] | None = None
        self.trace: Trace | None = None
        self.step = 0
        self.theme = "light"
        self._worker, self._painter = Worker(self), Worker(self)
        self._painter.failed.connect(self.failed)
        self._worker.progressed.connect(self.progressed)
        self._worker.failed.connect(self.failed)
        self._worker.said.connect(self.said)
        self._worker.ended.connect(self.settled)

    @property
    def idle(self) -> bool:
        """Whether nothing is being read, rendered, traced or drawn."""
        return not self.computing and self._painter.idle

    @property
    def computing(self) -> bool:
        """Whether something is being read, rendered or traced."""
        return not self._worker.idle

    @property
    def complete(self) -> bool:
        """Whether the picture is the full one, not a coarse first one."""
        return self.hits is not None and self.hits.size == self.size

    def open(self, source: str | PathLike[str], frame: int | None = None, camera: Camera | None = None) -> None:
        """Read a scene; when it cannot be read, `failed` says why and the old scene stays."""
        settings = self.settings
        self.said.emit(f"Reading {source} …")
        self._worker.submit("open", lambda job: tasks.read(source, frame, settings),
                            lambda read: self._opened(*read, camera))

    def set_value(self, name: str, value: Any) -> None:
        """Change one setting. Raises SettingsError when it cannot take the value."""
        self.set_settings(self.settings.replace(**{name: value}))

    def set_settings(self, settings: Settings) -> None:
        """Change the settings; only the stages that they enter are computed again."""
        old, self.settings = self.settings, settings
        if settings == old:
            return
        if self.hits is not None:
            self.hits = _with_settings(self.hits, settings)
        self.settings_changed.emit()
        if self.scene is not None and settings.key("rays") != old.key("rays"):
            self._keep_view()
            self._render()
        elif settings.key("trace") != old.key("trace"):
            self._trace()

    def set_camera(self, camera: Camera, dragging: bool = False) -> None:
        """Look from elsewhere; while dragging, smaller pictures are made so that they keep up."""
        if camera == self.camera and (dragging or (self.idle and self.complete)):
            return
        self.camera = camera
        self.camera_changed.emit()
        self._render(dragging)

    def set_size(self, width: int, height: int) -> None:
        """Change the size of the picture in pixels; the picked pixel stays at its place."""
        if (width, height) == self.size:
            return
        old, self.size = self.size, (width, height)
        if self.picked is not None:
            self.picked = (self.picked[0] * width // old[0], self.picked[1] * height // old[1])
            self.picked_changed.emit()
        self._render()

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

    def pick(self, x: int, y: int) -> None:
        """Trace the ray through pixel (x, y); a pixel outside the picture is moved to its edge."""
        self.picked = (min(max(x, 0), self.size[0] - 1), min(max(y, 0), self.size[1] - 1))
        self.picked_changed.emit()
        self._trace()

    def clear_pick(self) -> None:
        """Forget the picked ray."""
        self._worker.cancel("trace")
        self.picked, self.trace, self.step = None, None, 0
        self.picked_changed.emit()
        self.trace_changed.emit()

    def set_step(self, index: int) -> None:
        """Show a step of the picked ray, counted from 0 over all starts; moved into range."""
        last = self.trace.steps - 1 if self.trace is not None else 0
        index = max(0, min(index, last))
        if index != self.step:
            self.step = index
            self.step_changed.emit()

    def draw_later(self, work: Callable[[], Any], done: Callable[[Any], None]) -> None:
        """Have something drawn for a panel in a thread of its own; the newest drawing wins."""
        self._painter.submit("figure", lambda job: work(), done, brief=True)

    def close(self) -> None:
        """Cancel what runs and end the threads."""
        self._worker.stop()
        self._painter.stop()

    def _opened(self, scene: Scene, extent: Extent, camera: Camera | None) -> None:
        same = self.scene is not None and self.scene.source == scene.source and self.extent == extent
        for kind in ("picture", "trace"):
            self._worker.cancel(kind)
        self.scene, self.extent = scene, extent
        self.hits = self.quality = self.trace = None
        self.step = 0
        if not same:
            self.picked = None
        if camera is not None or self.camera is None or not same:
            self.camera = camera or Camera.fit(extent)
        for signal in (self.scene_changed, self.camera_changed, self.hits_changed, self.picked_changed,
                       self.trace_changed):
            signal.emit()
        for note in scene.notes:
            self.said.emit(note)
        self._render()

    def _keep_view(self) -> None:
        """Follow a scene whose raster changed, so that it is seen as before."""
        from jaart.core.prepare import extent

        assert self.scene is not None
        assert self.camera is not None
        old, self.extent = self.extent, extent(self.scene, self.settings)
        if old != self.extent:
            scale = np.asarray(self.extent) / np.asarray(old)
            width = None if self.camera.ortho is None else self.camera.ortho * float(scale.mean())
            self.camera = self.camera.replace(eye=tuple(self.camera.eye * scale), ortho=width,
                                              target=tuple(self.camera.target * scale))
            self.camera_changed.emit()

    def _render(self, dragging: bool = False) -> None:
        if self.scene is None or self.camera is None:
            return
        scene, settings, camera = self.scene, self.settings, self.camera
        size = self._drag_size() if dragging else self.size
        self._worker.submit("picture", lambda job: tasks.picture(job, scene, settings, camera, size, dragging),
                            lambda made: self._show(*made), lambda hits: self._show(hits, None),
                            brief=dragging)

    def _drag_size(self) -> tuple[int, int]:
        seconds = 0.0 if self.hits is None else self.hits.ray_s / len(self.hits) * self.size[0] * self.size[1]
        factor = next((f for f in (1, 2, 4) if seconds / f**2 <= DRAG_SECONDS), 8)
        return -(-self.size[0] // factor), -(-self.size[1] // factor)

    def _show(self, hits: Hits, quality: Quality | None) -> None:
        self.hits, self.quality = _with_settings(hits, self.settings), quality
        self.hits_changed.emit()
        if self.complete:
            self.progressed.emit(1.0)
            self._trace()

    def _trace(self) -> None:
        if self.scene is None or self.camera is None or self.picked is None:
            return
        scene, settings, camera, size, pixel = self.scene, self.settings, self.camera, self.size, self.picked
        self._worker.submit("trace", lambda job: tasks.ray(scene, settings, camera, size, pixel), self._traced,
                            brief=True)

    def _traced(self, trace: Trace) -> None:
        same = self.trace is not None and self.trace.pixel == trace.pixel
        self.trace = trace
        self.step = min(self.step, max(trace.steps - 1, 0)) if same else first_of_last_start(trace)
        self.trace_changed.emit()


def first_of_last_start(trace: Trace) -> int:
    """The first step of the start that ended the ray, 0 without steps."""
    return int(np.argmax(trace.start == trace.start[-1])) if trace.steps else 0


def _with_settings(hits: Hits, settings: Settings) -> Hits:
    """The same hits with other shading, when only that differs."""
    if hits.settings == settings or hits.settings.key("rays") != settings.key("rays"):
        return hits
    return replace(hits, settings=settings)
