"""What `auto` loses and saves: hits against those of the same surface at 1e-12 with nothing cut off, in pixels.

`python -m benchmarks.auto` prints it, and what the surfaces are away from the exact one against the law that `auto`
takes for that (jaart.core.visible).
"""

from __future__ import annotations

from typing import Any

import numpy as np

import jaart
from jaart.core import visible
from jaart.core.camera import Camera
from jaart.core.chosen import chosen
from jaart.core.extents import bounds, spacing
from jaart.core.records import Hits
from jaart.core.scene import Scene
from jaart.core.settings import Settings, preset
from jaart.core.suited import suited

SIZE = (256, 256)
#: The same surface, as exactly as rounding lets one find it; its neighbourhoods end where f jumps by no more, and slow
#: rays may go on.
EXACT: dict[str, Any] = {"tolerance": 1e-12, "max_iterations": 200}
#: What the preset `best` has.
FIXED = preset("best").tolerance
#: Scenes with a raster, and what is changed in the preset `best`.
SCENES = (("standard", 16), ("standard", 64), ("splash", None), ("bumpy", None))
SURFACES: dict[str, dict[str, Any]] = {
    "best": {}, "tangent, iterate": {"method": "tangent", "patch": 0.0, "search": "iterate"},
    "tangent, secant": {"method": "tangent", "patch": 0.0}, "tangent, newton": {"method": "tangent", "patch": 0.0,
                                                                               "search": "newton"}}


def settings_of(scene: Scene, raster: int | None, change: dict[str, Any]) -> Settings:
    """The settings of a row."""
    made = suited(scene, preset("best").replace(**change, tolerance="auto"))[0]
    return made if raster is None else made.replace(raster=raster)


def lost(hits: Hits, exact: Hits, camera: Camera) -> str:
    """How far hits are from the exact ones along their rays, in pixels: 95 %, the largest, how many are farther than
    one, and on how many rays only one of them hits.
    """
    both = hits.hit & exact.hit
    pixels = np.abs(hits.t - exact.t)[both] / (camera.view(SIZE).pixel * exact.t[both])
    return (f"{np.quantile(pixels, 0.95):8.1e} {pixels.max():8.1e} {int((pixels > 1).sum()):5d} "
            f"{int((hits.hit != exact.hit).sum()):5d}")


def row(scene: Scene, raster: int | None, change: dict[str, Any], zoom: float) -> str:
    """A row of the table; zoom: how much nearer the eye is than where the whole scene is in view."""
    settings = settings_of(scene, raster, change)
    camera = Camera.fit(bounds(scene, settings), size=SIZE)
    camera = camera.replace(eye=tuple(np.add(camera.target, np.subtract(camera.eye, camera.target) / zoom)))
    auto, fixed, exact = (jaart.render(scene, settings.replace(**change), camera, SIZE)
                          for change in ({}, {"tolerance": FIXED}, EXACT))
    each = [f"{h.evaluations.sum() / max(1, h.hit.sum()):6.2f}" for h in (auto, fixed, exact)]
    weighed = [f"{h.neighbours.sum() / max(1, h.hit.sum()):6.0f}" for h in (auto, exact)]
    found = visible.for_picture(scene, settings, camera, SIZE)[0]
    return " ".join([f"{found:7.4f} h", lost(auto, exact, camera), lost(fixed, exact, camera), *each, *weighed])


def errors(scene: Scene, raster: int | None, change: dict[str, Any]) -> str:
    """The median distance from the exact surface, and what the law has for it, in cells or spacings."""
    settings = settings_of(scene, raster, change)
    found = jaart.quality(jaart.render(scene, settings, size=SIZE), scene)
    if found is None:
        return ""
    values = chosen(scene, settings)
    law = visible.model_error(scene, settings, values.h) / spacing(scene)
    return f"{np.nanmedian(found.distance):9.1e} {law:9.1e}"


def main() -> None:
    """Print both tables."""
    names = [(f"{name} {raster or ''}", jaart.load(name), raster) for name, raster in SCENES]
    print(f"{SIZE[0]}x{SIZE[1]} rays, tolerance auto and {FIXED:g}: distance along the ray to the exact hit, 95 % and "
          "largest in pixels, rays beyond a pixel,\nrays on which only one of the two hits; evaluations a hit; surfels "
          "weighed a hit")
    print(f"{'':13}{'surface':18}zoom      auto     95 %      max    >1 single{'':3} 0.01:95 %   max    >1 single"
          "   auto   0.01  exact   auto  exact")
    for name, scene, raster in names:
        for surface, change in SURFACES.items():
            for zoom in (1.0, 2.0):
                print(f"{name:13}{surface:18} {zoom:3g} {row(scene, raster, change, zoom)}", flush=True)
    print("\nmedian distance from the exact surface, in cells or spacings, and the law")
    for name, scene, raster in names:
        for surface, change in list(SURFACES.items())[:2]:
            print(f"{name:13}{surface:18} {errors(scene, raster, change)}", flush=True)


if __name__ == "__main__":
    main()
