"""What is said while work takes long, who is told, and how Ctrl-C ends a command."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jaart
from jaart import cli_progress
from jaart.core.errors import Cancelled
from jaart.core.io import load
from jaart.core.pieces import do_each
from jaart.core.quality import quality
from jaart.core.render import render
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from jaart.core.telling import doing, stoppable, tell, told
from tests.core.cloud_scenes import fresh

ROOT = Path(jaart.__file__).parents[1]


class Terminal(io.StringIO):
    """A file that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def stages(said: list[tuple[str, int, int]]) -> list[str]:
    """What was told, without repetitions and without the ends."""
    names = [name for name, _, _ in said if name]
    return [name for i, name in enumerate(names) if i == 0 or name != names[i - 1]]


@pytest.mark.parametrize("filling", ["accurate", "corners"])
def test_each_stage_of_a_lattice_is_told_once_and_to_its_end(filling: str) -> None:
    scene, said = Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.3),), 12)), list[tuple[str, int, int]]()
    settings = Settings(filling=filling)
    render(scene, settings, size=(2, 2))
    scene._kept.clear()
    with told(lambda *one: said.append(one)):
        hits = render(scene, settings, size=(8, 8))
        quality(hits, scene)
        render(scene, settings, size=(8, 8))  # everything is kept
    assert stages(said) == ["table of the cells", "filling the lattice", "table of the cells", "surfels",
                            "table of the cells", "errors against the exact surface"]
    counts = [(done, total) for name, done, total in said if name == "filling the lattice" and total]
    assert counts == sorted(counts) and counts[-1][0] == counts[-1][1] > 0
    assert said[-1] == ("", 0, 0)


def test_stages_of_a_cloud_and_reading_are_told(tmp_path: Path) -> None:
    scene, said = fresh("sphere", 300, bare=True), list[tuple[str, int, int]]()
    np.savez(tmp_path / "points.npz", points=scene.points)
    with told(lambda *one: said.append(one)):
        render(load(tmp_path / "points.npz"), Settings(method="tangent", normal="surfel"), size=(4, 4))
    assert {"reading points.npz", "tree of the points", "nearest neighbours", "normals of the points", "balls",
            "tree of the balls"} <= set(stages(said))


def test_only_the_thread_that_watches_is_told_and_after_an_error_nobody() -> None:
    said: list[Any] = []

    def other() -> None:
        with doing("elsewhere"):
            tell(1, 2)

    with pytest.raises(ValueError, match="broken"), told(lambda *one: said.append(one)):
        thread = threading.Thread(target=other)
        thread.start()
        thread.join()
        tell(1, 2)  # nobody knows of what
        with doing("here"):
            tell(1, 2)
            raise ValueError("broken")
    with doing("later"):
        tell(3, 4)
    assert said == [("here", 0, 0), ("here", 1, 2), ("", 0, 0)]


@pytest.mark.parametrize("stage", ["nearest neighbours", "normals of the points", "balls"])
def test_a_cloud_that_is_made_ready_is_stopped_in_every_stage(stage: str) -> None:
    scene, stop = fresh("sphere", 300, bare=True), threading.Event()
    settings = Settings(method="tangent", normal="surfel")

    def stopping(what: str, _done: int, _total: int) -> None:
        if what == stage:
            stop.set()

    with told(stopping), pytest.raises(Cancelled):
        render(scene, settings, size=(4, 4), cancel=stop)
    assert "cloud_tracer" not in scene._kept
    assert render(scene, settings, size=(4, 4), cancel=threading.Event()).counts()["converged"]


def test_work_outside_a_stoppable_block_goes_on() -> None:
    stop = threading.Event()
    stop.set()
    with (pytest.raises(Cancelled, match="here was cancelled"), told(lambda *one: None), doing("here"),
          stoppable(stop), stoppable(None)):
        tell(1, 2)
    tell(1, 2)
    with doing("later"):
        tell(1, 2)


def test_what_progress_raises_ends_the_pieces_that_have_not_begun() -> None:
    done, gate = list[int](), threading.Event()

    def piece(number: int) -> None:
        if number:
            gate.wait(30)
        done.append(number)

    def progress(_: int, all_pieces: int) -> None:
        assert all_pieces == 100
        threading.Timer(0.1, gate.set).start()
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        do_each(piece, range(100), threads=2, progress=progress)
    assert 0 in done and len(done) < 5


def test_a_bar_is_drawn_on_a_terminal_after_a_while_and_cleared(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr(cli_progress, "QUIET", 0.05)
    monkeypatch.setattr(cli_progress, "TICK", 0.01)
    with cli_progress.shown():
        with doing("quick"):
            pass
        with doing("endless"):
            wait_for(terminal, "endless 00:0")
        with cli_progress.counted("pieces") as progress:
            assert progress is not None
            progress(3, 4)
            wait_for(terminal, "75%")
        with cli_progress.counted("alone", alone=True), doing("hidden"):
            wait_for(terminal, "alone")
    shown = terminal.getvalue()
    assert "quick" not in shown and "hidden" not in shown
    assert shown.endswith("\r") and not shown.rsplit("\r", 2)[1].strip()


def wait_for(terminal: Terminal, text: str) -> None:
    """Wait until a text is shown; the test fails where it never is."""
    end = time.monotonic() + 30
    while text not in terminal.getvalue():
        assert time.monotonic() < end, terminal.getvalue()
        time.sleep(0.01)


def test_nothing_is_drawn_in_a_pipe(capsys: pytest.CaptureFixture[str]) -> None:
    with cli_progress.shown(), cli_progress.counted("pieces") as progress:
        assert progress is None
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("code", [
    "from jaart.core import io\ndef load(*_): exec('raise KeyboardInterrupt')\nio.load = load",
    "sys.modules['jaart.cli'] = None\nclass Stop:\n def find_spec(*_): raise KeyboardInterrupt\n"
    "del sys.modules['jaart.cli']\nsys.meta_path.insert(0, Stop)"], ids=["while a module runs", "while loading"])
def test_an_interrupt_is_one_line_and_130_wherever_it_comes(code: str, tmp_path: Path) -> None:
    program = f"import sys\nimport jaart.__main__\n{code}\nsys.exit(jaart.__main__.main(['info', 'standard']))"
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(ROOT)})
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "jaart: interrupted\n")


@pytest.mark.parametrize("command", [
    ["render", "standard", "--set", "raster=500", "--output", "a.png"],
    ["isosurface", "standard", "--set", "raster=500", "--energy", "tangent", "--output", "a.ply"],
    ["trace", "standard", "--set", "raster=500", "--pixel", "9,9", "--output", "a.json"]], ids=lambda c: c[0])
def test_ctrl_c_while_a_scene_is_made_ready_leaves_nothing(command: list[str], tmp_path: Path) -> None:
    wait = "from jaart.core import telling\nimport jaart.core.scene as scene, os, signal, threading\n" \
           "told = telling.doing\ndef doing(what):\n if what == 'filling the lattice':\n" \
           "  threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()\n return told(what)\n" \
           "scene.doing = doing\n"
    program = f"import sys\n{wait}from jaart.__main__ import main\nsys.exit(main({command!r}))"
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(ROOT)}, timeout=200)
    assert done.returncode == 130 and done.stdout == ""
    assert done.stderr.splitlines()[-1] == "jaart: interrupted" and "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_process_that_ends_while_a_thread_writes_leaves_the_old_file(tmp_path: Path) -> None:
    (tmp_path / "x.csv").write_text("old")
    program = "import threading\nfrom jaart.cli_interrupt import leave\nfrom jaart.core.io.atomic import replacing\n" \
              "begun = threading.Event()\ndef write():\n with replacing('x.csv') as part:\n" \
              "  part.write_text('half')\n  begun.set()\n  threading.Event().wait()\n" \
              "threading.Thread(target=write).start()\nbegun.wait()\nprint('said', flush=True)\nleave(130)"
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(ROOT)}, timeout=100)
    assert (done.returncode, done.stdout, done.stderr) == (130, "said\n", "")
    assert [path.name for path in tmp_path.iterdir()] == ["x.csv"] and (tmp_path / "x.csv").read_text() == "old"
