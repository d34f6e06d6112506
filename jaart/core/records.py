"""The records that stages hand to each other: frozen, arrays read-only."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.camera import Camera
from jaart.core.settings import Settings

if TYPE_CHECKING:
    from jaart.core.cloud_surfels import Points
    from jaart.core.surfels import Surfels

Array = NDArray[np.float64]
Ints = NDArray[np.int32]

#: Named ends of a ray; the position in the tuple is the number in `Hits.status`.
STATUS_NAMES = ("converged", "background", "cap", "left_trust", "parallel", "few_neighbours",
                "undefined_normal", "bounded", "floor", "undecided", "bad_ray", "bounded_weight", "bounded_nearest",
                "bounded_angle", "bounded_gap")
STATUS = {name: number for number, name in enumerate(STATUS_NAMES)}


@dataclass(frozen=True, eq=False)
class Hits:
    """One entry for each ray: where it met the surface, and what that took.

    origin, direction: (R, 3); t: distance along the unit direction, NaN = no hit; point, normal: (R, 3),
    NaN = no hit; energy: length of the last step |e_ts| [T 2.20]; off_centre: |a(x) - x| [T 2.22];
    iterations: steps of the start that hit, of the last one without a hit; evaluations: of all starts, one or
    more a step; neighbours: surfels summed over the evaluations; cells: cells or balls visited (skipped ones are
    not); lowered: evaluations whose polynomial has fewer degrees than asked for; gap: (λ1 - λ0)/λ2 of a hit where
    min_gap asks for it, else NaN;
    status: index into STATUS_NAMES; starts: searches begun; eigenvectors: of covariances, for n(x); gradients: passes
    over the surfels for ∇f in closed form.
    size: (width, height) of a picture, row by row from the top, None for a list of rays.
    prep_s, ray_s: wall seconds of preparation and of all rays; gathered, fits: places of a cloud made ready for these
    rays, and planes or polynomials kept at their centres.
    """

    origin: Array
    direction: Array
    t: Array
    point: Array
    normal: Array
    energy: Array
    off_centre: Array
    iterations: Ints
    evaluations: Ints
    neighbours: Ints
    cells: Ints
    lowered: Ints
    gap: Array
    status: NDArray[np.uint8]
    starts: Ints
    eigenvectors: Ints
    gradients: Ints
    settings: Settings
    camera: Camera | None = None
    size: tuple[int, int] | None = None
    prep_s: float = 0.0
    ray_s: float = 0.0
    gathered: int = 0
    fits: int = 0

    @property
    def hit(self) -> NDArray[np.bool_]:
        """Whether each ray met the surface (converged, or stopped at the precision floor)."""
        found: NDArray[np.bool_] = (self.status == STATUS["converged"]) | (self.status == STATUS["floor"])
        return found

    @property
    def from_behind(self) -> NDArray[np.bool_]:
        """Whether each ray met the surface's inner side, as it does from within the object: <n, d> > 0.

        Normals point outwards, and shading turns them to the viewer. Covariance normals of a cloud that has none of
        its own are on no side; then this means nothing.
        """
        across: Array = np.einsum("ij,ij->i", self.normal, self.direction)
        return self.hit & (across > 0)

    def __len__(self) -> int:
        return len(self.t)

    def counts(self) -> dict[str, int]:
        """How many rays ended in each state, without the states that none ended in."""
        numbers = np.bincount(self.status, minlength=len(STATUS_NAMES))
        return {name: int(n) for name, n in zip(STATUS_NAMES, numbers, strict=True) if n}


@dataclass(frozen=True, eq=False)
class Curves:
    """Energies sampled along a ray; NaN where no surfel is near.

    t: (K,); tangent: signed step e_ts [T 2.20]; off_centre: e_oc [T 2.22]; mahalanobis: e_M [T 2.18];
    angle: e_angle [T 2.23].
    """

    t: Array
    tangent: Array
    off_centre: Array
    mahalanobis: Array
    angle: Array


@dataclass(frozen=True, eq=False)
class Trace:
    """One ray with every step it took; steps (S) of all starts in order, cells (C) in order.

    origin, direction: (3,); the ray's end: t, point, normal (NaN = no hit), status (a name).
    For each step: t_query, query x_i; barycentre a(x_i); normal n(x_i); t_next, next_point x_{i+1};
    energy e_ts (signed); off_centre; weight_sum; start: number of the start it belongs to, from 0;
    step_cell: cell (S, 3) whose neighbourhood was used; outcome: name of the state that the step led
    to ("continue" while the search went on); neighbours: indices into surfels; weights: the same
    length, normalised to sum 1.
    cells: (C, 3) crossed by the ray; borders: (C + 1,) the t where it crosses into each; with_surfel: (C,);
    balls: (B, 4) centre and radius of a cloud's balls that it pierces, in order. A lattice has no balls, a cloud
    no cells; there step_cell begins with the ball's number among these, or -1. low, high: (3,) corners of the scene.
    """

    origin: Array
    direction: Array
    t: float
    point: Array
    normal: Array
    status: str
    t_query: Array
    query: Array
    barycentre: Array
    step_normal: Array
    t_next: Array
    next_point: Array
    energy: Array
    off_centre: Array
    weight_sum: Array
    start: Ints
    step_cell: Ints
    outcome: tuple[str, ...]
    neighbours: tuple[NDArray[np.int64], ...]
    weights: tuple[Array, ...]
    cells: Ints
    borders: Array
    with_surfel: NDArray[np.bool_]
    balls: Array
    surfels: Surfels | Points
    curves: Curves
    settings: Settings
    low: Array
    high: Array
    pixel: tuple[int, int] | None = None

    @property
    def extent(self) -> tuple[float, float, float]:
        """Size of the scene along x, y, z."""
        x, y, z = (self.high - self.low).tolist()
        return x, y, z

    @property
    def steps(self) -> int:
        """How many steps were taken in all."""
        return len(self.t_query)

    @property
    def hit(self) -> bool:
        """Whether the ray met the surface."""
        return self.status in ("converged", "floor")

    def summary(self) -> dict[str, Any]:
        """The ray's end in plain numbers, for a status line."""
        return {"status": self.status, "t": self.t, "starts": int(self.start[-1]) + 1 if self.steps else 0,
                "steps": self.steps, "cells": len(self.cells)}


@dataclass(frozen=True, eq=False)
class Quality:
    """Errors of a picture against the exact surface [T 3.4, 3.5], lengths in cells, of a cloud in mean spacings.

    delta, delta_p, delta_n: NaN when no ray is relevant; relevant: rays that do not correctly show
    background; false_hit, false_miss, distance_miss: counts; distance, angle: for each ray, NaN where
    either is missing: |p_r - p_e| and the angle of the normals in degrees.
    """

    delta: float
    delta_p: float
    delta_n: float
    relevant: int
    false_hit: int
    false_miss: int
    distance_miss: int
    distance: Array
    angle: Array
