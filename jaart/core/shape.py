"""What all exact solids have in common: the intervals of a ray in them, from which hits and fill levels follow."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jaart.core.errors import SettingsError

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Vector = tuple[float, float, float]

#: Points closer to the surface than this share of the size count as on it, whatever their last bits say.
ROUNDING = 1e-12
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


@dataclass(frozen=True)
class Interval:
    """Where rays are inside a solid: from t = entry to exit (R,), NaN where they miss it.

    normals: gives the unit normals (R, 3) at entry and at exit, outwards of the solid, to who asks.
    """

    entry: Array
    exit: Array
    normals: Callable[[], tuple[Array, Array]]


class Shape:
    """A solid, the points on its surface included. Each is a frozen record with a `centre`."""

    centre: Vector

    def holds(self, x: Array, y: Array, z: Array) -> Mask:
        """Whether it holds the points (x, y, z), three arrays that broadcast."""
        raise NotImplementedError

    def intervals(self, origins: Array, directions: Array) -> tuple[Interval, ...]:
        """Where the rays (R, 3) are inside, touching included: as many intervals for each ray as it can have."""
        raise NotImplementedError

    def distance(self, points: Array) -> Array:
        """A bound (N,) of the distance of points (N, 3) from the surface, negative inside."""
        raise NotImplementedError

    def extremes(self) -> Array:
        """The points (M, 3) where it begins and ends along x, y and z, and its edges parallel to them."""
        raise NotImplementedError

    @property
    def thickness(self) -> float:
        """Its smallest length across."""
        raise NotImplementedError

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest corner (3,) of the box around it."""
        points = self.extremes()
        return points.min(axis=0), points.max(axis=0)

    def sides(self, low: Array, edge: float) -> tuple[Mask, Mask]:
        """Which cubes (N,) with lowest corners low (N, 3) lie surely inside it, and which surely outside."""
        distance, reach = self.distance(low + edge / 2), math.sqrt(3) / 2 * edge
        return distance < -reach, distance > reach

    def contains(self, points: Array) -> Mask:
        """Whether it holds each of the points (N, 3)."""
        return self.holds(*np.asarray(points, dtype=np.float64).T)


class Convex(Shape):
    """A solid that a ray is inside of once."""

    def interval(self, origins: Array, directions: Array) -> Interval:
        """Where the rays (R, 3) are inside, touching included."""
        raise NotImplementedError

    def intervals(self, origins: Array, directions: Array) -> tuple[Interval, ...]:
        """The one interval of each ray (R, 3)."""
        return (self.interval(origins, directions),)


def around(centre: Vector, half: Array) -> Array:
    """The points (6, 3) that lie half (3,) before and behind a centre along each axis."""
    steps = np.diag(half)
    return np.concatenate([centre - steps, centre + steps])


def dot(a: Array, b: Array) -> Array:
    """Scalar products (R,) of rows."""
    total: Array = np.einsum("...j,...j->...", a, b)
    return total


def times(vector: Vector, factor: float) -> Vector:
    """The vector in units that are smaller by a factor."""
    x, y, z = vector
    return x * factor, y * factor, z * factor


def numbers(name: str, values: Sequence[float]) -> Vector:
    """Three finite numbers. Raises SettingsError for others."""
    found = tuple(float(v) for v in values)
    if len(found) != 3 or not all(map(math.isfinite, found)):
        raise SettingsError(f"{name} = {found}: expected three finite numbers")
    return found[0], found[1], found[2]


def positive(name: str, value: float) -> float:
    """A finite number above 0. Raises SettingsError for another."""
    if not 0 < value < math.inf:
        raise SettingsError(f"{name} = {value:g}: expected a finite number above 0")
    return float(value)


def axis_vector(name: str, axis: str | Sequence[float]) -> Vector:
    """The unit vector along an axis: "x", "y", "z" or a direction. Raises SettingsError for others."""
    if isinstance(axis, str):
        if axis not in AXES:
            raise SettingsError(f"{name} = {axis!r}: expected x, y, z or a direction")
        return AXES[axis]
    direction = numbers(name, axis)
    largest = max(map(abs, direction))
    if largest == 0:
        raise SettingsError(f"{name} = {direction}: expected a direction that is not 0")
    x, y, z = (v / largest for v in direction)
    length = math.hypot(x, y, z)
    # a vector that already has unit length keeps its bits
    return direction if abs(math.hypot(*direction) - 1) < 4e-16 else (x / length, y / length, z / length)


def frame_of(axis: Vector) -> Array:
    """Unit vectors (3, 3) across an axis, row k as close to the k-th axis as they can be; zero rows if none is."""
    across = np.eye(3) - np.outer(axis, axis)
    length = np.linalg.norm(across, axis=1, keepdims=True)
    return np.where(length > ROUNDING, across / np.where(length > ROUNDING, length, 1), 0.0)
