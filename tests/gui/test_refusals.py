"""Settings that make no sense together: said once, marked in the form, and nothing else is lost."""

from __future__ import annotations

import pytest
from patience import choose, settle
from qtpy.QtCore import Qt
from qtpy.QtTest import QTest

from jaart.core.settings import PARAMETERS
from jaart.gui.suit import refused_name


@pytest.fixture
def form(window):
    return window.docks["Parameters"].panel


def test_a_refused_combination_keeps_the_picture_and_marks_its_row(qtbot, window, form):
    model, failures = window.model, []
    model.failed.connect(failures.append)
    hits, image = model.hits.t, window.view.image.copy()
    choose(form.rows["search"].combo, "newton")
    settle(qtbot, model)
    hits = model.hits.t
    choose(form.rows["method"].combo, "mahalanobis")
    settle(qtbot, model)
    assert model.hits.t is hits
    assert not window.view.image.isNull()
    assert image.size() == window.view.image.size()
    assert len(failures) == 1
    assert failures[0].startswith("search = newton: ")
    assert window.message.isVisible()
    assert window.message.text.text() == failures[0]
    assert form.rows["search"].fault.isVisible()
    assert form.rows["search"].fault.text() == failures[0]


def test_the_other_setting_can_then_be_changed(qtbot, window, form):
    model = window.model
    choose(form.rows["method"].combo, "mahalanobis")
    settle(qtbot, model)
    assert model.fault[0] == "search"
    choose(form.rows["search"].combo, "minimise")
    settle(qtbot, model)
    assert model.fault is None
    assert model.hits.settings == model.settings
    assert model.settings.method == "mahalanobis"
    assert not form.rows["search"].fault.isVisible()
    assert not window.message.isVisible()


def test_going_back_ends_the_fault_and_makes_the_picture_again(qtbot, window, form):
    model = window.model
    choose(form.rows["method"].combo, "angle")
    settle(qtbot, model)
    assert model.fault is not None
    form.rows["method"].reset.click()
    settle(qtbot, model)
    assert model.fault is None
    assert model.complete
    assert model.hits.settings == model.settings


def test_a_refused_setting_is_shown_even_where_it_has_no_other_meaning(qtbot, window, form):
    model = window.model
    for name, value in (("method", "tangent"), ("search", "minimise")):
        choose(form.rows[name].combo, value)
    form.rows["emphasise"].check.click()
    settle(qtbot, model)
    assert model.fault is None
    choose(form.rows["search"].combo, "iterate")
    settle(qtbot, model)
    assert model.fault[0] == "emphasise"
    assert form.rows["emphasise"].isVisibleTo(form)
    form.rows["emphasise"].check.click()
    settle(qtbot, model)
    assert model.fault is None
    assert not form.rows["emphasise"].isVisibleTo(form)


def test_a_pick_beside_a_fault_does_not_say_it_again(qtbot, window, form):
    model = window.model
    choose(form.rows["method"].combo, "angle")
    settle(qtbot, model)
    failures = []
    model.failed.connect(failures.append)
    QTest.mouseClick(window.view, Qt.MouseButton.LeftButton, pos=window.view.rect().center())
    settle(qtbot, model)
    assert not failures


@pytest.mark.parametrize(("message", "name"), [
    ("search = newton: a least energy", "search"), ("h: points has no two points apart", "h"),
    ("nothing of the kind", ""), ("", "")])
def test_the_refused_setting_is_read_from_the_message(message, name):
    assert refused_name(message) == name
    assert name == "" or name in PARAMETERS
