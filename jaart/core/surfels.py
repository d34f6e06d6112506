"""Surfels of a lattice: one point with a normal for each interface cell [T §3.1]."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from jaart.core import placements
from jaart.core.filters import filtered
from jaart.core.gradients import gradients
from jaart.core.lattice import interface_cells
from jaart.core.memory import ITEM, check, pieces
from jaart.core.scene import Array
from jaart.core.settings import Settings

Vector = tuple[float, float, float]

#: The spacing of a lattice whose cells are cubes.
CUBIC: Vector = (1.0, 1.0, 1.0)
#: A lattice that sticks out of its last cell by less than this ends there.
ROUNDING = 1e-9
#: Cells without a normal are worth a note when they are more than this share of the surfels.
MANY = 0.05


@dataclass(frozen=True, eq=False)
class Surfels:
    """Points with normals, one for each interface cell of a lattice.

    cells: index (N, 3) of each surfel's cell; offset: point minus the cell's centre (N, 3), cells;
    normal: unit normals (N, 3), out of the fluid; without_normal: interface cells dropped because
    their gradient vanishes.
    """

    cells: NDArray[np.int32]
    offset: Array
    normal: Array
    without_normal: int = 0

    @property
    def points(self) -> Array:
        """Positions (N, 3) in cells."""
        return self.cells + 0.5 + self.offset

    @property
    def notes(self) -> tuple[str, ...]:
        """What a person should know of them: that there are none and why, or how many cells gave none if many did."""
        cells = f"{self.without_normal} interface cell{'' if self.without_normal == 1 else 's'}"
        if len(self) and self.without_normal > MANY * len(self):
            return (f"{cells} without a normal left out: the level does not change across them",)
        if self.without_normal and not len(self):
            return (f"0 surfels, so there is no surface: {cells}, but the level changes at none of them",)
        if not len(self):
            return ("0 surfels, so there is no surface: no cell has a level between 0 and 1, and no full cell lies "
                    "beside an empty one",)
        return ()

    def __len__(self) -> int:
        return len(self.cells)


def make_surfels(levels: Array, settings: Settings, spacing: Vector = CUBIC) -> Surfels:
    """The surfels of a lattice, in the order of its cells (x slowest).

    levels: (nx, ny, nz) in [0, 1], before the filter; settings: filter, then neighbours and border
    name the interface cells, gradient, smoothing and border the normal -gradient/|gradient| [T 3.1],
    placement the point. Cells whose gradient vanishes are left out and counted. spacing: edges of a
    cell along x, y, z in units of the longest, which is the cell that the surfels' lengths count in.
    """
    levels = filtered(levels, settings)
    cells = interface_cells(levels, settings.neighbours, settings.border)
    check(ITEM * len(cells), f"a surfel in each of {len(cells)} interface cells")
    slopes = gradients(levels, cells, settings.border, settings.gradient, settings.smoothing)
    defined = slopes.any(axis=1)
    found, without = len(cells), int((~defined).sum())
    if without:
        cells, slopes = cells[defined], slopes[defined]
    normal, offset = slopes, np.empty((found - without, 3))  # a normal takes its gradient's place
    for piece in pieces(len(cells)):
        across = _normals(slopes[piece])
        where, normal[piece] = placements.offsets(settings.placement, levels[tuple(cells[piece].T)], across), across
        if tuple(spacing) == CUBIC:
            offset[piece] = where
        else:
            cells[piece], offset[piece], normal[piece] = _stretched(cells[piece], where, across, np.array(spacing),
                                                                    settings.placement, levels.shape)
    for column in (cells, offset, normal):
        column.flags.writeable = False
    return Surfels(cells, offset, normal, without_normal=without)


def stretched_shape(shape: tuple[int, ...], spacing: Vector) -> tuple[int, int, int]:
    """Cells of size 1×1×1 along each axis that cover a lattice whose cells have these edges.

    shape: cells of the lattice; spacing: their edges in units of the longest.
    """
    x, y, z = (max(1, ceil(n * s - ROUNDING)) for n, s in zip(shape, spacing, strict=True))
    return x, y, z


def _stretched(cells: NDArray[np.int32], offset: Array, across: Array, spacing: Array, placement: str,
               shape: tuple[int, ...]) -> tuple[NDArray[np.int32], Array, Array]:
    """Cell, offset and normal (N, 3) of surfels that were found as if their cells were cubes.

    A plane stays a plane when the lattice is stretched, and the volumes below it keep their ratio: its
    normal is divided by the spacing, and its point moved to the new normal through the cell's centre,
    or, for the polygon's centre, with the cell.
    """
    normal = across / spacing
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    offset = offset * spacing
    if placement != placements.CENTROID:
        offset = (offset * normal).sum(axis=1, keepdims=True) * normal
    points = (cells + 0.5) * spacing + offset
    last = np.array(stretched_shape(shape, (spacing[0], spacing[1], spacing[2]))) - 1
    index = np.clip(np.floor(points), 0, last).astype(np.int32)
    return index, points - index - 0.5, normal


def _normals(gradient: Array) -> Array:
    """Unit normals (N, 3) against gradients that are not 0. Scaling first keeps tiny ones from underflow."""
    scaled = gradient / np.abs(gradient).max(axis=1, keepdims=True)
    result: Array = -scaled / np.sqrt((scaled * scaled).sum(axis=1, keepdims=True)) + 0.0
    return result
