"""What kernels are handed: tuples of arrays and of scalars."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Vector = tuple[float, float, float]
Cell = tuple[int, int, int]
#: np.uint64 to the compiler, which unlike numpy counts a loop up to one in its own type.
Unsigned: TypeAlias = Any


class Cells(NamedTuple):
    """A lattice's cells with the surfels near each.

    empty: (nx, ny, nz) Chebyshev distance to the nearest cell with a surfel, in cells, 0 = has one;
    first: (nx·ny·nz + 1,) where each cell's surfels begin in ids, C order of cells;
    ids: (M,) the surfels near each cell; columns: (6·M,) for each cell with N of them N times x, then y, z
    relative to its centre and the three parts of the normal, each contiguous so that sums vectorise.
    """

    empty: NDArray[np.uint8]
    first: NDArray[np.int64]
    ids: NDArray[np.int32]
    columns: Array


class Near(NamedTuple):
    """The surfels near one cell: as many as size in the columns from base on.

    The numbers are unsigned: a signed index would be checked for its sign, and the sums stay scalar.
    """

    columns: Array
    base: Unsigned
    size: Unsigned


class Search(NamedTuple):
    """What the iteration needs to know; lengths in cells.

    h: feature size; arrived: a shorter step ends it; cap: steps a start; trust: how far from the start;
    growth: 1 to give up as soon as |f| grows; max_off_centre: bound on |a(x) - x| of a hit.
    """

    h: float
    arrived: float
    cap: int
    trust: float
    growth: int
    max_off_centre: float


class Out(NamedTuple):
    """Columns of Hits for R rays, written in place."""

    t: Array
    point: Array
    normal: Array
    energy: Array
    off_centre: Array
    iterations: NDArray[np.int32]
    evaluations: NDArray[np.int32]
    neighbours: NDArray[np.int32]
    cells: NDArray[np.int32]
    status: NDArray[np.uint8]


#: Columns of a step's row in the log.
(START, T, X, Y, Z, AX, AY, AZ, NX, NY, NZ, STEP, WEIGHT, OFF, CELL_I, CELL_J, CELL_K, END) = range(18)
LOG_WIDTH = 18

#: Numbers of the end states, in the order of STATUS_NAMES; CONTINUE while a search goes on.
(CONVERGED, BACKGROUND, CAP, LEFT_TRUST, PARALLEL, FEW_NEIGHBOURS, UNDEFINED_NORMAL, BOUNDED, FLOOR,
 UNDECIDED, BAD_RAY) = range(11)
CONTINUE = 255
#: (state, t, point, normal, last step, off-centre, iterations, evaluations, neighbours, cells) of a ray.
RayEnd = tuple[int, float, Vector, Vector, float, float, int, int, int, int]
