"""A ring torus: what it holds, and where rays are inside, by the quartic of their crossings."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from jaart.core.errors import SettingsError
from jaart.core.shape import (
    AXES,
    ROUNDING,
    Array,
    Interval,
    Mask,
    Shape,
    Vector,
    axis_vector,
    dot,
    frame_of,
    numbers,
    positive,
    times,
)
from jaart.core.torus_roots import Line, crossings


@dataclass(frozen=True)
class Torus(Shape):
    """A ring around an axis. centre: (x, y, z); axis: "x", "y", "z" or a direction; major: radius of the
    ring's middle line; minor: radius of its tube, above 0 and below major. Raises SettingsError for other values.
    """

    centre: Vector
    axis: Vector
    major: float
    minor: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", numbers("torus centre", self.centre))
        object.__setattr__(self, "axis", axis_vector("torus axis", self.axis))
        object.__setattr__(self, "major", positive("torus major radius", self.major))
        object.__setattr__(self, "minor", positive("torus minor radius", self.minor))
        if not self.minor < self.major:
            raise SettingsError(f"torus minor radius = {self.minor:g}: expected it below the major, {self.major:g}")

    def extremes(self) -> Array:
        """The points (M, 3) of the tube's outer and inner side that reach farthest along x, y and z."""
        rows, tube = frame_of(self.axis), np.array(list(AXES.values())) * self.minor
        ring = np.where(rows.any(axis=1, keepdims=True), rows, np.roll(rows, 1, axis=0)) * self.major
        offsets = [ring + tube, ring - tube]
        return np.concatenate([self.centre + sign * offset for sign, offset in itertools.product((-1, 1), offsets)])

    @property
    def thickness(self) -> float:
        """Its smallest length across."""
        return 2 * self.minor

    def scaled(self, factor: float) -> Torus:
        """The torus in units that are smaller by a factor."""
        return Torus(times(self.centre, factor), self.axis, self.major * factor, self.minor * factor)

    def holds(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether it holds the points (x, y, z), three arrays that broadcast."""
        (cx, cy, cz), (ax, ay, az) = self.centre, self.axis
        above = (x - cx) * ax + (y - cy) * ay + (z - cz) * az
        away = np.sqrt((x - cx - above * ax) ** 2 + (y - cy - above * ay) ** 2 + (z - cz - above * az) ** 2)
        inside: Mask = (away - self.major) ** 2 + above**2 <= (self.minor + ROUNDING * self.major) ** 2
        return inside

    def distance(self, points: Array) -> Array:
        """The distance (N,) of points (N, 3) from the surface, negative inside."""
        offset = points - self.centre
        above = offset @ np.array(self.axis)
        away = np.linalg.norm(offset - above[:, None] * self.axis, axis=1)
        distance: Array = np.hypot(away - self.major, above) - self.minor
        return distance

    def intervals(self, origins: Array, directions: Array) -> tuple[Interval, ...]:
        """Two intervals of each ray, before and behind the middle, NaN where it has none there.

        Rays are based on their foot points on the centre, which keeps far origins exact.
        """
        axis = np.array(self.axis)
        with np.errstate(all="ignore"):
            length = np.sqrt(dot(directions, directions))
            along = directions / length[:, None]
            to_centre = np.subtract(self.centre, origins)
            foot = dot(to_centre, along)
            aside = foot[:, None] * along - to_centre
            above, up = aside @ axis, along @ axis
            away, across = aside - above[:, None] * axis, along - up[:, None] * axis
            line = Line(above, up, dot(away, away), dot(away, across), dot(across, across))

        def interval(entry: Array, leave: Array) -> Interval:
            def normal(t: Array) -> Array:
                with np.errstate(all="ignore"):
                    radial = away + t[:, None] * across
                    radius = np.sqrt(dot(radial, radial))[:, None]
                    middle = radial * (1 - self.major / radius) + (above + t * up)[:, None] * axis
                    outwards: Array = middle / np.sqrt(dot(middle, middle))[:, None]
                    return outwards

            return Interval((foot + entry) / length, (foot + leave) / length, lambda: (normal(entry), normal(leave)))

        with np.errstate(all="ignore"):
            first, second = crossings(line, self.major, self.minor)
            return interval(*first), interval(*second)
