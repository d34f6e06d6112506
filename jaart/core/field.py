"""An energy as a field: sampled at the points of a grid finer than the lattice, near surfels only [T §2.4.6]."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from threading import Event

import numpy as np

from jaart.core import memory
from jaart.core.errors import Cancelled, SettingsError
from jaart.core.kernels import field
from jaart.core.kernels import records as r
from jaart.core.kernels.records import Cells, Plan, Vector
from jaart.core.scene import Array
from jaart.core.tracers import scratch

#: Numbers of the energies whose isosurface is made; tangent is |f|, tangent_step |e_ts| along a direction.
ENERGIES = {"tangent": r.TANGENT, "tangent_step": r.TANGENT_STEP, "off_centre": r.OFF_CENTRE,
            "mahalanobis": r.MAHALANOBIS, "angle": r.ANGLE}
#: The energy that a ray's direction enters.
DIRECTED = "tangent_step"
_NO_DIRECTION = (0.0, 0.0, 1.0)


def energy_field(cells: Cells, plan: Plan, energy: str, emphasise: bool, divisions: int,
                 direction: Vector | None = None, threads: int | None = None, cancel: Event | None = None) -> Array:
    """The energy (nx·divisions + 1, …) at the points (i, j, k)/divisions of a lattice; NaN where no surfel is near.

    cells, plan: the neighbourhoods and how a point is evaluated; energy: a name of ENERGIES; emphasise: by the
    angle [T 2.24]; direction: unit vector of e_ts [T 2.20]; threads: as many as the machine has when None. On a face
    the cell on the low side gives the neighbourhood. Raises SettingsError when the field would not fit into memory,
    Cancelled after cancel was set.
    """
    shape = tuple(n * divisions + 1 for n in cells.sites.shape)
    _check_memory(shape, divisions)
    values = np.full(shape, np.nan)
    how = plan._replace(how=plan.how._replace(energy=ENERGIES[energy], emphasise=int(emphasise)))

    def layer(number: int) -> None:
        if cancel is None or not cancel.is_set():
            work, fit = scratch(cells.sites)
            field.sample_layer(cells.sites, how, direction or _NO_DIRECTION, divisions, number, values, work, fit)

    with ThreadPoolExecutor(threads or os.cpu_count() or 1) as pool:
        list(pool.map(layer, range(cells.sites.shape[0])))
    if cancel is not None and cancel.is_set():
        raise Cancelled("the field of the energy was cancelled")
    return values


def _check_memory(shape: tuple[int, ...], divisions: int) -> None:
    needed = 8 * int(np.prod(np.array(shape, np.float64)))
    if needed > memory.limit():
        raise SettingsError(f"subdivide = {divisions}: a field of {'x'.join(map(str, shape))} values needs "
                            f"{memory.words(needed)} of memory, more than the {memory.words(memory.limit())} it may take")
