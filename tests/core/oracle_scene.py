"""Small scenes, rays through them, and what the slow oracle makes of a prepared scene's surfels."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache

import numpy as np
from numpy.typing import NDArray

from jaart.core import prepare
from jaart.core.chosen import Chosen
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Box, Sphere
from tests import naive_cells
from tests.oracle import energies, neighbourhoods, searches, surfaces
from tests.oracle.normals import NORMALS
from tests.oracle.projection import project
from tests.oracle.vectors import Vector, along, dot

Array = NDArray[np.float64]
Cell = tuple[int, int, int]


@cache
def scene_of(name: str) -> Scene:
    """The standard model in 12³ cells, or noise in 7×5×6 of which a third is interface."""
    if name == "standard":
        solids = (Sphere((0.7, 0.7, 0.7), 0.25), Box((0.3, 0.5, 0.4), (0.2, 0.4, 0.3)))
        return Scene("standard", model=Model(solids, 12))
    rng = np.random.default_rng(11)
    levels = rng.uniform(0, 1, (7, 5, 6))
    levels[rng.uniform(size=levels.shape) < 0.7] = 0.0
    return Scene("random", levels=levels)


def rays_of(size: Array, count: int, seed: int = 5) -> tuple[Array, Array]:
    """Rays from all around through points of a box from the origin to size."""
    rng = np.random.default_rng(seed)
    targets, eyes = rng.uniform(0.15, 0.85, (count, 3)) * size, rng.normal(size=(count, 3))
    eyes = targets + eyes / np.linalg.norm(eyes, axis=1, keepdims=True) * 2.5 * size.max()
    return eyes, (targets - eyes) / np.linalg.norm(targets - eyes, axis=1, keepdims=True)


def grazing_rays(count: int, seed: int = 6) -> tuple[Array, Array]:
    """Rays past the ball of the standard scene, from clearly inside to clearly outside of its silhouette."""
    rng = np.random.default_rng(seed)
    origins, directions = [], []
    for miss in np.linspace(-0.25, 0.1, count):
        aside, towards = np.linalg.qr(rng.normal(size=(3, 2)))[0].T
        origins.append(12 * 0.7 + (12 * 0.25 + miss) * aside - 20 * towards)
        directions.append(towards)
    return np.array(origins), np.array(directions)


@dataclass
class Oracle:
    """The surfels of a prepared lattice, and what its settings ask for, by the slow oracle."""

    points: list[list[float]]
    normals: list[list[float]]
    settings: Settings
    values: Chosen
    extent: Cell
    _lists: dict[Cell, list[int]] = field(default_factory=dict)

    @classmethod
    def of(cls, scene: Scene, settings: Settings) -> Oracle:
        """The oracle of a lattice scene."""
        ready = prepare.prepared(scene, settings)
        nx, ny, nz = (int(n) for n in prepare.extent(scene, settings))
        found = ready.surfels
        return cls(found.points.tolist(), found.normal.tolist(), settings, ready.values, (nx, ny, nz))

    def cell_of(self, x: Vector) -> Cell:
        """The cell of the lattice that holds x."""
        i, j, k = (min(max(math.floor(c), 0), n - 1) for c, n in zip(x, self.extent, strict=True))
        return i, j, k

    def near(self, cell: Cell, x: Vector) -> list[int]:
        """Ids of the surfels that count at x, whose cell is given; in order of id."""
        kind = self.values.neighbourhood
        if kind == "ball":
            return neighbourhoods.ball(x, self.points, self.values.radius)
        if kind == "knn":
            return sorted(neighbourhoods.knn(x, self.points, self.settings.k))
        if cell not in self._lists:
            self._lists[cell] = (neighbourhoods.cell_ball(cell, self.points, self.values.radius)
                                 if kind == "cell_ball" else
                                 sorted(neighbourhoods.cell_knn(cell, self.points, self.settings.k)))
        return self._lists[cell]

    def surfels(self, cell: Cell, x: Vector) -> tuple[list[list[float]], list[list[float]]]:
        """Points and normals that count at x."""
        ids = self.near(cell, x)
        return [self.points[i] for i in ids], [self.normals[i] for i in ids]

    def f(self, cell: Cell, x: Vector) -> float | None:
        """The implicit function of the method."""
        points, normals = self.surfels(cell, x)
        v, degree = self.values, self.settings.degree
        if not points:
            return None
        if v.method == "polynomial":
            return surfaces.polynomial(x, points, normals, v.h, degree, v.weight, v.normal)
        if v.method == "projection":
            found = project(x, points, normals, v.h, degree, v.weight, v.normal)
            return None if found is None else found.value
        return surfaces.tangent(x, points, normals, v.h, v.weight, v.normal)

    def n(self, cell: Cell, x: Vector) -> list[float] | None:
        """The normal n(x)."""
        points, normals = self.surfels(cell, x)
        return NORMALS[self.values.normal](x, points, normals, self.values.h, self.values.weight).vector

    def energy(self, cell: Cell, x: Vector, d: Vector) -> float | None:
        """The energy that is minimised, never negative."""
        points, normals = self.surfels(cell, x)
        v, e = self.values, None
        if not points:
            return None
        if v.method == "off_centre":
            e = energies.e_oc(x, points, v.h, v.weight)
        elif v.method == "mahalanobis":
            e = energies.e_mahalanobis(x, points, normals, v.h, self.settings.mahalanobis_c, v.weight)
        elif v.method == "angle":
            e = energies.e_angle(x, points, normals, v.h, v.weight, v.normal)
        else:
            e = energies.e_ts(x, d, points, normals, v.h, v.weight, v.normal)
        if self.settings.emphasise:
            e = energies.emphasised(energies.e_angle(x, points, normals, v.h, v.weight, v.normal), e)
        return None if e is None else abs(e)

    def is_sheet(self, cell: Cell, x: Vector) -> bool:
        """Whether f falls along n at x, and x is within the off-centre bound: else a root is no surface."""
        n, off = self.n(cell, x), self.off_centre(cell, x)
        if n is None or off is None or off > self.values.off_centre:
            return False
        above, below = ((self.f(cell, along(x, n, s)), self.n(cell, along(x, n, s))) for s in (1e-5, -1e-5))
        heights = [value * math.copysign(1, dot(m, n)) for value, m in (above, below)
                   if value is not None and m is not None]
        return len(heights) == 2 and heights[0] <= heights[1]

    def off_centre(self, cell: Cell, x: Vector) -> float | None:
        """|a(x) - x|."""
        return energies.e_oc(x, self.surfels(cell, x)[0], self.values.h, self.values.weight)


@dataclass
class Stretch:
    """A ray's way through one cell."""

    cell: Cell
    enter: float
    leave: float

    def along(self, value: Callable[[Cell, Vector], float | None], o: Vector, d: Vector) -> searches.Function:
        """A function of t, made of one of a cell and a point."""
        return lambda t: value(self.cell, along(o, d, t))


def stretches(oracle: Oracle, o: Vector, d: Vector) -> list[Stretch]:
    """The cells that a ray crosses."""
    crossed = naive_cells.crossed_cells(o, d, oracle.extent)
    return [Stretch(c.cell, float(c.enter), float(c.leave)) for c in crossed]


def face_distance(x: Vector) -> float:
    """How far a point is from the nearest face of a cell."""
    return min(abs(c - round(c)) for c in x)
