"""What takes long before rays are traced, reading a file and filling a lattice, is told and can be stopped."""

from __future__ import annotations

import threading

import pytest
from patience import PATIENCE, choose, settle
from qtpy.QtCore import Qt
from qtpy.QtTest import QTest

import jaart.core.io
import jaart.core.render
from jaart.gui import stop

LEFT = Qt.MouseButton.LeftButton
READ = jaart.core.io.load
RENDER = jaart.core.render.render


@pytest.fixture
def slow(monkeypatch):
    """A file is read only once this event is set, whoever waits for it."""
    go = threading.Event()
    go.waited = False

    def load(*given):
        go.waited = True
        assert go.wait(PATIENCE / 1000)
        return READ(*given)

    monkeypatch.setattr(jaart.core.io, "load", load)
    yield go
    go.set()


def press_stop(qtbot, window):
    button = window.statusBar().findChild(stop.StopButton)
    qtbot.waitUntil(button.isVisible, timeout=PATIENCE)
    QTest.mouseClick(button, LEFT)
    settle(qtbot, window.model)
    assert not button.isVisible()


def test_reading_a_file_is_stopped_by_the_button_and_the_open_scene_stays(qtbot, window, slow):
    model, scene, hits = window.model, window.model.scene, window.model.hits
    model.open("splash")
    qtbot.waitUntil(window.statusBar().bar.isVisible, timeout=PATIENCE)
    assert "splash" in window.statusBar().state.text()
    press_stop(qtbot, window)
    assert not window.statusBar().bar.isVisible()
    assert (model.scene, model.hits) == (scene, hits)
    model.set_value("h", 0.9)  # nothing waits for the file
    settle(qtbot, model)
    assert model.complete
    assert model.hits.settings == model.settings
    slow.set()
    model.open("standard")
    settle(qtbot, model)
    assert model.scene is not scene
    assert model.scene.source == "standard"


def test_another_file_does_not_wait_for_the_one_before(qtbot, window, slow, monkeypatch):
    model = window.model
    model.open("splash")
    qtbot.waitUntil(lambda: slow.waited, timeout=PATIENCE)
    monkeypatch.setattr(jaart.core.io, "load", READ)
    model.open("bumpy")
    settle(qtbot, model)
    assert model.scene.kind == "cloud"
    slow.set()
    qtbot.wait(300)
    assert model.scene.kind == "cloud"


def test_filling_a_lattice_is_told_and_stopped_by_the_button(qtbot, window):
    model, told = window.model, []
    model.staged.connect(lambda what, share: told.append((what, share)))
    model.set_value("raster", 200)
    press_stop(qtbot, window)
    assert "levels" not in {stage for stage, (key, _) in model.scene._kept.items() if 200 in key}
    shares = [share for what, share in told if what == "filling the lattice"]
    assert shares
    assert max(shares) < 1
    model.set_value("raster", 12)
    settle(qtbot, model)
    assert model.complete
    assert model.hits.settings.raster == 12


@pytest.fixture
def held(monkeypatch):
    """A picture goes on only to its first coarse one, until it is cancelled."""
    def render(*given, picture, cancel, **more):
        def shown(hits):
            picture(hits)
            assert cancel.wait(PATIENCE / 1000)

        return RENDER(*given, picture=shown, cancel=cancel, **more)

    monkeypatch.setattr(jaart.core.render, "render", render)
    monkeypatch.setattr(jaart.core.render, "PATIENCE", 0.0)
    return monkeypatch


def test_a_stopped_picture_is_called_so_and_has_no_numbers_of_another(qtbot, window, held):
    model, status, panel = window.model, window.statusBar(), window.docks["Statistics"].panel
    qtbot.waitUntil(lambda: not panel.picture.pixmap().isNull(), timeout=PATIENCE)
    model.set_value("h", 1.2)
    qtbot.waitUntil(lambda: not model.complete, timeout=PATIENCE)
    press_stop(qtbot, window)
    assert status.state.text() == "Stopped: a coarse picture. Changing a value begins again."
    assert status.figures.text() == ""
    assert panel.picture.pixmap().isNull()
    assert panel.picture.text().startswith("The picture was stopped.")
    window.actions_.dark.trigger()
    assert panel.picture.pixmap().isNull()
    held.undo()
    model.set_value("h", 1.3)
    settle(qtbot, model)
    qtbot.waitUntil(lambda: not panel.picture.pixmap().isNull(), timeout=PATIENCE)
    assert status.state.text() == "Picture of 192 × 192 rays"
    assert "of rays hit" in status.figures.text()


@pytest.fixture
def endless(monkeypatch):
    """A picture shows nothing at all until it is cancelled."""
    def render(*given, cancel, **more):
        assert cancel.wait(PATIENCE / 1000)
        return RENDER(*given, cancel=cancel, **more)

    monkeypatch.setattr(jaart.core.render, "render", render)
    return monkeypatch


def test_a_first_picture_that_was_stopped_is_called_so_and_the_panels_are_there(qtbot, bare, endless):
    window, view = bare, bare.view
    assert view._nothing() == "Drop a file here, or open one"
    window.model.open("standard")
    qtbot.waitUntil(lambda: window.model.scene is not None, timeout=PATIENCE)
    press_stop(qtbot, window)
    assert view._nothing() == window.statusBar().state.text() == "Stopped. Changing a value begins again."
    qtbot.waitUntil(lambda: window.panels_ready, timeout=PATIENCE)
    assert all(dock.panel is not None for dock in window.docks.values())
    endless.undo()
    choose(window.docks["Parameters"].panel.rows["bail"].combo, "growth")
    settle(qtbot, window.model)
    assert window.model.complete


def test_words_follow_a_value_before_its_picture_is_done(qtbot, window, held):
    model, rows = window.model, window.docks["Parameters"].panel.rows
    choose(rows["trust"].word, "radius")
    model.set_value("h", 0.8)
    slider = rows["h"].slider
    slider.setFocus()
    QTest.keyClick(slider, Qt.Key.Key_Right)
    qtbot.waitUntil(lambda: rows["radius"].box.text() == "2.65625", timeout=PATIENCE)  # 3.125 h
    assert model.computing
    assert rows["trust"].box.text() == rows["radius"].box.text()
    model.stop()
    settle(qtbot, model)
