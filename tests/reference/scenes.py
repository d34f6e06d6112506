"""The scenes of the reference: their surfels as exact numbers, and the settings that make all of them count at once.

cloud: an uneven ball of 300 points; moved: the same far from the origin, its coordinates rounded there; lattice: a ball
and a box in 10³ cells, whose lists of surfels are so long that they hold all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from jaart.core import prepare
from jaart.core.samples import BumpySphere, fibonacci
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Box, Sphere
from tests.reference.tangent import Array, Tangent

#: h and settings of each kind of scene: bounds are those of the reference's tracer.
CLOUD_H, LATTICE_H = 0.25, 0.8
CLOUD = Settings(h=CLOUD_H, radius=10.0, max_iterations=100, max_off_centre=CLOUD_H, max_nearest=1.5 * CLOUD_H)
LATTICE = Settings(h=LATTICE_H, radius=30.0, trust=2.5, max_iterations=100, max_off_centre=LATTICE_H,
                   max_nearest=1.5 * LATTICE_H, filling="corners", subdivision=4, border="closed")
#: How far the moved cloud is from the origin.
SHIFT = (1e6, -3e5, 2e4)
NAMES = ("cloud", "moved", "lattice")
NORMALS = ("surfel", "covariance")


@dataclass(frozen=True, eq=False)
class Surfels:
    """Points and unit normals (N, 3) of a scene."""

    points: Array
    normals: Array

    def surface(self, name: str, normal: str) -> Tangent:
        """The tangent surface of a scene with a kind of normal."""
        return Tangent(self.points, self.normals, LATTICE_H if name == "lattice" else CLOUD_H, normal)


def solids() -> Scene:
    """The lattice: levels are shares of 64 votes, so their surfels are the same bits on every machine."""
    return Scene("lattice", model=Model((Sphere((0.3, 0.35, 0.4), 0.2), Box((0.7, 0.6, 0.55), (0.3, 0.4, 0.5))), 10))


def made(name: str) -> Surfels:
    """The surfels of a scene as this machine makes them."""
    if name == "lattice":
        found = prepare.surfels(solids(), LATTICE)
        return Surfels(found.points, found.normal)
    ball = BumpySphere(fibonacci(10), np.tile([0.15, -0.08], 5), np.tile([6.0, 10.0], 5))
    points = ball.points_along(fibonacci(300))
    return Surfels(points + (SHIFT if name == "moved" else (0.0, 0.0, 0.0)), ball.exact_normal(points))


def program(name: str, stored: Surfels, normal: str) -> tuple[Scene, Settings]:
    """A scene and settings as the program takes them."""
    if name == "lattice":
        return solids(), LATTICE.replace(normal=normal)
    return Scene(name, points=stored.points, normals=stored.normals), CLOUD.replace(normal=normal)


def written(vectors: Array) -> list[str]:
    """Each vector's exact numbers, in hexadecimal."""
    return [" ".join(float(c).hex() for c in v) for v in vectors]


def read(texts: Sequence[str]) -> Array:
    """The vectors that were written."""
    return np.array([[float.fromhex(c) for c in text.split()] for text in texts])


def stored(kept: Any) -> dict[str, Surfels]:
    """The surfels of all scenes that a file keeps."""
    return {name: Surfels(read(kept[name]["points"]), read(kept[name]["normals"])) for name in NAMES}
