"""Exact solids, and where a ray first meets the surface of their union."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from jaart.core.shape import AXES, ROUNDING, Array, Convex, Interval, Mask, Shape, Vector
from jaart.core.shape_box import Box
from jaart.core.shape_cylinder import Cylinder
from jaart.core.shape_ellipsoid import Ellipsoid
from jaart.core.shape_sphere import Sphere
from jaart.core.shape_torus import Torus

__all__ = ["AXES", "ROUNDING", "Array", "Mask", "Vector", "Interval", "Shape", "Convex", "Solid", "Sphere", "Box",
           "Torus", "Cylinder", "Ellipsoid", "first_hit"]

Solid = Sphere | Box | Torus | Cylinder | Ellipsoid


def first_hit(solids: Sequence[Shape], origins: Array, directions: Array) -> tuple[Array, Array]:
    """Where rays first meet the surface of the union of solids.

    origins, directions: (R, 3). Returns t (R,), the first t > 0 at which the ray crosses from outside
    to inside of the union or back, and the normal (R, 3), outwards of the solid met; NaN = no hit.
    Surfaces inside another solid, and faces that two solids share, are no part of the union's surface;
    a ray that only touches a solid meets it.
    """
    origins = np.asarray(origins, dtype=np.float64).reshape(-1, 3)
    directions = np.asarray(directions, dtype=np.float64).reshape(-1, 3)
    t, normal = np.full(len(origins), np.inf), np.full((len(origins), 3), np.nan)
    spans = [span for solid in solids for span in solid.intervals(origins, directions)]
    start = _leave(spans, np.zeros(len(origins)))
    inside = start > 0
    for span in spans:
        better = np.where(inside, span.exit == start, (span.entry > 0) & (span.entry < t))
        t = np.where(better, np.where(inside, span.exit, span.entry), t)
        at_entry, at_exit = span.normals()
        normal = np.where(better[:, None], np.where(inside[:, None], at_exit, at_entry), normal)
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
