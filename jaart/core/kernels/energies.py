"""The energies of a point, sampled along a ray."""

from __future__ import annotations

from math import nan, sqrt

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import records as r
from jaart.core.kernels.iterate import along, dot
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.records import Array, Cell, Cells, Vector
from jaart.core.kernels.sums import mahalanobis_sums, nearest, shifted_weight
from jaart.core.kernels.tangent import tangent


@kernel(STRICT)
def sample(cells: Cells, h: float, c: float, o: Vector, d: Vector, ts: Array, of_cell: NDArray[np.int64],
           energies: Array) -> None:
    """Write e_ts [T 2.20], e_oc [T 2.22] and e_M [T 2.18] at each t; NaN where no surfel is near.

    ts: (K,); of_cell: (K, 3) the cell whose neighbourhood counts at each; energies: (3, K).
    """
    for i in range(ts.shape[0]):
        cell = (of_cell[i, 0], of_cell[i, 1], of_cell[i, 2])
        near = surfels_near(cells, cell)
        if near.size == 0:
            energies[0, i] = energies[1, i] = energies[2, i] = nan
            continue
        x = along((o[0] - (cell[0] + 0.5), o[1] - (cell[1] + 0.5), o[2] - (cell[2] + 0.5)), d, ts[i])
        state, f, n, off, _, _ = tangent(near, x, h)
        s, total = mahalanobis_sums(near, x, h, c)
        energies[0, i] = f / dot(n, d) if state == r.CONTINUE else nan
        energies[1, i] = sqrt(dot(off, off))
        energies[2, i] = total / s


@kernel(STRICT)
def write_weights(cells: Cells, cell: Cell, x: Vector, h: float, weights: Array) -> None:
    """Write the weights θ_N of the surfels near a cell at x, sum 1, into (N,) [T §2.3.6].

    x: relative to the cell's centre.
    """
    near, per_h = surfels_near(cells, cell), 1.0 / h
    nearest_one = nearest(near, x, per_h)
    total = 0.0
    for i in range(near.size):
        weights[i] = shifted_weight(near, i, nearest_one, x, per_h)
        total += weights[i]
    for i in range(near.size):
        weights[i] /= total
