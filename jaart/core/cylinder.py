"""Rays through a lattice by the mean of the surfels in a cylinder around each [Schaufler & Jensen 2000; A §2]."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from jaart.core.cell_table import cell_table
from jaart.core.chosen import HALF_DIAGONAL, Chosen
from jaart.core.kernels import cylinder
from jaart.core.kernels.records import LOG_WIDTH, Cells, Out, Plan, Sites
from jaart.core.places import Pool
from jaart.core.scene import Array
from jaart.core.surfels import Surfels
from jaart.core.tiles import Pixels, columns_for
from jaart.core.tracers import NO_BEGINS, NO_LOG, OnLattice, all_of

#: Room for rounding in a neighbourhood's radius, in cells.
_ROUNDING = 1e-6


@dataclass(frozen=True, eq=False)
class CylinderTracer(OnLattice):
    """A lattice of surfels, each a disc of radius h, which is the cylinder's radius too.

    cells: the neighbourhoods, of `reach(radius)` or more; plan: how the energies along a ray are sampled; radius:
    of discs and cylinder, in cells.
    """

    radius: float

    def trace(self, origins: Array, directions: Array, pixels: Pixels, out: Out, log: Array = NO_LOG,
              any_hit: bool = False, begins: Array = NO_BEGINS) -> int:
        """Trace some rays into their rows of the columns; see `Tracer`. The first hit costs no more than any."""
        def rest(sites: Sites, pool: Pool, rays: Pixels) -> tuple[int, int]:
            done, written = cylinder.cylinder_rays(self.cells._replace(sites=sites), self.radius, origins, directions,
                                                   rays, out, log)
            return done, written

        return all_of(self.sites, pixels, rest)


def reach(radius: float) -> float:
    """How far from a cell's centre a surfel may be that counts for a disc hit in the cell.

    A disc that is hit there is at most a radius from the hit; a surfel of the cylinder at most √2 radii.
    """
    return math.sqrt(2.0) * radius + HALF_DIAGONAL + _ROUNDING


def with_reach(values: Chosen) -> Chosen:
    """The values with the neighbourhood that a cylinder needs."""
    return replace(values, neighbourhood="cell_ball", radius=reach(values.h))


def cylinder_tracer(values: Chosen, plan: Plan, cells: Callable[[Chosen], Cells]) -> CylinderTracer:
    """What rays are sent through; cells: makes the table of a neighbourhood."""
    made = cells(with_reach(values))
    return CylinderTracer(lambda: made, plan, values.h)


@functools.cache
def warm_up() -> None:
    """Run the kernels once, so that none compiles later."""
    found = Surfels(np.array([[1, 1, 1]], np.int32), np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]))
    plan: Any = None
    small = cell_table(found, (3, 3, 3), _SMALL, 1)
    tracer = CylinderTracer(lambda: small, plan, 1.0)
    tracer.trace(np.array([[1.5, 1.5, 9.0]]), np.array([[0.0, 0.0, -1.0]]), np.zeros(1, np.int64), columns_for(1),
                 np.empty((1, LOG_WIDTH)))
    cylinder.write_shares(tracer.sites, (1, 1, 1), (0.0, 0.0, 0.0), (0.0, 0.0, -1.0), 1.0, np.empty(2))


_SMALL = Chosen(method="cylinder", search="iterate", weight="gaussian", normal="surfel", neighbourhood="cell_ball",
                h=1.0, radius=reach(1.0), trust=1.0, off_centre=math.inf, nearest=math.inf, level=0.0, step=1.0,
                stride=1.0, tolerance=1.0)
