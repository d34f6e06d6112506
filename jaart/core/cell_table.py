"""The neighbourhoods of a lattice's cells, each cell's surfels in contiguous columns [T §3.1.3]."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core import memory
from jaart.core.bricks import brick_slots
from jaart.core.chosen import HALF_DIAGONAL, Chosen, counts_nearest
from jaart.core.empty_space import FARTHEST, bricks_within, empty_space
from jaart.core.kernels import table
from jaart.core.kernels.cell_gather import gather_cell
from jaart.core.kernels.nearest_gather import gather_nearest
from jaart.core.kernels.records import Cell, Cells, Empty, Sites
from jaart.core.memory import COUNTED, check_near, pieces
from jaart.core.places import Ints, Places, address
from jaart.core.scene import Array
from jaart.core.surfels import Surfels

#: Nearest surfels are gathered for cells up to so many cells from one with a surfel.
KNN_HALO = 2
#: Distances from surfels are told cell by cell up to this at least: with fewer rays would visit more cells.
SKIPPED = 12


def cell_table(found: Surfels, shape: Cell, values: Chosen, k: int) -> Cells:
    """A lattice's cells with the surfels that may count at a point in them, which are gathered when a ray asks.

    shape: cells along each axis; values: which neighbourhood, and its radius; k: of the nearest ones. A cell of
    `ball` and `knn` holds what counts at any of its points; which of them counts at one, `weigh` decides. Raises
    SettingsError when what rays may ask for would not fit into memory.
    """
    if counts_nearest(values.neighbourhood):
        return _nearest(found, shape, k, 2 * HALF_DIAGONAL if values.neighbourhood == "knn" else 0.0)
    radius = values.radius + (HALF_DIAGONAL if values.neighbourhood == "ball" else 0.0)
    return _within(found, shape, radius)


def _within(found: Surfels, shape: Cell, radius: float) -> Cells:
    """The surfels within a radius of each cell's centre."""
    what = f"radius = {radius:g} cells"
    _check(found, lambda distance: radius, what)
    most = min(int(min(radius + _largest(found), max(shape))), FARTHEST)
    empty = empty_space(found.cells, shape, max(most, SKIPPED))
    halo = table.widest(found.cells, found.offset, radius, empty, most)
    return Cells(_sites(found, empty, halo, gather_cell, (radius, 0.0), 0, what), empty, halo, 0, 0.0)


def _nearest(found: Surfels, shape: Cell, k: int, beyond: float) -> Cells:
    """The k surfels nearest to the centres of cells near a surfel, of equally far ones those that come first.

    beyond: how much farther others may be that are gathered with them. A point in the cell is as far from a surfel as
    the centre but for half a diagonal: so with a whole one, all are there that may be among the k nearest of any point.
    """
    what = f"k = {k}"
    _check(found, lambda distance: float(np.partition(distance, min(k, len(found)) - 1)[min(k, len(found)) - 1])
           + beyond, what)
    empty = empty_space(found.cells, shape, SKIPPED)
    return Cells(_sites(found, empty, KNN_HALO, gather_nearest, (0.0, beyond), k, what), empty, KNN_HALO, 0, 0.0)


def _sites(found: Surfels, empty: Empty, halo: int, gatherer: Any, lengths: tuple[float, float], k: int,
           what: str) -> Sites:
    """The cells that have surfels near; arguments as of kernels/cell_gather.py."""
    order, rows = _rows(found, empty.shape)
    own = [np.ascontiguousarray(a) for a in (found.cells, found.offset, found.normal)]
    alive: tuple[NDArray[Any], ...] = (rows, order, *own, np.array([lengths[0], _largest(found), lengths[1]]))
    source = [*empty.shape[:2], len(found), *(address(array) for array in alive), k, halo]
    slots = brick_slots(bricks_within(empty, halo if len(found) else -1))
    return Places(empty.shape, np.empty((0, 3)), slots, gatherer, source, 6, 0, alive, what).sites


def _largest(found: Surfels) -> float:
    """The largest part of an offset."""
    return float(max(found.offset.max(initial=0.0), -found.offset.min(initial=0.0)))


def _check(found: Surfels, reach: Callable[[Array], float], what: str) -> None:
    """Raise SettingsError where what a picture asks for would not fit; reach: how far from a surfel others count, of
    their distances from it.
    """
    if memory.room_for_all(len(found), 6):
        return
    near = []
    for one in range(0, len(found), max(len(found) // COUNTED, 1)):
        distance = np.empty(len(found))
        for piece in pieces(len(found)):
            apart = (found.cells[piece] - found.cells[one]) + (found.offset[piece] - found.offset[one])
            distance[piece] = np.sqrt(np.einsum("ij,ij->i", apart, apart))
        near.append(int((distance <= reach(distance)).sum()))
    check_near(near, len(found), 6, what)


def _rows(found: Surfels, shape: Cell) -> tuple[NDArray[np.int32], Ints]:
    """The surfels in the order of their cells, and where each row of cells along z begins in it (nx·ny + 1,)."""
    row = found.cells[:, 0].astype(np.int64) * shape[1] + found.cells[:, 1]
    order = np.argsort(row * shape[2] + found.cells[:, 2], kind="stable").astype(np.int32)
    begins = np.zeros(shape[0] * shape[1] + 1, np.int64)
    np.cumsum(np.bincount(row, minlength=len(begins) - 1), out=begins[1:])
    return order, begins
