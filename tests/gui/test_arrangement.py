"""Docks stand side by side in a large window and as tabs in a small one, until somebody moves one."""

from __future__ import annotations

import pytest
from patience import PATIENCE
from qtpy.QtCore import QPoint, Qt
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QTabBar

from jaart.gui.arrangement import TABS, WIDTHS


def resized(qtbot, window, width, height):
    window.resize(width, height)
    qtbot.waitUntil(lambda: (window.width(), window.height()) == (width, height), timeout=PATIENCE)
    qtbot.wait(50)


def behind(window, title):
    """The titles of the docks that share their place with one, as the keys of the window's docks."""
    names = {id(dock): name for name, dock in window.docks.items()}
    return sorted(names[id(dock)] for dock in window.tabifiedDockWidgets(window.docks[title]))


def test_a_small_window_gives_the_picture_room(qtbot, window):
    resized(qtbot, window, 1000, 700)
    for front, others in TABS.items():
        assert behind(window, front) == sorted(others)
    assert window.view.width() >= 1000 - sum(WIDTHS[True]) - 20
    assert window.view.height() > 500
    resized(qtbot, window, 1500, 950)
    assert behind(window, "3D ray analyzer") == behind(window, "Parameters") == []
    assert behind(window, "Statistics") == ["Messages"]
    assert window.docks["2D projector"].y() > window.docks["3D ray analyzer"].y()
    assert window.docks["Statistics"].y() > window.view.mapTo(window, QPoint(0, 0)).y()


def test_a_click_on_a_tab_shows_its_panel(qtbot, window):
    resized(qtbot, window, 1000, 700)
    panel = window.docks["2D projector"].panel
    assert not panel.isVisible()
    bar = next(bar for bar in window.findChildren(QTabBar) if bar.isVisible() and bar.tabText(1) == "2D projector")
    QTest.mouseClick(bar, Qt.MouseButton.LeftButton, pos=bar.tabRect(1).center())
    qtbot.waitUntil(panel.isVisible, timeout=PATIENCE)


@pytest.mark.parametrize("title", ["2D projector", "Statistics"])
def test_docks_that_were_moved_stay_where_they_were_put(qtbot, window, title):
    resized(qtbot, window, 1500, 950)
    window.docks[title].setFloating(True)
    resized(qtbot, window, 1000, 700)
    assert window.docks[title].isFloating()
    assert behind(window, "Parameters") == []
