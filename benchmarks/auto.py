"""What `tolerance = auto` saves, and that nothing of it can be seen: against the same picture traced to 1e-9.

`hits` are those of auto less those at 1e-9: a few rays differ, mostly on lattices. f jumps there where lists of
surfels end (benchmarks/jumps.py); whether that is why is not measured. `off` is how far the surface is from the true
one, median of the hits: the model's error, which visible.ERROR and FITTED_ERROR give from below.
"""

from __future__ import annotations

import statistics
from typing import Any

import numpy as np

import jaart
from jaart.core import cloud, extents, prepare, visible
from jaart.core.chosen import arrival
from jaart.core.parameter import Length
from jaart.core.samples import bumpy_sphere

SIZE, REPEATS = (256, 256), 7
#: Far below every tolerance that auto comes to; the radius is auto's, so that the tolerance alone differs.
EXACT = 1e-9
METHODS: dict[str, dict[str, Any]] = {
    "plane": {"method": "tangent", "search": "iterate"}, "polynomial": {"method": "polynomial", "search": "secant"}}
SCENES = {"standard 32": (jaart.load("standard"), {"raster": 32}),
          "standard 64": (jaart.load("standard"), {"raster": 64}), "splash": (jaart.load("splash"), {}),
          "bumpy": (jaart.load("bumpy"), {}), "bumpy 4k": (bumpy_sphere(4000), {})}


def main() -> None:
    print(f"tolerance = auto against {EXACT:g}, {SIZE[0]}x{SIZE[1]}, lengths in pixels where the scene is nearest, "
          f"median of {REPEATS} times")
    print(f"{'scene':12} {'surface':10} {'tolerance':>10} {'off, h²/L':>9} {'depth 99 %':>10} {'worst':>9} "
          f"{'colours > 2':>11} {'hits':>5} {'evaluations':>11} {'time':>6}")
    for scene_name, (scene, given) in SCENES.items():
        for name, method in METHODS.items():
            print(f"{scene_name:12} {name:10} {row(scene, jaart.Settings(**method, **given))}", flush=True)


def row(scene: jaart.Scene, settings: jaart.Settings) -> str:
    """One scene and surface: what auto came to, how it differs and what it saves."""
    auto = settings.replace(tolerance="auto")
    eye = jaart.Camera.fit(extents.bounds(scene, settings), size=SIZE)
    values = prepare.prepared(scene, visible.seen(scene, auto, eye, SIZE)).values
    exact = settings.replace(tolerance=EXACT, radius=Length(values.radius))  # else a finer tolerance has a wider one
    pictures = {one: jaart.picture(scene, one, eye, SIZE) for one in (auto, exact)}
    (found, colours), (true, wanted) = pictures[auto], pictures[exact]
    times: dict[jaart.Settings, list[float]] = {auto: [], exact: []}
    for _ in range(REPEATS):
        for one, seconds in times.items():
            seconds.append(jaart.render(scene, one, eye, SIZE).ray_s)
    both = found.hit & true.hit
    depth = np.abs(found.t - true.t)[both] / visible.pixel(scene, settings, eye, SIZE)
    differs = np.abs(colours.astype(int) - wanted.astype(int)).max(axis=-1) > 2
    share = statistics.median(times[auto]) / statistics.median(times[exact])
    return (f"{arrival(values) / values.h:8.2g} h {off(scene, true, values.h):9.2g} {np.quantile(depth, 0.99):10.2g} "
            f"{depth.max():9.2g} {differs.sum():11} {found.hit.sum() - true.hit.sum():5} "
            f"{found.evaluations.sum() / true.evaluations.sum():10.2f}x {share:5.2f}x")


def off(scene: jaart.Scene, hits: jaart.Hits, h: float) -> float:
    """Median distance from the true surface in h² over the longest edge; NaN where nobody knows it."""
    errors = jaart.quality(hits, scene)
    if errors is None:
        return float("nan")
    unit = cloud.spacing(scene) if scene.kind == "cloud" else 1.0
    return float(np.nanmedian(errors.distance)) * unit * extents.largest(scene, hits.settings) / (h * h)


if __name__ == "__main__":
    main()
