"""A finite cylinder: what it holds, and where rays are inside."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from jaart.core.shape import (
    ROUNDING,
    Array,
    Convex,
    Interval,
    Mask,
    Vector,
    axis_vector,
    dot,
    frame_of,
    numbers,
    positive,
    times,
)


@dataclass(frozen=True)
class Cylinder(Convex):
    """A cylinder with flat ends. centre: (x, y, z), half way up; axis: "x", "y", "z" or a direction;
    radius and height: above 0. Raises SettingsError for other values.
    """

    centre: Vector
    axis: Vector
    radius: float
    height: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", numbers("cylinder centre", self.centre))
        object.__setattr__(self, "axis", axis_vector("cylinder axis", self.axis))
        object.__setattr__(self, "radius", positive("cylinder radius", self.radius))
        object.__setattr__(self, "height", positive("cylinder height", self.height))

    def extremes(self) -> Array:
        """The middles (M, 3) of its ends and the points of its rims that reach farthest along x, y and z."""
        up = np.multiply(self.axis, self.height / 2)
        across = np.vstack([np.zeros(3), frame_of(self.axis) * self.radius])
        signs = itertools.product((-1, 1), repeat=2)
        return np.concatenate([self.centre + end * up + side * across for end, side in signs])

    @property
    def thickness(self) -> float:
        """Its smallest length across."""
        return min(2 * self.radius, self.height)

    def scaled(self, factor: float) -> Cylinder:
        """The cylinder in units that are smaller by a factor."""
        return Cylinder(times(self.centre, factor), self.axis, self.radius * factor, self.height * factor)

    def holds(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether it holds the points (x, y, z), three arrays that broadcast."""
        (cx, cy, cz), (ax, ay, az) = self.centre, self.axis
        along = (x - cx) * ax + (y - cy) * ay + (z - cz) * az
        aside = (x - cx - along * ax) ** 2 + (y - cy - along * ay) ** 2 + (z - cz - along * az) ** 2
        slack = ROUNDING * max(self.radius, self.height)
        inside: Mask = (np.abs(along) <= self.height / 2 + slack) & (aside <= (self.radius + slack) ** 2)
        return inside

    def distance(self, points: Array) -> Array:
        """The distance (N,) of points (N, 3) from the surface, negative inside."""
        along, across = _split(points - self.centre, self.axis)
        beyond = np.stack([np.abs(along) - self.height / 2, np.linalg.norm(across, axis=1) - self.radius])
        distance: Array = np.linalg.norm(np.maximum(beyond, 0), axis=0) + np.minimum(beyond.max(axis=0), 0)
        return distance

    def interval(self, origins: Array, directions: Array) -> Interval:
        """Where the rays are inside both the slab between the ends and the endless cylinder."""
        origins, directions = np.broadcast_arrays(origins, directions)
        with np.errstate(all="ignore"):
            up, across = _split(directions, self.axis)
            above, away = _split(origins - self.centre, self.axis)
            ends = _crossing(-above / up, self.height / 2 / np.abs(up), up == 0, np.abs(above) <= self.height / 2)
            squared = dot(across, across)
            foot = -dot(away, across) / squared
            aside = np.where(squared[:, None] > 0, away + foot[:, None] * across, away)
            far = np.sqrt(dot(aside, aside))
            half = np.sqrt((self.radius - far) * (self.radius + far) / squared)
            wall = _crossing(foot, half, squared == 0, far <= self.radius)
            entry, leave = np.maximum(ends[0], wall[0]), np.minimum(ends[1], wall[1])
        missed = ~((entry <= leave) & np.isfinite(entry) & np.isfinite(leave))

        def normals() -> tuple[Array, Array]:
            with np.errstate(all="ignore"):
                side = [(aside + sign * half[:, None] * across) / self.radius for sign in (-1, 1)]
                cap = np.sign(up)[:, None] * self.axis
            return (np.where((ends[0] >= wall[0])[:, None], -cap, side[0]),
                    np.where((ends[1] <= wall[1])[:, None], cap, side[1]))

        return Interval(np.where(missed, np.nan, entry), np.where(missed, np.nan, leave), normals)


def _split(vectors: Array, axis: Vector) -> tuple[Array, Array]:
    """The lengths (R,) of vectors (R, 3) along a unit axis, and what is across it (R, 3)."""
    along = vectors @ np.array(axis)
    return along, vectors - along[:, None] * axis


def _crossing(middle: Array, half: Array, parallel: Mask, inside: Mask) -> tuple[Array, Array]:
    """Entry and exit: half to both sides of the middle, or always or never for parallel rays."""
    always = np.where(inside, math.inf, -math.inf)
    return np.where(parallel, -always, middle - half), np.where(parallel, always, middle + half)
