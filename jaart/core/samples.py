"""A cloud whose surface is known exactly: points on a sphere with smooth bumps and dents."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jaart.core.scene import Array, Scene, frozen

#: Points of the built-in cloud; as many as the Rabbit of [A §6] has.
COUNT = 67_038
#: Directions at which the surface's bend is bounded; no other is farther than 4/sqrt of it from all of them.
BOUND_AT = 4000
#: A height that counts as 0, in radii: what is left when it is computed on the surface.
ROUNDING = 1e-15
#: Where the height falls more slowly along a ray, the ray grazes: ROUNDING/GRAZING is all that can be said of t.
GRAZING = 1e-5
#: A grazing ray steps on so far at least, in radii.
SHORTEST = 1e-9
#: How far the inner and the outer ball stay off the surface, in radii.
CLEAR = 0.01


@dataclass(frozen=True, eq=False)
class BumpySphere:
    """The surface r(u) = radius · (1 + sum of height · exp(sharpness · (<u, centre> - 1))) around the origin.

    centres: directions (B, 3) of the bumps, unit; heights (B,), below 0 for dents; sharpness (B,): a bump is about
    1/sqrt(sharpness) radians wide. The heights must leave r above 0 everywhere: the sum of the dents above -0.99.
    """

    centres: Array
    heights: Array
    sharpness: Array
    radius: float = 1.0

    @property
    def inner(self) -> float:
        """Radius of a ball about the origin that the surface lies clearly outside of."""
        return self.radius * (1 - CLEAR + float(np.minimum(self.heights, 0).sum()))

    @property
    def outer(self) -> float:
        """Radius of a ball about the origin in which the surface lies clearly."""
        return self.radius * (1 + CLEAR + float(np.maximum(self.heights, 0).sum()))

    def exact_radius(self, directions: Array) -> Array:
        """Distance (N,) of the surface from the origin along directions (N, 3), which need not be unit."""
        return self._radius_and_slope(unit(directions))[0]

    def exact_normal(self, directions: Array) -> Array:
        """Unit normals (N, 3), outwards, of the surface's points along directions (N, 3)."""
        u = unit(directions)
        r, slope = self._radius_and_slope(u)
        return unit(r[:, None] * u - slope)

    def points_along(self, directions: Array) -> Array:
        """The surface's points (N, 3) along directions (N, 3)."""
        u = unit(directions)
        result: Array = self.exact_radius(u)[:, None] * u
        return result

    def height(self, points: Array) -> Array:
        """|x| - r(x/|x|) of points (N, 3) other than the origin: 0 on the surface, below it inside."""
        above: Array = np.sqrt((points * points).sum(axis=1)) - self.exact_radius(points)
        return above

    def hit(self, origins: Array, directions: Array) -> tuple[Array, Array]:
        """First t > 0 (R,) on the surface and the outward normals (R, 3) there; NaN where a ray misses.

        A ray that starts on the surface leaves it first.
        Each step is the longest along which a bound on the second derivative of the height leaves it no zero: none
        is stepped over, and the steps converge quadratically. origins, directions: (R, 3), of any length.
        """
        origins, directions = np.asarray(origins, dtype=np.float64), np.asarray(directions, dtype=np.float64)
        length = np.sqrt((directions * directions).sum(axis=1))
        d = directions / length[:, None]
        begin, end = _within(self.outer, origins, d)
        begin = np.maximum(begin, 0)
        start = origins + begin[:, None] * d  # near the surface, where a far origin costs no digits
        travelled = self._travelled(start, d, end - begin)
        return (begin + travelled) / length, self._normals(start + travelled[:, None] * d)

    def _travelled(self, start: Array, d: Array, end: Array) -> Array:
        """Way (R,) from start to the first hit before end, NaN when there is none."""
        s, found = np.zeros(len(d)), np.full(len(d), np.nan)
        core = _within(self.inner, start, d)
        active = np.flatnonzero(end > 0)
        side = np.ones(len(d))
        height, slope = self._height_and_slope(start[active], d[active])
        side[active] = np.where(np.where(np.abs(height) <= 4 * ROUNDING * self.radius, slope, height) < 0, -1.0, 1.0)
        while len(active):
            x = start[active] + s[active, None] * d[active]
            height, slope = (side[active] * v for v in self._height_and_slope(x, d[active]))
            arrived = (height <= ROUNDING * self.radius) & ((slope < 0) | (s[active] > GRAZING * self.radius))
            found[active[arrived]] = s[active[arrived]]
            step = _free_way(height, slope, self._bend)
            step = np.where(slope > -GRAZING, np.maximum(step, SHORTEST * self.radius), step)
            s[active] = self._past_core(s[active], step, core[0][active], core[1][active])
            active = active[~arrived & (s[active] <= end[active])]
        return found

    @staticmethod
    def _past_core(s: Array, step: Array, enter: Array, leave: Array) -> Array:
        """s + step; the inner ball, in which the bound does not hold and no surface lies, is skipped."""
        moved = np.where((s < enter) & (s + step > enter), enter, s + step)
        result: Array = np.where((s >= enter) & (s < leave), leave, moved)
        return result

    @functools.cached_property
    def _bend(self) -> float:
        """A bound on the second derivative of the height along any line outside of the inner ball.

        |x| gives 1/|x|; a bump gives at most k(2kw + 2) exp(-kw) · height · radius / |x|², k its sharpness and
        w = 1 - cos(angle) the distance from its middle, with which that falls. So the sum is largest at one of
        many directions, each taken as near to the bumps as its neighbours reach.
        """
        around = fibonacci(BOUND_AT)
        angle = np.arccos(np.clip(around @ self.centres.T, -1, 1)) - 4 / math.sqrt(BOUND_AT)
        kw = self.sharpness * (1 - np.cos(np.maximum(angle, 0)))
        bumps = (np.abs(self.heights) * self.sharpness * (2 * kw + 2) * np.exp(-kw)).sum(axis=1).max()
        return 1 / self.inner + self.radius * float(bumps) / self.inner**2

    def _radius_and_slope(self, u: Array) -> tuple[Array, Array]:
        """r (N,) at unit directions and its gradient over the unit sphere (N, 3)."""
        bumps = self.radius * self.heights * np.exp(self.sharpness * (u @ self.centres.T - 1))
        steepest = (bumps * self.sharpness) @ self.centres
        return self.radius + bumps.sum(axis=1), steepest - (steepest * u).sum(axis=1)[:, None] * u

    def _height_and_slope(self, x: Array, d: Array) -> tuple[Array, Array]:
        """The height (N,) and its derivative along d (N,)."""
        distance = np.maximum(np.sqrt((x * x).sum(axis=1)), 1e-300)
        u = x / distance[:, None]
        r, slope = self._radius_and_slope(u)
        return distance - r, (d * (u - slope / distance[:, None])).sum(axis=1)

    def _normals(self, points: Array) -> Array:
        normal = np.full(points.shape, np.nan)
        met = np.isfinite(points[:, 0])
        normal[met] = self.exact_normal(points[met])
        return normal


def fibonacci(count: int) -> Array:
    """Evenly spread unit directions (count, 3): equal steps in z, the golden angle around it."""
    z = 1 - (2 * np.arange(count) + 1) / count
    angle = math.pi * (3 - math.sqrt(5)) * np.arange(count)
    across = np.sqrt((1 - z) * (1 + z))
    return np.stack((across * np.cos(angle), across * np.sin(angle), z), axis=1)


def standard_bumps() -> BumpySphere:
    """The surface of the built-in cloud: 24 bumps and dents of four widths."""
    kind = np.arange(24) % 4
    heights = np.array([0.15, 0.05, 0.08, -0.03])[kind]
    return BumpySphere(fibonacci(24), heights, np.array([8.0, 16.0, 40.0, 80.0])[kind])


def bumpy_sphere(count: int = COUNT) -> Scene:
    """The built-in cloud "bumpy": points alone, on `standard_bumps` to the last bits, along `fibonacci` directions."""
    surface = standard_bumps()
    return Scene("bumpy", points=frozen(surface.points_along(fibonacci(count))), exact=surface)


def unit(vectors: Array) -> Array:
    """Vectors (N, 3) other than 0 at length 1."""
    result: Array = vectors / np.sqrt((vectors * vectors).sum(axis=1))[:, None]
    return result


def _free_way(height: Array, slope: Array, bend: float) -> Array:
    """The way to the first zero of height + slope·s - bend·s²/2, height >= 0, free of cancellation."""
    height = np.maximum(height, 0)
    root = np.sqrt(slope * slope + 2 * bend * height)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(slope < 0, 2 * height / (root - slope), (slope + root) / bend)


def _within(radius: float, origins: Array, d: Array) -> tuple[Array, Array]:
    """Where lines with unit directions enter and leave a ball about the origin; NaN where they miss it."""
    foot = -(origins * d).sum(axis=1)
    aside = origins + foot[:, None] * d
    distance = np.sqrt((aside * aside).sum(axis=1))
    with np.errstate(invalid="ignore"):
        half: NDArray[np.float64] = np.sqrt((radius - distance) * (radius + distance))
    return foot - half, foot + half
