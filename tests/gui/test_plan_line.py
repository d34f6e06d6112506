"""The plan in the status bar and the whole list that a click opens."""

from __future__ import annotations

from patience import PATIENCE, settle
from qtpy.QtCore import Qt

import jaart
from jaart.gui.plan import PlanLine, line


def rested(qtbot, window, ready=lambda plan: True):
    """The line once it shows the plan of the window's settings."""
    (shown,) = window.statusBar().findChildren(PlanLine)
    model = window.model
    qtbot.waitUntil(lambda: model.idle and shown.plan is not None and shown.plan.settings == model.settings
                    and ready(shown.plan), timeout=PATIENCE)
    return shown


def rows(tree):
    """Group titles, and the stages or values in each."""
    groups = [tree.topLevelItem(i) for i in range(tree.topLevelItemCount())]
    return {g.text(0).partition(" ")[0]: [[g.child(i).text(c) for c in range(3)] for i in range(g.childCount())]
            for g in groups}


def test_a_click_opens_all_of_the_plan(window, qtbot):
    shown = rested(qtbot, window)
    model = window.model
    expected = jaart.plan(model.scene, model.settings, model.camera, model.size)
    assert shown.plan == expected and shown.isVisible()
    assert shown.text() == line(expected, model.hits)
    assert shown.text().startswith("polynomial, ") and "near, no eigenvectors; " in shown.text()
    assert shown.text().endswith(f"{len(expected.left_out)} left out")
    qtbot.mouseClick(shown, Qt.MouseButton.LeftButton)
    assert shown.dialog.isVisible() and not shown.dialog.isModal()
    listed = rows(shown.dialog.list)
    assert [row[:2] for row in listed["Runs"]] == [[s.name, s.reason] for s in expected.runs]
    assert [row[:2] for row in listed["Left"]] == [[s.name, s.reason] for s in expected.left_out]
    assert ["filter", "none is asked for", "filter = none"] in listed["Left"]
    assert [row[0] for row in listed["Values"]] == [v.name for v in expected.values]


def test_the_list_follows_settings_also_those_that_trace_nothing_anew(window, qtbot):
    shown = rested(qtbot, window)
    shown.click()
    window.model.set_value("filter", "median")
    rested(qtbot, window)
    assert any(row[0] == "filter" for row in rows(shown.dialog.list)["Runs"])
    window.model.set_value("samples", 2)
    rested(qtbot, window)
    assert any(row[0] == "more samples" for row in rows(shown.dialog.list)["Runs"])
    window.model.set_value("normal", "covariance")
    rested(qtbot, window)
    assert f"{window.model.hits.eigenvectors.sum()} eigenvectors" in shown.text()


def test_refused_settings_have_no_plan(window, qtbot):
    shown = rested(qtbot, window)
    model = window.model
    model.open("bumpy")
    qtbot.waitUntil(lambda: model.scene.kind == "cloud", timeout=PATIENCE)
    settle(qtbot, model)
    rested(qtbot, window, lambda plan: plan.kind == "cloud")
    told = []
    model.failed.connect(told.append)
    model.set_value("h", "1e-300d")
    qtbot.waitUntil(lambda: model.fault is not None and shown.plan is None, timeout=PATIENCE)
    settle(qtbot, model)
    assert not shown.isVisible() and len(told) == 1
    model.set_value("h", "auto")
    assert rested(qtbot, window).isVisible()
