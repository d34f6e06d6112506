"""Surfels of a lattice: one point with a normal for each interface cell [T §3.1]."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jaart.core.lattice import Mask, gradients, interface_cells
from jaart.core.scene import Array, frozen
from jaart.core.settings import Settings


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

    def __len__(self) -> int:
        return len(self.cells)


def make_surfels(levels: Array, settings: Settings) -> Surfels:
    """The surfels of a lattice, in the order of its cells (x slowest).

    levels: (nx, ny, nz) in [0, 1]; settings: neighbours and border name the interface cells, border
    the gradient at the walls, placement the point. The normal is -gradient/|gradient| [T 3.1]; cells
    whose gradient vanishes are left out and counted.
    """
    cells = np.argwhere(interface_cells(levels, settings.neighbours, settings.border))
    normal, defined = _normals(gradients(levels, settings.border, cells))
    kept, normal = cells[defined], normal[defined]
    along = PLACEMENTS[settings.placement](levels[tuple(kept.T)], normal)
    index = kept.astype(np.int32)
    index.flags.writeable = False
    return Surfels(index, frozen(along[:, None] * normal), frozen(normal), without_normal=int((~defined).sum()))


def box_placement(level: Array, normal: Array) -> Array:
    """Signed distance v (N,) of the points from their cells' centres along the normals [T 3.3].

    v = 2(l - 1/2)t, t the distance from the centre to the cell's boundary along the normal.
    """
    to_boundary = 0.5 / np.abs(normal).max(axis=1)
    result: Array = 2 * (level - 0.5) * to_boundary
    return result


def _normals(gradient: Array) -> tuple[Array, Mask]:
    """Unit normals (N, 3), and where (N,) they exist. Scaling first keeps tiny gradients from underflow."""
    largest = np.abs(gradient).max(axis=1)
    defined = largest > 0
    scaled = gradient / np.where(defined, largest, 1)[:, None]
    length = np.sqrt((scaled * scaled).sum(axis=1))
    return -scaled / np.where(defined, length, 1)[:, None] + 0.0, defined


PLACEMENTS = {"box": box_placement}
