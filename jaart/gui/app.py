"""Starting the window, or taking a picture of it."""

from __future__ import annotations

import logging
import signal
import sys
from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from jaart.core.camera import Camera
from jaart.core.errors import JaartError
from jaart.core.settings import PRESETS, Settings, preset
from jaart.gui.libraries import check

if TYPE_CHECKING:
    from qtpy.QtCore import QProcess, Qt

    from jaart.gui.main_window import MainWindow

#: What is opened when nothing is named.
SAMPLE = "splash"
#: The preset when nobody says.
FIRST = next(iter(PRESETS))


def run(source: str | PathLike[str] | None = None, settings: Settings | None = None, camera: Camera | None = None,
        pick: tuple[int, int] | None = None, screenshot: str | PathLike[str] | None = None,
        frame: int | None = None, notes: Sequence[str] = (), base: str = FIRST) -> int:
    """Open the window and return the exit status when it closes.

    source: a file or a built-in name, the sample when None; settings: those of the preset `base` when None;
    pick: pixel (x, y) of the picture; screenshot: save the window there once everything is drawn, and end;
    notes: what to say beforehand, a line each. Raises JaartError without a display or a system library, for a scene
    that cannot be read, and, with screenshot, for any failure.
    """
    check()
    logging.basicConfig(format="%(name)s: %(message)s")
    sys.setswitchinterval(0.001)
    from qtpy.QtWidgets import QApplication

    from jaart.gui.main_window import MainWindow
    from jaart.gui.model import PICTURE

    _check_pick(pick, PICTURE)
    app = QApplication.instance() or QApplication(["jaart"])
    app.setApplicationName("Jaart")
    window = MainWindow()
    window.model.set_settings(preset(base))
    window.model.set_settings(settings or preset(base))
    problems: list[str] = []
    end_without_a_scene(window, problems)
    if screenshot is not None:
        _end_when_taken(window, Path(screenshot), pick is not None, problems)
    if pick is not None:
        window.model.scene_changed.connect(lambda: window.model.pick(*pick), _once())

    def begin() -> None:
        for note in notes:
            window.model.said.emit(note)
        window.model.open(source or SAMPLE, frame, camera)

    _show_until_closed(window, begin, compiling=screenshot is None)
    if problems:
        raise JaartError(problems[0])
    return 0


def _show_until_closed(window: MainWindow, begin: Callable[[], None], compiling: bool) -> None:
    """Show the window, begin its work and return when it closes; compiling: kernels are compiled beside it."""
    from qtpy.QtCore import QEventLoop

    from jaart.gui import garbage
    from jaart.gui.compiling import compile_beside, end

    loop = QEventLoop()
    beside: list[QProcess | None] = []
    window.closed.connect(loop.quit)
    window.loader.finished.connect(garbage.set_aside)
    if compiling:
        window.loader.finished.connect(lambda: beside.append(compile_beside(window)), _once())
    interrupt = signal.signal(signal.SIGINT, signal.SIG_DFL)  # Qt's loop would not let Python answer Ctrl-C
    window.show()
    begin()
    loop.exec()
    for process in beside:
        end(process)
    signal.signal(signal.SIGINT, interrupt)


def _end_when_taken(window: MainWindow, path: Path, picked: bool, problems: list[str]) -> None:
    """Save the window once everything in it is drawn, then close it; at once where anything fails, with the reason."""
    from jaart.gui.screenshot import Screenshot

    window.model.failed.connect(problems.append)
    window.model.failed.connect(window.close)
    Screenshot(window, path, picked).taken.connect(window.close)


def _check_pick(pick: tuple[int, int] | None, size: tuple[int, int]) -> None:
    if pick is not None and not (0 <= pick[0] < size[0] and 0 <= pick[1] < size[1]):
        raise JaartError(f"--pick {pick[0]},{pick[1]}: expected a pixel of the picture, "
                         f"0,0 to {size[0] - 1},{size[1] - 1}")


def end_without_a_scene(window: MainWindow, problems: list[str]) -> None:
    """Close the window when its first scene cannot be read, and keep the reason."""
    def failed(message: str) -> None:
        if window.model.scene is None:
            problems.append(message)
            window.close()

    window.model.failed.connect(failed)


def _once() -> Qt.ConnectionType:
    from qtpy.QtCore import Qt

    return Qt.ConnectionType.SingleShotConnection
