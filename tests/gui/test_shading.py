"""Water, shadows and samples: plain at first, finished in a thread, and always of the newest picture."""

from __future__ import annotations

import numpy as np
import pytest
from patience import choose, settle

from jaart.core.picture import finish, plain
from jaart.core.shade import shade
from jaart.gui.image_view import ImageView
from jaart.gui.navigation import orbit


@pytest.fixture
def view(qtbot, standard):
    view = ImageView(standard)
    qtbot.addWidget(view)
    view.show()
    return view


def pixels(view):
    """What the view shows (h, w, 3)."""
    image = view.image
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return rows[:, :3 * image.width()].reshape(image.height(), image.width(), 3).copy()


@pytest.mark.parametrize("values", [{"shading": "water"}, {"samples": 3}, {"light": "9,-30,40", "shadows": True}],
                         ids=["water", "samples", "shadows"])
def test_the_finished_picture_takes_the_place_of_the_plain_one(qtbot, standard, view, values):
    standard.set_settings(standard.settings.replace(**values))
    settle(qtbot, standard)
    assert standard.complete
    assert (pixels(view) == finish(standard.hits, standard.scene)).all()
    assert (pixels(view) != shade(standard.hits, settings=plain(standard.settings))).any()


def test_shading_otherwise_traces_no_hit_again_and_keeps_the_last_colours(qtbot, standard, view):
    standard.set_value("shading", "water")
    settle(qtbot, standard)
    t, before = standard.hits.t, pixels(view)
    standard.set_value("ior", 1.6)
    assert (pixels(view) == before).all()
    settle(qtbot, standard)
    assert standard.hits.t is t
    assert (pixels(view) != before).any()
    assert (pixels(view) == finish(standard.hits, standard.scene)).all()
    standard.set_value("shading", "phong")
    assert standard.idle
    assert (pixels(view) == shade(standard.hits)).all()


def test_a_number_in_false_colour_needs_no_more_rays(qtbot, standard, view):
    standard.set_value("shading", "water")
    settle(qtbot, standard)
    standard.set_map("iterations")
    assert standard.idle
    assert (pixels(view) == shade(standard.hits, "iterations")).all()
    standard.set_map("shaded")
    settle(qtbot, standard)
    assert (pixels(view) == finish(standard.hits, standard.scene)).all()


def test_a_drag_is_plain_and_ends_in_the_finished_picture_of_its_end(qtbot, standard, view):
    standard.set_value("shading", "water")
    settle(qtbot, standard)
    for degrees in (4, 8):
        standard.set_camera(orbit(standard.camera, degrees, 0), dragging=True)
    qtbot.waitUntil(lambda: standard.hits.camera == standard.camera)
    standard.set_camera(standard.camera)
    settle(qtbot, standard)
    assert standard.hits.camera == standard.camera
    assert (pixels(view) == finish(standard.hits, standard.scene)).all()


def test_the_theme_reaches_the_finished_picture(qtbot, standard, view):
    standard.set_value("samples", 2)
    settle(qtbot, standard)
    standard.set_theme("dark")
    settle(qtbot, standard)
    assert (pixels(view) == finish(standard.hits, standard.scene, theme="dark")).all()


def test_water_is_chosen_in_the_form(qtbot, window):
    form, model = window.docks["Parameters"].panel, window.model
    assert not form.rows["ior"].isVisibleTo(form)
    choose(form.rows["shading"].combo, "water")
    settle(qtbot, model)
    assert form.rows["ior"].isVisibleTo(form)
    assert (pixels(window.view) == finish(model.hits, model.scene)).all()


def test_a_pick_does_not_wait_for_the_shading(qtbot, standard):
    order = []
    standard.trace_changed.connect(lambda: order.append("trace"))
    standard.shader.changed.connect(lambda: order.append("shaded"))
    standard.set_value("samples", 8)
    qtbot.waitUntil(lambda: standard.complete and not standard.shader.worker.idle)
    standard.pick(48, 48)
    settle(qtbot, standard)
    assert sorted(order) == ["shaded", "trace"]
    assert standard.trace.pixel == (48, 48)
