"""A box along the axes: what it holds, and where rays are inside."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jaart.core.shape import ROUNDING, Array, Convex, Interval, Mask, Vector, numbers, positive, times


@dataclass(frozen=True)
class Box(Convex):
    """A box along the axes. centre: (x, y, z); size: (width, height, depth) along x, y, z, above 0.

    Raises SettingsError for other values.
    """

    centre: Vector
    size: Vector

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", numbers("box centre", self.centre))
        object.__setattr__(self, "size", numbers("box size", self.size))
        for name, value in zip(("width", "height", "depth"), self.size, strict=True):
            positive(f"box {name}", value)

    def extremes(self) -> Array:
        """Its corners (8, 3)."""
        half = np.divide(self.size, 2)
        return np.array([self.centre + half * signs for signs in itertools.product((-1, 1), repeat=3)])

    @property
    def thickness(self) -> float:
        """Its smallest length across."""
        return min(self.size)

    def scaled(self, factor: float) -> Box:
        """The box in units that are smaller by a factor."""
        return Box(times(self.centre, factor), times(self.size, factor))

    def holds(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether it holds the points (x, y, z), three arrays that broadcast."""
        half = np.divide(self.size, 2) + ROUNDING * max(self.size)
        cx, cy, cz = self.centre
        inside: Mask = (np.abs(x - cx) <= half[0]) & (np.abs(y - cy) <= half[1]) & (np.abs(z - cz) <= half[2])
        return inside

    def distance(self, points: Array) -> Array:
        """The distance (N,) of points (N, 3) from the surface, negative inside."""
        beyond = np.abs(points - self.centre) - np.divide(self.size, 2)
        distance: Array = np.linalg.norm(np.maximum(beyond, 0), axis=1) + np.minimum(beyond.max(axis=1), 0)
        return distance

    def interval(self, origins: Array, directions: Array) -> Interval:
        """Where the rays are inside: between the last slab they enter and the first they leave."""
        low, high = self.bounds
        parallel = np.equal(directions, 0)
        inside = (low <= origins) & (origins <= high)
        with np.errstate(all="ignore"):
            to_low, to_high = (low - origins) / directions, (high - origins) / directions
            near = np.where(parallel, np.where(inside, -np.inf, np.inf), np.minimum(to_low, to_high))
            far = np.where(parallel, np.where(inside, np.inf, -np.inf), np.maximum(to_low, to_high))
            facing = np.sign(directions)
        entry, leave = near.max(axis=1), far.min(axis=1)
        missed = ~((entry <= leave) & np.isfinite(entry) & np.isfinite(leave))
        return Interval(np.where(missed, np.nan, entry), np.where(missed, np.nan, leave),
                        lambda: (_face(-facing, near.argmax(axis=1)), _face(facing, far.argmin(axis=1))))


def _face(sign: Array, axis: NDArray[np.intp]) -> Array:
    return np.where(np.eye(3, dtype=bool)[axis], sign, 0.0)
