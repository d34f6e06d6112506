"""An energy at the points of a grid that divides a lattice's cells, only where surfels are near [T §2.4.6]."""

from __future__ import annotations

from math import ceil, nan

from jaart.core.kernels import records as r
from jaart.core.kernels.call import evaluate_at
from jaart.core.kernels.energy import energy, has_slope
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.records import Array, Cell, Near, Plan, Sites, Vector
from jaart.core.kernels.unowned import unowned, unowned_sites


@kernel(STRICT)
def energy_at(near: Near, x: Vector, plan: Plan, d: Vector, work: Array, fit: Array) -> float:
    """The energy at x, relative to its cell's centre; NaN where it is not defined."""
    want = r.BARYCENTRE if has_slope(plan.how.energy, plan.how.emphasise) else r.VALUE_ONLY
    v = evaluate_at(plan.how.evaluate, near, x, plan.rule, want, work, fit)
    if v.state == r.FEW_NEIGHBOURS:
        return nan
    return energy(plan.how.energy, plan.how.emphasise, near, x, d, v, plan.rule.c, work)


@kernel(STRICT)
def first_sample(cell: int, divisions: int) -> int:
    """Number of the first sample along an axis that a cell owns: on a face, the cell on the low side does."""
    return cell * divisions + 1 if cell > 0 else 0


@kernel(STRICT)
def sample_cell(sites: Sites, plan: Plan, d: Vector, divisions: int, cell: Cell, values: Array, work: Array,
                fit: Array) -> None:
    """Write the energy at the samples that a cell owns, with the surfels near that cell."""
    near = surfels_near(sites, cell)
    if near.size == 0:
        return
    for i in range(first_sample(cell[0], divisions), (cell[0] + 1) * divisions + 1):
        x = (i - cell[0] * divisions) / divisions - 0.5
        for j in range(first_sample(cell[1], divisions), (cell[1] + 1) * divisions + 1):
            y = (j - cell[1] * divisions) / divisions - 0.5
            for k in range(first_sample(cell[2], divisions), (cell[2] + 1) * divisions + 1):
                z = (k - cell[2] * divisions) / divisions - 0.5
                values[i, j, k] = energy_at(near, (x, y, z), plan, d, work, fit)


@kernel(STRICT, entry=True)
def sample_layer(sites: Sites, plan: Plan, d: Vector, divisions: int, layer: int, values: Array, work: Array,
                 fit: Array) -> None:
    """Write the energy at the samples of one layer of cells across x.

    d: direction of e_ts; divisions: samples along an edge of a cell; values: (nx·divisions + 1, …), sample
    (i, j, k) lies at (i, j, k)/divisions; what no cell with surfels near owns is left as it is.
    """
    own, scratch, fitted, there = unowned_sites(sites), unowned(work), unowned(fit), unowned(values)
    for j in range(sites.shape[1]):
        for k in range(sites.shape[2]):
            sample_cell(own, plan, d, divisions, (layer, j, k), there, scratch, fitted)


@kernel(STRICT)
def holder(x: float, cells: int) -> int:
    """The cell that owns a coordinate: on a face, the one on the low side."""
    return min(max(int(ceil(x)) - 1, 0), cells - 1)


@kernel(STRICT, entry=True)
def write_gradients(sites: Sites, plan: Plan, d: Vector, width: float, points: Array, gradients: Array, work: Array,
                    fit: Array) -> None:
    """Write the energy's gradient at points (N, 3) of a lattice, by central differences; NaN where undefined.

    width: half of what the differences are taken over.
    """
    own, scratch, fitted = unowned_sites(sites), unowned(work), unowned(fit)
    for i in range(points.shape[0]):
        p = (points[i, 0], points[i, 1], points[i, 2])
        cell = (holder(p[0], sites.shape[0]), holder(p[1], sites.shape[1]), holder(p[2], sites.shape[2]))
        near = surfels_near(own, cell)
        for axis in range(3):
            gradients[i, axis] = nan
            if near.size == 0:
                continue
            change = 0.0
            for side in range(2):
                step = width if side == 1 else -width
                x = (p[0] - cell[0] - 0.5 + (step if axis == 0 else 0.0),
                     p[1] - cell[1] - 0.5 + (step if axis == 1 else 0.0),
                     p[2] - cell[2] - 0.5 + (step if axis == 2 else 0.0))
                e = energy_at(near, x, plan, d, scratch, fitted)
                change += e if side == 1 else -e
            gradients[i, axis] = change / (2.0 * width)
