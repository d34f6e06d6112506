"""What all rays together took beside what is counted for each: places made ready on first use, and fits kept there."""

from __future__ import annotations

from typing import NamedTuple

from jaart.core.mesh_tracer import MeshTracer
from jaart.core.places import places_of
from jaart.core.tracers import Tracer


class Made(NamedTuple):
    """What a tracer has made so far because rays asked for it.

    gathered: places whose surfels were gathered; fits: planes or polynomials kept at centres, an evaluation each.
    """

    gathered: int = 0
    fits: int = 0


def made_by(tracer: Tracer) -> Made:
    """What a tracer has made so far; a mesh is whole before the first ray."""
    if isinstance(tracer, MeshTracer):
        return Made()
    kept = places_of(tracer.sites).kept
    return Made(kept.gathered, kept.fits)


def since(before: Made, tracer: Tracer) -> Made:
    """What a tracer has made since."""
    now = made_by(tracer)
    return Made(now.gathered - before.gathered, now.fits - before.fits)
