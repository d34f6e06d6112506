"""An energy at the points of a grid that divides a lattice's cells, only where surfels are near [T §2.4.6]."""

from __future__ import annotations

from math import nan

from jaart.core.kernels import records as r
from jaart.core.kernels.call import evaluate_at
from jaart.core.kernels.energy import energy
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import surfels_near
from jaart.core.kernels.records import Array, Cell, Near, Plan, Sites, Vector
from jaart.core.kernels.unowned import unowned, unowned_sites


@kernel(STRICT)
def energy_at(near: Near, x: Vector, plan: Plan, d: Vector, work: Array, fit: Array) -> float:
    """The energy at x, relative to its cell's centre; NaN where it is not defined."""
    v = evaluate_at(plan.how.evaluate, near, x, plan.rule, r.VALUE_ONLY, work, fit)
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


@kernel(STRICT)
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
