"""Compile every kernel there is into the user's cache, so that no option waits for its own.

`python -m jaart.core.compile_all` does it; the window has that run beside itself, at low priority, when it must.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from typing import Any

import numpy as np

from jaart.core.kernels import jit
from jaart.core.scene import Scene
from jaart.core.settings import Settings

#: Lies in the cache when everything was compiled.
DONE = "complete"
#: Settings that between them need every evaluator, search and driver.
NEEDED: tuple[dict[str, Any], ...] = (
    {}, {"normal": "covariance", "search": "newton"}, {"method": "polynomial", "search": "safe"},
    {"method": "polynomial", "search": "secant"}, {"neighbourhood": "cell_knn"},
    {"method": "projection", "search": "march"}, {"method": "off_centre"}, {"search": "centres"},
    {"method": "cylinder"}, {"method": "isosurface"},
)


def missing() -> bool:
    """Whether some kernel may still have to be compiled, and can be kept; never so in tests, whose kernels differ."""
    return jit.kept() and not jit.CALLABLE and not (jit.CACHE / DONE).exists()


def compile_all() -> None:
    """Render and follow a ray with every kind of settings, in a lattice and a cloud."""
    from jaart.core.render import render
    from jaart.core.trace import trace

    for scene, settings in _cases():
        render(scene, settings, size=(4, 4), threads=1)
        trace(scene, settings, (2.0, 2.0, 9.0), (0.0, 0.0, -1.0))
    with contextlib.suppress(OSError):
        (jit.CACHE / DONE).touch()


def _cases() -> Iterator[tuple[Scene, Settings]]:
    levels = np.zeros((4, 4, 4))
    levels[:, :, 0], levels[:, :, 1] = 1.0, 0.5
    lattice = Scene("lattice", levels=levels)
    for values in NEEDED:
        yield lattice, Settings(**values)
    x, y = np.meshgrid(np.arange(5.0), np.arange(5.0))
    points = np.column_stack((x.ravel(), y.ravel(), 0.1 * (x * y).ravel()))
    yield Scene("cloud", points=points), Settings(method="polynomial", orient="none")
    yield Scene("cloud", points=points), Settings()


if __name__ == "__main__":
    with contextlib.suppress(OSError, AttributeError):
        os.nice(10)
    compile_all()
