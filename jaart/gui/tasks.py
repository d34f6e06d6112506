"""What the worker computes for the window; the heavy imports happen here, in its thread."""

from __future__ import annotations

from os import PathLike

import numpy as np

from jaart.core.camera import Camera
from jaart.core.records import Hits, Quality, Trace
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.gui.worker import Job

Extent = tuple[float, float, float]


def read(source: str | PathLike[str], frame: int | None, settings: Settings) -> tuple[Scene, Extent]:
    """A scene and its size in cells. Raises FileError for a file that cannot be read or has no surface."""
    from jaart.core import prepare
    from jaart.core.io import load

    scene = load(source, frame)
    prepare.surfels(scene, settings)
    return scene, prepare.extent(scene, settings)


def picture(job: Job, scene: Scene, settings: Settings, camera: Camera, size: tuple[int, int],
            dragging: bool) -> tuple[Hits, Quality | None]:
    """A picture and, where the exact surface is known, its errors; coarse ones are shown while it is made."""
    from jaart.core.quality import quality
    from jaart.core.render import render
    from jaart.core.warm import needs_compile

    if needs_compile():
        job.say("Compiling the kernels, once on this machine; this takes some seconds …")
    hits = render(scene, settings, camera, size, progress=None if dragging else job.progress, cancel=job.cancel,
                  picture=None if dragging else job.partial)
    return hits, None if dragging else quality(hits, scene)


def ray(scene: Scene, settings: Settings, camera: Camera, size: tuple[int, int], pixel: tuple[int, int]) -> Trace:
    """The ray through a pixel with every step."""
    from jaart.core.trace import trace

    origins, directions = camera.rays(size, np.array([pixel[0] + pixel[1] * size[0]]))
    return trace(scene, settings, origins[0], directions[0], pixel=pixel)


