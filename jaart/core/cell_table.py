"""The neighbourhoods of a lattice's cells, each cell's surfels in contiguous columns [T §3.1.3]."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.bricks import BRICK, brick_slots
from jaart.core.chosen import HALF_DIAGONAL, Chosen, counts_nearest
from jaart.core.kernels import table
from jaart.core.kernels.cell_gather import gather_cell
from jaart.core.kernels.records import Cell, Cells, Sites
from jaart.core.places import Ints, Places, address, check, listed
from jaart.core.scene import Array
from jaart.core.surfels import Surfels

#: Nearest surfels are listed for cells up to so many cells from one with a surfel.
KNN_HALO = 2
#: A picture asks for about one cell a pixel; the surfels near so many are counted before it begins.
CELLS_ASKED, CELLS_COUNTED = 1 << 18, 16


def cell_table(found: Surfels, shape: Cell, values: Chosen, k: int) -> Cells:
    """A lattice's cells with the surfels that may count at a point in them.

    shape: cells along each axis; values: which neighbourhood, and its radius; k: of the nearest ones. A cell of
    `ball` and `knn` holds what counts at any of its points; which of them counts at one, `weigh` decides. The nearest
    are listed at once, what lies within a radius when a ray asks. Raises SettingsError when what rays may ask for would
    not fit into memory.
    """
    empty = np.full(shape, 255, np.uint8)
    empty[tuple(found.cells.T)] = 0
    table.fill_empty(empty)
    if counts_nearest(values.neighbourhood) and len(found):
        sites = _nearest(found, empty, k, exact=values.neighbourhood == "knn")
        return Cells(sites, empty, min(KNN_HALO, int(empty.max())), 0, 0.0)
    radius = values.radius + (HALF_DIAGONAL if values.neighbourhood == "ball" else 0.0)
    halo = table.widest(found.cells, found.offset, radius, empty, min(_cells_away(found, shape, radius), 255))
    return Cells(_within(found, empty, radius, halo), empty, halo, 0, 0.0)


def _cells_away(found: Surfels, shape: Cell, radius: float) -> int:
    """How many cells a cell and one with a surfel near it may be apart."""
    farthest = radius + float(np.abs(found.offset).max(initial=0.0))
    return int(min(farthest, max(shape)))


def _within(found: Surfels, empty: NDArray[np.uint8], radius: float, halo: int) -> Sites:
    """The surfels within a radius of each cell's centre, which are gathered when somebody asks."""
    shape = (empty.shape[0], empty.shape[1], empty.shape[2])
    order, rows = _rows(found, shape)
    lengths = np.array([radius, np.abs(found.offset).max(initial=0.0)])
    own = [np.ascontiguousarray(a) for a in (found.cells, found.offset, found.normal)]
    alive: tuple[NDArray[Any], ...] = (rows, order, *own, lengths)
    addresses = [address(array) for array in alive]
    source = [shape[0], shape[1], len(found), *addresses[:5], _cells_away(found, shape, radius), addresses[5]]
    what = f"radius = {radius:g} cells"
    near = _near_some(found, radius) * min(len(found), CELLS_ASKED)
    check(near * (6 * 8 + 4), what)
    slots = brick_slots(shape, _least(empty) <= halo) if len(found) else np.zeros(empty.size, np.int64)
    return Places(shape, np.empty((0, 3)), slots, gather_cell, source, 6, 0, alive, what).sites


def _near_some(found: Surfels, radius: float) -> float:
    """The mean number of surfels within a radius of some of them."""
    points, some = found.points, found.points[::max(len(found) // CELLS_COUNTED, 1)]
    near = [int((((points - x) ** 2).sum(axis=1) <= radius * radius).sum()) for x in some]
    return sum(near) / max(len(near), 1)


def _rows(found: Surfels, shape: Cell) -> tuple[NDArray[np.int32], Ints]:
    """The surfels in the order of their cells, and where each row of cells along z begins in it (nx·ny + 1,)."""
    row = found.cells[:, 0].astype(np.int64) * shape[1] + found.cells[:, 1]
    order = np.argsort(row * shape[2] + found.cells[:, 2], kind="stable").astype(np.int32)
    return order, np.searchsorted(row[order], np.arange(shape[0] * shape[1] + 1))


def _least(empty: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The least distance from a surfel in each brick."""
    for axis in range(3):
        lines = np.moveaxis(empty, axis, 0)
        least = lines[::BRICK].copy()
        for first in range(1, BRICK):
            part = lines[first::BRICK]
            np.minimum(least[:len(part)], part, out=least[:len(part)])
        empty = np.moveaxis(least, 0, axis)
    return empty


def _nearest(found: Surfels, empty: NDArray[np.uint8], k: int, exact: bool) -> Sites:
    """The k surfels nearest to each cell's centre, for the cells near a surfel.

    exact: list all that may be among the k nearest of any point in the cell: their distance from the centre
    exceeds that of the k-th by no more than the cell's diagonal.
    """
    from scipy.spatial import cKDTree

    tree = cKDTree(found.points)
    cells = np.argwhere(empty <= KNN_HALO)
    distance, ids = tree.query(cells + 0.5, min(k, len(found)))
    distance, ids = distance.reshape(len(cells), -1), ids.reshape(len(cells), -1)
    if exact:
        lists = tree.query_ball_point(cells + 0.5, distance[:, -1] * (1 + 1e-12) + 2 * HALF_DIAGONAL,
                                      return_sorted=True)
        sizes = np.array([len(one) for one in lists], np.int64)
        ids = np.concatenate(lists).astype(np.int32) if len(lists) else np.empty(0, np.int32)
    else:
        ids, sizes = np.sort(ids, axis=1).astype(np.int32).ravel(), np.full(len(cells), len(ids[0]), np.int64)
    check(len(ids) * (6 * 8 + 4), f"k = {k}")
    counts = np.zeros(empty.size + 1, np.int64)
    counts[1 + np.ravel_multi_index(tuple(cells.T), empty.shape)] = sizes
    shape = (empty.shape[0], empty.shape[1], empty.shape[2])
    return listed(shape, np.empty((0, 3)), np.cumsum(counts), ids, _columns(found, cells, sizes, ids))


def _columns(found: Surfels, cells: NDArray[np.intp], sizes: NDArray[np.int64], ids: NDArray[np.int32]) -> Array:
    """For each cell its surfels' x, y, z relative to the centre and the normals' parts, each contiguous."""
    values = np.empty((len(ids), 6))
    values[:, :3] = (found.cells[ids] - np.repeat(cells, sizes, axis=0)) + found.offset[ids]
    values[:, 3:] = found.normal[ids]
    begin = np.repeat(np.cumsum(sizes) - sizes, sizes)
    place, size = np.arange(len(ids)) - begin, np.repeat(sizes, sizes)
    columns = np.empty(6 * len(ids))
    for part in range(6):
        columns[6 * begin + part * size + place] = values[:, part]
    return columns
