"""The figures of a picked ray with a real scene: pick, step from each of them, zoom, hover."""

from __future__ import annotations

import numpy as np
import pytest
from panel_calls import LEFT, pick, shown
from patience import PATIENCE, settle
from qtpy.QtCore import QPoint, QPointF, Qt
from qtpy.QtGui import QColor, QWheelEvent
from qtpy.QtWidgets import QApplication, QToolTip

from jaart.gui.energy_plot import EnergyPlot
from jaart.gui.projector2d import Projector2D
from jaart.plot.style import THEMES


def drawn(qtbot, panel, words):
    """Wait until a figure panel shows words in its title."""
    def seen():
        return any(words in text.get_text() for axes in panel.canvas.figure.axes for text in axes.texts)
    qtbot.waitUntil(seen, timeout=PATIENCE)
    panel.canvas._canvas.draw()


def place(panel, start):
    """Where on the canvas the spot is whose text starts so."""
    canvas = panel.canvas._canvas
    spot = next(s for s in panel.canvas._spots if s.text.startswith(start))
    x, y = panel.canvas._axes.transData.transform((spot.x, spot.y)) / canvas.device_pixel_ratio
    return canvas, QPoint(round(x), round(canvas.height() - y))


def wheel(canvas, at):
    event = QWheelEvent(QPointF(at), QPointF(canvas.mapToGlobal(at)), QPoint(0, 0), QPoint(0, 240),
                        Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False)
    QApplication.sendEvent(canvas, event)


@pytest.mark.parametrize("panel", [EnergyPlot, Projector2D])
def test_before_a_pick_a_panel_says_what_to_do_and_after_it_draws(qtbot, standard, panel):
    panel = shown(qtbot, panel(standard))
    assert "Click a pixel" in panel.canvas._message.text()
    assert panel.canvas._message.isVisible()
    pick(qtbot, standard, 2)
    drawn(qtbot, panel, "Step 1")
    assert not panel.canvas._message.isVisible()
    standard.clear_pick()
    qtbot.waitUntil(panel.canvas._message.isVisible)


@pytest.mark.parametrize("panel", [EnergyPlot, Projector2D])
def test_a_click_on_a_mark_chooses_its_step(qtbot, standard, panel):
    pick(qtbot, standard, 3)
    panel = shown(qtbot, panel(standard), 1200, 600)
    drawn(qtbot, panel, "Step 1")
    canvas, at = place(panel, "Q2:")
    qtbot.mouseClick(canvas, LEFT, pos=at)
    assert standard.step == 1
    drawn(qtbot, panel, "Step 2")
    qtbot.keyClick(panel, Qt.Key.Key_Right)
    drawn(qtbot, panel, "Step 3")


def test_hovering_tells_what_a_point_is(qtbot, standard):
    pick(qtbot, standard, 2)
    panel = shown(qtbot, Projector2D(standard), 900, 600)
    drawn(qtbot, panel, "Step 1")
    canvas, at = place(panel, "a:")
    qtbot.mouseMove(canvas, at - QPoint(40, 60))
    qtbot.mouseMove(canvas, at)
    qtbot.waitUntil(lambda: QToolTip.text() != "")
    spot = panel.canvas.spot_at(*panel.canvas._axes.transData.transform([
        (s.x, s.y) for s in panel.canvas._spots if s.text.startswith("a:")])[0])
    assert QToolTip.text().startswith(spot.text)
    assert ", ".join(f"{c:.3f}" for c in standard.trace.barycentre[0]) in QToolTip.text()


@pytest.mark.parametrize("panel", [EnergyPlot, Projector2D])
def test_the_wheel_zooms_stepping_keeps_that_and_a_double_click_resets(qtbot, standard, panel):
    pick(qtbot, standard, 2)
    panel = shown(qtbot, panel(standard))
    drawn(qtbot, panel, "Step 1")
    before = np.array(panel.canvas._axes.get_xlim())
    canvas, at = place(panel, "Q1:")
    wheel(canvas, at)
    after = np.array(panel.canvas._axes.get_xlim())
    assert np.diff(after) == pytest.approx(np.diff(before) * 0.64)
    standard.set_step(1)
    drawn(qtbot, panel, "Step 2")
    np.testing.assert_allclose(panel.canvas._axes.get_xlim(), after)
    qtbot.mouseDClick(canvas, LEFT, pos=at)
    qtbot.waitUntil(lambda: np.ptp(panel.canvas._axes.get_xlim()) > 1.2 * np.ptp(after))


def test_other_settings_keep_what_is_zoomed_into_and_another_ray_does_not(qtbot, standard):
    pick(qtbot, standard, 2)
    panel = shown(qtbot, EnergyPlot(standard))
    drawn(qtbot, panel, "Step 1")
    canvas, at = place(panel, "Q1:")
    wheel(canvas, at)
    zoomed = panel.canvas._axes.get_xlim()
    standard.set_value("h", 0.9)
    settle(qtbot, standard)
    qtbot.waitUntil(lambda: not panel._dirty)
    assert panel.canvas._axes.get_xlim() == zoomed
    x, y = standard.picked
    standard.pick(x + 1, y)
    settle(qtbot, standard)
    qtbot.waitUntil(lambda: not panel._dirty)
    assert not panel.canvas.zoomed


def test_dragging_moves_what_is_seen_and_chooses_nothing(qtbot, standard):
    pick(qtbot, standard, 3)
    panel = shown(qtbot, EnergyPlot(standard))
    drawn(qtbot, panel, "Step 1")
    before = np.array(panel.canvas._axes.get_xlim())
    canvas, at = place(panel, "Q2:")
    qtbot.mousePress(canvas, LEFT, pos=at)
    qtbot.mouseMove(canvas, at + QPoint(50, 0))
    qtbot.mouseRelease(canvas, LEFT, pos=at + QPoint(50, 0))
    after = np.array(panel.canvas._axes.get_xlim())
    assert (after < before).all()
    assert np.diff(after) == pytest.approx(np.diff(before))
    assert standard.step == 0


def test_the_whole_ray_on_request(qtbot, standard):
    trace = pick(qtbot, standard, 2)
    panel = shown(qtbot, EnergyPlot(standard))
    drawn(qtbot, panel, "Step 1")
    qtbot.mouseClick(panel.whole, LEFT)
    qtbot.waitUntil(lambda: panel.canvas._axes.get_xlim()[1] > trace.borders[-1])


def test_a_hidden_panel_draws_when_it_is_shown(qtbot, standard):
    panel = shown(qtbot, Projector2D(standard))
    panel.hide()
    pick(qtbot, standard, 2)
    QApplication.processEvents()
    assert panel.canvas._canvas is None
    panel.show()
    drawn(qtbot, panel, "Step 1")


@pytest.mark.parametrize("panel", [EnergyPlot, Projector2D])
def test_figures_follow_the_theme(qtbot, standard, panel):
    pick(qtbot, standard, 2)
    panel = shown(qtbot, panel(standard))
    drawn(qtbot, panel, "Step 1")
    standard.set_theme("dark")

    def dark():
        corner = panel.grab().toImage().pixelColor(2, panel.height() - 3)
        return all(abs(c - w) <= 8 for c, w in zip(corner.getRgb(), QColor(THEMES["dark"].face).getRgb(), strict=True))
    qtbot.waitUntil(dark)


def test_the_button_does_not_lie_over_the_title_of_energies(qtbot, standard):
    pick(qtbot, standard, 3)
    panel = shown(qtbot, EnergyPlot(standard), 345, 300)
    drawn(qtbot, panel, "Step 1")
    axes, height = panel.canvas.figure.axes[0], panel.canvas.height()
    title = next(text for text in axes.texts if "Step 1" in text.get_text()).get_window_extent()
    button = panel.whole.geometry()
    assert height - button.top() < title.y0
