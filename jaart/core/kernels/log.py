"""The log of a ray: a row for every evaluation."""

from __future__ import annotations

from math import log

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.place import in_scene
from jaart.core.kernels.records import Array, Cell, Sites, Start, Value, Vector
from jaart.core.kernels.vectors import along, length


@kernel(STRICT)
def write_step(rows: Array, row: int, sites: Sites, start: Start, s: float, cell: Cell, x: Vector, v: Value,
               step: float) -> None:
    """Write one evaluation into the log where it has room; points in the scene's coordinates."""
    if row >= rows.shape[0]:
        return
    to = rows[row]
    to[r.START], to[r.T], to[r.STEP], to[r.END] = start.number, start.t + s, step, r.CONTINUE
    to[r.WEIGHT] = v.shift + log(v.weight)
    to[r.X], to[r.Y], to[r.Z] = in_scene(sites, cell, x)
    to[r.AX], to[r.AY], to[r.AZ] = in_scene(sites, cell, along(x, v.off, 1.0))
    to[r.NX], to[r.NY], to[r.NZ] = v.n
    to[r.CELL_I], to[r.CELL_J], to[r.CELL_K] = cell
    to[r.OFF] = length(v.off)


@kernel(STRICT)
def end_log(rows: Array, row: int, state: int) -> None:
    """Write the end of a start into the row of its last evaluation."""
    if 0 < row <= rows.shape[0]:
        rows[row - 1, r.END] = state
