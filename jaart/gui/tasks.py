"""What the worker computes for the window; the heavy imports happen here, in its thread."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np

from jaart.core.camera import Camera
from jaart.core.records import Hits, Trace
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.telling import told
from jaart.gui.navigation import Bounds
from jaart.gui.worker import Job

if TYPE_CHECKING:
    from jaart.core.chosen import Chosen


@dataclass(frozen=True)
class Opened:
    """A scene that was read: its corners, settings that suit it, the preset's there, and what was changed."""

    scene: Scene
    bounds: Bounds
    settings: Settings
    base: Settings
    changed: str


@dataclass(frozen=True)
class Known:
    """What the settings come to in a scene.

    spacing: the unit "s" of lengths; diagonal: the unit "d"; notes: what a person should know of it; sided: whether
    normals point outwards, and not to either side.
    """

    values: Chosen
    spacing: float
    diagonal: float
    notes: tuple[str, ...] = ()
    sided: bool = False


@dataclass(frozen=True)
class Made:
    """A picture, and what its settings came to."""

    hits: Hits
    known: Known


def read(job: Job, source: str | PathLike[str], frame: int | None, settings: Settings | None, preset: str,
         before: Scene | None) -> Opened:
    """A scene and settings for it: the preset's for None.

    Raises FileError for a file that cannot be read, Cancelled once it is unwanted.
    """
    from jaart.core import prepare
    from jaart.core.groups.surface import evaluates
    from jaart.core.io import load
    from jaart.gui.suit import of_preset, suited

    with told(job.watch):
        scene = load(source, frame)
        base, changed = of_preset(scene, preset)
        settings, changed = (base, changed) if settings is None else suited(scene, settings, base, before)
        if scene.kind != "cloud" and evaluates(settings):
            prepare.surfels(scene, settings)
    return Opened(scene, bounds(scene, settings), settings, base, changed)


def bounds(scene: Scene, settings: Settings) -> Bounds:
    """Lowest and highest corner of a scene."""
    from jaart.core import extents

    low, high = extents.bounds(scene, settings)
    return (float(low[0]), float(low[1]), float(low[2])), (float(high[0]), float(high[1]), float(high[2]))


def picture(job: Job, scene: Scene, settings: Settings, camera: Camera, size: tuple[int, int],
            dragging: bool, take: Callable[[Chosen], None]) -> Made:
    """A picture; coarse ones are shown while it is made, and what its settings come to is taken before that."""
    from jaart.core.meaning import check
    from jaart.core.render import render

    _say_compiling(job, scene, settings)
    values = check(scene, settings)
    job.hand(take, values)
    with told(job.watch):
        hits = render(scene, settings, camera, size, progress=None if dragging else job.progress, cancel=job.cancel,
                      picture=None if dragging else job.partial)
    return Made(hits, _known(scene, settings, values))


def _say_compiling(job: Job, scene: Scene, settings: Settings, tracing: bool = False) -> None:
    """Say why nothing happens for some seconds, the first time that kernels are needed on a machine."""
    from jaart.core.warm import needs_compile

    if needs_compile(scene, settings, tracing):
        job.say("Compiling kernels that are needed for the first time on this machine; this takes some seconds …")


def _known(scene: Scene, settings: Settings, values: Chosen) -> Known:
    from jaart.core import cloud, extents
    from jaart.core.meaning import oriented
    from jaart.core.notes import notes

    spacing = cloud.spacing(scene) if scene.kind == "cloud" else 1.0
    sided = values.normal == "surfel" or oriented(scene, settings, values)
    return Known(values, spacing, extents.diagonal(scene, settings), notes(scene, settings), sided)


def ray(job: Job, scene: Scene, settings: Settings, camera: Camera, size: tuple[int, int],
        pixel: tuple[int, int]) -> Trace:
    """The ray through a pixel with every step."""
    from jaart.core.trace import trace
    from jaart.core.visible import seen

    _say_compiling(job, scene, settings, tracing=True)
    settings = seen(scene, settings, camera, size)
    origins, directions = camera.rays(size, np.array([pixel[0] + pixel[1] * size[0]]))
    return trace(scene, settings, origins[0], directions[0], pixel=pixel)
