"""Which exact solids are too small for h: the tangent surface shrinks by h²/2R, and round things end where R is small.

Inside a dense sphere of radius R the barycentre lies at R(coth q - 1/q) of the middle, q = 2rR/h², in a tube at
R I1(q)/I0(q), between two sheets at distance 2s at s tanh(2sr/h²): below √1.5 h, h and √2 h no point but the middle is
its own barycentre. What ends, rims and coarse samples leave there are specks near the middle and along rims. A
polynomial of degree 2 follows the bend: it still holds a sphere of 0.8 h, though not one of 0.7 h; of it nothing is
said.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from jaart.core import extents, prepare
from jaart.core.chosen import Chosen
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Box, Cylinder, Solid, Sphere, Torus

#: Radius of a sphere and of a tube, and distance of two sheets, below which they collapse, in h.
SPHERE, TUBE, SHEETS = math.sqrt(1.5), 1.0, math.sqrt(2)
#: A smaller radius of the neighbourhood, in h, cuts off the other side, on which a collapse hangs.
WHOLE = 2.0
#: Other solids nearer than this, in h, hold a small one up.
APART = 2.0
#: At most so many solids are named.
MOST = 3


class Limit(NamedTuple):
    """A length of a solid, the least one at which it stays, in h, and what it is then like."""

    name: str
    length: float
    least: float
    like: str


def limits(solid: Solid) -> tuple[Limit, ...]:
    """What must not be too small in a solid, in its own units.

    The least length of an ellipsoid is as that of two sheets, its middle one as a tube's, its largest as a sphere's.
    """
    if isinstance(solid, Sphere):
        return (Limit("radius", solid.radius, SPHERE, "spheres"),)
    if isinstance(solid, Cylinder):
        return Limit("radius", solid.radius, TUBE, "tubes"), Limit("height", solid.height, SHEETS, "sheets")
    if isinstance(solid, Torus):
        return (Limit("minor radius", solid.minor, TUBE, "tubes"),)
    if isinstance(solid, Box):
        return (Limit("thickness", solid.thickness, SHEETS, "sheets"),)
    least, middle, largest = sorted(solid.semi_axes)
    return (Limit("thickness", 2 * least, SHEETS, "sheets"), Limit("middle semi-axis", middle, TUBE, "tubes"),
            Limit("largest semi-axis", largest, SPHERE, "spheres"))


def collapsing(scene: Scene, settings: Settings, values: Chosen) -> tuple[str, ...]:
    """In words, which of a model's solids collapse at this h.

    Said of a solid that lies whole in the lattice, apart from the others; nothing is said where the law does not
    hold: other surfaces, weights other than the Gaussian, neighbourhoods that end too soon.
    """
    if scene.model is None or not _holds(values):
        return ()
    solids = prepare.solids(scene, settings) or ()
    size, apart = extents.largest(scene, settings), APART * values.h
    boxes = np.array([solid.bounds for solid in solids]).reshape(-1, 2, 3)
    said = []
    for number, solid in enumerate(solids):
        small = [one for one in limits(solid) if one.length < one.least * values.h]
        if small and (boxes[number] >= 0).all() and (boxes[number] <= size).all() and _alone(boxes, number, apart):
            said.append(_words(solid, number, small[0], values.h))
    more = len(said) - MOST
    return (*said[:MOST], *([f"so it is with {more} more of the solids"] if more > 0 else []))


def _holds(values: Chosen) -> bool:
    return (values.method == "tangent" and values.search not in ("minimise", "centres")
            and values.weight == "gaussian" and values.neighbourhood.endswith("ball")
            and values.radius >= WHOLE * values.h)


def _alone(boxes: Array, number: int, apart: float) -> bool:
    """Whether the box (low, high) of a solid is farther than this from those of all others."""
    low, high = boxes[number]
    gap = np.maximum(boxes[:, 0] - high, low - boxes[:, 1]).max(axis=1)
    gap[number] = math.inf
    return bool((gap > apart).all())


def _words(solid: Solid, number: int, small: Limit, h: float) -> str:
    return (f"{type(solid).__name__.lower()} {number + 1} has a {small.name} of {small.length:.4g}: at h = {h:.4g} "
            f"{small.like} below {small.least * h:.4g} ({small.least:.4g} h) collapse, and little is left of them")
