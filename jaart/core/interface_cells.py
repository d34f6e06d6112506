"""Which cells of a lattice solids may cut, found by halving blocks that lie on neither side of a surface."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jaart.core.shape import Array, Mask, Shape

Ints = NDArray[np.intp]
HALVES = np.array(list(np.ndindex(2, 2, 2)))


def interface_cells(solids: Sequence[Shape], raster: int) -> tuple[Array, list[tuple[tuple[int, ...], Ints]]]:
    """Levels (raster, raster, raster), 1 in cells that lie in one solid, and the cells that may be cut.

    solids: in cells. The latter come as groups: which solids may cut them, and the cells (N, 3).
    """
    levels = np.zeros((raster,) * 3)
    cut = [descend(solid, levels) for solid in solids]
    found = np.concatenate([np.empty((0, 3), np.intp), *cut])
    owner = np.repeat(np.arange(len(cut)), [len(cells) for cells in cut])
    open_ = levels[tuple(found.T)] == 0
    place = np.ravel_multi_index(tuple(found[open_].T), levels.shape)
    order = np.argsort(place, kind="stable")
    cells, starts = np.unique(place[order], return_index=True)
    groups: dict[tuple[int, ...], list[int]] = {}
    for cell, members in zip(cells.tolist(), np.split(owner[open_][order], starts[1:]), strict=False):
        groups.setdefault(tuple(members.tolist()), []).append(cell)
    return levels, [(members, np.stack(np.unravel_index(places, levels.shape), axis=1))
                    for members, places in groups.items()]


def descend(solid: Shape, levels: Array | Mask) -> Ints:
    """Set the levels of cells that lie in the solid to 1; the cells (N, 3) that it may cut."""
    low, high = solid.bounds
    first = np.clip(np.floor(low), 0, levels.shape).astype(np.intp)
    last = np.clip(np.ceil(high), 0, levels.shape).astype(np.intp)
    edge = 1 << math.ceil(math.log2(max(1, (last - first).max())))
    blocks = first[None]
    while True:
        blocks = blocks[(blocks < last).all(axis=1)]
        full, empty = solid.sides(blocks.astype(np.float64), float(edge))
        for i, j, k in blocks[full]:
            levels[i:i + edge, j:j + edge, k:k + edge] = 1
        blocks = blocks[~full & ~empty]
        if edge == 1:
            return blocks
        edge //= 2
        blocks = (blocks[:, None] + edge * HALVES).reshape(-1, 3)
