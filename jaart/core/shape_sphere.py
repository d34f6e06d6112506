"""A ball: what it holds, and where rays are inside."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from jaart.core.shape import ROUNDING, Array, Convex, Interval, Mask, Vector, around, dot, numbers, positive, times


@dataclass(frozen=True)
class Sphere(Convex):
    """A ball. centre: (x, y, z); radius: above 0. Raises SettingsError for other values."""

    centre: Vector
    radius: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", numbers("sphere centre", self.centre))
        object.__setattr__(self, "radius", positive("sphere radius", self.radius))

    def extremes(self) -> Array:
        """The points (6, 3) where it begins and ends along x, y and z."""
        return around(self.centre, np.full(3, self.radius))

    @property
    def thickness(self) -> float:
        """Its smallest length across."""
        return 2 * self.radius

    def scaled(self, factor: float) -> Sphere:
        """The sphere in units that are smaller by a factor."""
        return Sphere(times(self.centre, factor), self.radius * factor)

    def holds(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether it holds the points (x, y, z), three arrays that broadcast."""
        cx, cy, cz = self.centre
        inside: Mask = (x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2 <= (self.radius * (1 + ROUNDING)) ** 2
        return inside

    def distance(self, points: Array) -> Array:
        """The distance (N,) of points (N, 3) from the surface, negative inside."""
        away: Array = np.linalg.norm(points - self.centre, axis=1)
        return away - self.radius

    def interval(self, origins: Array, directions: Array) -> Interval:
        """Where the rays are inside."""
        return ball_interval(np.subtract(self.centre, origins) / self.radius, directions / self.radius, np.ones(3))


def ball_interval(to_centre: Array, directions: Array, stretch: Array) -> Interval:
    """Where rays (R, 3) are inside the unit ball whose centre lies at to_centre from their origins.

    The ray's foot point on the centre keeps far origins exact. stretch (3,): the factors that made the
    ball out of an ellipsoid, whose normals are given.
    """
    with np.errstate(all="ignore"):
        squared = dot(directions, directions)
        foot = dot(to_centre, directions) / squared
        aside = foot[:, None] * directions - to_centre
        distance = np.sqrt(dot(aside, aside))
        half = np.sqrt((1 - distance) * (1 + distance) / squared)

    def normals() -> tuple[Array, Array]:
        with np.errstate(all="ignore"):
            along = half[:, None] * directions
            both = ((aside - along) * stretch, (aside + along) * stretch)
            return both if (stretch == 1).all() else (unit(both[0]), unit(both[1]))

    return Interval(foot - half, foot + half, normals)


def unit(vectors: Array) -> Array:
    """The vectors (R, 3) at unit length."""
    length: Array = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / length
