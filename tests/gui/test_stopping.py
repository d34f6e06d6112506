"""What takes long before rays are traced, reading a file and filling a lattice, is told and can be stopped."""

from __future__ import annotations

import threading

import pytest
from patience import PATIENCE, settle
from qtpy.QtCore import Qt
from qtpy.QtTest import QTest

import jaart.core.io
from jaart.gui import stop

LEFT = Qt.MouseButton.LeftButton
READ = jaart.core.io.load


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
