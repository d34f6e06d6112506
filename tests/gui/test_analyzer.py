"""Stepping along a picked ray, and the analyzer that shows its steps in space."""

from __future__ import annotations

import numpy as np
import pytest
from panel_calls import LEFT, pick, shown
from patience import PATIENCE, settle
from qtpy.QtCore import Qt
from qtpy.QtGui import QColor
from qtpy.QtWidgets import QApplication

from jaart.gui.analyzer3d import Analyzer3D
from jaart.gui.step_bar import StepBar
from jaart.plot.style import THEMES


@pytest.fixture
def analyzer(qtbot, standard):
    panel = shown(qtbot, Analyzer3D(standard))
    yield panel
    panel.close_view()


def test_the_step_bar_steps_by_button_and_by_key(qtbot, standard):
    bar = shown(qtbot, StepBar(standard), height=60)
    assert bar.position.text() == "step 0 / 0"
    assert not bar.forward.isEnabled()
    trace = pick(qtbot, standard, 3)
    assert bar.position.text() == f"step 1 / {trace.steps}"
    assert bar.state.text().startswith(f"start 1 of {trace.start[-1] + 1}")
    assert not bar.back.isEnabled()
    qtbot.mouseClick(bar.forward, LEFT)
    assert standard.step == 1
    for key, step in ((Qt.Key.Key_Right, 2), (Qt.Key.Key_Left, 1), (Qt.Key.Key_End, trace.steps - 1),
                      (Qt.Key.Key_Home, 0)):
        qtbot.keyClick(bar, key)
        assert standard.step == step
    qtbot.mouseClick(bar.last, LEFT)
    assert bar.position.text() == f"step {trace.steps} / {trace.steps}"
    assert not bar.forward.isEnabled()


def test_a_narrow_step_bar_says_how_a_start_ended(qtbot, standard):
    bar = shown(qtbot, StepBar(standard), width=345, height=84)
    pick(qtbot, standard, 3)
    for width, below in ((345, True), (600, False), (345, True)):
        bar.resize(width, 84)
        QApplication.processEvents()
        assert bar.state.width() >= bar.state.fontMetrics().horizontalAdvance("start 1 of 1: left the trust region")
        assert (bar.state.y() > bar.back.geometry().bottom() - 4) == below


def test_play_goes_to_the_last_step_and_stops(qtbot, standard):
    bar = shown(qtbot, StepBar(standard), height=60)
    trace = pick(qtbot, standard, 3)
    bar._timer.setInterval(10)
    seen = []
    standard.step_changed.connect(lambda: seen.append(standard.step))
    qtbot.mouseClick(bar.play, LEFT)
    qtbot.waitUntil(lambda: not bar.play.isChecked())
    assert seen == list(range(1, trace.steps))
    qtbot.mouseClick(bar.play, LEFT)
    assert standard.step == 0
    standard.clear_pick()
    assert not bar._timer.isActive()


def test_the_analyzer_makes_its_view_for_the_first_ray_and_shows_it(qtbot, standard, analyzer):
    assert analyzer._view is None
    assert "Click a pixel" in analyzer._message.text()
    pick(qtbot, standard, 2)
    qtbot.waitUntil(lambda: analyzer._view is not None and not analyzer._dirty, timeout=PATIENCE)
    colours = THEMES["light"]

    def close(wanted):
        image = analyzer.grab().toImage()
        pixels = np.frombuffer(image.convertToFormat(image.Format.Format_RGB32).bits(), np.uint8).reshape(-1, 4)
        wanted = QColor(wanted)
        hue = np.array([wanted.blue(), wanted.green(), wanted.red()])
        return (np.abs(pixels[:, :3].astype(int) - hue).max(axis=1) < 40).sum()
    qtbot.waitUntil(lambda: all(close(c) > 5 for c in (colours.query, colours.hit, colours.next, colours.barycentre)))


def test_stepping_keeps_the_view_and_a_button_changes_it(qtbot, standard, analyzer):
    pick(qtbot, standard, 3)
    qtbot.waitUntil(lambda: analyzer._view is not None and not analyzer._dirty, timeout=PATIENCE)
    eye = analyzer._view.camera.position
    solids = analyzer._actors["solids"].mapper.dataset.points.copy()
    qtbot.keyClick(analyzer._view, Qt.Key.Key_Right)
    assert standard.step == 1
    qtbot.waitUntil(lambda: not analyzer._dirty)
    assert analyzer._view.camera.position == eye
    assert not np.array_equal(analyzer._actors["solids"].mapper.dataset.points, solids)
    standard.set_value("h", 0.85)
    settle(qtbot, standard)
    qtbot.waitUntil(lambda: not analyzer._dirty)
    assert analyzer._view.camera.position == eye
    analyzer.look("ray")
    ahead = np.subtract(analyzer._view.camera.focal_point, analyzer._view.camera.position)
    np.testing.assert_allclose(ahead / np.linalg.norm(ahead), standard.trace.direction, atol=1e-6)


def test_a_step_out_of_view_is_brought_into_it_from_the_same_side(qtbot, model):
    panel = shown(qtbot, Analyzer3D(model))
    model.set_size(128, 128)
    model.set_settings(model.settings.replace(h=2.55))
    model.open("splash")
    settle(qtbot, model)
    trace = pick_far_starts(qtbot, model)
    qtbot.waitUntil(lambda: panel._view is not None and not panel._dirty, timeout=PATIENCE)
    camera = panel._view.camera
    camera.Azimuth(25)  # as a person turns it
    looks, up = np.array(camera.GetDirectionOfProjection()), camera.up
    assert not panel._sees(trace.query[0])
    qtbot.keyClick(panel._view, Qt.Key.Key_Home)
    qtbot.waitUntil(lambda: not panel._dirty)
    assert panel._sees(trace.query[0]) and not panel._sees(trace.point)
    np.testing.assert_allclose(camera.GetDirectionOfProjection(), looks, atol=1e-9)
    assert camera.up == up
    qtbot.keyClick(panel._view, Qt.Key.Key_End)
    qtbot.waitUntil(lambda: not panel._dirty)
    assert panel._sees(trace.query[-1]) and panel._sees(trace.point)
    panel.close_view()


def pick_far_starts(qtbot, model):
    """Pick a ray that arrives far behind its first start."""
    hits = model.hits
    for pixel in np.flatnonzero(hits.hit & (hits.evaluations > hits.iterations)):
        model.pick(int(pixel) % hits.size[0], int(pixel) // hits.size[0])
        settle(qtbot, model)
        if model.trace.hit and model.trace.t - model.trace.t_query[0] > 20:
            model.set_step(model.trace.steps - 1)
            return model.trace
    raise AssertionError("no ray of the picture has starts far apart")


def test_keys_do_not_reach_the_shortcuts_of_the_view(qtbot, standard, analyzer):
    pick(qtbot, standard, 2)
    qtbot.waitUntil(lambda: analyzer._view is not None and not analyzer._dirty, timeout=PATIENCE)
    eye = analyzer._view.camera.position
    for key in (Qt.Key.Key_R, Qt.Key.Key_V, Qt.Key.Key_Q, Qt.Key.Key_W):
        qtbot.keyClick(analyzer._view, key)
    assert analyzer._view.camera.position == eye
    assert analyzer._view.isVisible()


def test_a_closed_analyzer_stays_closed(qtbot, standard, analyzer):
    pick(qtbot, standard, 2)
    qtbot.waitUntil(lambda: analyzer._view is not None and not analyzer._dirty, timeout=PATIENCE)
    analyzer.close_view()
    pick(qtbot, standard, 3)
    QApplication.processEvents()
    assert analyzer._view is None
