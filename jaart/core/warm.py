"""Load or compile the kernels once in a process, so that no measured time holds a compilation."""

from __future__ import annotations

import functools
import threading

import numpy as np

from jaart.core.kernels import energies, jit, pinhole, ray, traversal
from jaart.core.kernels.records import LOG_WIDTH, Search
from jaart.core.prepare import cell_table
from jaart.core.surfels import Surfels
from jaart.core.tiles import columns_for

_LOCK = threading.Lock()


def needs_compile() -> bool:
    """Whether the kernels will be compiled, which takes seconds, or only loaded from the user's cache."""
    return jit.first_time()


def warm_up() -> None:
    """Run every kernel once on two surfels; afterwards nothing compiles in this process."""
    with _LOCK:
        _run_all()


@functools.cache
def _run_all() -> None:
    found = Surfels(np.array([[1, 1, 1], [1, 2, 1]], np.int32), np.zeros((2, 3)), np.eye(3)[[2, 2]])
    cells = cell_table(found, (3, 4, 3), 2.0)
    search = Search(h=0.8, arrived=0.1, cap=2, trust=2.0, growth=0, max_off_centre=0.3)
    o, d = (1.5, 1.5, 9.0), (0.0, 0.0, -1.0)
    origin, direction = np.array([o]), np.array([d])
    view = pinhole.View(o, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), d, 1.0, 0, 1, 1)
    pinhole.write_rays(view, np.zeros(1, np.int64), np.zeros(1, np.int64), origin, direction)
    ray.trace_rays(cells, search, origin, direction, np.zeros(1, np.int64), columns_for(1))
    ray.trace_ray(cells, search, o, d, np.empty((2, LOG_WIDTH)))
    traversal.crossed(origin[0], direction[0], (3, 4, 3), np.empty((13, 3), np.int32), np.empty(14))
    energies.sample(cells, 0.8, 0.25, o, d, np.array([7.5]), np.array([[1, 1, 1]]), np.empty((3, 1)))
    energies.write_weights(cells, (1, 1, 1), (0.0, 0.0, 0.0), 0.8, np.empty(2))
