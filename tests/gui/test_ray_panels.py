"""The ray panels with a real scene: pick, step from each of them, zoom, hover, export."""

from __future__ import annotations

import csv
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from patience import PATIENCE, settle
from qtpy.QtCore import QPoint, QPointF, Qt
from qtpy.QtGui import QColor, QWheelEvent
from qtpy.QtWidgets import QApplication, QToolTip

from jaart.core.errors import FileError
from jaart.gui.analyzer3d import Analyzer3D
from jaart.gui.energy_plot import EnergyPlot
from jaart.gui.projector2d import Projector2D
from jaart.gui.statistics import StatisticsPanel
from jaart.gui.step_bar import StepBar
from jaart.plot.style import THEMES

LEFT = Qt.MouseButton.LeftButton


def shown(qtbot, panel, width=460, height=300):
    qtbot.addWidget(panel)
    panel.resize(width, height)
    panel.show()
    qtbot.waitExposed(panel)
    return panel


def pick(qtbot, model, steps):
    """Pick a pixel whose ray arrives after so many steps at least."""
    hits = model.hits
    pixel = int(np.flatnonzero(hits.hit & (hits.evaluations >= steps))[0])
    model.pick(pixel % hits.size[0], pixel // hits.size[0])
    settle(qtbot, model)
    model.set_step(0)
    assert model.trace.steps >= steps
    return model.trace


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


@pytest.fixture
def analyzer(qtbot, standard):
    panel = shown(qtbot, Analyzer3D(standard))
    yield panel
    panel.close_view()


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


def test_statistics_are_written_as_svg_and_csv(qtbot, standard, tmp_path):
    panel = shown(qtbot, StatisticsPanel(standard), 800, 240)
    qtbot.waitUntil(lambda: not panel.picture.pixmap().isNull(), timeout=PATIENCE)
    assert panel.picture.pixmap().size() == panel.size() * panel.devicePixelRatioF()
    said = []
    standard.said.connect(said.append)
    panel.export(tmp_path / "numbers.csv")
    panel.export(tmp_path / "picture.svg")
    with (tmp_path / "numbers.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["statistic", "bin", "value"]
    assert ["hits", "", str(int(standard.hits.hit.sum()))] in rows
    assert any(row[0] == "delta" and float(row[2]) == standard.quality.delta for row in rows)
    assert ET.parse(tmp_path / "picture.svg").getroot().tag.endswith("svg")
    assert len(said) == 2


def test_an_export_that_cannot_be_done_says_why(qtbot, standard, tmp_path):
    panel = shown(qtbot, StatisticsPanel(standard), 800, 240)
    with pytest.raises(FileError, match=r"\.svg or \.csv"):
        panel.export(tmp_path / "numbers.txt")
    with pytest.raises(FileError, match="cannot be written"):
        panel.export(tmp_path / "absent" / "numbers.csv")
    assert list(tmp_path.iterdir()) == []


def test_without_a_picture_there_is_nothing_to_export(qtbot, model, tmp_path):
    panel = shown(qtbot, StatisticsPanel(model), 800, 240)
    assert not any(button.isEnabled() for button in panel.buttons)
    with pytest.raises(FileError, match="no picture"):
        panel.export(tmp_path / "numbers.csv")
