"""Kernels called one at a time: surfels made into a place, names into a rule."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.assemble import NORMALS, WEIGHTS
from jaart.core.bricks import slot_numbers
from jaart.core.kernels import records as r
from jaart.core.kernels.fitted import polynomial
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.records import Cell, Near, Rule, Sites, Value
from jaart.core.kernels.tangent import tangent_covariance, tangent_surfel
from jaart.core.kernels.weigh import weigh
from jaart.core.places import scratch

Array = NDArray[np.float64]
Vectors = Sequence[Sequence[float]]


def near_of(points: Vectors, normals: Vectors | None = None) -> Near:
    """All the surfels as those near one place at the origin; without normals they have (0, 0, 1)."""
    ahead = [[0.0, 0.0, 1.0]] * len(points) if normals is None else normals
    columns = np.concatenate([np.array(points, float).reshape(-1, 3), np.array(ahead, float).reshape(-1, 3)], axis=1)
    return Near(np.ascontiguousarray(columns.T).ravel(), np.uint64(0), np.uint64(len(points)), np.uint64(len(points)))


@kernel(STRICT, entry=True)
def _copy_near(sites: Sites, cell: Cell, columns: Array) -> tuple[int, int]:
    near = surfels_near(sites, cell)
    for i in range(near.columns.shape[0]):
        columns[i] = near.columns[i]
    return int(near.size), int(near.wide)


def near_at(sites: Sites, cell: Cell) -> Near:
    """The surfels near a place, up to 680 of them, in columns of their own: Python cannot hold what nobody owns."""
    columns = np.empty(6 * 680)
    size, wide = _copy_near(sites, cell, columns)
    return Near(columns[:6 * wide], np.uint64(0), np.uint64(size), np.uint64(wide))


def rule_of(weight: str = "gaussian", normal: str = "surfel", h: float = 0.8, reach: float = math.inf, k: int = 0,
            degree: int = 0, patch: float = 0.0, c: float = 0.25, oriented: int = 1) -> Rule:
    """A rule by names."""
    return Rule(weight=WEIGHTS[weight], normal=NORMALS[normal], h=float(h), reach=float(reach), k=k,
                oriented=oriented, degree=degree, patch=float(patch), c=float(c))


def place(x: Sequence[float]) -> tuple[float, float, float]:
    """A point as kernels take it."""
    return float(x[0]), float(x[1]), float(x[2])


def work_for(near: Near) -> Array:
    """Scratch as `places.scratch` makes it."""
    return scratch(int(near.size))[0]


def weights_of(near: Near, x: Sequence[float], rule: Rule) -> tuple[Array, float, float]:
    """The weights that the kernel writes, their sum and the shift."""
    work = work_for(near)
    s, shift = weigh(near, place(x), rule, work)
    return work[:int(near.size)].copy(), s, shift


def evaluator(rule: Rule) -> Any:
    """The kernel of the tangent surface for a rule's normal."""
    return tangent_surfel if rule.normal == r.SURFEL else tangent_covariance


def value_of(near: Near, x: Sequence[float], rule: Rule, gradient: bool = False) -> Value:
    """The tangent surface at x."""
    want = r.WITH_GRADIENT if gradient else r.VALUE_ONLY
    found: Value = evaluator(rule)(near, place(x), rule, want, work_for(near), np.zeros(r.FIT_SIZE))
    return found


def fitted_value(near: Near, x: Sequence[float], rule: Rule) -> tuple[Value, Array]:
    """The polynomial surface at x, and the coefficients."""
    fit = np.full(r.FIT_SIZE, np.nan)
    return polynomial(near, place(x), rule, r.VALUE_ONLY, work_for(near), fit), fit[:r.COEFFICIENTS]


def asked_cells(sites: Sites) -> NDArray[np.int64]:
    """Cells (N, 3) of a lattice that somebody asked for."""
    cells = np.indices(sites.shape).reshape(3, -1).T
    number = slot_numbers(sites.shape, sites.slots, cells)
    return cells[(number >= 0) & (sites.slots[number] != 0)]
