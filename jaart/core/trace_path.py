"""What a followed ray passes: the cells of a lattice or the balls of a cloud, and where its energies are sampled."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.balls import CloudTracer
from jaart.core.empty_space import distances
from jaart.core.kernels import traversal
from jaart.core.kernels.records import Empty
from jaart.core.scene import Array, frozen

#: Samples of the energies in each cell that a ray crosses, its borders included; in each ball.
SAMPLES_A_CELL = 12
SAMPLES_A_BALL = 24

Ints = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Path:
    """What a ray passes.

    cells: (C, 3) crossed, in order; borders: (C + 1,) the t where it crosses into each; with_surfel: (C,); balls:
    (B, 4) centre and radius of those pierced, in order; ts: (K,) where energies are sampled; places: (K, 3) the cell
    or ball whose neighbourhood counts there; slots: (B,) numbers of the balls in the tracer.
    """

    cells: Ints
    borders: Array
    with_surfel: NDArray[np.bool_]
    balls: Array
    ts: Array
    places: NDArray[np.int64]
    slots: NDArray[np.int64] | None = None

    def numbered(self, places: Ints) -> Ints:
        """Places (S, 3) of steps: cells as they are, of balls their numbers here, -1 for one that is not among them."""
        if self.slots is None:
            return places
        found = places[:, :1] == self.slots
        number = np.where(found.any(axis=1), found.argmax(axis=1) if found.size else -1, -1)
        return whole(np.column_stack((number, places[:, 1:])))


def lattice_path(empty: Empty, o: Array, d: Array) -> Path:
    """The cells a ray crosses; energies evenly in each, with both sides of each border."""
    size = sum(empty.shape) + 3
    cells, borders = np.empty((size, 3), np.int32), np.empty(size + 1)
    n = traversal.crossed(o, d, empty.shape, cells, borders)
    cells, borders = whole(cells[:n]), borders[:n + 1] if n else borders[:0]
    share = np.linspace(0.0, 1.0, SAMPLES_A_CELL)
    ts = (borders[:-1, None] + np.diff(borders)[:, None] * share).ravel() if n else np.empty(0)
    places = np.repeat(cells.astype(np.int64), SAMPLES_A_CELL, axis=0)
    return Path(cells, frozen(borders), distances(empty, cells) == 0, frozen(np.empty((0, 4))), ts, places)


def cloud_path(tracer: CloudTracer, o: Array, d: Array) -> Path:
    """The gathered balls that a ray pierces; energies evenly along them, each with the ball whose centre is nearest.

    o, d: in the cloud's local frame.
    """
    slots, span = pierced(tracer, o, d)
    centres, radii = tracer.ball(slots)
    balls = np.column_stack((centres + tracer.offset, radii)) if len(slots) else np.empty((0, 4))
    ts, places = np.empty(0), np.empty((0, 3), np.int64)
    if len(slots):
        ts = np.linspace(max(span[0, 0], 0.0), span[:, 1].max(), min(SAMPLES_A_BALL * len(slots), 2000))
        foot = (centres - o) @ d
        aside = np.linalg.norm(centres - o - foot[:, None] * d, axis=1)
        apart = np.hypot(ts[:, None] - foot, aside) - radii
        nearest = apart.argmin(axis=1)
        within = apart[np.arange(len(ts)), nearest] <= 0
        ts, places = ts[within], np.zeros((int(within.sum()), 3), np.int64)
        places[:, 0] = slots[nearest[within]]
    return Path(whole(np.empty((0, 3))), frozen(np.empty(0)), np.empty(0, bool), frozen(balls), ts, places,
                slots)


def pierced(tracer: CloudTracer, o: Array, d: Array) -> tuple[NDArray[np.int64], Array]:
    """The gathered balls ahead that a ray pierces, in order, and where it enters and leaves each (B, 2)."""
    slots = tracer.asked
    centres, radii = tracer.ball(slots)
    foot = (centres - o) @ d
    aside = np.linalg.norm(centres - o - foot[:, None] * d, axis=1)
    half = np.sqrt(np.maximum((radii - aside) * (radii + aside), 0.0))
    met = np.flatnonzero((aside <= radii) & (foot + half > 0))
    order = met[np.argsort((foot - half)[met], kind="stable")]
    return slots[order], np.column_stack((foot - half, foot + half))[order]


def whole(numbers: NDArray[Any]) -> Ints:
    """Read-only whole numbers."""
    result = numbers.astype(np.int32)
    result.flags.writeable = False
    return result
