"""Trace all rays of a picture, or of a list, in tiles over a pool of threads."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from threading import Event

import numpy as np

from jaart.core import extents, memory, prepare, visible
from jaart.core.camera import Camera, check_size
from jaart.core.counters import Made, made_by, since
from jaart.core.errors import Cancelled, RayError
from jaart.core.kernels.pinhole import View, write_rays
from jaart.core.kernels.records import Out
from jaart.core.prepare import Prepared
from jaart.core.records import Array, Hits
from jaart.core.scene import Scene
from jaart.core.settings import Settings, preset
from jaart.core.tiles import Pixels, coarse_passes, columns_for, tiles
from jaart.core.warm import warm_up

#: What one ray and its hit take.
_BYTES_A_RAY = 6 * 8 + 9 * 8 + 4 * 4 + 1

Size = tuple[int, int]


def render(scene: Scene, settings: Settings | None = None, camera: Camera | None = None,
           size: Size = (512, 512), *, rays: tuple[Array, Array] | None = None, threads: int | None = None,
           progress: Callable[[int, int], None] | None = None, cancel: Event | None = None,
           picture: Callable[[Hits], None] | None = None, any_hit: bool = False) -> Hits:
    """Where every ray of a picture meets the surface.

    settings: those of the preset "best" when None; camera: the whole scene in view when None; size: (width,
    height); rays: origins and directions (R, 3) in cells or cloud units instead of a camera, directions of any
    length; threads: as many as the machine has when None;
    progress(done, all rays) is called from the caller's thread; cancel: set it to stop;
    picture: called with coarse pictures, every 8th, 4th and 2nd pixel, while the work goes on; any_hit: one that
    is found sooner will do for the first, as shadows need.
    Raises RayError for a picture or rays that cannot be, Cancelled after cancel was set.
    """
    settings = settings or preset("best")
    job = _camera_job(scene, settings, camera, size) if rays is None else _list_job(rays, any_hit)
    warm_up(scene, settings)
    ready = prepare.prepared(scene, visible.seen(scene, settings, job.camera, size), cancel)
    before, begin = made_by(ready.tracer), time.perf_counter()
    out = columns_for(job.count)
    passes = coarse_passes(job.size) if picture and job.size else [(1, np.arange(job.count))]
    done = 0
    with ThreadPoolExecutor(threads or os.cpu_count() or 1) as pool:
        for step, pixels in passes:
            _trace_all(pool, ready, job, pixels, out, _Watch(progress, cancel, done, job.count))
            done += len(pixels)
            if picture and step > 1:
                picture(_every(step, job, out, settings, ready, before, begin))
    return _every(1, job, out, settings, ready, before, begin)


@dataclass(frozen=True)
class _Job:
    """The rays to trace: those of a camera, written tile by tile, or a list.

    origins, directions: (R, 3); view: the camera as the kernels take it, None for a list; any_hit: not only the
    first hit will do.
    """

    origins: Array
    directions: Array
    camera: Camera | None = None
    size: Size | None = None
    view: View | None = None
    any_hit: bool = False

    @property
    def count(self) -> int:
        """How many rays there are."""
        return len(self.origins)

    def trace(self, ready: Prepared, pixels: Pixels, out: Out) -> None:
        """Trace some of the rays into their rows of the columns."""
        if self.view is not None:
            write_rays(self.view, pixels, pixels, self.origins, self.directions)
        ready.tracer.trace(self.origins, self.directions, pixels, out, any_hit=self.any_hit)


@dataclass(frozen=True)
class _Watch:
    """Who is told how far the work is, and who may stop it."""

    progress: Callable[[int, int], None] | None
    cancel: Event | None
    before: int
    total: int

    def stopped(self) -> bool:
        """Whether the work is to stop."""
        return self.cancel is not None and self.cancel.is_set()


def _camera_job(scene: Scene, settings: Settings, camera: Camera | None, size: Size) -> _Job:
    check_size(size)
    camera = camera or Camera.fit(extents.bounds(scene, settings), size=size)
    count = size[0] * size[1]
    if count * _BYTES_A_RAY > memory.limit():
        raise RayError(f"size {size[0]}x{size[1]}: needs {memory.words(count * _BYTES_A_RAY)} of memory, more than the "
                       f"{memory.words(memory.limit())} it may take")
    return _Job(np.empty((count, 3)), np.empty((count, 3)), camera, size, camera.view(size))


def _list_job(rays: tuple[Array, Array], any_hit: bool) -> _Job:
    origins, directions = (np.array(a, dtype=np.float64) for a in rays)
    if origins.ndim != 2 or origins.shape[1] != 3 or origins.shape != directions.shape:
        raise RayError(f"rays: expected origins and directions (R, 3), found {origins.shape} and {directions.shape}")
    return _Job(origins, unit(directions), any_hit=any_hit)


def unit(directions: Array) -> Array:
    """Directions (R, 3) of length 1, those that have it to the last bit; NaN where they have none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        scaled = directions / np.abs(directions).max(axis=1, keepdims=True)
        scaled /= np.sqrt((scaled * scaled).sum(axis=1, keepdims=True))
    with np.errstate(over="ignore", invalid="ignore"):
        already = np.abs((directions * directions).sum(axis=1, keepdims=True) - 1.0) < 1e-15
    return np.where(already, directions, scaled)


def _trace_all(pool: ThreadPoolExecutor, ready: Prepared, job: _Job, pixels: Pixels, out: Out,
               watch: _Watch) -> None:
    """Trace some of the rays and wait for them."""
    def trace_tile(tile: Pixels) -> int:
        if watch.stopped():
            return 0
        job.trace(ready, tile, out)
        return len(tile)

    tasks = [pool.submit(trace_tile, tile) for tile in tiles(pixels)]
    try:
        _wait(tasks, watch)
    except BaseException:  # an interrupt must not wait for the tiles that have not begun
        pool.shutdown(cancel_futures=True)
        raise


def _wait(tasks: list[Future[int]], watch: _Watch) -> None:
    """Wait for tiles, telling how far they are. Raises Cancelled when they were stopped."""
    done, told = watch.before, time.perf_counter()
    for task in tasks:
        done += task.result()
        if watch.progress and time.perf_counter() - told > 0.1:
            told = time.perf_counter()
            watch.progress(done, watch.total)
    if watch.stopped():
        raise Cancelled("the picture was cancelled")
    if watch.progress:
        watch.progress(done, watch.total)


def _every(step: int, job: _Job, out: Out, settings: Settings, ready: Prepared, before: Made, begin: float) -> Hits:
    """The hits of every so many pixels, as a smaller picture, and what was made and how long it took since `begin`."""
    ray_s, made = time.perf_counter() - begin, since(before, ready.tracer)
    columns = {"origin": job.origins, "direction": job.directions, **out._asdict()}
    size = job.size
    if step > 1 and size is not None:
        pixels = np.arange(job.count).reshape(size[1], size[0])[::step, ::step].ravel()
        columns = {name: column[pixels] for name, column in columns.items()}
        size = (-(-size[0] // step), -(-size[1] // step))
    for column in columns.values():
        column.flags.writeable = False
    return Hits(**columns, settings=settings, camera=job.camera, size=size, prep_s=ready.seconds, ray_s=ray_s,
                gathered=made.gathered, fits=made.fits)
