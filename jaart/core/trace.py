"""One ray with every step it took, and the energies along it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jaart.core import prepare
from jaart.core.cylinder import CylinderTracer
from jaart.core.errors import RayError
from jaart.core.kernels import cylinder, energies, traversal
from jaart.core.kernels import records as r
from jaart.core.kernels.records import Out
from jaart.core.prepare import Prepared
from jaart.core.records import STATUS_NAMES, Array, Curves, Trace
from jaart.core.render import unit
from jaart.core.scene import Scene, frozen
from jaart.core.settings import Settings
from jaart.core.tiles import columns_for
from jaart.core.tracers import scratch
from jaart.core.warm import warm_up

#: Samples of the energies in each cell that a ray crosses, its borders included.
SAMPLES_A_CELL = 12

Ints = NDArray[np.int32]


def trace(scene: Scene, settings: Settings, origin: ArrayLike, direction: ArrayLike,
          pixel: tuple[int, int] | None = None) -> Trace:
    """Follow one ray and keep every step; its hit has the same bits as `render` gives it.

    origin: (3,) in cells; direction: (3,) of any length; pixel: where it was picked, kept for display.
    Raises RayError for an origin or a direction that is not finite, or a direction of zero length.
    """
    o, d = _ray(origin, direction)
    warm_up(scene, settings, tracing=True)
    ready = prepare.prepared(scene, settings)
    end, rows = _logged(ready, o, d)
    shape = ready.tracer.cells.empty.shape
    bad = end.status[0] == r.BAD_RAY
    cells, borders = _crossed(o, d, (0, 0, 0) if bad else (shape[0], shape[1], shape[2]))
    near, weights = _neighbours(ready, rows, d)
    step = np.where(np.isfinite(rows[:, r.STEP]), rows[:, r.STEP], np.nan)
    return Trace(
        origin=frozen(o), direction=frozen(d), t=float(end.t[0]), point=frozen(end.point[0]),
        normal=frozen(end.normal[0]), status=STATUS_NAMES[end.status[0]], t_query=frozen(rows[:, r.T]),
        query=frozen(rows[:, r.X:r.Z + 1]), barycentre=frozen(rows[:, r.AX:r.AZ + 1]),
        step_normal=frozen(rows[:, r.NX:r.NZ + 1]), t_next=frozen(rows[:, r.T] + step),
        next_point=frozen(rows[:, r.X:r.Z + 1] + step[:, None] * d), energy=frozen(step),
        off_centre=frozen(rows[:, r.OFF]), weight_sum=frozen(np.exp(rows[:, r.WEIGHT])),
        start=_whole(rows[:, r.START]), step_cell=_step_cells(rows),
        outcome=tuple("continue" if e == r.CONTINUE else STATUS_NAMES[int(e)] for e in rows[:, r.END]),
        neighbours=near, weights=weights, cells=cells, borders=frozen(borders),
        with_surfel=ready.tracer.cells.empty[tuple(cells.T)] == 0, surfels=ready.surfels,
        curves=_curves(ready, o, d, cells, borders), settings=settings,
        extent=prepare.extent(scene, settings), pixel=pixel)


def _ray(origin: ArrayLike, direction: ArrayLike) -> tuple[Array, Array]:
    o, d = np.array(origin, dtype=np.float64), np.array(direction, dtype=np.float64)
    for name, vector in (("origin", o), ("direction", d)):
        if vector.shape != (3,) or not np.isfinite(vector).all():
            raise RayError(f"ray {name} {vector.tolist()}: expected three finite numbers")
    if not d.any():
        raise RayError("ray direction has zero length")
    return o, unit(d[None])[0]


def _logged(ready: Prepared, o: Array, d: Array) -> tuple[Out, Array]:
    """The end of a ray and the log of its steps, in a log that is enlarged until it holds them."""
    room, out = 256, columns_for(1)
    while True:
        rows = np.empty((room, r.LOG_WIDTH))
        written = ready.tracer.trace(o[None], d[None], np.zeros(1, np.int64), out, rows)
        if written <= room:
            return out, rows[:written]
        room = written


def _whole(numbers: NDArray[Any]) -> Ints:
    whole = numbers.astype(np.int32)
    whole.flags.writeable = False
    return whole


def _step_cells(rows: Array) -> Ints:
    return _whole(rows[:, r.CELL_I:r.CELL_K + 1])


def _crossed(o: Array, d: Array, shape: tuple[int, int, int]) -> tuple[Ints, Array]:
    """All cells (C, 3) that a ray crosses, and the t where it crosses into each and out of the last."""
    cells, borders = np.empty((sum(shape) + 3, 3), np.int32), np.empty(sum(shape) + 4)
    n = traversal.crossed(o, d, shape, cells, borders)
    return _whole(cells[:n]), borders[:n + 1] if n else borders[:0]


def _neighbours(ready: Prepared, rows: Array, d: Array) -> tuple[tuple[NDArray[np.int64], ...], tuple[Array, ...]]:
    """For each step the surfels that count, and their normalised weights."""
    sites, rule = ready.tracer.sites, ready.tracer.plan.rule
    ids, weights = [], []
    for row, cell in zip(rows, _step_cells(rows), strict=True):
        number = np.ravel_multi_index(cell, sites.shape)
        first, last = sites.first[number], sites.first[number + 1]
        x, w = row[r.X:r.Z + 1] - (cell + 0.5), np.empty(2 * (last - first))
        place, at = tuple(cell.tolist()), tuple(x.tolist())
        if isinstance(ready.tracer, CylinderTracer):
            cylinder.write_shares(sites, place, at, tuple(d.tolist()), ready.tracer.radius, w)
        else:
            energies.write_weights(sites, place, at, rule, w)
        w = w[:last - first]
        ids.append(sites.ids[first:last][w > 0].astype(np.int64))
        weights.append(frozen(w[w > 0]))
    return tuple(ids), tuple(weights)


def _curves(ready: Prepared, o: Array, d: Array, cells: Ints, borders: Array) -> Curves:
    """The energies at evenly spaced points of every cell crossed, with both sides of each border."""
    share = np.linspace(0.0, 1.0, SAMPLES_A_CELL)
    ts = (borders[:-1, None] + np.diff(borders)[:, None] * share).ravel() if len(cells) else np.empty(0)
    values = np.empty((4, len(ts)))
    sites = ready.tracer.sites
    energies.sample(sites, ready.tracer.plan, tuple(o.tolist()), tuple(d.tolist()), ts,
                    np.repeat(cells.astype(np.int64), SAMPLES_A_CELL, axis=0), values, *scratch(sites))
    return Curves(frozen(ts), *(frozen(v) for v in values))
