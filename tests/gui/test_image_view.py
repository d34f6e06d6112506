"""The picture under the mouse: pick, orbit, pan, zoom, hover, keys, maps."""

from __future__ import annotations

import numpy as np
import pytest
from patience import PATIENCE, settle
from qtpy.QtCore import QPoint, QPointF, Qt
from qtpy.QtGui import QWheelEvent
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QApplication

from jaart.core.maps import MAPS
from jaart.core.records import STATUS
from jaart.core.shade import shade
from jaart.gui import overlay
from jaart.gui.image_view import ImageView
from jaart.gui.overlay import numbers, ticks

LEFT, MIDDLE = Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton


@pytest.fixture
def view(qtbot, standard):
    view = ImageView(standard)
    qtbot.addWidget(view)
    view.resize(640, 480)
    view.show()
    qtbot.waitExposed(view)
    view.refresh()
    return view


def drag(view, start, by, button=LEFT, modifier=Qt.KeyboardModifier.NoModifier):
    QTest.mousePress(view, button, modifier, start)
    for part in (0.25, 0.5, 1.0):
        place = start + QPoint(round(by.x() * part), round(by.y() * part))
        event = _move(view, place, button, modifier)
        QApplication.sendEvent(view, event)
    QTest.mouseRelease(view, button, modifier, start + by)


def _move(view, place, button, modifier):
    from qtpy.QtCore import QEvent
    from qtpy.QtGui import QMouseEvent

    at = QPointF(place)
    return QMouseEvent(QEvent.Type.MouseMove, at, QPointF(view.mapToGlobal(place)), button, button, modifier)


def away(camera):
    return np.subtract(camera.eye, camera.target)


def test_the_picture_keeps_its_shape(view):
    area = view.picture_area()
    assert (area.width(), area.height()) == (480, 480)
    assert area.left() == 80


def test_pixels_and_places_are_inverse(view):
    for pixel in ((0, 0), (95, 95), (17, 60)):
        assert view.pixel_at(view.place_of(pixel)) == pixel
    assert view.pixel_at(QPointF(79, 10)) is None


def test_a_click_picks_the_pixel_below(qtbot, view, standard):
    place = view.place_of((40, 50)).toPoint()
    QTest.mouseClick(view, LEFT, pos=place)
    settle(qtbot, standard)
    assert standard.picked == (40, 50)
    assert standard.trace.pixel == (40, 50)


def test_a_click_beside_the_picture_picks_nothing(view, standard):
    QTest.mouseClick(view, LEFT, pos=QPoint(5, 5))
    assert standard.picked is None


def test_a_drag_turns_the_scene_and_ends_in_a_full_picture(qtbot, view, standard):
    before, hits = standard.camera, standard.hits
    drag(view, QPoint(300, 200), QPoint(80, 0))
    settle(qtbot, standard)
    assert standard.picked is None
    assert np.linalg.norm(away(standard.camera)) == pytest.approx(np.linalg.norm(away(before)))
    assert away(standard.camera)[2] == pytest.approx(away(before)[2])
    assert not np.allclose(away(standard.camera), away(before))
    assert standard.complete
    assert standard.hits is not hits
    assert standard.hits.camera == standard.camera


@pytest.mark.parametrize(("button", "modifier"), [(MIDDLE, Qt.KeyboardModifier.NoModifier),
                                                  (LEFT, Qt.KeyboardModifier.ShiftModifier)])
def test_a_middle_or_shift_drag_moves_the_scene(qtbot, view, standard, button, modifier):
    before = standard.camera
    drag(view, QPoint(300, 200), QPoint(60, 30), button, modifier)
    settle(qtbot, standard)
    np.testing.assert_allclose(away(standard.camera), away(before), atol=1e-9)
    assert not np.allclose(standard.camera.target, before.target)


def test_the_wheel_brings_the_scene_closer(qtbot, view, standard):
    before = np.linalg.norm(away(standard.camera))
    at = QPointF(300, 200)
    event = QWheelEvent(at, at, QPoint(), QPoint(0, 240), Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier,
                        Qt.ScrollPhase.NoScrollPhase, False)
    QApplication.sendEvent(view, event)
    assert np.linalg.norm(away(standard.camera)) < before
    qtbot.waitUntil(lambda: standard.idle and standard.complete, timeout=PATIENCE)
    assert standard.hits.camera == standard.camera


def test_arrow_keys_move_the_picked_pixel(qtbot, view, standard):
    standard.pick(40, 40)
    QTest.keyClick(view, Qt.Key.Key_Right)
    QTest.keyClick(view, Qt.Key.Key_Down, Qt.KeyboardModifier.ShiftModifier)
    assert standard.picked == (41, 50)
    settle(qtbot, standard)
    assert standard.trace.pixel == (41, 50)
    QTest.keyClick(view, Qt.Key.Key_Escape)
    assert standard.picked is None


def test_f_fits_the_scene_from_the_same_side(qtbot, view, standard):
    before = standard.camera
    view.look_from("Default")
    QTest.keyClick(view, Qt.Key.Key_Plus)
    QTest.keyClick(view, Qt.Key.Key_F)
    settle(qtbot, standard)
    np.testing.assert_allclose(away(standard.camera), away(before), rtol=1e-9)


def test_a_standard_view_looks_along_its_axis(qtbot, view, standard):
    view.look_from("Top")
    settle(qtbot, standard)
    towards = away(standard.camera) / np.linalg.norm(away(standard.camera))
    np.testing.assert_allclose(towards, (0, 0, 1), atol=1e-12)


def test_hovering_shows_the_pixels_numbers(qtbot, view, standard):
    x, y = (int(n) for n in np.argwhere(standard.hits.hit.reshape(96, 96))[0][::-1])
    before = view.grab().toImage()
    QApplication.sendEvent(view, _move(view, view.place_of((x, y)).toPoint(), Qt.MouseButton.NoButton,
                                       Qt.KeyboardModifier.NoModifier))
    assert view.hovered == (x, y)
    assert view.grab().toImage() != before
    rows = dict(numbers(standard.hits, standard.quality, x, y))
    assert rows["Pixel"] == f"{x}, {y}"
    assert float(rows["Depth t"].split()[0]) == pytest.approx(standard.hits.t[x + 96 * y], abs=1e-4)
    assert {"Normal", "Off-centre", "Iterations"} <= set(rows)


def test_background_has_no_hit_numbers(standard):
    at = int(np.flatnonzero(standard.hits.status == STATUS["background"])[0])
    assert "Depth t" not in dict(numbers(standard.hits, standard.quality, at % 96, at // 96))


def test_every_map_gives_another_picture(qtbot, view, standard):
    seen = set()
    for name in MAPS:
        standard.set_map(name)
        seen.add(view.image.convertToFormat(view.image.Format.Format_RGB888).bits().tobytes())
        assert view.grab().width() == 640
    assert len(seen) == len(MAPS)


def test_themes_change_the_ground(view, standard):
    light = view.image.pixelColor(0, 0)
    standard.set_theme("dark")
    assert view.image.pixelColor(0, 0).lightness() < light.lightness()


def test_shading_is_shown_at_once(view, standard):
    before = view.image.copy()
    standard.set_value("shading", "diffuse")
    assert standard.idle
    assert view.image != before


def test_ticks_are_round_and_within_the_scale():
    assert ticks(0, 1) == [0, 0.2, 0.4, 0.6, 0.8, 1.0]
    assert ticks(3, 7) == [3, 4, 5, 6, 7]
    assert ticks(0, 1e-4)[-1] == 1e-4


def test_bar_and_colours_change_together(qtbot, standard, view, monkeypatch):
    monkeypatch.setattr("jaart.core.render.PATIENCE", 0.0)
    painted, draw = [], overlay.draw_scale

    def note(painter, area, name, hits, quality, *rest):
        draw(painter, area, name, hits, quality, *rest)
        errors = quality if name.endswith("_error") else None
        painted.append((name, hits.size, errors is None, (pixels(view) == shade(hits, name, errors)).all()))

    monkeypatch.setattr(overlay, "draw_scale", note)
    standard.set_map("distance_error")
    standard.set_value("h", 1.6)
    settle(qtbot, standard)
    view.repaint()
    assert {(name, size, without, same) for name, size, without, same in painted} == {
        ("distance_error", (96, 96), False, True)}
    painted.clear()
    standard.open("bumpy")  # of another surface there is nothing to keep: plain until it is measured
    settle(qtbot, standard)
    view.repaint()
    assert painted[0][0] == "shaded"
    assert painted[-1][:3] == ("distance_error", (96, 96), False)
    assert all(same for *_, same in painted)
    assert (96, 96) in {size for name, size, *_ in painted if name == "shaded"}


def pixels(view):
    """What the view shows (h, w, 3)."""
    image = view.image
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return rows[:, :3 * image.width()].reshape(image.height(), image.width(), 3)
