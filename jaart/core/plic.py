"""Fill level <-> plane in a unit cube (PLIC), exact to rounding for every normal.

The cube is centred on the origin; a plane is {x: <n, x> = v}, n its unit normal out of the fluid and
v its distance from the centre, so that the fluid is where <n, x> <= v. Inside, the cube is mirrored
and its axes are sorted so that the fluid fills the corner below α = m1 x + m2 y + m3 z, with
0 <= m1 <= m2 <= m3, m1 + m2 + m3 = 1 and α <= 1/2. The formulas are those of Scardovelli & Zaleski
(2000), written so that every ratio is at most about 1: components of 0 or 1e-300 do no harm.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.scene import Array

#: Newton steps that reach rounding: the slope changes by less than a factor 2 from the start to the root.
STEPS = 7


def volume(distance: Array, normal: Array) -> Array:
    """The share of the cube that lies below a plane (...), from 0 to 1.

    distance: v (...), cells; normal: (..., 3), unit, of a shape that broadcasts with v.
    """
    _, m, total = _sorted(normal)
    small = _volume(np.maximum(0.5 - np.abs(distance) / total, 0.0), *m)
    return np.where(np.asarray(distance) > 0, 1 - small, small)


def distance(level: Array, normal: Array) -> Array:
    """The distance v (N,) of the plane that cuts a volume from the cube: the inverse of `volume`.

    level: (N,) in [0, 1]; normal: (N, 3), unit. For level 0 or 1 the plane touches the cube from
    outside: |v| = (|n_x| + |n_y| + |n_z|)/2.
    """
    _, m, total = _sorted(normal)
    outside = (0.5 - _alpha(np.minimum(level, 1 - level), *m)) * total
    return np.where(level > 0.5, outside, -outside)


def centroid(level: Array, normal: Array) -> Array:
    """The centre (N, 3) of the polygon in which the cube and the plane of `distance` meet.

    level: (N,) in [0, 1]; normal: (N, 3), unit. For level 0 or 1 it is the middle of what the plane
    touches: a corner, an edge or a face of the cube.
    """
    order, (m1, m2, m3), _ = _sorted(normal)
    alpha = _alpha(np.minimum(level, 1 - level), m1, m2, m3)
    x, y = _strip_centre(alpha, m1, m2, m3)
    z = np.clip((alpha - m1 * x - m2 * y) / m3, 0.0, 1.0)
    centre = np.empty_like(normal)
    np.put_along_axis(centre, order, np.stack((x, y, z), axis=-1) - 0.5, axis=-1)
    side = np.where(level > 0.5, -1.0, 1.0)[:, None] * np.where(normal < 0, -1.0, 1.0)
    result: Array = side * centre + 0.0
    return result


def _sorted(normal: Array) -> tuple[NDArray[np.intp], tuple[Array, Array, Array], Array]:
    """The order of the axes, m1 <= m2 <= m3 with sum 1, and the sum that they were divided by."""
    size = np.abs(normal)
    total = size.sum(axis=-1)
    order = np.argsort(size, axis=-1, kind="stable")
    m = np.take_along_axis(size, order, axis=-1) / total[..., None]
    return order, (m[..., 0], m[..., 1], m[..., 2]), total


def _volume(alpha: Array, m1: Array, m2: Array, m3: Array) -> Array:
    """Volume below α <= 1/2: a tetrahedron, less what sticks out of the cube, or a prism."""
    with np.errstate(all="ignore"):
        corner = alpha / m1 * (alpha / m2) * (alpha / m3) / 6
        edge = (alpha / m2 * ((alpha - m1) / m3) + m1 / m2 * (m1 / m3) / 3) / 2
        second, third = alpha - m2, alpha - m3
        edge = edge - np.where(second > 0, second * (second / m1) * (second / m2) / (6 * m3), 0.0)
        edge = edge - np.where(third > 0, third * (third / m1) * (third / m2) / (6 * m3), 0.0)
        face = (alpha - (m1 + m2) / 2) / m3
    return np.where(alpha >= m1 + m2, face, np.where(alpha < m1, corner, edge))


def _slope(alpha: Array, m1: Array, m2: Array, m3: Array) -> Array:
    """dV/dα of `_volume` for m2 <= α < m1 + m2."""
    second, third = np.maximum(alpha - m2, 0), np.maximum(alpha - m3, 0)
    slope: Array = ((alpha - m1 / 2) / m2 - (second / m1 * (second / m2) + third / m1 * (third / m2)) / 2) / m3
    return slope


def _alpha(volume: Array, m1: Array, m2: Array, m3: Array) -> Array:
    """The α at which the volume below is V <= 1/2: in closed form, or by Newton where that is a cubic."""
    with np.errstate(all="ignore"):
        first = np.where(m2 > 0, m1 / m2 * (m1 / m3) / 6, 0.0)
        second = np.where(m2 > 0, ((m2 - m1) / m3 + m1 / m2 * (m1 / m3) / 3) / 2, 0.0)
        corner = np.cbrt(6 * m3 * m2 * (m1 * volume))
        edge = m1 / 2 + np.sqrt(np.maximum(2 * m2 * m3 * volume - m1 * m1 / 12, 0))
        face = (m1 + m2) / 2 + m3 * volume
    alpha = np.where(volume < first, corner, np.where(volume < second, edge, face))
    cubic = (volume >= second) & (alpha < m1 + m2)
    alpha[cubic] = _newton(volume[cubic], m1[cubic], m2[cubic], m3[cubic])
    return np.where(volume > 0, np.minimum(alpha, 0.5), 0.0)


def _newton(volume: Array, m1: Array, m2: Array, m3: Array) -> Array:
    """Root α of V(α) = volume between m2 and m1 + m2. V is convex there, so that steps from its top stay above."""
    top = np.minimum(m1 + m2, 0.5)
    alpha = np.nextafter(top, 0)
    for _ in range(STEPS):
        step = (_volume(alpha, m1, m2, m3) - volume) / _slope(alpha, m1, m2, m3)
        alpha = np.clip(alpha - step, m2, top)
    return alpha


def _strip_centre(alpha: Array, m1: Array, m2: Array, m3: Array) -> tuple[Array, Array]:
    """Centre of the polygon seen along z: the part of the unit square with α - m3 <= m1 x + m2 y <= α."""
    area, x, y = _below(alpha, m1, m2)
    beyond = alpha > m3
    cut, cut_x, cut_y = _below(np.where(beyond, alpha - m3, 0.0), m1, m2)
    cut = np.where(beyond, cut, 0.0)
    rest = np.where(beyond, area - cut, 1.0)
    return (np.where(beyond, (area * x - cut * cut_x) / rest, x),
            np.where(beyond, (area * y - cut * cut_y) / rest, y))


def _below(alpha: Array, m1: Array, m2: Array) -> tuple[Array, Array, Array]:
    """Area and centre (x, y) of the part of the unit square with m1 x + m2 y <= α."""
    with np.errstate(all="ignore"):
        p, q = alpha / m1, alpha / m2
        t = np.where(alpha > 0, m1 / alpha, 0.0)
        u, w = (m1 + m2 - alpha) / m1, (m1 + m2 - alpha) / m2
        corner = p * q / 2, p / 3, q / 3
        edge = q * (1 - t / 2), (0.5 - t / 3) / (1 - t / 2), q / 2 * (1 - t + t * t / 3) / (1 - t / 2)
        rest = 1 - u * w / 2
        square = rest, (0.5 - u * w / 2 * (1 - u / 3)) / rest, (0.5 - u * w / 2 * (1 - w / 3)) / rest
    where = [alpha >= m1 + m2, alpha < m1, alpha < m2]
    area, x, y = (np.select(where, [full, a, b], c)
                  for full, a, b, c in zip((1.0, 0.5, 0.5), corner, edge, square, strict=True))
    return area, x, y
