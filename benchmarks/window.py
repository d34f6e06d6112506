"""How quickly the window answers: start, stalls of its thread, slider to pictures, click to each panel.

Slider and click in the standard model at 64³, 512×512 pixels. Run with a display, or under xvfb-run:
python benchmarks/window.py; with the word "quick" without the starts. Prints medians over several runs, with the
spread, and the parts of each answer. "Of the window" is what the window's own thread computed, whatever else runs, "of
all threads" what the whole program did.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from collections import defaultdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

STARTS, DRAGS, CLICKS = 7, 21, 11
#: Beside "best", with which the window opens.
PRESET = "thesis"
PANELS = {"2D projector": "2D projector", "Energy along the ray": "energies"}


def main() -> None:
    starts = [0.0] if "quick" in sys.argv else [start_in_process() for _ in range(STARTS + 1)][1:]
    report("start to first paint", starts, "s", 2)
    window, stalls = opened()
    report("longest stall while panels load", [max(stalls)], "ms")
    show(window, "standard")
    for name in ("best", PRESET):
        window.model.choose_preset(name)
        settle_all(window)
        stalls.clear()
        report_parts(f"slider of h, preset {name}", [slid(window, turn) for turn in range(DRAGS)])
    report_parts("click on a pixel", [clicked(window, turn) for turn in range(CLICKS)])
    report("longest stall in use", [max(stalls)], "ms")
    window.close()


def report(name: str, values: list[float], unit: str, digits: int = 0) -> None:
    ordered = sorted(values)
    spread = f"   ({ordered[0]:.{digits}f} … {ordered[-1]:.{digits}f})" if len(values) > 1 else ""
    print(f"{name:44s} {statistics.median(values):8.{digits}f} {unit}{spread}", flush=True)


def report_parts(name: str, runs: list[dict[str, float]]) -> None:
    """A line for each part: a time since the beginning, or of the part alone where its name begins with a dash."""
    print(name)
    parts = defaultdict(list)
    for run in runs:
        for part, value in run.items():
            parts[part].append(value)
    for part, values in parts.items():
        report(f"    {part}", values, "ms", 1)


def start_in_process() -> float:
    """Seconds from the start of a process to the first paint of its window."""
    begin = time.time()
    out = subprocess.run([sys.executable, __file__, "first-paint"], capture_output=True, text=True, check=True)
    return float(out.stdout.split()[-1]) - begin


def first_paint() -> None:
    """Open the window as the program does, print the time of day of its first paint, and end."""
    from jaart.gui.libraries import check

    check()
    sys.setswitchinterval(0.001)
    from qtpy.QtWidgets import QApplication

    from jaart.gui.main_window import MainWindow

    app = QApplication(["jaart"])
    window = MainWindow()
    seen = watch_paints(app, {"view": window.view})
    window.show()
    window.model.open("splash")
    wait(lambda: "view" in seen)
    print(time.time(), flush=True)
    os._exit(0)


def opened():
    """The window with its panels, and the gaps between turns of its event loop [ms]."""
    from jaart.gui.libraries import check

    check()
    sys.setswitchinterval(0.001)
    from qtpy.QtCore import Qt, QTimer
    from qtpy.QtWidgets import QApplication

    from jaart.gui import garbage
    from jaart.gui.main_window import MainWindow

    app = QApplication(["jaart"])
    window, stalls, last = MainWindow(), [0.0], [0.0]
    window.loader.finished.connect(garbage.set_aside)
    window.show()
    window.model.open("splash")
    wait(lambda: window.model.complete)
    last[0] = time.perf_counter()

    def tick() -> None:
        now = time.perf_counter()
        stalls.append(1000 * (now - last[0]))
        last[0] = now

    app.ticker = QTimer(interval=1, timerType=Qt.TimerType.PreciseTimer)
    app.ticker.timeout.connect(tick)
    app.ticker.start()
    wait(lambda: window.panels_ready and window.model.idle)
    window.model.pick(230, 300)
    wait(lambda: window.model.idle)
    settle()
    return window, stalls


def show(window, scene: str) -> None:
    """Show a model at 64³ in 512×512 pixels, with a ray picked."""
    window.model.open(scene)
    wait(lambda: window.model.scene is not None and window.model.scene.kind == "model" and window.model.idle)
    window.model.set_settings(window.model.settings.replace(raster=64))
    wait(lambda: window.model.idle)
    window.model.pick(230, 300)
    settle_all(window)


def slid(window, turn: int) -> dict[str, float]:
    """What follows a move of the slider of h, up to the full picture."""
    from qtpy.QtWidgets import QApplication

    model, slider = window.model, window.docks["Parameters"].panel.rows["h"].slider
    clock, first = Clock(), []

    def new() -> bool:
        return model.hits.settings == model.settings

    def made() -> None:
        if new() and not first:
            first.append(model.hits)
            clock.mark("panels told of the coarse picture")

    model.hits_changed.connect(made)
    coarse = watch_paints(QApplication.instance(), {"view": window.view}, new)
    full = watch_paints(QApplication.instance(), {"view": window.view}, lambda: new() and model.complete)
    slider.setValue(slider.value() + (1 if turn % 20 < 10 else -1))
    clock.mark("panels told of the value")
    wait(lambda: "view" in full and first)
    model.hits_changed.disconnect(made)
    for seen in (coarse, full):
        seen.stop()
    clock.took["- prepared"] = 1000 * first[0].prep_s
    clock.took["- coarse rays"] = 1000 * first[0].ray_s
    clock.mark("coarse picture painted", coarse["view"])
    clock.took["- all rays"] = 1000 * model.hits.ray_s
    clock.mark("full picture painted", full["view"])
    clock.end()
    settle_all(window)
    return clock.took


def clicked(window, turn: int) -> dict[str, float]:
    """What follows a click on a pixel, up to the paint of the last of the ray's panels."""
    from pyvistaqt import QtInteractor
    from qtpy.QtCore import Qt
    from qtpy.QtTest import QTest
    from qtpy.QtWidgets import QApplication

    model, before, begun = window.model, window.model.trace, []
    seen = watch_paints(QApplication.instance(), {name: window.docks[title] for title, name in PANELS.items()},
                        lambda: model.trace is not before)
    space = window.docks["3D ray analyzer"].panel.findChild(QtInteractor).render_window
    observers = [space.AddObserver("StartEvent", lambda *_: begun.append(time.perf_counter())),
                 space.AddObserver("EndEvent", lambda *_: model.trace is not before and
                                   seen.setdefault("3D analyzer", time.perf_counter()))]
    met = model.hits.hit.nonzero()[0]
    pixel = int(met[(2 * turn + 1) * len(met) // (2 * CLICKS)])
    place = window.view.place_of((pixel % model.size[0], pixel // model.size[0])).toPoint()
    clock, traced = Clock(), []
    heard = model.trace_changed.connect(lambda: traced.append(time.perf_counter()))
    QTest.mouseClick(window.view, Qt.MouseButton.LeftButton, pos=place)
    wait(lambda: len(seen) == len(PANELS) + 1)
    model.trace_changed.disconnect(heard)
    clock.mark("ray traced", traced[0])
    space_begun = max(at for at in begun if at < seen["3D analyzer"])
    clock.took["- rendering in space"] = 1000 * (seen["3D analyzer"] - space_begun)
    for name, when in sorted(seen.items(), key=lambda item: item[1]):
        clock.mark(f"{name} painted", when)
    clock.mark("last panel painted", max(seen.values()))
    clock.end()
    seen.stop()
    for observer in observers:
        space.RemoveObserver(observer)
    settle_all(window)
    return clock.took


class Clock:
    """Milliseconds since it was made, by name."""

    def __init__(self) -> None:
        self.begin, self.thread, self.all, self.took = time.perf_counter(), time.thread_time(), time.process_time(), {}

    def mark(self, name: str, when: float | None = None) -> None:
        """Note a time, now when None."""
        self.took[name] = 1000 * ((time.perf_counter() if when is None else when) - self.begin)

    def end(self) -> None:
        """Note what the window's own thread computed, and all threads together: as much on a busy machine."""
        self.took["- of the window"] = 1000 * (time.thread_time() - self.thread)
        self.took["- of all threads"] = 1000 * (time.process_time() - self.all)


def watch_paints(app, widgets, ready=lambda: True):
    """A dict that gets the time of the first paint of each widget, or of one inside it, once ready."""
    from qtpy.QtCore import QEvent, QObject

    class Watch(QObject):
        def eventFilter(self, watched, event):
            if event.type() == QEvent.Type.Paint and ready():
                for name, widget in widgets.items():
                    if name not in seen and (watched is widget or (
                            watched.isWidgetType() and widget.isAncestorOf(watched))):
                        seen[name] = time.perf_counter()
            return False

    class Seen(dict):
        def stop(self) -> None:
            app.removeEventFilter(self.watch)

    seen = Seen()
    seen.watch = Watch()
    app.installEventFilter(seen.watch)
    return seen


def wait(done, patience: float = 60.0) -> None:
    """Run the event loop until something is done."""
    from qtpy.QtCore import QEventLoop, QTimer

    loop, timer, end = QEventLoop(), QTimer(interval=1), time.perf_counter() + patience
    timer.timeout.connect(lambda: loop.exit(0) if done() else loop.exit(1) if time.perf_counter() > end else None)
    timer.start()
    if loop.exec():
        raise TimeoutError(f"nothing was painted in {patience:g} s")


def settle_all(window) -> None:
    """Let everything be computed and painted, statistics last."""
    wait(lambda: window.model.idle)
    settle()
    wait(lambda: window.model.idle and not any(getattr(dock.panel, "pending", False) for dock in window.docks.values()))
    settle(0.1)


def settle(seconds: float = 0.3) -> None:
    """Let everything that was asked for be painted."""
    end = time.perf_counter() + seconds
    wait(lambda: time.perf_counter() > end)


if __name__ == "__main__":
    first_paint() if sys.argv[1:] == ["first-paint"] else main()
