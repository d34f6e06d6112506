"""A window with a scene in it; closed, joined and forgotten after each test."""

from __future__ import annotations

import os

os.environ.setdefault("QT_API", "pyside6")

import pytest
from patience import PATIENCE, settle
from qtpy.QtCore import QCoreApplication, QEvent

from jaart.gui.main_window import MainWindow
from jaart.gui.model import SceneModel


@pytest.fixture
def model(qtbot):
    """A scene model without a scene."""
    model = SceneModel()
    yield model
    model.close()
    forget(model)


@pytest.fixture
def standard(qtbot, model):
    """A scene model with the standard scene in a small picture."""
    model.set_size(96, 96)
    model.open("standard")
    settle(qtbot, model)
    assert model.complete
    return model


@pytest.fixture
def bare(qtbot):
    """The window without a scene."""
    window = MainWindow()
    window.model.set_size(192, 192)
    window.show()
    qtbot.waitExposed(window)
    yield window
    window.close()
    forget(window)


@pytest.fixture
def window(qtbot, bare):
    """The window with the standard scene, all panels built."""
    bare.model.open("standard")
    qtbot.waitUntil(lambda: bare.model.idle and bare.panels_ready, timeout=PATIENCE)
    return bare


def forget(thing):
    """Delete a Qt object now, not at some later turn of the event loop."""
    thing.deleteLater()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QCoreApplication.processEvents()
