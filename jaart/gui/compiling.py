"""Compiles the kernels of options that nobody has chosen yet, beside the window and at low priority.

A kernel is compiled when it is first needed, which takes seconds, once on a machine. So the first window on a
machine has all of them compiled by a process of its own, and no option has to wait.
"""

from __future__ import annotations

import sys

from qtpy.QtCore import QObject, QProcess

from jaart.core import compile_all


def compile_beside(parent: QObject) -> QProcess | None:
    """Start that process, which ends with its parent; None when there is nothing to compile."""
    if not compile_all.missing():
        return None
    process = QProcess(parent)
    process.start(sys.executable, ["-m", compile_all.__name__])
    return process


def end(process: QProcess | None) -> None:
    """End the process: what it has compiled is kept, the rest waits for the next window."""
    if process is not None and process.state() != QProcess.ProcessState.NotRunning:
        process.kill()
        process.waitForFinished(2000)
