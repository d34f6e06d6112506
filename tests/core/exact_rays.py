"""Exact balls as something that rays can be shot at, for tests of rays behind the first hit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jaart.core.records import STATUS, Hits
from jaart.core.secondary import Shoot
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere

Array = NDArray[np.float64]


def exact_hits(balls: Sequence[Sphere], origin: Array, direction: Array, last: bool = False) -> Hits:
    """Where rays first meet the surface of any of the balls (or last), with the outward normal there."""
    t, normal = np.full(len(origin), np.nan), np.full(origin.shape, np.nan)
    for ball in balls:
        foot = ((np.array(ball.centre) - origin) * direction).sum(axis=1)
        aside = origin + foot[:, None] * direction - ball.centre
        distance = np.linalg.norm(aside, axis=1)
        half = np.sqrt(np.maximum((ball.radius - distance) * (ball.radius + distance), 0.0))
        for step in (-half, half):
            there = foot + step
            better = (distance < ball.radius) & (there > 0)
            better &= np.isnan(t) | ((there > t) if last else (there < t))
            t[better] = there[better]
            normal[better] = ((aside + step[:, None] * direction) / ball.radius)[better]
    count = np.isfinite(t).astype(np.int32)
    status = np.where(count > 0, STATUS["converged"], STATUS["background"]).astype(np.uint8)
    return Hits(origin=origin, direction=direction, t=t, point=origin + t[:, None] * direction, normal=normal,
                energy=t * 0, off_centre=t * 0, iterations=count, evaluations=count, neighbours=count, cells=count,
                lowered=0 * count, gap=np.full(len(count), np.nan), status=status, starts=count,
                eigenvectors=0 * count, gradients=0 * count, settings=Settings())


def shooting_at(*balls: Sphere) -> Shoot:
    """A function that traces rays against exact balls; any hit is the last one."""
    def shoot(origins: Array, directions: Array, any_hit: bool) -> Hits:
        return exact_hits(balls, origins, directions, last=any_hit)

    return shoot
