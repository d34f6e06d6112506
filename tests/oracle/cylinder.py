"""The hit of a ray with bare surfels by the points in a cylinder around it (Schaufler & Jensen 2000, named in [A §2]).

[A] says of it: "They collect points within a cylinder around the ray and compute a weighted average surface location",
and that the geometry then depends on the ray. The definition taken here, for a ray o + s·d with |d| = 1 and a radius r:

1. Every surfel is a disc: its point p_i, its unit normal n_i, the radius r; both faces count. The ray hits the disc at
   s_i = <p_i - o, n_i> / <d, n_i> when |<d, n_i>| > 1e-12, s_i >= s_min and |o + s_i·d - p_i| < r.
   The first hit, s_0, is the least s_i (the lower id of equal ones). Without one, the ray misses.
2. The cylinder has the ray as its axis, the radius r and the length 2r, with its middle at s_0. It holds the surfels
   with d_i = |p_i - o - <p_i - o, d>·d| < r and |<p_i - o, d> - s_0| <= r; it so holds all whose disc is hit at s_0.
3. Of these, the ones whose plane meets the axis within the cylinder take part: |s_i - s_0| <= r (not necessarily on the
   disc); a surfel seen edge-on says nothing about the position. The first one hit always does.
4. Weights fall linearly with the distance from the axis: w_i = r - d_i (positive).
5. The hit is at s = Σw_i s_i / Σw_i with the normal Σw_i n_i / |Σw_i n_i|. When |Σw_i n_i| <= 1e-8 Σw_i the normal is
   undefined, and the ray has no hit there. There is no second try behind it.

On a plane every s_i is the same, so the hit is exact from any direction. r must exceed the largest hole of the cloud.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from tests.oracle.normals import UNDEFINED
from tests.oracle.vectors import Vector, along, dot, mean, minus, times

#: A disc is edge-on when |<d, n>| is not above this.
PARALLEL = 1e-12


@dataclass
class CylinderHit:
    """status: hit, background (no disc met) or undefined_normal; t and normal are None without a hit.

    first: t of the first disc met; ids: the surfels that take part, in order of id.
    """

    status: str
    t: float | None = None
    normal: list[float] | None = None
    first: float | None = None
    ids: list[int] | None = None


def plane_hit(origin: Vector, direction: Vector, p: Vector, n: Vector) -> float | None:
    """Where the ray meets the plane through p with normal n; None when it runs along it."""
    cosine = dot(direction, n)
    return dot(minus(p, origin), n) / cosine if abs(cosine) > PARALLEL else None


def axis_distance(origin: Vector, direction: Vector, p: Vector) -> tuple[float, float]:
    """<p - o, d> and the distance of p from the line of the ray."""
    away = minus(p, origin)
    s = dot(away, direction)
    return s, math.hypot(*minus(away, times(direction, s)))


def first_disc(origin: Vector, direction: Vector, points: Sequence[Vector], normals: Sequence[Vector], radius: float,
               s_min: float = 0.0) -> float | None:
    """s_0: the least s >= s_min at which the ray hits a disc (step 1)."""
    hits = []
    for p, n in zip(points, normals, strict=True):
        s = plane_hit(origin, direction, p, n)
        if s is not None and s >= s_min and math.dist(along(origin, direction, s), p) < radius:
            hits.append(s)
    return min(hits, default=None)


def cylinder_hit(origin: Vector, direction: Vector, points: Sequence[Vector], normals: Sequence[Vector],
                 radius: float, s_min: float = 0.0) -> CylinderHit:
    """The hit of a ray, |direction| = 1, by the five steps above."""
    first = first_disc(origin, direction, points, normals, radius, s_min)
    if first is None:
        return CylinderHit("background")
    ids, places, weights = [], [], []
    for i, (p, n) in enumerate(zip(points, normals, strict=True)):
        foot, distance = axis_distance(origin, direction, p)
        s = plane_hit(origin, direction, p, n)
        if distance < radius and abs(foot - first) <= radius and s is not None and abs(s - first) <= radius:
            ids.append(i)
            places.append(s)
            weights.append(radius - distance)
    total = math.fsum(weights)
    normal = mean([normals[i] for i in ids], weights)
    length = math.hypot(*normal)
    if length <= UNDEFINED:
        return CylinderHit("undefined_normal", first=first, ids=ids)
    t = math.fsum(w * s for w, s in zip(weights, places, strict=True)) / total
    return CylinderHit("hit", t, times(normal, 1 / length), first, ids)
