"""What a scene is once rays can be sent through it: each kind traces a list of rays into columns."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from jaart.core.kernels import abreast, beams, blocks, packet, ray, together
from jaart.core.kernels.guess import GUESS_WIDTH
from jaart.core.kernels.pinhole import EDGE, View
from jaart.core.kernels.records import LOG_WIDTH, Cells, Out, Plan, Sites
from jaart.core.memory import sparse
from jaart.core.places import Ints, Pool, address, served
from jaart.core.scene import Array
from jaart.core.tiles import Pixels

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

    table: makes the surfels' neighbourhoods, or has them; plan: how a point is evaluated and a ray searched.
    """

    table: Callable[[], Cells]
    plan: Plan

    @cached_property
    def cells(self) -> Cells:
        """The surfels' neighbourhoods, made when they are first asked for."""
        return self.table()

    @property
    def sites(self) -> Sites:
        """The cells with the surfels near each."""
        return self.cells.sites

    @property
    def offset(self) -> Array:
        """A lattice is computed in its own frame."""
        return np.zeros(3)

    def blocks(self, view: View) -> Array:
        """Nothing is known but where a search goes cell by cell."""
        return NO_BLOCKS


@dataclass(frozen=True, eq=False)
class Centres:
    """The polynomials at the centres of a lattice's cells, as far as rays asked for them.

    asked: (S,) 1 where one is kept, numbered as slots of Sites; rows: (S, GUESS_WIDTH).
    """

    asked: Ints
    rows: Array

    def shown_to(self, pool: Pool) -> None:
        """Let a thread know where they are."""
        pool.numbers[blocks.ASKED], pool.numbers[blocks.ROWS] = address(self.asked), address(self.rows)


def centres_for(sites: Sites) -> Centres:
    """Room for as many as there are cells near a surfel; a page of it costs memory once it is used."""
    what = "polynomials at the cells' centres"
    return Centres(sparse(sites.slots.shape, what, np.int64), sparse((len(sites.slots), GUESS_WIDTH), what))


@dataclass(frozen=True, eq=False)
class LatticeTracer(OnLattice):
    """A lattice of surfels whose surface each ray searches.

    centres: where a search begins by them; together: whether rays without a log search side by side.
    """

    centres: Centres | None = None
    together: bool = False

    def trace(self, origins: Array, directions: Array, pixels: Pixels, out: Out, log: Array = NO_LOG,
              any_hit: bool = False, begins: Array = NO_BEGINS) -> int:
        """Trace some rays into their rows of the columns; see `Tracer`."""
        abreast_now = self.together and not len(log)
        driver = together.trace_together if abreast_now else ray.trace_rays
        columns = np.empty(abreast.ROOM if abreast_now else packet.ROOM)

        def rest(sites: Sites, pool: Pool, rays: Pixels) -> tuple[int, int]:
            if self.centres:
                self.centres.shown_to(pool)
            done, written = driver(self.cells._replace(sites=sites), self.plan, origins, directions, begins, rays, out,
                                   log, columns, pool.work, pool.fit)
            return done, written

        return all_of(self.sites, pixels, rest)

    def blocks(self, view: View) -> Array:
        """The t before which no ray of a block comes near a surfel; not for even steps, which count from the border."""
        if self.cells.uniform > 0.0:
            return NO_BLOCKS
        near = max(self.cells.halo, 1) if self.cells.stretches == 1 else 1
        begins = np.empty((-(-view.height // EDGE), -(-view.width // EDGE)))
        beams.write_blocks(view, self.cells.empty, near, 0, len(begins), begins)
        return begins


def all_of(sites: Sites, pixels: Pixels, rest: Callable[[Sites, Pool, Pixels], tuple[int, int]]) -> int:
    """Trace rays until none is left; returns the rows written to the log.

    rest: traces rays until its pool is short of room; returns how many of them, and the rows.
    """
    left = pixels

    def ask(own: Sites, pool: Pool) -> int:
        nonlocal left
        done, written = rest(own, pool, left)
        left = left[done:]
        return written

    return served(sites, ask)
