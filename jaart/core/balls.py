"""A cloud that rays can be sent through: what a ball needs is gathered by the first ray that asks for it, and kept."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import ball_ray
from jaart.core.kernels.bundle import NODES, ROOM, Room
from jaart.core.kernels.gather import Grid, gather_ball
from jaart.core.kernels.guess import GUESS_WIDTH
from jaart.core.kernels.leaving import ROUNDING
from jaart.core.kernels.pierce import LANES, Balls
from jaart.core.kernels.pinhole import View
from jaart.core.kernels.records import Out, Plan, Sites
from jaart.core.kernels.tree import Tree
from jaart.core.places import HEAP, Places, Pool, address, places_of, served
from jaart.core.scene import Array
from jaart.core.tiles import Pixels
from jaart.core.tracers import NO_BEGINS, NO_BLOCKS, NO_LOG

Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Cloud:
    """What all settings of a search share: points, balls around some of them, and a tree over these.

    grid: the points, sorted; centres, radii: (B, 3), (B,) of the balls; reach: (B,) how far a surfel that counts
    somewhere in a ball may be from its centre; tree: over the balls; offset: (3,) of the local frame.
    """

    grid: Grid
    centres: Array
    radii: Array
    reach: Array
    tree: Tree
    offset: Array

    @cached_property
    def leaves(self) -> Array:
        """The parts of the balls' centres and their radii, as of `Balls`."""
        made = np.zeros((4, len(self.radii) + LANES))
        made[:3, :-LANES], made[3, :-LANES] = self.centres[self.tree.order].T, self.radii[self.tree.order]
        return made.ravel()


@dataclass(frozen=True, eq=False)
class CloudTracer:
    """A cloud and how it is searched.

    cloud: points and balls; plan: how a point is evaluated and a ray searched; stretches: whether a ball is searched
    from side to side; guessing: whether the plane or polynomial at its centre is kept.
    """

    cloud: Cloud
    plan: Plan
    stretches: bool
    guessing: bool

    @cached_property
    def sites(self) -> Sites:
        """The balls, with the surfels near those that somebody asked for."""
        grid, slots = self.cloud.grid, np.zeros(len(self.cloud.radii), np.int64)
        alive = (np.append(grid.low, grid.edge), grid.shape, grid.keys, grid.points, grid.normals, grid.ids,
                 self.cloud.centres, self.cloud.reach)
        source = [len(grid.keys), *(address(array) for array in alive)]
        return Places((0, 0, 0), self.cloud.centres, slots, gather_ball, source, 6 if len(grid.normals) else 3,
                      GUESS_WIDTH if self.guessing else 0, alive, "the neighbourhoods of balls", listed=False).sites

    @property
    def offset(self) -> Array:
        """Origin (3,) of the frame that balls are in."""
        return self.cloud.offset

    @property
    def asked(self) -> Ints:
        """Numbers, rising, of the balls that rays have asked for so far."""
        return np.flatnonzero(self.sites.slots)

    @property
    def gathered(self) -> int:
        """How many balls rays have asked for so far."""
        return places_of(self.sites).kept.gathered

    @property
    def fits(self) -> int:
        """How many planes or polynomials at centres are kept: each is one evaluation."""
        return places_of(self.sites).kept.fits

    def ball(self, numbers: Ints) -> tuple[Array, Array]:
        """Centres (B, 3) in the local frame and radii (B,) of balls."""
        return self.cloud.centres[numbers], self.cloud.radii[numbers]

    def trace(self, origins: Array, directions: Array, pixels: Pixels, out: Out, log: Array = NO_LOG,
              any_hit: bool = False, begins: Array = NO_BEGINS) -> int:
        """Trace some rays, in the cloud's own coordinates, into their rows of the columns; see `Tracer`."""
        blur = ROUNDING * float(np.abs(self.cloud.offset).max())
        x, y, z = self.cloud.offset.tolist()
        done, room = 0, bundle_room()

        def ask(sites: Sites, pool: Pool) -> int:
            nonlocal done
            pool.have_heap(HEAP)
            cloud = self.cloud
            balls = Balls(sites, cloud.radii, cloud.tree, cloud.leaves, int(self.stretches), int(any_hit), (x, y, z),
                          blur)
            done, written = ball_ray.trace_ball_rays(balls, self.plan, origins, directions, pixels, done, out, log,
                                                     room, pool.work, pool.fit, pool.keys, pool.items)
            return int(written)

        return served(self.sites, ask)

    def blocks(self, view: View) -> Array:
        """Nothing is known: the tree leads rays through what is empty."""
        return NO_BLOCKS


def bundle_room() -> Room:
    """Room for the balls of a bundle."""
    return Room(np.empty(5 * ROOM), np.empty(ROOM, np.int64), np.empty(ROOM, np.int64), np.empty(NODES),
                np.empty(NODES, np.int64))
