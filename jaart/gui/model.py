"""SceneModel: the one shared state of the window; panels listen to it and write to it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from qtpy.QtCore import QObject

from jaart.core.camera import Camera
from jaart.core.records import Hits, Quality, Trace
from jaart.core.scene import Scene
from jaart.core.settings import PRESETS, Settings, preset
from jaart.gui import navigation, results, tasks
from jaart.gui.computers import Computers
from jaart.gui.measurer import Measurer
from jaart.gui.navigation import Bounds
from jaart.gui.notes import Notes
from jaart.gui.preparing import Preparing
from jaart.gui.shader import Shader
from jaart.gui.signals import Signals
from jaart.gui.suit import of_preset, refused_name
from jaart.gui.tasks import Known, Made, Opened
from jaart.gui.worker import Worker

if TYPE_CHECKING:
    from os import PathLike

    from jaart.core.chosen import Chosen

#: Size of a picture in pixels when nobody says.
PICTURE = (512, 512)


class SceneModel(Signals):
    """Scene, settings, camera, picture, picked ray and theme, and the work that follows their changes.

    Pixels (x, y) count from the top left of the full picture of `size` (width, height). Files are
    read, and pictures and traces made, in a worker thread; results arrive as signals. Settings that make no sense in
    the scene leave the last picture; `fault` holds what is refused and why, `base` the preset's values for the scene.
    """

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.scene: Scene | None = None
        self.camera: Camera | None = None
        self.bounds: Bounds = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
        self.preset = next(iter(PRESETS))
        self.settings = self.base = preset(self.preset)
        self.known: Known | None = None
        self.fault: tuple[str, str] | None = None
        self.size = PICTURE
        self.hits: Hits | None = None
        self.quality: Quality | None = None
        self._full: tuple[Hits, Quality | None] | None = None
        self.picked: tuple[int, int] | None = None
        self.trace, self.step = None, 0  # type: Trace | None, int
        self._stopped = False
        self._worker, self._painter = Worker(self), Worker(self)
        self.shader, self.measurer = Shader(self), Measurer(self)
        self.notes, self._slow = Notes(self), Preparing(self)
        self._computers = Computers(self, self._worker, self._painter, self._refuse, self._ended)
        self._worker.said.connect(self._slow.stop)

    @property
    def idle(self) -> bool:
        """Whether nothing is being read, rendered, traced or drawn."""
        return not self.computing and self._painter.idle

    @property
    def computing(self) -> bool:
        """Whether something is being read, rendered, traced, shaded or measured."""
        return self._computers.computing

    @property
    def kind(self) -> str:
        """Kind of the scene, a lattice while there is none."""
        return "lattice" if self.scene is None else self.scene.kind

    @property
    def complete(self) -> bool:
        """Whether the picture is the full one, not a coarse first one."""
        return self.hits is not None and self.hits.size == self.size

    @property
    def current(self) -> bool:
        """Whether the picture is of the settings, and no newer one is under way."""
        return self.hits is not None and self.hits.settings.key("rays") == self.settings.key("rays")

    @property
    def halted(self) -> bool:
        """Whether the picture that was asked for last was stopped before it was done."""
        return self._stopped and not (self.complete and self.current and self.hits is not None
                                      and self.hits.camera == self.camera)

    def open(self, source: str | PathLike[str], frame: int | None = None, camera: Camera | None = None) -> None:
        """Read a scene; when it cannot be read, `failed` says why and the old scene stays."""
        name, before = self.preset, self.scene
        settings = self.settings if self.settings != self.base else None
        self.said.emit(f"Reading {source} …")
        self._worker.submit("open", lambda job: tasks.read(job, source, frame, settings, name, before),
                            lambda opened: self._opened(opened, camera))

    def choose_preset(self, name: str) -> None:
        """Take a preset's values; those that make no sense in the scene are replaced, and `said` says so."""
        if (scene := self.scene) is None:
            self.set_settings(preset(name))
            return
        self._worker.cancel("picture")
        self._worker.submit("open", lambda job: of_preset(scene, name), lambda made: self._take(name, *made))

    def _take(self, name: str, settings: Settings, changed: str) -> None:
        traced = settings.key("rays") == self.settings.key("rays") and self.fault is None
        same, self.preset, self.base = settings == self.settings, name, settings
        self.set_settings(settings)
        if same:
            self.settings_changed.emit()  # what the values are compared with may be new
        if traced and (self.hits is None or self.hits.camera != self.camera or not self.complete):
            self._render()  # what was under way was stopped
        if changed:
            self.said.emit(changed)

    def set_value(self, name: str, value: Any) -> None:
        """Change one setting. Raises SettingsError when it cannot take the value."""
        self.set_settings(self.settings.replace(**{name: value}))

    def set_settings(self, settings: Settings) -> None:
        """Change the settings; only the stages that they enter are computed again."""
        old, self.settings = self.settings, settings
        if settings == old:
            return
        for name in PRESETS:
            if preset(name) == settings:
                self.preset, self.base = name, settings
        refused = self.fault is not None
        self._set_fault(None)
        if self.hits is not None:
            self.hits = results.with_settings(self.hits, settings)
        if self.scene is not None and (refused or settings.key("rays") != old.key("rays")):
            self._keep_view()
            self._render()  # before the panels are told: rays are traced meanwhile
        elif settings.key("trace") != old.key("trace"):
            self._trace()
        self.settings_changed.emit()

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
            self.picked = results.moved(self.picked, old, self.size)
            self.picked_changed.emit()
        self._render()

    def pick(self, x: int, y: int) -> None:
        """Trace the ray through pixel (x, y); a pixel outside the picture is moved to its edge."""
        self.picked = (min(max(x, 0), self.size[0] - 1), min(max(y, 0), self.size[1] - 1))
        self._trace()
        self.picked_changed.emit()

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

    def draw_later(self, work: Callable[[], Any], done: Callable[[Any], None], kind: str = "figure") -> None:
        """Have something drawn for a panel in a thread of its own; of a kind the newest drawing wins."""
        self._painter.submit(kind, lambda job: work(), done, brief=True)

    def stop(self) -> None:
        """Stop what is being read, rendered, traced, shaded or measured; what is shown stays."""
        self._stopped = True
        self._computers.cancel()
        self._slow.stop()
        self.said.emit("Stopped")

    def close(self) -> None:
        """Cancel what runs and end the threads."""
        self._computers.close()

    def _opened(self, opened: Opened, camera: Camera | None) -> None:
        scene, bounds = opened.scene, opened.bounds
        same = self.scene is not None and self.scene.source == scene.source and self.bounds == bounds
        for kind in ("picture", "trace"):
            self._worker.cancel(kind)
        self.scene, self.bounds, self.base, self.known = scene, bounds, opened.base, None
        self._set_fault(None)
        self.hits = self.quality = self.trace = self._full = None
        self.step = 0
        if not same:
            self.picked = None
        if camera is not None or self.camera is None or not same:
            self.camera = camera or navigation.view(bounds, "Default")
        if opened.settings != self.settings:
            self.settings = opened.settings
            self.settings_changed.emit()
        for signal in (self.scene_changed, self.camera_changed, self.hits_changed, self.picked_changed,
                       self.trace_changed):
            signal.emit()
        if opened.changed:
            self.said.emit(opened.changed)
        self._render()

    def _keep_view(self) -> None:
        """Follow a model whose raster changed, so that it is seen as before."""
        if self.scene is None or self.scene.kind != "model" or self.camera is None:
            return
        old, self.bounds = self.bounds, tasks.bounds(self.scene, self.settings)
        if old != self.bounds:
            self.camera = navigation.rescaled(self.camera, old, self.bounds)
            self.camera_changed.emit()

    def _render(self, dragging: bool = False) -> None:
        if self.scene is None or self.camera is None:
            return
        size = results.smaller(self.hits, self.size) if dragging else self.size
        what = self.scene, self.settings, self.camera, size, dragging, self._choose
        self._slow.start()
        self._stopped = False
        self._worker.submit("picture", lambda job: tasks.picture(job, *what), self._made, self._show, brief=dragging)

    def _made(self, made: Made) -> None:
        known, self.known = self.known, made.known
        self._show(made.hits)
        if made.known != known:
            self.known_changed.emit()

    def _choose(self, values: Chosen) -> None:
        if self.known is not None and values != self.known.values:
            self.known = replace(self.known, values=values)
            self.known_changed.emit()

    def show_quality(self, quality: Quality | None) -> None:
        """Take the errors of the picture that is shown."""
        assert self.hits is not None
        self.quality, self._full = quality, (self.hits, quality)
        self.hits_changed.emit()

    def _show(self, hits: Hits) -> None:
        self._slow.stop()
        self.hits, self.quality = results.with_settings(hits, self.settings), None
        self.hits_changed.emit()
        if self.complete:
            self._full = self.hits, self.quality
            self.progressed.emit(1.0)
            self._trace()

    def _trace(self) -> None:
        if self.scene is None or self.camera is None or self.picked is None or self.fault is not None:
            return
        what = self.scene, self.settings, self.camera, self.size, self.picked
        self._worker.submit("trace", lambda job: tasks.ray(job, *what), self._traced, brief=True)

    def _traced(self, trace: Trace) -> None:
        same = self.trace is not None and self.trace.pixel == trace.pixel
        self.trace = trace
        self.step = min(self.step, max(trace.steps - 1, 0)) if same else results.first_of_last_start(trace)
        self.trace_changed.emit()

    def _refuse(self, message: str) -> None:
        """The core refused the settings: keep the last full picture, mark the setting, and say why once."""
        told = self.fault
        self._slow.stop()
        self._set_fault((refused_name(message), message))
        if not self.complete and self._full is not None:
            self.hits, self.quality = self._full
            self.hits_changed.emit()
        if self.fault != told:
            self.failed.emit(message)

    def _set_fault(self, fault: tuple[str, str] | None) -> None:
        if fault != self.fault:
            self.fault = fault
            self.fault_changed.emit()

    def _ended(self) -> None:
        if not self.computing:
            self._slow.stop()
            self.settled.emit()
