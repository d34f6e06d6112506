"""How quickly the window answers: start, stall of its thread, slider to pixels, click to panels.

Slider and click in the standard model at 64³, 512×512 pixels. Run with a display, or under xvfb-run:
python benchmarks/window.py. Prints medians over several runs; with the word "quick" without the starts.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

STARTS, DRAGS, CLICKS = 5, 20, 10
#: Seconds that the rays of each dragged picture took.
RAYS: list[float] = []


def main() -> None:
    starts = [0.0] if "quick" in sys.argv else [start_in_process() for _ in range(STARTS + 1)][1:]
    report("start to first paint", starts, "s", 2)
    window, stalls = opened()
    report("longest stall while panels load", [max(stalls)], "ms")
    show(window, "standard")
    stalls.clear()
    drags = [drag(window, k) for k in range(DRAGS)]
    for name in drags[0]:
        report(f"slider to {name}", [1000 * times[name] for times in drags], "ms")
    report("of that, rays", [1000 * seconds for seconds in RAYS], "ms")
    clicks = [click(window, k) for k in range(CLICKS)]
    for name in clicks[0]:
        report(f"click to {name}", [1000 * times[name] for times in clicks], "ms")
    report("click to all ray panels", [1000 * max(times.values()) for times in clicks], "ms")
    report("longest stall in use", [max(stalls)], "ms")
    window.close()


def report(name: str, values: list[float], unit: str, digits: int = 0) -> None:
    ordered = sorted(values)
    spread = f"   (p95 {ordered[int(0.95 * (len(ordered) - 1))]:.{digits}f})" if len(values) > 1 else ""
    print(f"{name:36s} {statistics.median(values):8.{digits}f} {unit}{spread}", flush=True)


def start_in_process() -> float:
    """Seconds from the start of a process to the first paint of its window."""
    begin = time.time()
    out = subprocess.run([sys.executable, __file__, "first-paint"], capture_output=True, text=True, check=True)
    return float(out.stdout.split()[-1]) - begin


def first_paint() -> None:
    """Open the window as the program does, print the time of day of its first paint, and end."""
    from jaart.gui.libraries import check

    check()
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
    wait(lambda: window.model.idle)
    settle(1.0)


def drag(window, turn: int) -> dict[str, float]:
    """Seconds from a move of the slider of h to the first paint of a picture made with it, and of the full one."""
    from qtpy.QtWidgets import QApplication

    model, slider = window.model, window.docks["Parameters"].panel.rows["h"].slider
    target = slider.value() + (1 if turn % 20 < 10 else -1)
    current = lambda: model.hits is not None and model.hits.settings == model.settings  # noqa: E731
    seen = watch_paints(QApplication.instance(), {"first pixels": window.view}, current)
    full = watch_paints(QApplication.instance(), {"full picture": window.view}, lambda: current() and model.complete)
    begin = time.perf_counter()
    slider.setValue(target)
    wait(lambda: seen and full)
    seen.stop()
    full.stop()
    RAYS.append(model.hits.ray_s)
    wait(lambda: model.idle)
    settle()
    return {name: at - begin for name, at in {**seen, **full}.items()}


def click(window, turn: int) -> dict[str, float]:
    """Seconds from a click on a pixel to the first paint of each of the ray's panels."""
    from pyvistaqt import QtInteractor
    from qtpy.QtCore import Qt
    from qtpy.QtTest import QTest
    from qtpy.QtWidgets import QApplication

    model = window.model
    names = ("2D projector", "Energy along the ray")
    before = model.trace
    seen = watch_paints(QApplication.instance(), {name: window.docks[name] for name in names},
                        lambda: model.trace is not before)
    space = window.docks["3D ray analyzer"].panel.findChild(QtInteractor).render_window
    observer = space.AddObserver("EndEvent", lambda *_: model.trace is not before
                                 and seen.setdefault("3D ray analyzer", time.perf_counter()))
    met = model.hits.hit.nonzero()[0]
    pixel = int(met[(2 * turn + 1) * len(met) // (2 * CLICKS)])
    place = window.view.place_of((pixel % model.size[0], pixel // model.size[0])).toPoint()
    begin = time.perf_counter()
    QTest.mouseClick(window.view, Qt.MouseButton.LeftButton, pos=place)
    wait(lambda: len(seen) == len(names) + 1)
    seen.stop()
    space.RemoveObserver(observer)
    settle()
    return {name: seen[name] - begin for name in (*names, "3D ray analyzer")}


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


def settle(seconds: float = 0.3) -> None:
    """Let everything that was asked for be painted."""
    end = time.perf_counter() + seconds
    wait(lambda: time.perf_counter() > end)


if __name__ == "__main__":
    first_paint() if sys.argv[1:] == ["first-paint"] else main()
