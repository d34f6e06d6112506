"""A whole picture: the hits of one ray a pixel, and its colours, averaged over several rays where the settings say."""

from __future__ import annotations

from collections.abc import Callable
from threading import Event

import numpy as np
from numpy.typing import NDArray

from jaart.core import extents, visible
from jaart.core.camera import Camera
from jaart.core.colours import Bytes
from jaart.core.quality import quality as errors_of
from jaart.core.records import Array, Hits, Quality
from jaart.core.render import Size, render
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.shade import needs_scene, shade

Progress = Callable[[int, int], None]

#: So many rays of a picture with several samples are traced and shaded at once.
RAYS_AT_ONCE = 1 << 18


def picture(scene: Scene, settings: Settings | None = None, camera: Camera | None = None, size: Size = (512, 512),
            map: str = "shaded", theme: str = "light", cancel: Event | None = None, progress: Progress | None = None,
            threads: int | None = None) -> tuple[Hits, Bytes]:
    """The hits of a picture, one ray through the middle of each pixel, and its colours (h, w, 3).

    The arguments are those of `render` and `shade`; progress(done, all rays) counts those of all samples, not those
    behind a surface. Raises what `render` and `shade` raise.
    """
    settings = settings or Settings()
    camera = camera or Camera.fit(extents.bounds(scene, settings), size=size)
    count, more = size[0] * size[1], _samples(settings, map) ** 2 * size[0] * size[1]
    more = 0 if more == count else more
    hits = render(scene, settings, camera, size, threads=threads, cancel=cancel,
                  progress=progress and (lambda done, _: progress(done, count + more)))
    errors = errors_of(hits, scene) if map.endswith("_error") else None
    return hits, finish(hits, scene, map, errors, theme, settings, cancel,
                        progress and (lambda done, _: progress(count + done, count + more)), threads)


def finish(hits: Hits, scene: Scene, map: str = "shaded", quality: Quality | None = None, theme: str = "light",
           settings: Settings | None = None, cancel: Event | None = None, progress: Progress | None = None,
           threads: int | None = None) -> Bytes:
    """The colours (h, w, 3) of a picture's hits, with every ray that they take.

    settings: how to shade, those of the hits when None; several samples a pixel are traced anew, and the light they
    bring is averaged. A number in false colour is that of the one ray of a hit. Raises what `shade` raises.
    """
    settings = settings or hits.settings
    if _samples(settings, map) == 1 or hits.camera is None:
        return shade(hits, map, quality, theme, settings, scene, threads, cancel)
    return _averaged(hits, scene, theme, settings, cancel, progress, threads)


def takes_time(settings: Settings, map: str = "shaded") -> bool:
    """Whether the colours of hits take more rays, and so perhaps seconds."""
    return map == "shaded" and (needs_scene(settings) or settings.samples > 1)


def plain(settings: Settings) -> Settings:
    """Settings that shade at once: Phong, no shadows, one sample."""
    if needs_scene(settings):
        settings = settings.replace(shading="phong", shadows=False)
    return settings.replace(samples=1)


def _samples(settings: Settings, map: str) -> int:
    return settings.samples if map == "shaded" else 1


def _averaged(hits: Hits, scene: Scene, theme: str, settings: Settings, cancel: Event | None,
              progress: Progress | None, threads: int | None) -> Bytes:
    """The picture in strips of whole rows, so that many samples take no more memory than few."""
    assert hits.camera is not None and hits.size is not None
    (width, height), n = hits.size, settings.samples
    fine, traced = (width * n, height * n), visible.of_hits(scene, hits).replace(samples=1)
    rows, total = max(1, RAYS_AT_ONCE // (fine[0] * n)), fine[0] * fine[1]
    result = np.empty((height, width, 3), np.uint8)
    for top in range(0, height, rows):
        first, last = top * n * fine[0], min(top + rows, height) * n * fine[0]
        rays = hits.camera.rays(fine, np.arange(first, last))
        done = render(scene, traced, rays=rays, threads=threads, cancel=cancel)
        colours = shade(done, "shaded", None, theme, settings, scene, threads, cancel)
        result[top:top + rows] = box_average(colours.reshape(-1, fine[0], 3), n)
        if progress:
            progress(last, total)
    return result


def box_average(colours: Bytes, n: int) -> Bytes:
    """Every n × n pixels of a picture (h·n, w·n, 3) as one: the mean of their light, not of its sRGB bytes."""
    height, width = colours.shape[0] // n, colours.shape[1] // n
    light: Array = _linear()[colours].reshape(height, n, width, n, 3).mean(axis=(1, 3))
    return _bytes(light)


def _linear() -> Array:
    """Linear light of each byte of sRGB (IEC 61966-2-1)."""
    srgb: NDArray[np.float64] = np.arange(256) / 255
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def _bytes(light: Array) -> Bytes:
    srgb = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    result: Bytes = np.rint(255 * srgb).astype(np.uint8)
    return result
