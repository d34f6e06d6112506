"""What the window's model tells those who listen to it."""

from __future__ import annotations

from qtpy.QtCore import Signal

from jaart.gui.look import Look


class Signals(Look):
    """The signals of the model; what each of them is about stands in its name."""

    scene_changed = Signal()
    settings_changed = Signal()
    camera_changed = Signal()
    hits_changed = Signal()
    picked_changed = Signal()
    trace_changed = Signal()
    step_changed = Signal()
    progressed = Signal(float)
    staged = Signal(str, float)
    begun = Signal()
    settled = Signal()
    failed = Signal(str)
    fault_changed = Signal()
    known_changed = Signal()
    said = Signal(str)
