"""Trace all rays of a picture, or of a list, in tiles over a pool of threads."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from threading import Event

import numpy as np

from jaart.core import extents, meaning, memory, prepare, visible
from jaart.core.camera import Camera, check_size
from jaart.core.counters import Made, made_by, since
from jaart.core.errors import Cancelled, RayError
from jaart.core.kernels.pinhole import View, write_rays
from jaart.core.kernels.records import Out
from jaart.core.prepare import Prepared
from jaart.core.records import Array, Hits
from jaart.core.reuse import lent
from jaart.core.scene import Scene
from jaart.core.settings import Settings, preset
from jaart.core.telling import stoppable
from jaart.core.tiles import STEPS, TILE, Pixels, columns_for, in_blocks, pixels_at, tile_of, tiles
from jaart.core.tracers import NO_BEGINS, NO_BLOCKS
from jaart.core.warm import warm_choice, warm_up

#: What one ray and its hit take.
_BYTES_A_RAY = 6 * 8 + 9 * 8 + 7 * 4 + 1
#: A picture that is done sooner than this [s] shows nothing between its first coarse one and itself: to trace rays
#: that are no neighbours, and to copy and paint what they met, would make it a quarter later.
PATIENCE = 0.3
#: A ray of the first pass takes so many times as long as one among all: it has no neighbours, and finds less made.
FIRST = 2.0

Size = tuple[int, int]


@prepare.making_room
def render(scene: Scene, settings: Settings | None = None, camera: Camera | None = None,
           size: Size = (512, 512), *, rays: tuple[Array, Array] | None = None, threads: int | None = None,
           progress: Callable[[int, int], None] | None = None, cancel: Event | None = None,
           picture: Callable[[Hits], None] | None = None, any_hit: bool = False) -> Hits:
    """Where every ray of a picture meets the surface.

    settings: those of the preset "best" when None; camera: the whole scene in view when None; size: (width,
    height); rays: origins and directions (R, 3) in cells or cloud units instead of a camera, directions of any
    length; threads: as many as the machine has when None;
    progress(done, all rays) is called from the caller's thread; cancel: set it to stop;
    picture: called with coarse pictures while the work goes on: every 8th pixel, then every 4th and 2nd where the
    rest takes long; again from the first where memory ends and the picture begins anew; any_hit: one that is found
    sooner will do for the first, as shadows need.
    Raises RayError for a picture or rays that cannot be, Cancelled after cancel was set.
    """
    settings = settings or preset("best")
    job = _camera_job(scene, settings, camera, size) if rays is None else _list_job(rays, any_hit)
    with stoppable(cancel):
        ready = _ready(scene, settings, job.camera, size, cancel)
    count, begin = threads or os.cpu_count() or 1, time.perf_counter()
    with ThreadPoolExecutor(count) as pool:
        watch = _Watch(progress, cancel, job.count)
        run = _Run(pool, count, ready, job.beginning(ready), settings, watch, begin, made_by(ready.tracer))
        if picture and job.size:
            return _refined(run, job.size, picture)
        out = columns_for(job.count)
        run.trace(run.job, in_blocks(job.size, 1) if job.size else np.arange(job.count), out)
        return run.hits(run.job, out, job.size)


def _ready(scene: Scene, settings: Settings, camera: Camera | None, size: Size, cancel: Event | None) -> Prepared:
    """All that rays need; its seconds hold what the settings came to, but no compilation."""
    warm_choice(scene)
    begin = time.perf_counter()
    meaning.check(scene, settings)
    chosen = time.perf_counter() - begin
    warm_up(scene, settings)
    ready = prepare.prepared(scene, visible.seen(scene, settings, camera, size), cancel)
    return replace(ready, seconds=ready.seconds + chosen)


@dataclass(frozen=True)
class _Job:
    """The rays to trace: those of a camera, written tile by tile, or a list.

    origins, directions: (R, 3); view: the camera as the kernels take it, None for a list; any_hit: not only the
    first hit will do; pixels: (R,) of the picture, None for all of them in order; blocks: t before which blocks of
    pixels meet nothing, begins: (R,) that of each ray, or both without entries.
    """

    origins: Array
    directions: Array
    camera: Camera | None = None
    size: Size | None = None
    view: View | None = None
    any_hit: bool = False
    pixels: Pixels | None = None
    blocks: Array = field(default_factory=lambda: NO_BLOCKS)
    begins: Array = field(default_factory=lambda: NO_BEGINS)

    @property
    def count(self) -> int:
        """How many rays there are."""
        return len(self.origins)

    def trace(self, ready: Prepared, rows: Pixels, out: Out) -> None:
        """Trace some of the rays into their rows of the columns."""
        if self.view is not None:
            pixels = rows if self.pixels is None else self.pixels[rows]
            write_rays(self.view, pixels, rows, self.origins, self.directions, self.blocks, self.begins)
        ready.tracer.trace(self.origins, self.directions, rows, out, any_hit=self.any_hit, begins=self.begins)

    def some(self, pixels: Pixels) -> _Job:
        """The rays of some pixels, in rows of their own."""
        few = np.empty((len(pixels), 3)), np.empty((len(pixels), 3))
        return replace(self, origins=few[0], directions=few[1], pixels=pixels, begins=self.begins[:len(pixels)].copy())

    def beginning(self, ready: Prepared) -> _Job:
        """This job with what is known of where the rays of a picture can meet anything."""
        blocks = NO_BLOCKS if self.view is None else ready.tracer.blocks(self.view)
        return replace(self, blocks=blocks, begins=lent((self.count if blocks.size else 0,)))


@dataclass
class _Watch:
    """Who is told how far the work is, and who may stop it; done: rays traced so far."""

    progress: Callable[[int, int], None] | None
    cancel: Event | None
    total: int
    done: int = 0

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
    return _Job(lent((count, 3)), lent((count, 3)), camera, size, camera.view(size))


def _list_job(rays: tuple[Array, Array], any_hit: bool) -> _Job:
    origins, directions = (np.array(a, dtype=np.float64) for a in rays)
    if origins.ndim != 2 or origins.shape[1] != 3 or origins.shape != directions.shape:
        raise RayError(f"rays: expected origins and directions (R, 3), found {origins.shape} and {directions.shape}")
    return _Job(origins, unit(directions), any_hit=any_hit)


#: The square of a length is this near to 1 where it was divided by its own length.
ROUNDED = 16 * float(np.finfo(float).eps)


def unit(directions: Array) -> Array:
    """Directions (R, 3) of length 1, those of a camera as they are; NaN where they have none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        scaled = directions / np.abs(directions).max(axis=1, keepdims=True)
        scaled /= np.sqrt((scaled * scaled).sum(axis=1, keepdims=True))
    with np.errstate(over="ignore", invalid="ignore"):
        already = np.abs((directions * directions).sum(axis=1, keepdims=True) - 1.0) < ROUNDED
    return np.where(already, directions, scaled)


@dataclass(frozen=True, eq=False)
class _Run:
    """A picture, or a list of rays, under way in a pool of so many threads.

    begin: when it began; before: what earlier rays of the same tracer had made ready.
    """

    pool: ThreadPoolExecutor
    threads: int
    ready: Prepared
    job: _Job
    settings: Settings
    watch: _Watch
    begin: float
    before: Made

    @property
    def seconds(self) -> float:
        """Seconds since it began."""
        return time.perf_counter() - self.begin

    def trace(self, job: _Job, rows: Pixels, out: Out, tile: int = TILE) -> None:
        """Trace some of the rays, so many at once, and wait for them."""
        def trace_tile(some: Pixels) -> int:
            if self.watch.stopped():
                return 0
            job.trace(self.ready, some, out)
            return len(some)

        tasks = [self.pool.submit(trace_tile, some) for some in tiles(rows, self.threads, tile)]
        try:
            _wait(tasks, self.watch)
        except BaseException:  # an interrupt must not wait for the tiles that have not begun
            self.pool.shutdown(cancel_futures=True)
            raise

    def hits(self, job: _Job, out: Out, size: Size | None, rows: Pixels | None = None) -> Hits:
        """The hits of a job's rays, or of some of them, as a picture of a size."""
        columns = {"origin": job.origins, "direction": job.directions, **out._asdict()}
        if rows is not None:
            columns = {name: column.take(rows, axis=0) for name, column in columns.items()}
        for column in columns.values():
            column.flags.writeable = False
        made = since(self.before, self.ready.tracer)
        return Hits(**columns, settings=self.settings, camera=job.camera, size=size, prep_s=self.ready.seconds,
                    ray_s=self.seconds, gathered=made.gathered, fits=made.fits)


def _refined(run: _Run, size: Size, picture: Callable[[Hits], None]) -> Hits:
    """A picture after coarser ones. The first is made in columns of its own: those of all rays cost more than it."""
    coarse, pixels = _coarse(size, STEPS[0]), pixels_at(size, STEPS[0])
    small, few = run.job.some(pixels), columns_for(len(pixels))
    begin = run.seconds
    run.trace(small, in_blocks(coarse, 1), few)
    ray = (run.seconds - begin) / len(pixels) / FIRST
    picture(run.hits(small, few, coarse))
    run.watch.done, out = 0, columns_for(run.job.count)
    for step, before in _finer(ray * run.job.count):
        run.trace(run.job, in_blocks(size, step, before), out, tile_of(ray * run.threads))
        if step > 1:
            picture(run.hits(run.job, out, _coarse(size, step), pixels_at(size, step)))
    return run.hits(run.job, out, size)


def _finer(seconds: float) -> list[tuple[int, int]]:
    """Steps of the passes after the first, each with the one before; the last alone where they take no longer.

    The few rays of the first are traced again: whole blocks of neighbours are quicker than blocks with holes.
    """
    steps = STEPS[1:] if seconds > PATIENCE else STEPS[-1:]
    return list(zip(steps, (0, *steps), strict=False))


def _coarse(size: Size, step: int) -> Size:
    """The size of a picture of every so many pixels."""
    return -(-size[0] // step), -(-size[1] // step)


def _wait(tasks: list[Future[int]], watch: _Watch) -> None:
    """Wait for tiles, telling how far they are. Raises Cancelled when they were stopped."""
    told = time.perf_counter()
    for task in tasks:
        watch.done += task.result()
        if watch.progress and time.perf_counter() - told > 0.1:
            told = time.perf_counter()
            watch.progress(watch.done, watch.total)
    if watch.stopped():
        raise Cancelled("the picture was cancelled")
    if watch.progress:
        watch.progress(watch.done, watch.total)
