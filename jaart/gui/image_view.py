"""The picture: orbit, pan and zoom by mouse, a click picks a ray, hovering shows a pixel's numbers."""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import QPointF, QRectF, QSize, Qt, QTimer
from qtpy.QtGui import QImage, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPixmap, QResizeEvent, QWheelEvent
from qtpy.QtWidgets import QApplication, QWidget

from jaart.core.camera import Camera
from jaart.core.records import Hits, Quality
from jaart.core.settings import PARAMETERS, Settings
from jaart.gui import navigation, overlay, theme
from jaart.gui.model import SceneModel
from jaart.gui.status import at_rest

#: Degrees that a drag across the view turns the scene.
TURN = 240.0
ARROWS = {Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, -1), Qt.Key.Key_Down: (0, 1)}
ZOOMS = {Qt.Key.Key_Plus: 1.15, Qt.Key.Key_Equal: 1.15, Qt.Key.Key_Minus: 1 / 1.15}


class ImageView(QWidget):
    """Shows the model's picture. A window of its own to the system: the 3D view beside it would slow it down."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DontCreateNativeAncestors)
        self.setAttribute(Qt.WidgetAttribute.WA_NativeWindow)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(240, 200)
        self.setFont(theme.tabular(self.font()))
        self.model, self.image = model, QImage()
        self._results: tuple[Any, ...] = (None, None, None)
        self._shown: tuple[str, Hits, Quality | None] | None = None
        self._values: tuple[Any, ...] = ()
        self._scaled: tuple[tuple[Any, ...], QPixmap] = (), QPixmap()
        self.hovered: tuple[int, int] | None = None
        self._pressed: QPointF | None = None
        self._last = QPointF()
        self._start: Camera | None = None
        self._still = QTimer(self, singleShot=True, interval=150)
        self._still.timeout.connect(self._settle)
        for signal in (model.hits_changed, model.map_changed, model.theme_changed, model.settings_changed,
                       model.shader.changed, model.settled):
            signal.connect(self.refresh)
        model.picked_changed.connect(self.update)

    def sizeHint(self) -> QSize:
        """The size that the view would like."""
        return QSize(820, 640)

    def refresh(self) -> None:
        """Colour the hits again, if anything that their colours depend on has changed, and paint them at once."""
        model, hits, before = self.model, self.model.hits, self.image
        if hits is None:
            self.image, self._values = QImage(), ()
        elif model.quality is not None or not model.map.endswith("_error") or not self._keeps_errors():
            self._colour(hits)
        if self.image is not before:
            self.repaint()  # before the panels that tell its numbers
        else:
            self.update()

    def _colour(self, hits: Hits) -> None:
        from jaart.core.picture import plain
        from jaart.core.shade import shade

        model, settings = self.model, plain(self.model.settings)
        errors = model.quality if model.map.endswith("_error") else None
        name = "shaded" if model.map.endswith("_error") and errors is None else model.map
        finished = model.shader.colours
        results, values = (hits.t, errors, finished), (name, model.theme, *shading(settings))
        if values == self._values and all(one is other for one, other in zip(results, self._results, strict=True)):
            return
        self._results, self._values, self._shown = results, values, (name, hits, model.quality)
        pixels = shade(hits, name, errors, model.theme, settings) if finished is None else finished
        height, width = pixels.shape[:2]
        self.image = QImage(pixels.data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()

    def _keeps_errors(self) -> bool:
        """Whether errors are on show that the next full picture will bring anew."""
        errors = self._shown is not None and self._shown[0] == self.model.map
        return errors and not self.image.isNull() and self.model.computing

    def picture_area(self) -> QRectF:
        """Where the picture stands in the view, its shape kept."""
        width, height = self.model.size
        scale = min(self.width() / width, self.height() / height)
        return QRectF((self.width() - width * scale) / 2, (self.height() - height * scale) / 2,
                      width * scale, height * scale)

    def pixel_at(self, place: QPointF) -> tuple[int, int] | None:
        """The pixel of the full picture under a place in the view, None beside the picture."""
        area, (width, height) = self.picture_area(), self.model.size
        x, y = (place.x() - area.left()) / area.width(), (place.y() - area.top()) / area.height()
        return (int(x * width), int(y * height)) if 0 <= x < 1 and 0 <= y < 1 else None

    def place_of(self, pixel: tuple[int, int]) -> QPointF:
        """Where the middle of a pixel is in the view."""
        area, (width, height) = self.picture_area(), self.model.size
        return QPointF(area.left() + (pixel[0] + 0.5) / width * area.width(),
                       area.top() + (pixel[1] + 0.5) / height * area.height())

    def fit(self) -> None:
        """See the whole scene from where it is seen now."""
        camera = self.model.camera
        if camera is not None:
            towards = -camera.frame()[2]
            fitted = navigation.fit(self.model.bounds, (towards[0], towards[1], towards[2]), camera.fov)
            self.model.set_camera(fitted.replace(up=camera.up))

    def look_from(self, name: str) -> None:
        """See the whole scene from a standard direction."""
        self.model.set_camera(navigation.view(self.model.bounds, name))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the picture and what lies over it."""
        painter = QPainter(self)
        painter.drawPixmap(0, 0, self._below())
        if self.image.isNull():
            painter.setPen(theme.colour(self.model.theme, "weak"))
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, self._nothing())
            return
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._paint_over(painter)

    def _below(self) -> QPixmap:
        """The picture as large as it stands in the view: to bring it to that size takes longer than all above it."""
        ratio = self.devicePixelRatioF()
        key = self.image.cacheKey(), self.size(), self.model.size, ratio, self.model.theme
        if key != self._scaled[0]:
            ground = QPixmap(self.size() * ratio)
            ground.setDevicePixelRatio(ratio)
            ground.fill(theme.colour(self.model.theme, "view"))
            painter = QPainter(ground)
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            painter.drawImage(self.picture_area(), self.image)
            painter.end()
            self._scaled = key, ground
        return self._scaled[1]

    def _nothing(self) -> str:
        if self.model.computing:
            return "The first picture is being made …"
        if self.model.scene is None:
            return "Drop a file here, or open one"
        return at_rest(self.model) or "There is no picture with these settings"

    def _paint_over(self, painter: QPainter) -> None:
        model, hits = self.model, self.model.hits
        if model.picked is not None:
            overlay.draw_mark(painter, self.place_of(model.picked), model.theme)
        if hits is None:
            return
        if self._shown is not None:  # what the colours are of, which may be older than the hits
            overlay.draw_scale(painter, self.rect(), *self._shown, model.theme, model.kind)
        if self.hovered is not None and model.complete and self._pressed is None:
            corner = QPointF(10, 10)
            if self.place_of(self.hovered).x() < 300 and self.place_of(self.hovered).y() < 200:
                corner = QPointF(10, self.height() - 190)
            sided = model.known is not None and model.known.sided
            rows = overlay.numbers(hits, model.quality, *self.hovered, model.kind, sided)
            overlay.draw_lens(painter, corner, self.image, self.hovered, rows, model.theme)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a click or a drag."""
        self._pressed = self._last = event.position()
        self._start = None

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move the camera while dragged, else show the numbers of the pixel below."""
        place = event.position()
        if self._pressed is None:
            self._hover(self.pixel_at(place))
        elif self.model.camera is not None and (self._start is not None or self._is_drag(place)):
            self._start = self._start or self.model.camera
            self._drag(event, place - self._last)
            self._last = place

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End a drag with a full picture, a click with a picked ray."""
        dragged, self._pressed = self._start is not None, None
        if dragged:
            self._settle()
        elif event.button() == Qt.MouseButton.LeftButton and (pixel := self.pixel_at(event.position())):
            self.model.pick(*pixel)

    def _is_drag(self, place: QPointF) -> bool:
        assert self._pressed is not None
        return (place - self._pressed).manhattanLength() >= QApplication.startDragDistance() / 2

    def _drag(self, event: QMouseEvent, moved: QPointF) -> None:
        camera, across = self.model.camera, max(self.picture_area().width(), self.picture_area().height())
        assert camera is not None
        right, down = moved.x() / across, moved.y() / across
        shifted = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        if event.buttons() & Qt.MouseButton.MiddleButton or shifted:
            self.model.set_camera(navigation.pan(camera, right, down), dragging=True)
        elif event.buttons() & Qt.MouseButton.LeftButton:
            self.model.set_camera(navigation.orbit(camera, TURN * right, TURN * down), dragging=True)

    def _settle(self) -> None:
        """The camera rests: make the full picture."""
        self._start = None
        if self.model.camera is not None:
            self.model.set_camera(self.model.camera)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom."""
        self._zoom(1.0015 ** event.angleDelta().y())

    def _zoom(self, factor: float) -> None:
        if self.model.camera is not None:
            self.model.set_camera(navigation.zoom(self.model.camera, factor), dragging=True)
            self._still.start()

    def _hover(self, pixel: tuple[int, int] | None) -> None:
        if pixel != self.hovered:
            self.hovered = pixel
            self.update()

    def leaveEvent(self, event: object) -> None:
        """Put the lens away."""
        self._hover(None)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Put the lens away: another pixel is below the mouse."""
        self.hovered = None

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move the picked pixel, zoom, fit, or forget the pick."""
        key = Qt.Key(event.key())
        if key in ARROWS and self.model.picked is not None:
            stride = 10 if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else 1
            self.model.pick(*(p + stride * d for p, d in zip(self.model.picked, ARROWS[key], strict=True)))
        elif key in ZOOMS:
            self._zoom(ZOOMS[key])
        elif key == Qt.Key.Key_F:
            self.fit()
        elif key == Qt.Key.Key_Escape:
            self.model.clear_pick()
        else:
            super().keyPressEvent(event)


def shading(settings: Settings) -> tuple[Any, ...]:
    """The values that enter the colours of hits."""
    return tuple(getattr(settings, about.name) for about in PARAMETERS.values() if about.stage == "shade")
