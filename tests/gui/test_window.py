"""The window as a person uses it: real clicks and keys, everything followed to the panels."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from patience import settle
from qtpy.QtCore import QMimeData, QPointF, Qt, QTimer, QUrl
from qtpy.QtGui import QDropEvent, QImage, QPalette
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QApplication

from jaart.core.errors import JaartError
from jaart.core.settings import Settings
from jaart.gui import app, libraries
from jaart.gui.main_window import MainWindow

LEFT = Qt.MouseButton.LeftButton


def pick_a_hit(qtbot, window, steps=1):
    """Click the middle one of the pixels that hit in at least so many steps."""
    model = window.model
    hits = np.argwhere((model.hits.hit & (model.hits.iterations >= steps)).reshape(model.size[::-1]))
    y, x = (int(n) for n in hits[len(hits) // 2])
    QTest.mouseClick(window.view, LEFT, pos=window.view.place_of((x, y)).toPoint())
    settle(qtbot, model)
    return x, y


def test_a_click_on_a_pixel_is_followed_by_every_panel(qtbot, window):
    x, y = pick_a_hit(qtbot, window)
    trace = window.model.trace
    assert trace.pixel == (x, y)
    assert trace.hit
    steps = window.docks["Steps"].panel
    assert steps.position.text() == f"step {window.model.step + 1} / {trace.steps}"


def test_keys_step_through_the_iterations(qtbot, window):
    pick_a_hit(qtbot, window, steps=3)
    panel, model = window.docks["2D projector"].panel, window.model
    model.set_step(0)
    panel.setFocus()
    QTest.keyClick(panel, Qt.Key.Key_Right)
    assert model.step == 1
    QTest.keyClick(panel, Qt.Key.Key_Home)
    assert model.step == 0
    QTest.keyClick(panel, Qt.Key.Key_End)
    assert model.step == model.trace.steps - 1
    assert window.docks["Steps"].panel.position.text() == f"step {model.trace.steps} / {model.trace.steps}"


def test_a_slider_that_moves_makes_a_new_picture_and_cancels_the_older(qtbot, window):
    model, pictures = window.model, []
    model.hits_changed.connect(lambda: pictures.append(model.hits.settings.h.value) if model.complete else None)
    slider = window.docks["Parameters"].panel.rows["h"].slider
    slider.setFocus()
    for _ in range(12):
        QTest.keyClick(slider, Qt.Key.Key_Right)
    settle(qtbot, model)
    assert pictures[-1] == pytest.approx(1.4)
    assert len(pictures) < 12


def test_a_broken_file_is_told_and_the_old_scene_stays(qtbot, window, tmp_path):
    broken = tmp_path / "broken.vti"
    broken.write_text("<VTKFile")
    scene, hits = window.model.scene, window.model.hits
    window.model.open(broken)
    settle(qtbot, window.model)
    assert window.message.isVisible()
    assert "broken.vti" in window.message.text.text()
    assert "broken.vti" in window.docks["Messages"].panel.toPlainText()
    assert window.model.scene is scene
    assert window.model.hits is hits
    assert "standard" in window.windowTitle()


def test_a_file_that_is_dropped_is_opened(qtbot, window, tmp_path):
    file = tmp_path / "ramp.npz"
    np.savez(file, levels=np.repeat(np.linspace(1, 0, 8)[None, None, :], 8, axis=0).repeat(8, axis=1))
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(file))])
    event = QDropEvent(QPointF(800, 400), Qt.DropAction.CopyAction, mime, LEFT, Qt.KeyboardModifier.NoModifier)
    window.dropEvent(event)
    settle(qtbot, window.model)
    assert "ramp.npz" in window.windowTitle()
    assert window.model.scene.kind == "lattice"
    assert window.model.quality is None


def test_error_maps_are_offered_where_the_exact_surface_is_known(qtbot, window, tmp_path):
    actions = window.actions_
    assert actions.map_actions["distance_error"].isEnabled()
    window.model.set_map("distance_error")
    window.model.open("splash")
    settle(qtbot, window.model)
    assert not actions.map_actions["distance_error"].isEnabled()
    assert window.model.map == "shaded"
    assert actions.frame_action.isVisible()


def test_the_map_list_and_the_menu_agree(qtbot, window):
    actions = window.actions_
    actions.map_actions["depth"].trigger()
    assert window.model.map == "depth"
    assert actions.maps.currentData() == "depth"
    actions.maps.setFocus()
    QTest.keyClick(actions.maps, Qt.Key.Key_Down)
    assert window.model.map == "status"
    assert actions.map_actions["status"].isChecked()


def test_the_theme_reaches_everything(qtbot, window):
    ground = QPalette.ColorRole.Window
    light = QApplication.palette().color(ground).lightness()
    window.actions_.dark.trigger()
    assert window.model.theme == "dark"
    assert QApplication.palette().color(ground).lightness() < light
    window.actions_.dark.trigger()
    assert QApplication.palette().color(ground).lightness() == light


def test_another_size_gives_a_picture_of_that_size(qtbot, window):
    sizes = window.actions_.sizes
    sizes.setFocus()
    sizes.setCurrentIndex(0)
    sizes.activated.emit(0)
    settle(qtbot, window.model)
    assert window.model.hits.size == (256, 256)


def test_the_picture_is_saved_as_it_is_shown(qtbot, window, tmp_path):
    path = tmp_path / "picture.png"
    window.save_picture(path)
    assert QImage(str(path)).size() == window.view.image.size()
    window.save_picture(tmp_path / "no" / "such" / "folder.png")
    assert window.message.isVisible()


def test_statistics_are_exported(qtbot, window, tmp_path):
    panel = window.docks["Statistics"].panel
    for kind in ("csv", "svg"):
        path = tmp_path / f"statistics.{kind}"
        panel.export(path)
        assert path.stat().st_size > 200


def test_the_status_bar_shows_the_pictures_numbers(qtbot, window):
    text = window.statusBar().figures.text()
    for part in ("of rays hit", "evaluations/ray", "ms", "δ"):
        assert part in text


def test_closing_ends_the_threads(qtbot, window):
    import threading

    window.model.set_value("h", 0.9)
    window.close()
    assert not [t.name for t in threading.enumerate() if t.name.startswith("jaart")]


def test_a_screenshot_shows_the_picked_ray(qtbot, tmp_path):
    path = tmp_path / "window.png"
    assert app.run("standard", pick=(256, 256), screenshot=path) == 0
    assert QImage(str(path)).width() == 1600


def test_the_window_ends_when_it_is_closed(qtbot):
    def close_when_done():
        windows = [w for w in QApplication.topLevelWidgets() if isinstance(w, MainWindow) and w.isVisible()]
        if windows and windows[0].model.complete:
            assert windows[0].model.settings.h.value == 1.5
            windows[0].close()

    timer = QTimer(interval=50)
    timer.timeout.connect(close_when_done)
    timer.start()
    assert app.run("standard", settings=Settings(h=1.5)) == 0


def test_a_screenshot_of_what_cannot_be_read_is_an_error(qtbot, tmp_path):
    path = tmp_path / "window.png"
    with pytest.raises(JaartError, match=r"missing\.npz"):
        app.run(tmp_path / "missing.npz", screenshot=path)
    assert not path.exists()


def test_a_pick_beside_the_picture_is_an_error(qtbot, tmp_path):
    with pytest.raises(JaartError, match="--pick 512,0"):
        app.run("standard", pick=(512, 0), screenshot=tmp_path / "window.png")


def test_without_a_display_one_line_says_so(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(JaartError, match="no display"):
        libraries.check()
    monkeypatch.setenv("DISPLAY", ":987")
    with pytest.raises(JaartError, match=":987"):
        libraries.check()


def test_missing_libraries_are_named_by_their_packages(monkeypatch):
    assert libraries.missing({"libno-such-thing.so.9": "libno-such-thing9"}) == ["libno-such-thing9"]
    monkeypatch.setattr(libraries, "NEEDED", {"libno-such-thing.so.9": "libno-such-thing9"})
    with pytest.raises(JaartError, match="apt-get install libno-such-thing9"):
        libraries.check()


def test_a_first_scene_that_cannot_be_read_ends_the_program(qtbot, tmp_path):
    with pytest.raises(JaartError, match=r"missing\.npz: no such file"):
        app.run(str(tmp_path / "missing.npz"))


def test_drawing_a_panel_is_no_progress_of_the_picture(qtbot, window):
    settle(qtbot, window.model)
    hold, bar = threading.Event(), window.statusBar().bar
    window.model.draw_later(hold.wait, lambda _: None)
    assert not window.model.idle and not window.model.computing
    window.model.progressed.emit(0.0)
    assert not bar.isVisible()
    hold.set()
    settle(qtbot, window.model)
