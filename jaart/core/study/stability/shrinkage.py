"""Rows 8 to 11: dense spheres, cylinders and slabs, whose surface is known in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from jaart.core.notes import notes
from jaart.core.samples import fibonacci
from jaart.core.scene import Array, Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Box
from jaart.core.study.stability.case import Outcome, case, counted
from jaart.core.study.stability.scenes import cloud, plane, shot

#: h is 1. Balls that reach to the middle, a search that misses nothing, and no bound on what is found.
DENSE = Settings(search="safe", ball_k=100, tolerance=1e-9, max_nearest="none", max_off_centre="none").replace(
    h=1.0, radius=7.0)


@case(8, "dense spheres of 1.25, 1.5, 2 and 4 h", "radii 0.3191, 1.0136, 1.7071, 3.8708 h, to 1e-3")
def dense_spheres() -> Outcome:
    """The barycentre in a dense sphere lies at R(coth q - 1/q), q = 2rR/h²: the surface is where that is r.

    Of 60 rays from all around the one that is farthest off counts.
    """
    got: dict[float, Array] = {}
    exact: dict[float, float] = {}
    for radius, pairs in ((1.25, 300), (1.5, 300), (2.0, 300), (4.0, 1500)):
        around = fibonacci(pairs)
        both, rays = np.vstack((around, -around)), fibonacci(60)
        hits = shot(cloud(radius * both, both), DENSE, 9.0 * rays, -rays)
        got[radius] = np.linalg.norm(hits.point, axis=1)
        exact[radius] = _fixed(in_sphere, radius)
    return _compared(got, exact, 1e-3)


@case(9, "dense cylinders of 0.95, 1.05, 1.5 and 3 h", "none, then radii 0.4386, 1.2869, 2.9129 h, to 1e-6")
def dense_cylinders() -> Outcome:
    """The barycentre lies at R I1(q)/I0(q): below R = h no other than the axis is its own.

    Rays across the axis, through it and beside it. Even samples of a periodic function are exact at once.
    """
    got: dict[float, Array] = {}
    exact: dict[float, float] = {}
    for radius in (0.95, 1.05, 1.5, 3.0):
        turns = np.linspace(0.1, 2 * math.pi + 0.1, 24, endpoint=False)
        out = np.column_stack((np.cos(turns), np.sin(turns), 0 * turns))
        beside = 0.1 * np.column_stack((-np.sin(turns), np.cos(turns), 0 * turns))
        hits = shot(_tube(radius), DENSE, np.vstack((9 * out, 9 * out + beside)), np.vstack((-out, -out)))
        got[radius] = np.linalg.norm(hits.point[:, :2], axis=1)
        exact[radius] = _fixed(in_tube, radius)
    none = got.pop(0.95)
    rest = _compared(got, exact, 1e-6)
    return Outcome(f"0.95 h: {np.isfinite(none).sum()} hits, {rest.got}", rest.holds and bool(np.isnan(none).all()))


@case(10, "slabs 1.2 and 1.4 h thick", "no hit, and of a model's box a note: thinner than √2 h")
def slabs_that_are_too_thin() -> Outcome:
    """Between two sheets f < 0 but in the middle, where it touches 0 and the normal is not defined."""
    origins = np.array([(0, 0, 5), (0.2, 0.1, 5), (0.3, -0.2, 5), (0.1, 0.3, -5)])
    down = -np.sign(origins[:, 2:]) * (0, 0, 1)
    hits = [shot(_slab(thickness), DENSE, origins, down) for thickness in (1.2, 1.4)]
    box = Scene("case", model=Model((Box((0.5, 0.5, 0.5), (0.6, 0.6, 0.125)),), 24))
    said = notes(box, Settings().replace(h=3 / 1.4))
    return Outcome(f"{counted(hits[0].counts())}; {counted(hits[1].counts())}; {'; '.join(said)}",
                   not any(found.hit.any() for found in hits) and len(said) == 1
                   and f"sheets below {math.sqrt(2) * 3 / 1.4:.4g} (1.414 h) collapse" in said[0])


@case(11, "slabs 1.44, 1.6, 2 and 3 h thick", "half thicknesses 0.2316, 0.5891, 0.9575, 1.4996 h, to 1e-6")
def slabs_that_stay() -> Outcome:
    """The barycentre lies at s tanh(2sz/h²) above the middle, s half the distance of the sheets."""
    got: dict[float, Array] = {}
    exact: dict[float, float] = {}
    for thickness in (1.44, 1.6, 2.0, 3.0):
        origins = np.array([(0, 0, 5), (0.2, 0.1, 5), (0.3, -0.2, -5)])
        hits = shot(_slab(thickness), DENSE, origins, -np.sign(origins[:, 2:]) * (0, 0, 1))
        got[thickness] = np.abs(hits.point[:, 2])
        exact[thickness] = _fixed(in_slab, thickness / 2)
    return _compared(got, exact, 1e-6)


def in_sphere(r: float, radius: float) -> float:
    """Distance of the barycentre from the middle of a dense sphere, seen at r; h is 1."""
    return radius / math.tanh(2 * r * radius) - 1 / (2 * r)


def in_tube(r: float, radius: float) -> float:
    """The same in a dense cylinder."""
    from scipy.special import ive

    return float(radius * ive(1, 2 * r * radius) / ive(0, 2 * r * radius))


def in_slab(z: float, half: float) -> float:
    """The same between two dense sheets at half and -half."""
    return half * math.tanh(2 * half * z)


def _fixed(barycentre: Callable[[float, float], float], size: float) -> float:
    """Where a point is its own barycentre, 0 where only the middle is."""
    low, high = 1e-3, size
    if barycentre(low, size) < low:
        return 0.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if barycentre(middle, size) > middle else (low, middle)
    return low


def _compared(got: dict[float, Array], exact: dict[float, float], close: float) -> Outcome:
    """Distances of hits from the middle against those in closed form, each by its size in h."""
    off = {size: float(np.abs(found - exact[size]).max()) for size, found in got.items()}
    words = ", ".join(f"{size:g} h: {found.mean():.4f} ± {off[size]:.1e}" for size, found in got.items())
    return Outcome(f"{words} from the closed form", all(error <= close for error in off.values()))


def _tube(radius: float, spacing: float = 0.3) -> Scene:
    """A cylinder about z, 10 h long."""
    turns = np.linspace(0, 2 * math.pi, round(2 * math.pi * radius / spacing), endpoint=False)
    out = np.column_stack((np.cos(turns), np.sin(turns), 0 * turns))
    heights = spacing * np.arange(-17, 18)
    return cloud((radius * out + heights[:, None, None] * np.array((0, 0, 1.0))).reshape(-1, 3),
                 np.tile(out, (len(heights), 1)))


def _slab(thickness: float) -> Scene:
    """Two sheets whose normals point away from each other."""
    sheet = plane(13, 0.45, thickness / 2)
    assert sheet.points is not None and sheet.normals is not None
    return cloud(np.vstack((sheet.points, sheet.points * (1, 1, -1))), np.vstack((sheet.normals, -sheet.normals)))
