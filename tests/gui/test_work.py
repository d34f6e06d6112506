"""What the window does for a click, a slider, a hidden panel, and no more: counted, not timed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from patience import PATIENCE, settle
from pyvistaqt import QtInteractor
from qtpy.QtCore import Qt
from qtpy.QtTest import QTest

import jaart.core.shade
import jaart.core.trace
from jaart.gui import stop

LEFT = Qt.MouseButton.LeftButton
FIGURES = ("2D projector", "Energy along the ray")


def click(qtbot, window, pixel):
    """Click on a pixel and wait until every panel shows its ray."""
    QTest.mouseClick(window.view, LEFT, pos=window.view.place_of(pixel).toPoint())
    settle(qtbot, window.model)
    quiet(qtbot, window)


def quiet(qtbot, window):
    qtbot.waitUntil(lambda: not any(getattr(dock.panel, "pending", False) for dock in window.docks.values()),
                    timeout=PATIENCE)
    qtbot.wait(100)


def counted(monkeypatch, place, name):
    """A list that grows with each call."""
    calls, real = [], getattr(place, name)

    def call(*given, **named):
        calls.append(given)
        return real(*given, **named)

    monkeypatch.setattr(place, name, call)
    return calls


def on_surface(model, part):
    """A pixel whose ray hits, after so large a part of all that do: one that misses may take no step to be drawn."""
    met = model.hits.hit.nonzero()[0]
    number = int(met[int(part * len(met))])
    return number % model.size[0], number // model.size[0]


def test_a_click_traces_once_and_draws_each_panel_once(qtbot, window, monkeypatch):
    click(qtbot, window, on_surface(window.model, 0.3))
    canvases = [window.docks[title].panel.canvas._canvas for title in FIGURES]
    axes = [canvas.figure.axes[0] for canvas in canvases]
    traces = counted(monkeypatch, jaart.core.trace, "trace")
    drawings = [counted(monkeypatch, canvas, "draw") for canvas in canvases]
    renders = []
    space = window.docks["3D ray analyzer"].panel.findChild(QtInteractor).render_window
    observer = space.AddObserver("StartEvent", lambda *_: renders.append(1))
    pixel = on_surface(window.model, 0.6)
    click(qtbot, window, pixel)
    qtbot.waitUntil(lambda: bool(renders), timeout=PATIENCE)  # painted by the system, when it has the time
    qtbot.wait(100)
    space.RemoveObserver(observer)
    assert window.model.trace.pixel == pixel
    assert [len(calls) for calls in (traces, *drawings)] == [1, 1, 1]
    assert renders == [1]
    assert [canvas.figure.axes for canvas in canvases] == [[one] for one in axes]  # kept, not made anew


def test_nothing_of_a_ray_stays_when_another_is_drawn(qtbot, window):
    click(qtbot, window, (96, 96))
    counts = []
    for _ in range(3):
        for pixel in ((2, 2), (96, 96)):
            click(qtbot, window, pixel)
        counts.append([len(window.docks[title].panel.canvas.figure.axes[0].get_children()) for title in FIGURES])
    assert counts[0] == counts[1] == counts[2]


def test_a_panel_that_is_closed_draws_nothing_until_it_is_shown(qtbot, window, monkeypatch):
    click(qtbot, window, (96, 96))
    closed = [window.docks[title] for title in (*FIGURES, "3D ray analyzer", "Statistics")]
    for dock in closed:
        dock.hide()
    drawn = [counted(monkeypatch, dock.panel, "draw") for dock in closed]
    click(qtbot, window, (100, 90))
    window.model.set_value("h", 0.9)
    settle(qtbot, window.model)
    qtbot.wait(700)  # statistics wait for half a second
    assert [len(calls) for calls in drawn] == [0, 0, 0, 0]
    for dock in closed:
        dock.show()
        dock.raise_()
    qtbot.waitUntil(lambda: all(drawn), timeout=PATIENCE)


def test_a_move_of_a_slider_colours_only_the_pictures_it_brings(qtbot, window, monkeypatch):
    quiet(qtbot, window)
    colourings = counted(monkeypatch, jaart.core.shade, "shade")
    pictures = []
    window.model.hits_changed.connect(lambda: pictures.append(window.model.hits.t))
    slider = window.docks["Parameters"].panel.rows["h"].slider
    slider.setValue(slider.value() + 1)
    assert not colourings
    settle(qtbot, window.model)
    assert len(colourings) == len({id(t) for t in pictures}) >= 2
    window.model.set_value("ambient", 0.3)
    assert len(colourings) == len({id(t) for t in pictures}) + 1


def test_a_click_is_answered_while_errors_are_measured_and_a_button_stops_that(qtbot, window, monkeypatch):
    model, button = window.model, window.statusBar().findChild(stop.StopButton)
    model.set_size(512, 512)
    model.open("bumpy")
    qtbot.waitUntil(lambda: model.complete and model.scene.kind == "cloud", timeout=PATIENCE)
    assert not model.measurer.worker.idle
    QTest.mouseClick(window.view, LEFT, pos=window.view.place_of((256, 256)).toPoint())
    qtbot.waitUntil(lambda: model.trace is not None, timeout=PATIENCE)
    assert not model.measurer.worker.idle
    qtbot.waitUntil(button.isVisible, timeout=PATIENCE)
    QTest.mouseClick(button, LEFT)
    settle(qtbot, model)
    assert model.complete
    assert model.quality is None
    assert not button.isVisible()
    model.set_value("h", "2s")
    qtbot.waitUntil(lambda: model.hits.settings == model.settings and model.complete, timeout=PATIENCE)


def test_rays_can_be_stopped_and_are_traced_again_when_something_is_set(qtbot, window):
    model = window.model
    model.set_size(1024, 1024)
    qtbot.waitUntil(lambda: model.hits.size != (192, 192), timeout=PATIENCE)
    model.stop()
    settle(qtbot, model)
    assert not model.complete
    model.set_size(192, 192)
    settle(qtbot, model)
    assert model.complete
    assert model.quality is not None


@pytest.mark.parametrize("library", ["numba", "matplotlib", "pyvista", "scipy"])
def test_the_window_opens_before_slow_libraries_are_loaded(library):
    code = f"import sys, jaart.gui.main_window; sys.exit({library!r} in sys.modules)"
    root = Path(__file__).resolve().parents[2]
    done = subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": str(root)}, check=False)
    assert done.returncode == 0
