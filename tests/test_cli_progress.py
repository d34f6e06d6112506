"""What a terminal shows of long work, and how Ctrl-C ends it: real processes, each with a terminal."""

from __future__ import annotations

import os
import re
import select
import signal
import subprocess
import sys
import termios
import time
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import jaart

Floats = NDArray[np.float32]

pty = pytest.importorskip("pty", reason="there are no such terminals here")

#: So long a process may take, to compile kernels on a first run included [s].
PATIENCE = 240
#: Work by what is shown of it: more than anybody waits for.
LONG = {
    "filling the lattice": ["info", "many.xml"],
    "rays": ["render", "splash", "--size", "6000x6000", "--hits", "h.npz", "--output", "p.png"],
    "rays ": ["statistics", "splash", "--size", "6000x6000", "--output", "s.csv"],
    "cases": ["study", "stability", "--output", "study"],
    "layers of cells": ["isosurface", "standard", "--energy", "tangent", "--subdivide", "8", "--set", "raster=80",
                        "--output", "m.ply"],
    "light through water": ["render", "splash", "--set", "shading=water", "--size", "1200x1200", "--output", "p.png"],
    "reading points.npz": ["info", "points.npz"],
    "nearest neighbours": ["render", "points.npz", "--set", "ball_k=64", "--output", "p.png"],
    "normals of the points": ["render", "points.npz", "--set", "normal=surfel", "--output", "p.png"],
}
#: How many points are in the file, where it is not a few.
POINTS = {"reading points.npz": 3_000_000, "nearest neighbours": 400_000, "normals of the points": 400_000}
#: 200 solids that overlap in a fine lattice.
MANY = '<SceneGraph raster="200">' + "".join(
    f'<Sphere radius="0.3"><location x="{0.4 + 0.001 * i}" y="0.5" z="0.5"/></Sphere>' for i in range(200)
) + "</SceneGraph>"


class Terminal:
    """A process whose errors go to a terminal."""

    def __init__(self, arguments: list[str], folder: Path, columns: int) -> None:
        self.ours, theirs = pty.openpty()
        termios.tcsetwinsize(theirs, (24, columns))
        environment = {**os.environ, "PYTHONPATH": str(Path(jaart.__file__).parents[1])}
        self.process = subprocess.Popen([sys.executable, "-m", "jaart", *arguments], cwd=folder, env=environment,
                                        stdout=subprocess.PIPE, stderr=theirs, text=True)
        os.close(theirs)
        self.shown = ""

    def read_until(self, words: str) -> None:
        """Read until these words were shown, or until the process has ended where there are none."""
        end = time.monotonic() + PATIENCE
        while not words or words not in self.shown:
            assert time.monotonic() < end, self.shown
            if select.select([self.ours], [], [], 0.1)[0]:
                try:
                    text = os.read(self.ours, 4096)
                except OSError:  # the other side is closed
                    text = b""
                if not text:
                    break
                self.shown += text.decode()
        assert words in self.shown, self.shown

    def interrupt(self) -> tuple[int, str]:
        """Type Ctrl-C: the exit status and the output."""
        self.process.send_signal(signal.SIGINT)
        self.read_until("")
        out, _ = self.process.communicate(timeout=PATIENCE)
        os.close(self.ours)
        return self.process.returncode, out


def on_a_sphere(count: int) -> Floats:
    """Points (count, 3)."""
    v = np.random.default_rng(3).normal(size=(count, 3))
    points: Floats = (v / np.linalg.norm(v, axis=1)[:, None]).astype(np.float32)
    return points


@pytest.mark.parametrize(("work", "columns"), [*((work, 100) for work in LONG), (next(iter(LONG)), 0)])
def test_long_work_is_shown_and_ctrl_c_ends_it_in_one_line(work: str, columns: int, tmp_path: Path) -> None:
    (tmp_path / "many.xml").write_text(MANY)
    np.savez(tmp_path / "points.npz", points=on_a_sphere(POINTS.get(work, 10)))
    terminal = Terminal(LONG[work], tmp_path, columns)  # some terminals do not tell how wide they are
    terminal.read_until(work.strip())
    status, out = terminal.interrupt()
    lines = [line for line in re.split(r"[\r\n]+", terminal.shown.replace("\x1b[A", "")) if line.strip()]
    assert status == 130 and "Traceback" not in terminal.shown, terminal.shown
    assert lines[-1] == "jaart: interrupted" and terminal.shown.count("interrupted") == 1, lines[-3:]
    assert "wrote" not in out
    assert {p.name for p in tmp_path.iterdir()} == {"many.xml", "points.npz"}


def test_what_is_done_at_once_shows_nothing(tmp_path: Path) -> None:
    terminal = Terminal(["info", "standard"], tmp_path, 100)
    terminal.read_until("")
    out, _ = terminal.process.communicate(timeout=PATIENCE)
    os.close(terminal.ours)
    assert terminal.process.returncode == 0 and out.startswith("standard") and "%" not in terminal.shown
