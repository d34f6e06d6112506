"""The plane that one step of an iteration is shown in, and coordinates in it [T §3.4]."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from jaart.core.records import Trace

Array = NDArray[np.float64]

#: Below this distance (cells) from the ray a point does not fix the plane's direction.
COLLINEAR = 1e-9

_CORNERS = np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)], dtype=float)
_EDGES = np.array([(a, a | bit) for a in range(8) for bit in (1, 2, 4) if not a & bit])


@dataclass(frozen=True, eq=False)
class Plane:
    """A plane through a ray.

    origin: the ray's origin (3,); u: the ray's direction; v: unit vector across it; through: what
    besides the ray lies in it: the barycentre, or where that is on the ray the normal or the up
    direction.
    """

    origin: Array
    u: Array
    v: Array
    through: Literal["barycentre", "normal", "up"] = "barycentre"

    @functools.cached_property
    def normal(self) -> Array:
        """Unit normal u × v of the plane."""
        return np.cross(self.u, self.v)

    def coordinates(self, points: Array) -> Array:
        """Points (N, 3) or (3,) dropped onto the plane: t along the ray and distance across it (N, 2)."""
        return self.components(np.asarray(points) - self.origin)

    def components(self, vectors: Array) -> Array:
        """Vectors (N, 3) or (3,) in the plane's axes (N, 2)."""
        return np.asarray(vectors) @ np.stack([self.u, self.v], axis=1)

    def heights(self, points: Array) -> Array:
        """Signed distances (N,) of points (N, 3) from the plane."""
        heights: Array = (np.asarray(points) - self.origin) @ self.normal
        return heights


def plane(trace: Trace, step: int, camera_up: Array | tuple[float, float, float] = (0.0, 0.0, 1.0)) -> Plane:
    """The plane through x_i, a(x_i) and x_{i+1}, turned so that n(x_i) does not point down in it [T §3.4].

    step: number of the step, from 0; camera_up: (3,), holds where x_i, a(x_i), x_{i+1} are collinear
    and n(x_i) is parallel to the ray. Both x lie on the ray, so the plane is the ray's with a(x_i).
    """
    u = trace.direction / np.linalg.norm(trace.direction)
    towards: tuple[tuple[Literal["barycentre", "normal", "up"], Array], ...] = (
        ("barycentre", trace.barycentre[step] - trace.query[step]),
        ("normal", trace.step_normal[step]),
        ("up", np.asarray(camera_up, dtype=float)),
    )
    for through, vector in towards:
        across = vector - (vector @ u) * u
        length = float(np.linalg.norm(across))
        if length > COLLINEAR:
            side = -1.0 if trace.step_normal[step] @ across < -COLLINEAR else 1.0
            return Plane(trace.origin, u, side * across / length, through)
    return Plane(trace.origin, u, _any_across(u), "up")


def section(plane: Plane, cell: NDArray[np.int32] | tuple[int, int, int]) -> Array:
    """The polygon (M, 2) in which a plane cuts the unit cell with the given index (3,); M = 0 when it does not."""
    corners = _CORNERS + np.asarray(cell)
    heights = plane.heights(corners)
    heights[np.abs(heights) < COLLINEAR] = 0.0
    below, above = heights[_EDGES[:, 0]], heights[_EDGES[:, 1]]
    cut = below * above < 0
    share = (below[cut] / (below[cut] - above[cut]))[:, None]
    start, end = corners[_EDGES[cut, 0]], corners[_EDGES[cut, 1]]
    points = np.concatenate([corners[heights == 0], start + share * (end - start)])
    if len(points) < 3:
        return np.empty((0, 2))
    flat = plane.coordinates(points)
    around = flat - flat.mean(axis=0)
    polygon: Array = flat[np.argsort(np.arctan2(around[:, 1], around[:, 0]))]
    return polygon


def _any_across(u: Array) -> Array:
    axis = np.eye(3)[np.argmin(np.abs(u))]
    across = axis - (axis @ u) * u
    unit: Array = across / np.linalg.norm(across)
    return unit
