"""Waiting for the window's worker."""

from __future__ import annotations

#: Longest wait for a picture or a panel, the first compilation of all kernels included [ms].
PATIENCE = 60_000


def settle(qtbot, model):
    """Wait until everything that was asked for is done."""
    qtbot.waitUntil(lambda: model.idle, timeout=PATIENCE)
