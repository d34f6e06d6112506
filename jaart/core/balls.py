"""A cloud that rays can be sent through: what a ball needs is gathered when the first ray asks for it, and kept.

A ray that comes to a ball whose surfels are not gathered stops there. When all rays of a tile have ended or
stopped, the balls they ask for are gathered, and those that stopped begin again. So the result is that of a
cloud with every ball ready, and nothing is gathered that no ray asked for.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import ball_ray, gather, guess
from jaart.core.kernels.ball_ray import NOTHING, ROOM, Balls
from jaart.core.kernels.gather import Grid
from jaart.core.kernels.leaving import ROUNDING
from jaart.core.kernels.pinhole import View
from jaart.core.kernels.records import Out, Plan, Sites
from jaart.core.kernels.tree import Tree
from jaart.core.scene import Array
from jaart.core.tiles import Pixels, columns_for
from jaart.core.tracers import NO_BEGINS, NO_BLOCKS, NO_LOG, scratch

Ints = NDArray[np.int64]
#: Room for the heap at first; it doubles where a ray needs more.
HEAP = 4096


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


@dataclass(eq=False)
class CloudTracer:
    """A cloud and how it is searched.

    cloud: points and balls; plan: how a point is evaluated and a ray searched; stretches: whether a ball is searched
    from side to side; guessing: whether the plane or polynomial at its centre is kept.
    """

    cloud: Cloud
    plan: Plan
    stretches: bool
    guessing: bool
    _balls: Balls = field(init=False, repr=False)
    _lock: Any = field(default_factory=Lock, init=False, repr=False)
    _heap: int = field(default=HEAP, init=False, repr=False)
    _most: int = field(default=1, init=False, repr=False)

    def __post_init__(self) -> None:
        nothing = Sites((0, 0, 0), np.empty((0, 3)), np.zeros(1, np.int64), np.empty(0, np.int32), np.empty(0))
        self._balls = Balls(nothing, np.full(len(self.cloud.radii), -1), 0, self.cloud.centres,
                            self.cloud.radii, self.cloud.tree, np.empty((0, guess.GUESS_WIDTH)), int(self.stretches), 0,
                            ROUNDING * float(np.abs(self.cloud.offset).max()))

    @property
    def sites(self) -> Sites:
        """The balls gathered so far, with the surfels near each."""
        return self._balls.sites

    @property
    def offset(self) -> Array:
        """Origin (3,) of the frame that balls are in."""
        return self.cloud.offset

    @property
    def gathered(self) -> int:
        """How many balls rays have asked for so far."""
        return self._balls.ready

    def ball(self, slots: Ints) -> tuple[Array, Array]:
        """Centres (B, 3) in the local frame and radii (B,) of gathered balls."""
        number = np.full(self.gathered, -1)
        known = np.flatnonzero((self._balls.slot >= 0) & (self._balls.slot < self.gathered))
        number[self._balls.slot[known]] = known
        return self.cloud.centres[number[slots]], self.cloud.radii[number[slots]]

    def scratch(self) -> tuple[Array, Array]:
        """Room for the weights and fits of the ball with the most surfels."""
        return scratch(self._most)

    @property
    def fits(self) -> int:
        """How many planes or polynomials at centres were made: each is one evaluation."""
        return self._balls.ready if self.guessing else 0

    def trace(self, origins: Array, directions: Array, pixels: Pixels, out: Out, log: Array = NO_LOG,
              any_hit: bool = False, begins: Array = NO_BEGINS) -> int:
        """Trace some rays, in the cloud's own coordinates, into their rows of the columns; see `Tracer`."""
        local = origins[pixels] - self.cloud.offset
        ways, rows, todo, written = directions[pixels], np.arange(len(pixels)), np.arange(len(pixels)), 0
        mine = columns_for(len(pixels))
        while len(todo):
            missing = np.full(len(todo), NOTHING)
            balls = self._balls._replace(any_hit=int(any_hit))
            work, fit = self.scratch()
            keys, items = np.empty(self._heap), np.empty(self._heap, np.int64)
            written = ball_ray.trace_ball_rays(balls, self.plan, local, ways, rows[todo], mine, log, missing, work, fit,
                                               keys, items)
            if (missing == ROOM).any():
                self._heap = 2 * len(keys)
            self._gather(np.unique(missing[missing >= 0]))
            todo = todo[missing != NOTHING]
        mine.point[:] += self.cloud.offset
        for name, column in out._asdict().items():
            column[pixels] = getattr(mine, name)
        return int(written)

    def blocks(self, view: View) -> Array:
        """Nothing is known: the tree leads rays through what is empty."""
        return NO_BLOCKS

    def _gather(self, balls: Ints) -> None:
        """Gather the surfels near some balls, and what is kept at their centres, behind those that are there."""
        with self._lock:
            before = self._balls
            new = balls[before.slot[balls] < 0]
            if not len(new):
                return
            first, ids, columns = gathered(self.cloud, new)
            sites, at = before.sites, before.ready
            total = int(sites.first[at])
            made = Sites((0, 0, 0), _behind(sites.centres, at, self.cloud.centres[new]),
                         _behind(sites.first, at + 1, total + first[1:]), _behind(sites.ids, total, ids),
                         _behind(sites.columns, 6 * total, columns))
            self._most = max(self._most, int(np.diff(first).max()))
            guesses = before.guesses
            if self.guessing:
                fitted = np.empty((len(new), guess.GUESS_WIDTH))
                guess.fit_centres(made, self.plan, at, fitted, *self.scratch())
                guesses = _behind(guesses, at, fitted)
            before.slot[new] = np.arange(at, at + len(new))
            self._balls = before._replace(sites=made, ready=at + len(new), guesses=guesses)


def gathered(cloud: Cloud, balls: Ints) -> tuple[Ints, NDArray[np.int32], Array]:
    """The surfels within reach of some balls: first (B + 1,), ids and columns as in records.Sites."""
    centres, reach, first = cloud.centres[balls], cloud.reach[balls], np.zeros(len(balls) + 1, np.int64)
    gather.gather(cloud.grid, centres, reach, first, np.empty(0, np.int32), np.empty(0), 0)
    np.cumsum(first, out=first)
    ids, columns = np.empty(first[-1], np.int32), np.empty(6 * first[-1])
    gather.gather(cloud.grid, centres, reach, first, ids, columns, 1)
    return first, ids, columns


def _behind(kept: Any, used: int, more: Any) -> Any:
    """An array whose first `used` entries are those kept, followed by more; with room to grow.

    What is kept stays where it is while there is room: other threads read it.
    """
    need = used + len(more)
    if len(kept) < need:
        larger = np.empty((max(need, 2 * len(kept)), *kept.shape[1:]), kept.dtype)
        larger[:used] = kept[:used]
        kept = larger
    kept[used:need] = more
    return kept
