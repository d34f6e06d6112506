"""The energies of a point, sampled along a ray."""

from __future__ import annotations

from math import nan

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import records as r
from jaart.core.kernels.blocks import PARTS
from jaart.core.kernels.call import evaluate_at
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.judge import angle_energy
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.place import centre_of
from jaart.core.kernels.records import Array, Cell, Near, Plan, Rule, Sites, Vector
from jaart.core.kernels.sums import covariance_sums, mahalanobis_sums
from jaart.core.kernels.vectors import along, dot, length
from jaart.core.kernels.weigh import weigh


@kernel(STRICT)
def mahalanobis(sites: Sites, near: Near, x: Vector, c: float, work: Array) -> float:
    """Σθ·d_M; without normals nothing is across them, and all of it counts c times."""
    if sites.pool[PARTS] == 6:
        return mahalanobis_sums(near, x, c, work)
    xx, _, _, yy, _, zz = covariance_sums(near, x, work)
    return c * (xx + yy + zz)


@kernel(STRICT, entry=True)
def sample(sites: Sites, plan: Plan, o: Vector, d: Vector, ts: Array, places: NDArray[np.int64], energies: Array,
           work: Array, fit: Array) -> None:
    """Write e_ts [T 2.20], e_oc [T 2.22], e_M [T 2.18] and e_angle [T 2.23] at each t; NaN where nothing is near.

    ts: (K,); places: (K, 3) the cell or ball whose neighbourhood counts at each; energies: (4, K). e_ts is the
    step to what the chosen surface makes of x: f over the slope of its normal.
    """
    for i in range(ts.shape[0]):
        energies[0, i] = energies[1, i] = energies[2, i] = energies[3, i] = nan
        place = (places[i, 0], places[i, 1], places[i, 2])
        near, centre = surfels_near(sites, place), centre_of(sites, place)
        if near.size == 0:
            continue
        x = along((o[0] - centre[0], o[1] - centre[1], o[2] - centre[2]), d, ts[i])
        v = evaluate_at(plan.how.evaluate, near, x, plan.rule, r.VALUE_ONLY, work, fit)
        if v.state == r.FEW_NEIGHBOURS:
            continue
        if v.state == r.CONTINUE:
            energies[0, i], energies[3, i] = v.f / dot(v.n, d), angle_energy(v.n, v.off)
        s, _ = weigh(near, x, plan.rule, work)
        energies[1, i] = length(v.off)
        energies[2, i] = mahalanobis(sites, near, x, plan.rule.c, work) / s


@kernel(STRICT, entry=True)
def write_weights(sites: Sites, place: Cell, x: Vector, rule: Rule, weights: Array) -> None:
    """Write the weights θ_N of the N surfels near a place at x, sum 1, into weights[:N] [T §2.3.6].

    x: relative to the place's centre; weights: (2·N,).
    """
    near = surfels_near(sites, place)
    s, _ = weigh(near, x, rule, weights)
    for i in range(near.size):
        weights[i] = weights[i] / s
