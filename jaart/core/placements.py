"""Where a cell's surfel lies: fill level and normal -> point, as the thesis does it and exactly.

Each placement but the last is a plane across the normal: p = c + v n, c the cell's centre, v the
signed distance in cells [T 3.3]. t is the distance from c to the cell's boundary along n.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from jaart.core import plic
from jaart.core.scene import Array


def box(level: Array, normal: Array) -> Array:
    """v = 2(l - 1/2)t (N,): the cell taken as a box along the normal [T §3.1.2].

    level: l (N,) in [0, 1]; normal: (N, 3), unit.
    """
    result: Array = 2 * (level - 0.5) * _to_boundary(normal)
    return result


def sphere(level: Array, normal: Array) -> Array:
    """v (N,) with the cell taken as a ball of radius t [T §3.1.2, figure 3.6].

    level: l (N,) in [0, 1]; normal: (N, 3), unit.
    """
    return _cap(level, _to_boundary(normal))


def sphere_half(level: Array, normal: Array) -> Array:
    """v (N,) with the cell taken as a ball of radius 1/2, whatever the normal [T §3.1.2, figure 3.6].

    level: l (N,) in [0, 1]; normal: (N, 3), unit.
    """
    return _cap(level, np.full(len(normal), 0.5))


def interpolated(level: Array, normal: Array) -> Array:
    """v (N,) between the exact values of an axis-aligned and a diagonal normal, linearly in t [T §3.1.2].

    level: l (N,) in [0, 1]; normal: (N, 3), unit.
    """
    share = (_to_boundary(normal) - 0.5) / (np.sqrt(3) / 2 - 0.5)
    result: Array = (1 - share) * (level - 0.5) + share * _diagonal(level)
    return result


def exact(level: Array, normal: Array) -> Array:
    """v (N,) of the plane that cuts the volume l from the cell; beyond the sources (Scardovelli & Zaleski 2000).

    level: l (N,) in [0, 1]; normal: (N, 3), unit. The point may leave the cell, by up to 0.21 along n for l = 1.
    """
    return plic.distance(level, normal)


def offsets(placement: str, level: Array, normal: Array) -> Array:
    """Points minus their cells' centres (N, 3), in cells.

    placement: a name of `PLACEMENTS`; level: (N,) in [0, 1]; normal: (N, 3), unit, out of the fluid.
    """
    if placement == CENTROID:
        return plic.centroid(level, normal)
    return ALONG_NORMAL[placement](level, normal)[:, None] * normal


def _to_boundary(normal: Array) -> Array:
    """t, from the centre of a unit cube to its boundary along the normal."""
    result: Array = 0.5 / np.abs(normal).max(axis=1)
    return result


def _cap(level: Array, radius: Array) -> Array:
    """v = H - r of the cap of height H with π H²(3r - H)/3 = l 4πr³/3.

    With s = H/2r that is s²(3 - 2s) = l, which trisects an angle: the one below comes from the
    smaller of l and 1 - l, so that it holds for the smallest cap.
    """
    angle = np.pi / 6 - 2 / 3 * np.arcsin(np.sqrt(np.minimum(level, 1 - level)))
    result: Array = np.where(level > 0.5, 2.0, -2.0) * radius * np.sin(angle)
    return result


def _diagonal(level: Array) -> Array:
    """v for a normal along the cube's diagonal [T figure 3.7].

    V = (√3/2)s³ up to s = 1/√3 from the corner, where V = 1/6; between, (√3/2)(s³ - 3(s - 1/√3)³),
    which in v = s - √3/2 is an angle's third again.
    """
    small = np.minimum(level, 1 - level)
    tip = np.sqrt(3) / 2 - np.cbrt(2 / np.sqrt(3) * small)
    middle = np.sin(np.arcsin(np.minimum(4 / np.sqrt(3) * (0.5 - small), 1.0)) / 3)
    result: Array = np.where(level > 0.5, 1.0, -1.0) * np.where(small < 1 / 6, tip, middle)
    return result


#: Placements p = c + v n by name, each (level (N,), unit normal (N, 3)) -> v (N,).
ALONG_NORMAL: dict[str, Callable[[Array, Array], Array]] = {
    "box": box, "sphere": sphere, "sphere_half": sphere_half, "interpolated": interpolated, "exact": exact}
#: The placement that takes the centre of the exact plane's polygon instead.
CENTROID = "exact_centroid"
#: Every placement's name.
PLACEMENTS = (*ALONG_NORMAL, CENTROID)
