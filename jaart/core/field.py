"""An energy as a field: sampled at the points of a grid finer than the lattice, near surfels only [T §2.4.6]."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from threading import Event

import numpy as np

from jaart.core import memory
from jaart.core.errors import SettingsError
from jaart.core.kernels import field
from jaart.core.kernels import records as r
from jaart.core.kernels.records import Cells, Plan, Vector
from jaart.core.pieces import do_each
from jaart.core.places import served
from jaart.core.scene import Array

#: Numbers of the energies whose isosurface is made; tangent is |f|, tangent_step |e_ts| along a direction.
ENERGIES = {"tangent": r.TANGENT, "tangent_step": r.TANGENT_STEP, "off_centre": r.OFF_CENTRE,
            "mahalanobis": r.MAHALANOBIS, "angle": r.ANGLE}
#: The energy that a ray's direction enters.
DIRECTED = "tangent_step"
Progress = Callable[[int, int], None]

#: Half the width of a central difference, in h.
WIDTH = 1e-5
#: A thread takes the gradients at so many points at a time.
POINTS_AT_ONCE = 4096


@dataclass(frozen=True)
class Energy:
    """Which energy, of which surface.

    cells, plan: neighbourhoods, and how a point is evaluated; name: one of ENERGIES; emphasise: by the angle
    [T 2.24]; direction: unit vector of e_ts [T 2.20].
    """

    cells: Cells
    plan: Plan
    name: str = "tangent"
    emphasise: bool = False
    direction: Vector = (0.0, 0.0, 1.0)

    @property
    def asked(self) -> Plan:
        """The plan with this energy in it."""
        how = self.plan.how._replace(energy=ENERGIES[self.name], emphasise=int(self.emphasise))
        return self.plan._replace(how=how)


def energy_field(energy: Energy, divisions: int, threads: int | None = None, cancel: Event | None = None,
                 progress: Progress | None = None) -> Array:
    """The energy (nx·divisions + 1, …) at the points (i, j, k)/divisions of a lattice; NaN where no surfel is near.

    threads: as many as the machine has when None; progress(done, all layers of cells) is called from the caller's
    thread. On a face the cell on the low side gives the neighbourhood. Raises SettingsError when the field would not
    fit into memory, Cancelled after cancel was set.
    """
    sites, plan = energy.cells.sites, energy.asked
    shape = tuple(n * divisions + 1 for n in sites.shape)
    _check_memory(shape, divisions)
    values = np.full(shape, np.nan)

    def layer(number: int) -> None:
        served(sites, lambda own, pool: field.sample_layer(own, plan, energy.direction, divisions, number, values,
                                                           pool.work, pool.fit))

    do_each(layer, range(sites.shape[0]), threads, cancel, progress)
    return values


def energy_gradients(energy: Energy, points: Array, threads: int | None = None, cancel: Event | None = None,
                     progress: Progress | None = None) -> Array:
    """The energy's gradient (N, 3) at points (N, 3) in cells, to about 1e-9; NaN where it is not defined.

    Raises Cancelled after cancel was set.
    """
    sites, plan = energy.cells.sites, energy.asked
    result, at = np.empty(points.shape), np.array(points)

    def some(first: int) -> None:
        part = slice(first, first + POINTS_AT_ONCE)
        served(sites, lambda own, pool: field.write_gradients(own, plan, energy.direction, WIDTH * plan.rule.h,
                                                              at[part], result[part], pool.work, pool.fit))

    do_each(some, range(0, len(points), POINTS_AT_ONCE), threads, cancel, progress)
    return result


def _check_memory(shape: tuple[int, ...], divisions: int) -> None:
    needed, most = 8 * int(np.prod(np.array(shape, np.float64))), memory.limit()
    if needed > most:
        raise SettingsError(f"subdivide = {divisions}: a field of {'x'.join(map(str, shape))} values needs "
                            f"{memory.words(needed)} of memory, more than the {memory.words(most)} it may take")
