"""Exact solids: what they hold, and where a ray meets them.

A solid is convex, so a ray is inside it for one interval of t; everything about hits follows from
these intervals. A solid holds the points on its surface.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jaart.core.errors import SettingsError

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Vector = tuple[float, float, float]

#: Points closer to the surface than this share of the size count as on it, whatever their last bits say.
ROUNDING = 1e-12


@dataclass(frozen=True)
class Interval:
    """Where rays are inside a solid: from t = entry to exit (R,), NaN where they miss it.

    entry_normal, exit_normal: unit normals (R, 3) there, outwards of the solid.
    """

    entry: Array
    exit: Array
    entry_normal: Array
    exit_normal: Array


class Convex:
    """What a ball and a box have in common."""

    def holds(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether it holds the points (x, y, z), three arrays that broadcast."""
        raise NotImplementedError

    def interval(self, origins: Array, directions: Array) -> Interval:
        """Where the rays (R, 3) are inside, touching included."""
        raise NotImplementedError

    def contains(self, points: Array) -> Mask:
        """Whether it holds each of the points (N, 3)."""
        return self.holds(*np.asarray(points, dtype=np.float64).T)

    def hit(self, origins: Array, directions: Array) -> tuple[Array, Array]:
        """First t > 0 on its surface (R,) and outward normals there (R, 3), NaN where a ray misses."""
        return first_hit([self], origins, directions)


@dataclass(frozen=True)
class Sphere(Convex):
    """A ball. centre: (x, y, z); radius: above 0. Raises SettingsError for other values."""

    centre: Vector
    radius: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", _numbers("sphere centre", self.centre))
        object.__setattr__(self, "radius", _positive("sphere radius", self.radius))

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest corner (3,) of the box around it."""
        return np.subtract(self.centre, self.radius), np.add(self.centre, self.radius)

    def scaled(self, factor: float) -> Sphere:
        """The sphere in units that are smaller by a factor."""
        return Sphere(_times(self.centre, factor), self.radius * factor)

    def holds(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether it holds the points (x, y, z), three arrays that broadcast."""
        cx, cy, cz = self.centre
        inside: Mask = (x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2 <= (self.radius * (1 + ROUNDING)) ** 2
        return inside

    def interval(self, origins: Array, directions: Array) -> Interval:
        """Where the rays are inside. The ray's foot point on the centre keeps far origins exact."""
        with np.errstate(all="ignore"):
            squared = _dot(directions, directions)
            to_centre = np.subtract(self.centre, origins)
            foot = _dot(to_centre, directions) / squared
            aside = foot[:, None] * directions - to_centre
            distance = np.sqrt(_dot(aside, aside))
            half = np.sqrt((self.radius - distance) * (self.radius + distance) / squared)
            along = half[:, None] * directions
            return Interval(foot - half, foot + half, (aside - along) / self.radius, (aside + along) / self.radius)


@dataclass(frozen=True)
class Box(Convex):
    """A box along the axes. centre: (x, y, z); size: (width, height, depth) along x, y, z, above 0.

    Raises SettingsError for other values.
    """

    centre: Vector
    size: Vector

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", _numbers("box centre", self.centre))
        object.__setattr__(self, "size", _numbers("box size", self.size))
        for name, value in zip(("width", "height", "depth"), self.size, strict=True):
            _positive(f"box {name}", value)

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest corner (3,)."""
        half = np.divide(self.size, 2)
        return self.centre - half, self.centre + half

    def scaled(self, factor: float) -> Box:
        """The box in units that are smaller by a factor."""
        return Box(_times(self.centre, factor), _times(self.size, factor))

    def holds(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether it holds the points (x, y, z), three arrays that broadcast."""
        half = np.divide(self.size, 2) + ROUNDING * max(self.size)
        cx, cy, cz = self.centre
        inside: Mask = (np.abs(x - cx) <= half[0]) & (np.abs(y - cy) <= half[1]) & (np.abs(z - cz) <= half[2])
        return inside

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
                        _face(-facing, near.argmax(axis=1)), _face(facing, far.argmin(axis=1)))


Solid = Sphere | Box


def first_hit(solids: Sequence[Convex], origins: Array, directions: Array) -> tuple[Array, Array]:
    """Where rays first meet the surface of the union of solids.

    origins, directions: (R, 3). Returns t (R,), the first t > 0 at which the ray crosses from outside
    to inside of the union or back, and the normal (R, 3), outwards of the solid met; NaN = no hit.
    Surfaces inside another solid, and faces that two solids share, are no part of the union's surface;
    a ray that only touches a solid meets it.
    """
    origins = np.asarray(origins, dtype=np.float64).reshape(-1, 3)
    directions = np.asarray(directions, dtype=np.float64).reshape(-1, 3)
    t, normal = np.full(len(origins), np.inf), np.full((len(origins), 3), np.nan)
    spans = [solid.interval(origins, directions) for solid in solids]
    start = _leave(spans, np.zeros(len(origins)))
    inside = start > 0
    for span in spans:
        better = np.where(inside, span.exit == start, (span.entry > 0) & (span.entry < t))
        t = np.where(better, np.where(inside, span.exit, span.entry), t)
        normal = np.where(better[:, None], np.where(inside[:, None], span.exit_normal, span.entry_normal), normal)
    return np.where(np.isfinite(t), t, np.nan), normal


def _leave(spans: Sequence[Interval], t: Array) -> Array:
    """Where rays that are inside the union at t leave it; t itself where they are outside."""
    for _ in spans:
        before = t
        for span in spans:
            with np.errstate(invalid="ignore"):
                gap = np.where(t > 0, ROUNDING * (t + span.exit - span.entry), 0.0)
            t = np.where((span.entry <= t + gap) & (span.exit > t), span.exit, t)
        if np.array_equal(before, t):
            break
    return t


def _dot(a: Array, b: Array) -> Array:
    total: Array = (a * b).sum(axis=1)
    return total


def _face(sign: Array, axis: NDArray[np.intp]) -> Array:
    return np.where(np.eye(3, dtype=bool)[axis], sign, 0.0)


def _times(vector: Vector, factor: float) -> Vector:
    x, y, z = vector
    return x * factor, y * factor, z * factor


def _numbers(name: str, values: Sequence[float]) -> Vector:
    numbers = tuple(float(v) for v in values)
    if len(numbers) != 3 or not all(map(math.isfinite, numbers)):
        raise SettingsError(f"{name} = {numbers}: expected three finite numbers")
    return numbers[0], numbers[1], numbers[2]


def _positive(name: str, value: float) -> float:
    if not 0 < value < math.inf:
        raise SettingsError(f"{name} = {value:g}: expected a finite number above 0")
    return float(value)
