"""Waiting for the window's worker, and what else the tests of the window share."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import Qt
from qtpy.QtTest import QTest

from jaart.core.samples import bumpy_sphere

#: Longest wait for a picture or a panel, the first compilation of all kernels included [ms].
PATIENCE = 60_000


def settle(qtbot, model):
    """Wait until everything that was asked for is done."""
    qtbot.waitUntil(lambda: model.idle, timeout=PATIENCE)


def write_cloud(path, count=4000, scale=0.1, shift=(3.0, -2.0, 1.0)):
    """A small file of bare points around a place that is not the origin: a bumpy sphere of radius `scale`."""
    points = bumpy_sphere(count).points
    np.savez(path, points=scale * points + shift)
    return path


def said(model):
    """The list that everything the model says goes into."""
    lines = []
    model.said.connect(lines.append)
    return lines


def choose(combo, text):
    """Choose an entry of a list by its keys, as a person does."""
    combo.setFocus()
    QTest.keyClick(combo, Qt.Key.Key_Home)
    for _ in range(combo.findText(text)):
        QTest.keyClick(combo, Qt.Key.Key_Down)
    assert combo.currentText() == text
