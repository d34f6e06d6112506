"""The neighbourhoods of a lattice's cells, each cell's surfels in contiguous columns [T §3.1.3]."""

from __future__ import annotations

from threading import Event
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core import memory
from jaart.core.chosen import HALF_DIAGONAL, Chosen, counts_nearest
from jaart.core.errors import Cancelled, SettingsError
from jaart.core.kernels import table
from jaart.core.kernels.records import Cell, Cells, Sites
from jaart.core.scene import Array
from jaart.core.surfels import Surfels
from jaart.core.telling import tell

#: The table is made for so many surfels at a time.
SURFELS_AT_ONCE = 1024
#: Nearest surfels are listed for cells up to so many cells from one with a surfel.
KNN_HALO = 2


def cell_table(found: Surfels, shape: Cell, values: Chosen, k: int, cancel: Event | None = None) -> Cells:
    """A lattice's cells with the surfels that may count at a point in them.

    shape: cells along each axis; values: which neighbourhood, and its radius; k: of the nearest ones. A cell of
    `ball` and `knn` lists what counts at any of its points; which of them counts at one, `weigh` decides. Raises
    SettingsError when the table would not fit into memory, Cancelled after cancel was set.
    """
    empty = np.full(shape, 255, np.uint8)
    empty[tuple(found.cells.T)] = 0
    table.fill_empty(empty)
    if counts_nearest(values.neighbourhood) and len(found):
        sites = _nearest(found, empty, k, exact=values.neighbourhood == "knn")
    else:
        more = HALF_DIAGONAL if values.neighbourhood == "ball" else 0.0
        sites = _within(found, shape, values.radius + more, cancel)
    counted = np.diff(sites.first).reshape(shape) > 0
    halo = int(empty[counted].max(initial=0))
    return Cells(sites, empty, halo, 0, 0.0)


def _within(found: Surfels, shape: Cell, radius: float, cancel: Event | None) -> Sites:
    """Every cell's surfels within a radius of its centre."""
    nobody, nothing = np.empty(0, np.int32), np.empty(0)
    first = np.zeros(shape[0] * shape[1] * shape[2] + 1, np.int64)
    _scan(found, radius, shape, first, first[1:], nobody, nothing, cancel)
    np.cumsum(first, out=first)
    _check_memory(int(first[-1]), f"radius = {radius:g} cells")
    ids, columns = np.empty(first[-1], np.int32), np.empty(6 * first[-1])
    _scan(found, radius, shape, first, np.zeros(len(first) - 1, np.int64), ids, columns, cancel)
    return Sites(shape, np.empty((0, 3)), first, ids, columns)


def _check_memory(surfels: int, what: str) -> None:
    needed = surfels * (6 * 8 + 4)
    if needed > memory.limit():
        raise SettingsError(f"{what}: needs {memory.words(needed)} of memory, more than the "
                            f"{memory.words(memory.limit())} it may take")


def _scan(found: Surfels, radius: float, shape: Cell, first: NDArray[np.int64], counted: NDArray[np.int64],
          ids: NDArray[np.int32], columns: Array, cancel: Event | None) -> None:
    """Count or write the surfels near each cell, a few surfels at a time so that it can be cancelled."""
    index, offset, normal = np.array(found.cells, np.int32), np.array(found.offset), np.array(found.normal)
    for begin in range(0, len(found), SURFELS_AT_ONCE):
        if cancel is not None and cancel.is_set():
            raise Cancelled("the neighbour table was cancelled")
        table.scan_near(index, offset, normal, begin, min(begin + SURFELS_AT_ONCE, len(found)), radius, shape,
                        first, counted, ids, columns)
        tell(begin + (len(found) if len(ids) else 0), 2 * len(found))


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
    _check_memory(len(ids), f"k = {k}")
    counts = np.zeros(empty.size + 1, np.int64)
    counts[1 + np.ravel_multi_index(tuple(cells.T), empty.shape)] = sizes
    shape: Any = empty.shape
    return Sites(shape, np.empty((0, 3)), np.cumsum(counts), ids, _columns(found, cells, sizes, ids))


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
