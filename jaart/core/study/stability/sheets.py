"""Rows 12 to 16: sheets close to each other, and a single surfel."""

from __future__ import annotations

import math

import numpy as np

from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings
from jaart.core.study.stability.case import Outcome, case, counted, largest
from jaart.core.study.stability.scenes import cloud, plane, shot

#: h is 1; balls as large as two sheets together, and no bound on what is found.
CLOSE = Settings(search="safe", ball_k=100, tolerance=1e-9, max_nearest="none", max_off_centre="none").replace(
    h=1.0, radius=6.0)
#: Distances of two sheets below √2 h.
GAPS = (1.0, 1.3, 1.4)
#: From above, from beneath, and from between two sheets down and up.
ORIGINS = np.array([(0.0, 0, 5), (0.2, 0.1, 5), (0, 0, -5), (0.2, 0.1, -5), (0.2, 0.1, 0.4), (0.2, 0.1, -0.4)])
DIRECTIONS = np.array([(0.0, 0, -1), (0, 0, -1), (0, 0, 1), (0, 0, 1), (0, 0, -1), (0, 0, 1)])


def circle(count: int) -> Array:
    """Unit directions (count, 3) around z."""
    turns = np.linspace(0, 2 * math.pi, count, endpoint=False)
    return np.column_stack((np.cos(turns), np.sin(turns), 0 * turns))


def pair(gap: float, below: float) -> Scene:
    """Two even sheets, normals up, those of the lower one times a sign."""
    sheet = plane(12, 0.45, gap / 2)
    assert sheet.points is not None and sheet.normals is not None
    return cloud(np.vstack((sheet.points, sheet.points * (1, 1, -1))),
                 np.vstack((sheet.normals, below * sheet.normals)))


def heights(gap: float, normal: str) -> Array:
    """Where rays down, up, and from between meet two sheets that face the same way; NaN for none."""
    z: Array = shot(pair(gap, 1.0), CLOSE.replace(normal=normal), ORIGINS, DIRECTIONS).point[:, 2]
    return z


@case(12, "two sheets that face the same way, 1.0, 1.3 and 1.4 h apart",
      "they merge: below √2 h there is one sheet, in the middle, from above, beneath and between")
def sheets_that_merge() -> Outcome:
    """f = s tanh(2sz/h²) - z has its only zero at z = 0 while 2s < √2 h, and falls through it."""
    worst = largest([np.abs(heights(gap, normal)) for gap in GAPS for normal in ("surfel", "covariance")])
    beyond = sum(int(shot(pair(gap, 1.0), CLOSE, (0.2, 0.1, -0.01), (0, 0, -1)).hit.sum()) for gap in GAPS)
    return Outcome(f"36 rays meet z = 0, off by up to {worst:.1e} h; {beyond} of 3 a sheet beyond it",
                   worst <= 1e-6 and beyond == 0)


@case(13, "two sheets that face the same way, 2 and 1.6 h apart",
      "two hits, at z = ±0.9575 and ±0.5891 h; none in the middle, where f rises through 0")
def ghost_between_two_sheets() -> Outcome:
    """f has three zeros. In the middle one ∇f points along n: no sheet, but what divides the two.

    Rays from between meet the sheet beyond the middle, so they have passed the third zero. At 1.6 h the middle is no
    zero of a covariance's f but a gap in it: its normal is not defined there, for the sheets are as far apart as the
    neighbourhood is wide.
    """
    sides = np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
    off = [float(np.abs(heights(gap, normal) - z * sides).max()) for gap, z in ((2.0, 0.957504), (1.6, 0.589141))
           for normal in ("surfel", "covariance")]
    return Outcome(f"24 rays meet ±0.957504 and ±0.589141 h, off by up to {largest(off):.1e} h", largest(off) <= 1e-6)


@case(14, "rays in the plane midway between two sheets with opposite normals",
      "undefined_normal: the normals cancel there")
def midway_between_opposite_normals() -> Outcome:
    """|Σθn| is below 1e-8 of Σθ. A ray from that plane up meets the upper sheet from within, as it should."""
    along = circle(12)
    ends = [shot(pair(2.0, -1.0), CLOSE.replace(search=search), 0.1 * along, along).counts()
            for search in ("safe", "march")]
    up = float(shot(pair(2.0, -1.0), CLOSE, (0.2, 0.1, 0.0), (0, 0, 1)).t[0])
    return Outcome(f"{counted(ends[0])}; {counted(ends[1])}; straight up t = {up:.4f}",
                   ends == [{"undefined_normal": 12}] * 2 and abs(up - 0.957504) < 1e-6)


@case(15, "a single surfel, rays at 45°", "t = √2, to 1 ulp")
def a_single_surfel() -> Outcome:
    """Its plane; a disc of it, for the ball around a point without neighbours has the radius h."""
    one, aside = cloud([(0, 0, 0)], [(0, 0, 1)]), np.array([(0.0, 0, 0), (0.4, 0.3, 0), (-0.2, 0.5, 0), (0, -0.9, 0)])
    directions = np.array([(1.0, 0, -1), (0, 1, -1), (-1, 0, -1), (1, 0, -1)])
    errors = []
    for search in ("iterate", "secant", "newton", "safe", "march"):
        hits = shot(one, Settings(search=search, tolerance=0).replace(h=1.0), aside - directions, directions)
        errors.append(float(np.abs(hits.t - math.sqrt(2)).max()))
    return Outcome(f"4 rays, 5 searches: largest error {largest(errors):.1e}",
                   largest(errors) <= np.spacing(math.sqrt(2)))


@case(16, "a single surfel, rays that pass it at 100 h", "a miss: there is no surface so far from all surfels")
def a_ray_far_beside_a_surfel() -> Outcome:
    """The plane goes on for ever, but balls end; and no bound is needed for that."""
    one, around = cloud([(0, 0, 0)], [(0, 0, 1)]), 100.0 * circle(200)
    ends: dict[str, int] = {}
    for search in ("iterate", "safe"):
        hits = shot(one, CLOSE.replace(search=search), around + (0, 0, 5), np.tile((0.0, 0.0, -1.0), (200, 1)))
        for name, count in hits.counts().items():
            ends[name] = ends.get(name, 0) + count
    return Outcome(counted(ends), ends == {"background": 400})
