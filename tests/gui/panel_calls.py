"""What a person does to a panel, and waits for."""

from __future__ import annotations

import numpy as np
from patience import settle
from qtpy.QtCore import Qt

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
