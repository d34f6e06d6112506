"""Normals that match the fill levels on one side of a cell, for surfaces with edges; beyond the sources.

The candidates are ELVIRA's (Pilliod & Puckett 2004): columns of three cells give heights, and their
one-sided differences the normal of a plane, exactly where the surface is one. Each is judged by the
volumes that its plane, moved so that it cuts the cell's own level, cuts from the cells of its own
side, so that a face of a box keeps its normal up to the edge; ELVIRA takes all 27 cells.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from jaart.core import plic
from jaart.core.gradients import smooth, with_outside
from jaart.core.scene import Array

Index = NDArray[np.integer]

#: A candidate is taken where its plane misses the levels by less than this share of what the smooth normal's does.
BETTER = 0.005
#: Cells looked at in one piece, so that what is computed for them stays in the processor's cache.
PIECE = 2048
#: The cell and its 26 neighbours, as steps (27, 3) in the order of a block (3, 3, 3); the cell is in the MIDDLE.
AROUND = np.moveaxis(np.indices((3, 3, 3)), 0, -1).reshape(27, 3) - 1
MIDDLE = 13


def elvira(levels: Array, cells: Index, border: str = "open", smoothing: float = 0.8) -> Array:
    """Minus the unit normal (N, 3) of the plane that fits best, `smooth` where none fits.

    levels: (nx, ny, nz); cells: indices (N, 3); border: sides that reach outside are left out where it is
    "open", and empty where it is "closed"; smoothing: sigma of smooth, cells.
    """
    result = smooth(levels, cells, border, smoothing)
    levels, cells = with_outside(levels, cells, border, 1)
    known = np.flatnonzero(np.abs(result).max(axis=1, initial=0) > 0)
    for begin in range(0, len(known), PIECE):
        piece = known[begin:begin + PIECE]
        result[piece] = _fitting(*_blocks(levels, cells[piece]), result[piece])
    return result


def _blocks(levels: Array, cells: Index) -> tuple[Array, NDArray[np.bool_]]:
    """The levels (N, 27) around each cell, the nearest ones outside, and which lie inside the lattice."""
    place = cells[:, None, :] + AROUND
    nearest = np.clip(place, 0, np.array(levels.shape) - 1)
    return levels[tuple(np.moveaxis(nearest, 2, 0))], (place == nearest).all(axis=2)


def _fitting(block: Array, inside: NDArray[np.bool_], gradient: Array) -> Array:
    """The gradient (N, 3), or minus the candidate's normal that misses the levels least where that is far less."""
    smoothed, every = _missed(_unit(-gradient), block, np.arange(27)), np.arange(len(block))
    least, result = np.full(len(block), np.inf), gradient.copy()
    for axis, first, second in itertools.product(range(3), (-1, 1), (-1, 1)):
        one, two = (a for a in range(3) if a != axis)
        step_one, step_two = AROUND[:, one] * first, AROUND[:, two] * second
        side = np.flatnonzero((step_one >= 0) & (step_two >= 0))
        corner = np.flatnonzero((step_one > 0) & (step_two > 0))
        most = np.minimum(least, BETTER**2 * smoothed[:, side].sum(axis=1))
        normal, rows = _candidate(block, axis, {one: first, two: second}), every[inside[:, side].all(axis=1)]
        for near in (corner, side):  # the column across tells nearly all that do not fit
            missed = _missed(normal[rows], block[rows], near).sum(axis=1)
            rows, missed = rows[missed < most[rows]], missed[missed < most[rows]]
        least[rows], result[rows] = missed, -normal[rows]
    return result


def _candidate(block: Array, axis: int, sides: dict[int, int]) -> Array:
    """Normal (N, 3) from the heights of columns along an axis: the cell's own and one on its side along each other."""
    levels = np.moveaxis(block.reshape(-1, 3, 3, 3), 1 + axis, -1)
    height, ends = levels.sum(axis=-1), levels.sum(axis=(1, 2))
    normal = np.empty((len(block), 3))
    normal[:, axis] = np.where(ends[:, 0] >= ends[:, 2], 1.0, -1.0)
    for place, (other, side) in enumerate(sides.items()):
        beside = [1, 1]
        beside[place] += side
        normal[:, other] = side * (height[:, 1, 1] - height[:, beside[0], beside[1]])
    return _unit(normal)


def _missed(normal: Array, block: Array, near: NDArray[np.intp]) -> Array:
    """Squares (N, M) of the volumes below the plane through the cell minus the levels, for the M cells near."""
    v = plic.distance(block[:, MIDDLE], normal)
    away = v[:, None] - normal @ AROUND[near].T
    cut = np.abs(away) < np.abs(normal).sum(axis=1)[:, None] / 2
    volume = (away > 0).astype(np.float64)
    volume[cut] = plic.volume(away[cut], np.broadcast_to(normal[:, None], (*cut.shape, 3))[cut])
    result: Array = (volume - block[:, near]) ** 2
    return result


def _unit(vectors: Array) -> Array:
    """The vectors (N, 3) at length 1. Scaling first keeps tiny ones from underflow."""
    scaled: Array = vectors / np.abs(vectors).max(axis=1, keepdims=True)
    scaled /= np.linalg.norm(scaled, axis=1, keepdims=True)
    return scaled
