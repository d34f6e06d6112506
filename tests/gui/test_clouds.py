"""Clouds of points in the window: opened, looked at, picked, and settings that suit them."""

from __future__ import annotations

import numpy as np
import pytest
from patience import PATIENCE, choose, said, settle, write_cloud
from qtpy.QtCore import Qt, QTimer
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QApplication, QFileDialog

from jaart import cli
from jaart.core.settings import preset
from jaart.gui.actions import SAMPLES
from jaart.gui.main_window import MainWindow
from jaart.gui.navigation import VIEWS, view

LEFT = Qt.MouseButton.LeftButton
MIDDLE = (3.0, -2.0, 1.0)


@pytest.fixture
def cloudy(qtbot, model, tmp_path):
    """A scene model with a small cloud in a small picture."""
    model.set_size(64, 64)
    model.open(write_cloud(tmp_path / "points.npz"))
    settle(qtbot, model)
    assert model.complete
    return model


def test_a_file_of_points_is_opened_from_the_menu(qtbot, window, tmp_path, monkeypatch):
    path = write_cloud(tmp_path / "points.npz")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    window.actions_.open.trigger()
    qtbot.waitUntil(lambda: window.model.scene.kind == "cloud", timeout=PATIENCE)
    settle(qtbot, window.model)
    assert window.windowTitle().startswith("points.npz")
    assert 0.1 < window.model.hits.hit.mean() < 0.6


def test_the_built_in_cloud_is_offered(window):
    assert "bumpy" in SAMPLES.values()
    menus = [menu for action in window.menuBar().actions() for menu in [action.menu()] if menu is not None]
    samples = [a.menu() for a in menus[0].actions() if a.menu() is not None]
    assert [a.text() for a in samples[0].actions()] == list(SAMPLES)


def test_a_cloud_is_seen_whole_from_every_side(qtbot, cloudy):
    low, high = np.array(cloudy.bounds)
    assert (low > (2.8, -2.2, 0.8)).all()
    assert (high < (3.2, -1.8, 1.2)).all()
    for name in VIEWS:
        camera = view(cloudy.bounds, name)
        assert camera.target == pytest.approx((low + high) / 2)
        cloudy.set_camera(camera)
        settle(qtbot, cloudy)
        seen = cloudy.hits.hit.reshape(64, 64)
        assert seen[32, 32]
        assert not (seen[0].any() or seen[-1].any() or seen[:, 0].any() or seen[:, -1].any())


def test_a_click_on_a_cloud_is_followed_by_every_panel(qtbot, window, tmp_path):
    model = window.model
    model.open(write_cloud(tmp_path / "points.npz"))
    settle(qtbot, model)
    QTest.mouseClick(window.view, LEFT, pos=window.view.place_of((96, 96)).toPoint())
    settle(qtbot, model)
    qtbot.waitUntil(lambda: not any(d.panel.pending for d in window.docks.values() if hasattr(d.panel, "pending")),
                    timeout=PATIENCE)
    assert model.trace.hit
    assert len(model.trace.balls)
    assert np.linalg.norm(model.trace.point - MIDDLE) == pytest.approx(0.1, rel=0.3)
    shown = window.docks["3D ray analyzer"].panel._actors
    assert shown["full_cells"].GetVisibility()
    for title, words in (("2D projector", "Step 1"), ("Energy along the ray", "Step 1: e_ts")):
        axes = window.docks[title].panel.canvas.figure.axes[0]
        assert any(words in text.get_text() for text in axes.texts)
        assert "[units]" in axes.get_xlabel()


def test_only_what_concerns_clouds_is_shown(qtbot, window, tmp_path):
    form = window.docks["Parameters"].panel
    assert form.rows["placement"].isVisibleTo(form)
    assert not form.rows["ball_k"].isVisibleTo(form)
    assert form.rows["h"].label.text().endswith("[cells]")
    window.model.open(write_cloud(tmp_path / "points.npz"))
    settle(qtbot, window.model)
    assert not form.rows["placement"].isVisibleTo(form)
    assert form.rows["ball_k"].isVisibleTo(form)
    assert form.rows["orient"].isVisibleTo(form)
    assert form.rows["h"].label.text().endswith("[units]")
    hidden = [section.title for section in form.sections if not section.isVisibleTo(form)]
    assert {"Lattice", "Model"} <= set(hidden)
    assert form.rows["neighbourhood"].combo.currentText() == "auto: ball"


def test_auto_shows_a_cloud_its_length_in_spacings_and_the_slider_takes_it(qtbot, window, tmp_path):
    model, form = window.model, window.docks["Parameters"].panel
    model.open(write_cloud(tmp_path / "points.npz"))
    settle(qtbot, model)
    row = form.rows["h"]
    assert row.box.text().endswith("s")
    assert float(row.box.text()[:-1]) == pytest.approx(model.known.values.h / model.known.spacing, rel=1e-3)
    row.slider.setValue(row.slider.value() + 4)
    assert model.settings.h.unit == "s"
    assert model.settings.h.value == pytest.approx(model.known.values.h / model.known.spacing + 0.2, abs=0.03)
    settle(qtbot, model)
    assert model.hits.settings.h == model.settings.h


def test_the_step_of_march_is_shown_and_taken_in_the_unit_of_its_label(qtbot, window):
    model, form = window.model, window.docks["Parameters"].panel
    model.open("bumpy")
    settle(qtbot, model)
    row = form.rows["step"]
    choose(form.rows["search"].combo, "march")
    settle(qtbot, model)
    before = model.hits.evaluations
    assert row.label.text() == "Step [h]"
    assert row.box.text() == "0.25"
    choose(row.word, "value")
    assert model.settings.step == 0.25
    settle(qtbot, model)
    assert (model.hits.evaluations == before).all()


def test_settings_that_do_not_suit_a_cloud_are_put_back_and_named(qtbot, standard, tmp_path):
    standard.set_settings(standard.settings.replace(neighbourhood="cell_knn", h=1.2, degree=3, raster=8))
    lines = said(standard)
    standard.open(write_cloud(tmp_path / "points.npz"))
    settle(qtbot, standard)
    assert standard.settings == preset("best").replace(degree=3)
    told = next(line for line in lines if line.startswith("Put back"))
    for part in ("neighbourhood = auto", "h = auto", "raster = file"):
        assert part in told
    assert "degree" not in told
    assert standard.fault is None
    assert standard.hits.hit.any()


def test_a_length_in_spacings_suits_any_scene(qtbot, standard, tmp_path):
    standard.set_value("h", "1.5s")
    standard.open(write_cloud(tmp_path / "points.npz"))
    settle(qtbot, standard)
    assert str(standard.settings.h) == "1.5s"


def test_a_preset_of_lattices_is_suited_to_a_cloud(qtbot, window, tmp_path):
    model, form = window.model, window.docks["Parameters"].panel
    model.open(write_cloud(tmp_path / "points.npz"))
    settle(qtbot, model)
    for name in ("thesis", "adamson-alexa"):
        choose(form.presets, name)
        settle(qtbot, model)
        assert model.fault is None
        assert model.settings.search == "iterate"
        assert model.hits.settings == model.settings
        assert model.hits.hit.any()


def resets(form):
    """The rows that offer a way back to the preset's value."""
    return [name for name, row in form.rows.items() if row.isVisibleTo(form) and row.reset.isVisibleTo(row)]


def test_a_preset_goes_from_scene_to_scene_as_it_suits_each(qtbot, window):
    model, form = window.model, window.docks["Parameters"].panel
    choose(form.presets, "thesis")
    settle(qtbot, model)
    assert model.settings == preset("thesis")
    model.open("bumpy")
    settle(qtbot, model)
    assert model.settings.max_off_centre == model.settings.h == "auto"
    assert form.presets.currentText() == "thesis"
    assert resets(form) == []
    choose(form.rows["max_off_centre"].word, "none")
    assert resets(form) == ["max_off_centre"]
    QTest.mouseClick(form.rows["max_off_centre"].reset, LEFT)
    assert model.settings.max_off_centre == "auto"
    settle(qtbot, model)
    model.open("standard")
    settle(qtbot, model)
    assert model.settings == preset("thesis")
    assert resets(form) == []


def test_a_preset_of_the_command_line_is_the_one_that_values_go_back_to(qtbot):
    seen = []

    def look():
        for window in QApplication.topLevelWidgets():
            if isinstance(window, MainWindow) and window.isVisible() and window.model.complete and not seen:
                form = window.docks["Parameters"].panel
                seen.extend([form.presets.currentText(), resets(form)])
                window.close()

    timer = QTimer(interval=50)
    timer.timeout.connect(look)
    timer.start()
    assert cli.gui("splash", pick=None, screenshot=None, frame=None, camera=None, preset="thesis",
                   set_=["tolerance=0.2"]) == 0
    assert seen == ["own values", ["tolerance"]]


def test_the_newest_of_two_scenes_is_shown(qtbot, cloudy):
    cloudy.open("standard")
    settle(qtbot, cloudy)
    assert cloudy.kind == "model"
    assert cloudy.bounds == ((0.0, 0.0, 0.0), (16.0, 16.0, 16.0))
    assert cloudy.hits.hit.any()


def test_a_late_picture_says_that_its_points_are_prepared(qtbot, cloudy):
    lines = said(cloudy)
    cloudy._slow.setInterval(0)
    cloudy.set_value("ball_k", 7)
    settle(qtbot, cloudy)
    assert any("Preparing" in line and "points" in line for line in lines)


def test_a_preset_chosen_twice_or_in_the_middle_of_a_picture_ends_in_a_full_one(qtbot, cloudy):
    cloudy.set_camera(view(cloudy.bounds, "Top"))
    cloudy.choose_preset("best")
    settle(qtbot, cloudy)
    assert cloudy.complete
    assert cloudy.hits.camera == cloudy.camera
    assert cloudy.settings == preset("best")
