"""The chosen step of the picked ray in space: cells or balls, surfels, plane, barycentre, query and next point."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from qtpy.QtCore import QEvent, QObject, Qt
from qtpy.QtGui import QCloseEvent, QKeyEvent
from qtpy.QtWidgets import QHBoxLayout, QLabel, QStackedLayout, QToolButton, QVBoxLayout, QWidget

from jaart.core.records import Trace
from jaart.gui.model import SceneModel
from jaart.gui.panel import Panel, step_by_key
from jaart.plot.glyphs import Mesh
from jaart.plot.scale import no_steps
from jaart.plot.scene3d import PARTS, Up, step_meshes, view
from jaart.plot.style import THEMES

if TYPE_CHECKING:
    from pyvista import PolyData

_MESSAGE = "Click a pixel in the picture to see its ray in space."
_VIEWS = (("oblique", "reset view", "Look from the side and above"),
          ("ray", "along ray", "Look along the ray"),
          ("side", "side view", "Look straight onto the plane of the 2D projector"))
#: A step this many times farther off than what is looked at is too small to be seen.
_FAR = 4.0


class Analyzer3D(Panel):
    """The 3D ray analyzer; its view is made when there is first something to see in it."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(model, parent)
        self._view: Any = None
        self._actors: dict[str, Any] = {}
        self._moved, self._closed = True, False
        self._arrange()
        model.trace_changed.connect(self.new_trace)
        model.step_changed.connect(self.mark_dirty)

    def new_view(self) -> None:
        """Look at another ray from a view that shows it."""
        self._moved = True
        self.mark_dirty()

    def look(self, kind: str) -> None:
        """Look at the chosen step: "oblique", "ray" or "side"."""
        trace = self.model.trace
        if self._view is None or trace is None or not trace.steps:
            return
        self._aim(trace, kind)
        self._render()

    def close_view(self) -> None:
        """Give the view's window and memory back; the panel shows nothing afterwards."""
        self._closed = True
        if self._view is not None:
            self._view.close()
            self._view, self._actors = None, {}

    def closeEvent(self, event: QCloseEvent) -> None:
        """Close the view before its window goes."""
        self.close_view()
        super().closeEvent(event)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keys step through the iterations instead of reaching the view's own shortcuts."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            return step_by_key(self.model, event) or bool(event.text())
        return bool(super().eventFilter(watched, event))

    def draw(self) -> None:
        """Draw the chosen step, into a view that is made on first use."""
        if self._closed:
            return
        trace = self.model.trace
        if trace is None or not trace.steps:
            self._say(_MESSAGE if trace is None else no_steps(trace))
            return
        if self._view is None:
            self._make()
        self._show(step_meshes(trace, self.model.step, self.model.theme))
        self._stack.setCurrentWidget(self._view)
        if self._moved:
            self._moved = False
            self._aim(trace, "oblique")
        elif not self._sees(trace.query[self.model.step]):
            self._follow(trace)
        self._render()

    def _sees(self, point: NDArray[np.float64]) -> bool:
        """Whether a point is within the view."""
        camera, aspect = self._view.camera, self._view.width() / max(self._view.height(), 1)
        camera.SetUseHorizontalViewAngle(aspect < 1)
        x, y, _, depth = camera.GetCompositeProjectionTransformMatrix(aspect, -1, 1).MultiplyPoint((*point, 1.0))
        return bool(max(abs(x), abs(y)) <= depth <= _FAR * camera.GetDistance())

    def _follow(self, trace: Trace) -> None:
        """Bring the chosen step into view, seen from the side from which the view looks now."""
        camera = self._view.camera
        away = -np.array(camera.GetDirectionOfProjection())
        eye, target, _ = view(trace, self.model.step, "oblique", self._up())
        camera.SetPosition(*(target + away * np.linalg.norm(np.subtract(eye, target))))
        camera.SetFocalPoint(*target)

    def _aim(self, trace: Trace, kind: str) -> None:
        eye, target, up = view(trace, self.model.step, kind, self._up())
        self._view.camera.SetPosition(*eye)  # VTK's own: pyvista measures the scene anew after each of them
        self._view.camera.SetFocalPoint(*target)
        self._view.camera.SetViewUp(*up)
        self._view.camera_set = True

    def _render(self) -> None:
        """Have the view painted, which renders it; to render it here too would do it twice."""
        self._view.camera.SetUseHorizontalViewAngle(self._view.width() < self._view.height())
        self._view.reset_camera_clipping_range()
        self._view.update()

    def _show(self, meshes: dict[str, Mesh]) -> None:
        self._view.set_background(THEMES[self.model.theme].face)
        for name, actor in self._actors.items():
            actor.SetVisibility(name in meshes)
            if name in meshes:
                actor.mapper.dataset = _polydata(meshes[name])

    def _make(self) -> None:
        from pyvistaqt import QtInteractor

        self._view = QtInteractor(self, multi_samples=0, line_smoothing=True, auto_update=False, lighting="none")
        self._view.installEventFilter(self)
        self._stack.addWidget(self._view)
        import pyvista

        self._view.add_light(pyvista.Light(light_type="headlight"))
        dot = Mesh(np.zeros((3, 3)), np.array([[0, 1, 2]]), np.zeros((3, 3), np.uint8))
        for name, part in PARTS.items():
            self._actors[name] = self._view.add_mesh(
                _polydata(dot), scalars="rgb", rgb=True, lighting=not part.width, line_width=part.width or None,
                opacity=part.opacity, ambient=0.55, diffuse=0.5, show_scalar_bar=False, render=False,
                reset_camera=False)

    def _say(self, message: str) -> None:
        self._message.setText(message)
        self._stack.setCurrentWidget(self._message)

    def _up(self) -> Up:
        camera = self.model.camera
        return (0.0, 0.0, 1.0) if camera is None else tuple(camera.frame()[1])

    def _arrange(self) -> None:
        self._message = QLabel(_MESSAGE)
        self._message.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._message.setWordWrap(True)
        self._message.setMargin(12)
        self._message.setObjectName("weak")
        self._stack = QStackedLayout()
        self._stack.addWidget(self._message)
        bar = QHBoxLayout()
        bar.setContentsMargins(6, 0, 6, 2)
        for kind, text, tip in _VIEWS:
            button = QToolButton(self)
            button.setText(text)
            button.setToolTip(tip)
            button.setAutoRaise(True)
            button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            button.clicked.connect(lambda _=False, kind=kind: self.look(kind))
            bar.addWidget(button)
        bar.addStretch(1)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setSpacing(0)
        rows.addLayout(self._stack, 1)
        rows.addLayout(bar)


def _polydata(mesh: Mesh) -> PolyData:
    from pyvista import PolyData

    count, corners = mesh.elements.shape
    cells = np.hstack([np.full((count, 1), corners), mesh.elements]).ravel()
    data = PolyData(mesh.points, lines=cells) if corners == 2 else PolyData(mesh.points, faces=cells)
    data.point_data["rgb"] = mesh.colours
    return data
