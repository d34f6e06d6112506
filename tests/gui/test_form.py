"""The form: every control writes what it shows, shows what the model holds, and refuses in words."""

from __future__ import annotations

import pytest
from patience import PATIENCE, choose, settle
from qtpy.QtCore import Qt
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QToolButton

from jaart.core.parameter import Length
from jaart.core.settings import PARAMETERS, PRESETS, preset
from jaart.gui.form import ChoiceRow, FlagRow, NumberRow, VectorRow, VectorsRow
from jaart.gui.model import SceneModel
from jaart.gui.parameters import OWN, Parameters
from jaart.gui.values import slider_span


@pytest.fixture
def form(qtbot, model: SceneModel):
    form = Parameters(model)
    qtbot.addWidget(form)
    form.resize(300, 900)
    form.show()
    qtbot.waitExposed(form)
    return form


def type_into(box, text):
    box.setFocus()
    box.lineEdit().selectAll()
    QTest.keyClicks(box.lineEdit(), text)
    QTest.keyClick(box.lineEdit(), Qt.Key.Key_Return)


def test_every_parameter_with_a_choice_has_a_row_and_no_other(form):
    fixed = {p.name for p in PARAMETERS.values() if p.kind == "choice" and len(p.choices) == 1}
    assert set(form.rows) == set(PARAMETERS) - fixed


@pytest.mark.parametrize(("name", "kind"), [("h", NumberRow), ("bail", ChoiceRow), ("light", VectorsRow),
                                            ("orient", VectorRow), ("shadows", FlagRow), ("max_angle", NumberRow),
                                            ("max_iterations", NumberRow)])
def test_kinds_have_their_controls(form, name, kind):
    assert type(form.rows[name]) is kind


def test_a_typed_value_is_taken(form, model):
    type_into(form.rows["h"].box, "1.25")
    assert model.settings.h == Length(1.25)


def test_a_typed_unit_is_kept(form, model):
    type_into(form.rows["h"].box, "0.01d")
    assert model.settings.h == Length(0.01, "d")
    assert form.rows["h"].box.text() == "0.01d"


@pytest.mark.parametrize("text", ["-1", "0", "wide", "nan", "inf", "1e9", ""])
def test_a_bad_value_is_refused_beside_its_control(form, model, text):
    model.set_value("h", 0.8)
    before, row = model.settings, form.rows["h"]
    row.box.lineEdit().selectAll()
    QTest.keyClick(row.box.lineEdit(), Qt.Key.Key_Delete)
    type_into(row.box, text)
    assert model.settings == before
    assert row.fault.isVisible()
    assert row.fault.text().startswith("h = ")
    type_into(row.box, "0.9")
    assert not row.fault.isVisible()
    assert model.settings.h == Length(0.9)


def test_a_slider_writes_and_follows(form, model):
    model.set_value("h", 0.8)
    row = form.rows["h"]
    row.slider.setValue(row.slider.value() + 4)
    assert model.settings.h == Length(1.0)
    assert row.box.text() == "1"
    model.set_value("h", 0.5)
    assert row.slider.value() == round((0.5 - row.low) / 0.05)


def test_a_slider_writes_once_and_hears_no_echo(form, model, qtbot):
    model.set_value("h", 0.8)
    changes = []
    model.settings_changed.connect(lambda: changes.append(model.settings.h.value))
    form.rows["h"].slider.setValue(form.rows["h"].slider.value() + 1)
    assert changes == [0.85]


def test_a_value_beyond_the_slider_is_kept_as_it_was_typed(form, model):
    type_into(form.rows["h"].box, "123.456")
    assert model.settings.h == Length(123.456)
    assert form.rows["h"].box.text() == "123.456"


def test_arrow_keys_step_a_number_within_its_bounds(form, model):
    box = form.rows["max_iterations"].box
    QTest.keyClick(box, Qt.Key.Key_Up)
    assert model.settings.max_iterations == 21
    model.set_value("max_iterations", 1)
    QTest.keyClick(box, Qt.Key.Key_Down)
    assert model.settings.max_iterations == 1


def test_a_word_stands_in_a_list_with_what_it_means(form, model, standard):
    row = form.rows["trust"]
    assert row.word.currentText() == "radius"
    assert row.box.text() == "2.5"
    choose(row.word, "value")
    assert model.settings.trust == Length(2.5)
    choose(row.word, "radius")
    assert model.settings.trust == "radius"


@pytest.mark.parametrize("word", ["auto", "none"])
def test_each_of_several_words_can_be_chosen(form, model, word):
    type_into(form.rows["max_off_centre"].box, "0.4")
    assert form.rows["max_off_centre"].word.currentText() == "value"
    choose(form.rows["max_off_centre"].word, word)
    assert model.settings.max_off_centre == word


def test_a_word_that_is_no_value_leaves_the_box_empty_until_one_is_chosen(form, model):
    row = form.rows["max_angle"]
    assert row.box.text() == ""
    assert not row.slider.isVisibleTo(form)
    choose(row.word, "value")
    assert model.settings.max_angle == 0.5
    assert row.slider.isVisibleTo(form)


def test_typing_or_dragging_takes_the_place_of_a_word(form, model, standard):
    row = form.rows["trust"]
    type_into(row.box, "3")
    assert model.settings.trust == Length(3.0)
    assert row.word.currentText() == "value"
    choose(row.word, "radius")
    row.slider.setValue(row.slider.value() + 1)
    assert model.settings.trust == Length(2.75)


def test_a_list_says_what_auto_stands_for(qtbot, form, model, standard):
    assert form.rows["normal"].combo.currentText() == "auto: surfel"
    assert form.rows["normal"].combo.currentData() == "auto"


@pytest.mark.parametrize(("name", "others", "auto"), [
    ("search", ("secant", "march", "iterate"), "auto: iterate"), ("normal", ("covariance",), "auto: surfel"),
    ("neighbourhood", ("ball", "knn"), "auto: cell_ball")])
def test_a_list_says_what_auto_would_come_to_whatever_is_chosen(qtbot, form, model, standard, name, others, auto):
    combo = form.rows[name].combo
    for other in others:
        choose(combo, other)
        settle(qtbot, model)
        assert combo.itemText(combo.findData("auto")) == auto
    choose(combo, auto)
    settle(qtbot, model)
    assert getattr(model.known.values, name) == auto.removeprefix("auto: ")


def test_auto_of_the_search_follows_the_method(qtbot, form, model, standard):
    choose(form.rows["method"].combo, "off_centre")
    combo = form.rows["search"].combo
    qtbot.waitUntil(lambda: combo.itemText(combo.findData("auto")) == "auto: minimise", timeout=PATIENCE)


@pytest.mark.parametrize(("search", "shown"), [("secant", "1"), ("march", "0.2")])
def test_the_step_on_auto_is_that_of_whatever_steps(qtbot, form, model, standard, search, shown):
    choose(form.rows["traversal"].combo, "uniform")
    choose(form.rows["search"].combo, search)
    qtbot.waitUntil(lambda: form.rows["step"].box.text() == shown, timeout=PATIENCE)
    assert form.rows["step"].label.text() == "Step [cells]"


def test_the_chosen_preset_stays_chosen(form, model):
    assert form.presets.currentText() == "best"
    model.set_value("h", 1.0)
    assert form.presets.currentText() not in PRESETS
    form.rows["h"].reset.click()
    assert form.presets.currentText() == "best"


def test_a_word_follows_what_it_stands_for(qtbot, form, model, standard):
    model.set_value("radius", 3.0)
    settle(qtbot, model)
    assert form.rows["trust"].box.text() == "3"


def test_a_vector_is_typed_in_three_boxes(form, model):
    model.set_value("orient", (0.0, 0.0, 0.0))
    row = form.rows["orient"]
    for box, text in zip(row.boxes, ("1", "2.5", "-3"), strict=True):
        type_into(box, text)
    assert model.settings.orient == (1.0, 2.5, -3.0)
    type_into(row.boxes[1], "up")
    assert row.fault.text().startswith("orient = ")
    assert model.settings.orient == (1.0, 2.5, -3.0)


def test_lights_are_typed_added_and_taken_away(form, model):
    row = form.rows["light"]
    choose(row.word, "x, y, z")
    assert model.settings.light == ((0.0, 0.0, 0.0),)
    type_into(row.lines[0].boxes[2], "9")
    row.add.click()
    type_into(row.lines[1].boxes[0], "-4.5")
    assert model.settings.light == ((0.0, 0.0, 9.0), (-4.5, 0.0, 9.0))
    type_into(row.lines[1].boxes[1], "east")
    assert row.fault.isVisible()
    row.lines[0].findChild(QToolButton).click()
    assert model.settings.light == ((-4.5, 0.0, 9.0),)
    assert not row.fault.isVisible()
    row.lines[0].findChild(QToolButton).click()
    assert model.settings.light == "headlight"


def test_flags_are_ticked(form, model):
    model.set_value("light", (1.0, 2.0, 3.0))
    assert form.rows["shadows"].isVisibleTo(form)
    form.rows["shadows"].check.click()
    assert model.settings.shadows is True


def test_a_choice_writes_what_is_chosen(form, model, qtbot):
    choose(form.rows["bail"].combo, "growth")
    assert model.settings.bail == "growth"


def test_what_does_not_matter_is_hidden(form, model):
    assert form.rows["specular"].isVisibleTo(form)
    model.set_value("shading", "diffuse")
    assert not form.rows["specular"].isVisibleTo(form)


def test_a_group_without_a_row_to_show_is_hidden(form, model):
    group = next(s for s in form.sections if s.title == "Boundary")
    assert group.isVisibleTo(form)
    model.set_value("method", "fill_level")
    assert not group.isVisibleTo(form)


def test_the_model_group_is_shown_for_models_only(form, model, standard):
    group = next(s for s in form.sections if s.title == "Model")
    assert group.isVisibleTo(form)
    assert form.rows["raster"].box.text() == "16"


def test_without_a_model_its_group_is_hidden(form):
    assert not next(s for s in form.sections if s.title == "Model").isVisibleTo(form)


def test_reset_goes_back_to_the_default(form, model):
    row = form.rows["tolerance"]
    assert not row.reset.isVisible()
    type_into(row.box, "0.2")
    assert row.reset.isVisible()
    row.reset.click()
    assert model.settings.tolerance == preset("best").tolerance
    assert not row.reset.isVisible()


def test_a_preset_sets_all_values(form, model):
    type_into(form.rows["h"].box, "1.1")
    assert form.presets.currentText() == OWN
    for name in ("thesis", "adamson-alexa", "best"):
        choose(form.presets, name)
        assert model.settings == preset(name)
        assert form.presets.currentText() == name


def test_a_section_folds(form):
    section = form.sections[0]
    section.heading.click()
    assert not section.body.isVisible()
    section.heading.click()
    assert section.body.isVisible()


def test_tips_say_what_may_be_typed_and_where_it_comes_from(form):
    tip = form.rows["h"].toolTip()
    for part in ("Width of the weight", "[T 2.7]", "Unit: cells", "d (diagonals)", "--set h=auto"):
        assert part in tip


@pytest.mark.parametrize("about", [p for p in PARAMETERS.values() if p.kind in ("number", "integer", "length")],
                         ids=lambda p: p.name)
def test_every_place_of_a_slider_is_a_value(about):
    low, steps = slider_span(about)
    assert steps >= 4
    for at in (0, 1, steps):
        about.check(round(low + at * about.step, 9))
