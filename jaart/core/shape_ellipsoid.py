"""An ellipsoid along the axes: a ball in coordinates divided by its semi-axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from jaart.core.shape import ROUNDING, Array, Convex, Interval, Mask, Vector, around, numbers, positive, times
from jaart.core.shape_sphere import ball_interval


@dataclass(frozen=True)
class Ellipsoid(Convex):
    """An ellipsoid along the axes. centre: (x, y, z); semi_axes: half its lengths along x, y, z, above 0.

    Raises SettingsError for other values.
    """

    centre: Vector
    semi_axes: Vector

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", numbers("ellipsoid centre", self.centre))
        object.__setattr__(self, "semi_axes", numbers("ellipsoid semi-axes", self.semi_axes))
        for name, value in zip("xyz", self.semi_axes, strict=True):
            positive(f"ellipsoid semi-axis along {name}", value)

    def extremes(self) -> Array:
        """The points (6, 3) where it begins and ends along x, y and z."""
        return around(self.centre, np.array(self.semi_axes))

    @property
    def thickness(self) -> float:
        """Its smallest length across."""
        return 2 * min(self.semi_axes)

    def scaled(self, factor: float) -> Ellipsoid:
        """The ellipsoid in units that are smaller by a factor."""
        return Ellipsoid(times(self.centre, factor), times(self.semi_axes, factor))

    def holds(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether it holds the points (x, y, z), three arrays that broadcast."""
        (cx, cy, cz), (a, b, c) = self.centre, self.semi_axes
        inside: Mask = ((x - cx) / a) ** 2 + ((y - cy) / b) ** 2 + ((z - cz) / c) ** 2 <= (1 + ROUNDING) ** 2
        return inside

    def distance(self, points: Array) -> Array:
        """A bound (N,) of the distance of points (N, 3) from the surface, negative inside."""
        ratio: Array = np.linalg.norm((points - self.centre) / self.semi_axes, axis=1)
        return (ratio - 1) * min(self.semi_axes)

    def sides(self, low: Array, edge: float) -> tuple[Mask, Mask]:
        """Which cubes (N,) lie surely inside it, and which outside: by their farthest and nearest points."""
        before, behind = (low - self.centre) / self.semi_axes, (low + edge - self.centre) / self.semi_axes
        farthest = np.maximum(np.abs(before), np.abs(behind))
        nearest = np.maximum(0, np.maximum(before, -behind))
        return np.linalg.norm(farthest, axis=1) < 1, np.linalg.norm(nearest, axis=1) > 1

    def interval(self, origins: Array, directions: Array) -> Interval:
        """Where the rays are inside."""
        stretch = 1 / np.array(self.semi_axes)
        return ball_interval(np.subtract(self.centre, origins) * stretch, directions * stretch, stretch)
