"""One ray with every step it took, and the energies along it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jaart.core import extents, prepare
from jaart.core.balls import CloudTracer
from jaart.core.errors import RayError
from jaart.core.kernels import cylinder, energies
from jaart.core.kernels import records as r
from jaart.core.kernels.records import Out
from jaart.core.places import neighbours_of, served
from jaart.core.prepare import Prepared
from jaart.core.records import STATUS_NAMES, Array, Curves, Trace
from jaart.core.render import unit
from jaart.core.scene import Scene, frozen
from jaart.core.settings import Settings
from jaart.core.tiles import columns_for
from jaart.core.trace_path import Path, cloud_path, lattice_path, whole
from jaart.core.tracers import OnLattice
from jaart.core.warm import warm_up


@prepare.making_room
def trace(scene: Scene, settings: Settings, origin: ArrayLike, direction: ArrayLike,
          pixel: tuple[int, int] | None = None) -> Trace:
    """Follow one ray and keep every step; its hit has the same bits as `render` gives it.

    origin: (3,) in cells or cloud units; direction: (3,) of any length; pixel: where it was picked, kept for
    display. Raises RayError for what is `bad_ray` in a picture: an origin or a direction that is not finite, a
    direction of zero length, and an origin so far away that it has no precision left.
    """
    o, d = _ray(origin, direction)
    warm_up(scene, settings, tracing=True)
    ready = prepare.prepared(scene, settings)
    end, rows = _logged(ready, o, d)
    if end.status[0] == r.BAD_RAY:
        raise RayError(f"ray origin {o.tolist()}: too far from the scene to have any precision there")
    path = _path(ready, o, d)
    near, weights = _neighbours(ready, rows, d)
    rows[:, r.X:r.Z + 1] += ready.tracer.offset
    rows[:, r.AX:r.AZ + 1] += ready.tracer.offset
    step = np.where(np.isfinite(rows[:, r.STEP]), rows[:, r.STEP], np.nan)
    low, high = extents.bounds(scene, settings)
    return Trace(
        origin=frozen(o), direction=frozen(d), t=float(end.t[0]), point=frozen(end.point[0]),
        normal=frozen(end.normal[0]), status=STATUS_NAMES[end.status[0]], t_query=frozen(rows[:, r.T]),
        query=frozen(rows[:, r.X:r.Z + 1]), barycentre=frozen(rows[:, r.AX:r.AZ + 1]),
        step_normal=frozen(rows[:, r.NX:r.NZ + 1]), t_next=frozen(rows[:, r.T] + step),
        next_point=frozen(rows[:, r.X:r.Z + 1] + step[:, None] * d), energy=frozen(step),
        off_centre=frozen(rows[:, r.OFF]), weight_sum=frozen(np.exp(rows[:, r.WEIGHT])),
        start=whole(rows[:, r.START]), step_cell=path.numbered(_step_places(rows)),
        outcome=tuple("continue" if e == r.CONTINUE else STATUS_NAMES[int(e)] for e in rows[:, r.END]),
        neighbours=near, weights=weights, cells=path.cells, borders=path.borders, with_surfel=path.with_surfel,
        balls=path.balls, surfels=ready.surfels, curves=_curves(ready, o, d, path), settings=settings,
        low=frozen(low), high=frozen(high), pixel=pixel)


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


def _path(ready: Prepared, o: Array, d: Array) -> Path:
    if isinstance(ready.tracer, CloudTracer):
        return cloud_path(ready.tracer, o - ready.tracer.offset, d)
    assert isinstance(ready.tracer, OnLattice)
    return lattice_path(ready.tracer.cells.empty, o, d)


def _step_places(rows: Array) -> NDArray[np.int32]:
    return whole(rows[:, r.CELL_I:r.CELL_K + 1])


def _neighbours(ready: Prepared, rows: Array, d: Array) -> tuple[tuple[NDArray[np.int64], ...], tuple[Array, ...]]:
    """For each step the surfels that count, and their normalised weights."""
    sites, rule = ready.tracer.sites, ready.tracer.plan.rule
    ids, weights = [], []
    for row, place in zip(rows, _step_places(rows), strict=True):
        near = neighbours_of(sites, tuple(place.tolist()))
        centre = sites.centres[place[0]] if sites.shape[0] == 0 else place + 0.5
        x, w = row[r.X:r.Z + 1] - centre, np.empty(2 * len(near))
        cell, at = tuple(place.tolist()), tuple(x.tolist())
        if ready.values.method == "cylinder":
            cylinder.write_shares(sites, cell, at, tuple(d.tolist()), ready.values.h, w)
        else:
            energies.write_weights(sites, cell, at, rule, w)
        w = w[:len(near)]
        ids.append(near[w > 0].astype(np.int64))
        weights.append(frozen(w[w > 0]))
    return tuple(ids), tuple(weights)


def _curves(ready: Prepared, o: Array, d: Array, path: Path) -> Curves:
    """The energies along the path."""
    values, tracer = np.empty((4, len(path.ts))), ready.tracer
    origin, direction = tuple((o - tracer.offset).tolist()), tuple(d.tolist())
    served(tracer.sites, lambda own, pool: energies.sample(own, tracer.plan, origin, direction, path.ts, path.places,
                                                           values, pool.work, pool.fit))
    return Curves(frozen(path.ts), *(frozen(v) for v in values))
