"""What a scene is once rays can be sent through it: each kind traces a list of rays into columns."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from jaart.core.kernels import beams, ray
from jaart.core.kernels.guess import GUESS_WIDTH
from jaart.core.kernels.packet import ROOM
from jaart.core.kernels.pinhole import EDGE, View
from jaart.core.kernels.records import FIT_SIZE, LOG_WIDTH, Cells, Out, Plan, Sites
from jaart.core.scene import Array
from jaart.core.tiles import Pixels

#: Scratch for each surfel that may be near a point: its weight, its place in the local frame, its row of a fit.
SCRATCH_A_SURFEL = 24
#: A log without room: nothing is written down.
NO_LOG = np.empty((0, LOG_WIDTH))
#: Nothing is known of where rays can meet anything.
NO_BLOCKS, NO_BEGINS = np.empty((0, 0)), np.empty(0)


class Tracer(Protocol):
    """A scene that rays can be sent through."""

    @property
    def plan(self) -> Plan:
        """How a point is evaluated and a ray searched."""

    @property
    def sites(self) -> Sites:
        """The places with the surfels near each."""

    @property
    def offset(self) -> Array:
        """Origin (3,) of the frame that places are in."""

    def scratch(self) -> tuple[Array, Array]:
        """Room for the weights and fits of the place with the most surfels, for one thread."""

    def trace(self, origins: Array, directions: Array, pixels: Pixels, out: Out, log: Array = NO_LOG,
              any_hit: bool = False, begins: Array = NO_BEGINS) -> int:
        """Trace some rays (R, 3) into their rows of the columns; returns the rows written to the log.

        log: (L, LOG_WIDTH) for the steps of a single ray; any_hit: any hit will do, not only the first; begins: (R,)
        t before which a ray meets nothing, (0,) where nobody knows.
        """

    def blocks(self, view: View) -> Array:
        """The t before which blocks of a picture's rays meet nothing (blocks down, blocks across), or (0, 0)."""


@dataclass(frozen=True, eq=False)
class OnLattice:
    """What tracers of a lattice have in common.

    cells: the surfels' neighbourhoods; plan: how a point is evaluated and a ray searched.
    """

    cells: Cells
    plan: Plan

    @property
    def sites(self) -> Sites:
        """The cells with the surfels near each."""
        return self.cells.sites

    @property
    def offset(self) -> Array:
        """A lattice is computed in its own frame."""
        return np.zeros(3)

    def scratch(self) -> tuple[Array, Array]:
        """Room for the weights and fits of the cell with the most surfels."""
        return scratch(self.most)

    def blocks(self, view: View) -> Array:
        """Nothing is known but where a search goes cell by cell."""
        return NO_BLOCKS

    @cached_property
    def most(self) -> int:
        """Surfels of the cell that has most near it."""
        return int(np.diff(self.cells.sites.first).max(initial=0))


class LatticeTracer(OnLattice):
    """A lattice of surfels whose surface each ray searches."""

    def trace(self, origins: Array, directions: Array, pixels: Pixels, out: Out, log: Array = NO_LOG,
              any_hit: bool = False, begins: Array = NO_BEGINS) -> int:
        """Trace some rays into their rows of the columns; see `Tracer`."""
        packet = np.empty(ROOM)
        return int(ray.trace_rays(self.cells, self.plan, origins, directions, begins, pixels, out, log, packet,
                                  *self.scratch()))

    def blocks(self, view: View) -> Array:
        """The t before which no ray of a block comes near a surfel; not for even steps, which count from the border."""
        if self.cells.uniform > 0.0:
            return NO_BLOCKS
        near = max(self.cells.halo, 1) if self.cells.stretches == 1 else 1
        blocks = np.empty((-(-view.height // EDGE), -(-view.width // EDGE)))
        beams.write_blocks(view, self.cells.empty, near, 0, len(blocks), blocks)
        return blocks


def scratch(most: int) -> tuple[Array, Array]:
    """Room for the weights and fits of so many surfels, and for what is kept of a centre, for one thread."""
    return np.empty(SCRATCH_A_SURFEL * max(most, 1)), np.zeros(FIT_SIZE + GUESS_WIDTH)
