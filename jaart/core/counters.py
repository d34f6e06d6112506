"""What all rays together took beside what is counted for each: places made ready on first use, and fits kept there."""

from __future__ import annotations

from typing import NamedTuple

from jaart.core.balls import CloudTracer
from jaart.core.tracers import Tracer


class Made(NamedTuple):
    """What a tracer has made so far because rays asked for it.

    gathered: places whose surfels were gathered; fits: planes or polynomials kept at centres, an evaluation each.
    """

    gathered: int = 0
    fits: int = 0


def made_by(tracer: Tracer) -> Made:
    """What a tracer has made so far; a lattice's table and a mesh are whole before the first ray."""
    return Made(tracer.gathered, tracer.fits) if isinstance(tracer, CloudTracer) else Made()


def since(before: Made, tracer: Tracer) -> Made:
    """What a tracer has made since."""
    now = made_by(tracer)
    return Made(now.gathered - before.gathered, now.fits - before.fits)
