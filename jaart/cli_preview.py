"""A scene without a window: its picture, and the plots of one ray, as files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from jaart.cli_files import save_figure
from jaart.core.camera import Camera
from jaart.core.export import save_picture
from jaart.core.quality import quality
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.settings import preset
from jaart.core.shade import shade
from jaart.core.statistics import statistics
from jaart.core.suited import suited
from jaart.core.trace import trace


def write_preview(scene: Scene, folder: Path) -> list[Path]:
    """Write the picture, the plots of the hit nearest to its middle and the statistics; returns the files."""
    from jaart.plot.statistics import statistics_figure
    from jaart.plot.trace import trace_figure

    settings = suited(scene, preset("best"))[0]
    hits = render(scene, settings)
    name = Path(scene.source).stem
    files = [folder / f"{name}{end}" for end in (".png", "-ray.svg", "-statistics.svg")]
    save_picture(shade(hits, scene=scene), files[0])
    ray = middle_hit(hits)
    followed = trace(scene, settings, hits.origin[ray], hits.direction[ray], _pixel(hits, ray))
    save_figure(trace_figure(followed, up=_up(hits.camera)), files[1])
    save_figure(statistics_figure(statistics(hits, quality(hits, scene))), files[2])
    return files


def middle_hit(hits: Hits) -> int:
    """The number of the ray that hit and is nearest to the middle of the picture; the middle when none hit."""
    width, height = hits.size or (len(hits), 1)
    y, x = np.divmod(np.arange(len(hits)), width)
    far = (x - width / 2) ** 2 + (y - height / 2) ** 2
    return int(np.argmin(np.where(hits.hit, far, np.inf) if hits.hit.any() else far))


def _pixel(hits: Hits, ray: int) -> tuple[int, int]:
    width = hits.size[0] if hits.size else len(hits)
    return ray % width, ray // width


def _up(camera: Camera | None) -> tuple[float, float, float]:
    return (0.0, 0.0, 1.0) if camera is None or camera.up is None else camera.up
