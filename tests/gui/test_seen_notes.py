"""Notes are seen above the picture while they hold, quietly, and can be closed; rays say why they took no step."""

from __future__ import annotations

import numpy as np
import pytest
from patience import PATIENCE, said, settle, write_cloud
from qtpy.QtCore import QEvent, QPointF, Qt, QTimer
from qtpy.QtGui import QMouseEvent
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QApplication

from jaart.core.camera import Camera
from jaart.gui import app, overlay, theme
from jaart.gui.main_window import MainWindow

LEFT, NONE = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton


@pytest.fixture
def two(tmp_path):
    """A file of two points."""
    np.savez(tmp_path / "two.npz", points=[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    return tmp_path / "two.npz"


def opened(qtbot, window, path):
    window.model.open(path)
    settle(qtbot, window.model)
    return window.model


def texts(window, title):
    """What is written in a figure panel."""
    return [text.get_text() for axes in window.docks[title].panel.canvas.figure.axes for text in axes.texts]


def test_a_scene_without_notes_has_no_bar(window):
    assert window.model.notes.now == ()
    assert not window.notes.isVisible()


def test_an_empty_lattice_says_above_the_picture_why_nothing_is_seen(qtbot, window, tmp_path):
    np.savez(tmp_path / "empty.npz", levels=np.zeros((8, 8, 8)))
    opened(qtbot, window, tmp_path / "empty.npz")
    assert window.notes.isVisible()
    assert not window.message.isVisible()
    assert window.notes.text.text().startswith("Note: 0 surfels, so there is no surface")
    assert window.docks["Messages"].panel.toPlainText().count("0 surfels, so there is no surface") == 1
    opened(qtbot, window, "standard")
    assert not window.notes.isVisible()


def test_a_note_is_quiet(qtbot, window, two):
    opened(qtbot, window, two)
    for name in ("light", "dark"):
        window.model.set_theme(name)
        ground = window.notes.grab().toImage().pixelColor(3, 3)
        assert ground == theme.colour(name, "window")
        assert ground != theme.colour(name, "alarm_ground")
    window.model.set_theme("light")


def test_two_points_say_all_that_holds_and_the_cross_closes_it(qtbot, window, two):
    model = opened(qtbot, window, two)
    lines = window.notes.text.text().splitlines()
    assert lines[0] == "Note: ball_k = 6: there is only 1 other point"
    assert "is larger than all the points together" in lines[1]
    assert lines[2] == "Note: no ray of this picture meets the surface; those that come near end so: normal undefined"
    QTest.mouseClick(window.notes.button, LEFT)
    assert not window.notes.isVisible()
    model.set_map("status")
    model.set_value("max_iterations", 7)
    settle(qtbot, model)
    assert not window.notes.isVisible()
    opened(qtbot, window, two)
    assert window.notes.isVisible()


def test_a_note_goes_when_it_holds_no_more_and_comes_back(qtbot, window, tmp_path):
    model = opened(qtbot, window, write_cloud(tmp_path / "points.npz", count=300))
    assert not window.notes.isVisible()
    row, lines = window.docks["Parameters"].panel.rows["h"], said(model)
    for _ in range(2):
        row.box.lineEdit().selectAll()
        QTest.keyClicks(row.box.lineEdit(), "1000")
        QTest.keyClick(row.box, Qt.Key.Key_Return)
        settle(qtbot, model)
        assert "h = 1000 is larger than all the points together" in window.notes.text.text()
        assert window.notes.isVisible()
        QTest.mouseClick(window.notes.button, LEFT)
        row.reset.click()
        settle(qtbot, model)
        assert not window.notes.isVisible()
    assert sum("h = 1000" in line for line in lines) == 2


def test_an_error_stands_beside_the_notes_and_is_closed_alone(qtbot, window, two):
    opened(qtbot, window, two)
    opened(qtbot, window, two.with_name("missing.npz"))
    assert window.message.isVisible() and window.notes.isVisible()
    QTest.mouseClick(window.message.button, LEFT)
    assert not window.message.isVisible()
    assert window.notes.isVisible()


def test_many_notes_leave_the_picture_its_room(qtbot, window):
    notes = window.model.notes
    notes.now = tuple(f"note {n}" for n in range(9))
    notes.changed.emit()
    assert window.notes.text.text().splitlines() == [*(f"Note: note {n}" for n in range(3)),
                                                     "6 more notes are under Messages"]


def test_a_ray_through_balls_without_a_normal_says_so(qtbot, window, two):
    model = opened(qtbot, window, two)
    QTest.mouseClick(window.view, LEFT, pos=window.view.place_of((96, 96)).toPoint())
    settle(qtbot, model)
    assert len(model.trace.balls) == 2
    because = "This ray pierces 2 balls,\nbut the normal is undefined there:\nno step was taken."
    for title in ("2D projector", "Energy along the ray"):
        qtbot.waitUntil(lambda title=title: because in texts(window, title), timeout=PATIENCE)
    panel = window.docks["Energy along the ray"].panel
    canvas = panel.canvas._canvas
    canvas.draw()
    button = (panel.height() - panel.whole.y()) * canvas.device_pixel_ratio  # its upper edge
    for text in canvas.figure.axes[0].texts:
        box = text.get_window_extent()
        assert box.x0 >= 0
        assert box.x1 < canvas.figure.bbox.x1
        assert box.y0 > button


def test_a_hit_from_within_is_told_where_the_pixel_is_described(qtbot, window, monkeypatch):
    model = window.model
    steps = window.docks["Steps"].panel
    outside = int(np.flatnonzero(model.hits.hit & ~model.hits.from_behind)[0])
    QTest.mouseClick(window.view, LEFT, pos=window.view.place_of((outside % 192, outside // 192)).toPoint())
    settle(qtbot, model)
    QTest.keyClick(window.docks["2D projector"].panel, Qt.Key.Key_End)
    assert steps.state.text().endswith("arrived")
    inside = model.trace.point - 0.5 * model.trace.normal
    model.set_camera(Camera(tuple(inside), tuple(inside + model.trace.normal), up=(0.1, 0.9, 0.3)))
    settle(qtbot, model)
    QTest.mouseClick(window.view, LEFT, pos=window.view.place_of((96, 96)).toPoint())
    settle(qtbot, model)
    assert model.trace.hit
    QTest.keyClick(window.docks["2D projector"].panel, Qt.Key.Key_End)
    assert steps.state.text().endswith("arrived, from behind")
    cards, draw = [], overlay.draw_lens
    monkeypatch.setattr(overlay, "draw_lens", lambda *args: (cards.append(dict(args[4])), draw(*args)))
    hover(window.view, (96, 96))
    assert cards[-1]["Pixel"] == "96, 96"
    assert cards[-1]["Ray"] == "arrived, from behind"


def hover(view, pixel):
    place = QPointF(view.place_of(pixel).toPoint())
    QApplication.sendEvent(view, QMouseEvent(QEvent.Type.MouseMove, place, QPointF(view.mapToGlobal(place)), NONE, NONE,
                                             Qt.KeyboardModifier.NoModifier))
    view.grab()


def test_bare_points_have_no_side_to_be_hit_from(qtbot, model, tmp_path):
    model.set_size(48, 48)
    model.open(write_cloud(tmp_path / "points.npz"))
    settle(qtbot, model)
    assert model.hits.from_behind.any()
    assert not model.known.sided
    model.set_value("normal", "surfel")
    settle(qtbot, model)
    assert model.known.sided
    assert not model.hits.from_behind.any()


def test_what_is_known_before_the_window_opens_is_among_its_messages(qtbot):
    seen = []

    def look():
        windows = [w for w in QApplication.topLevelWidgets() if isinstance(w, MainWindow) and w.isVisible()]
        if windows and windows[0].model.complete:
            seen.append(windows[0].docks["Messages"].panel.toPlainText())
            windows[0].close()

    timer = QTimer(interval=50)
    timer.timeout.connect(look)
    timer.start()
    assert app.run("standard", notes=["left out of the preset: h = 0.8"]) == 0
    assert "left out of the preset: h = 0.8" in seen[0]
