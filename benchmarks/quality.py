"""δ of the standard model against its exact solids, `--preset thesis`, 512×512."""

from __future__ import annotations

from dataclasses import replace

import jaart
from benchmarks.standard import RASTERS, SIZE, camera
from jaart.core.scene import Model

GOALS = {16: 0.18, 32: 0.09, 64: 0.045}
#: Solids smaller by this share hold no corner that lies on the surface, and are else the same.
OPEN = 1 - 1e-9


def main() -> None:
    scene = jaart.load("standard")
    print("standard model, --preset thesis, 512x512, lengths in cells")
    table(scene)
    print("\nthe same, corners on a surface counted as outside")
    table(replace(scene, model=opened(scene.model)))


def opened(model: Model) -> Model:
    """The model without its surfaces."""
    sphere, box = model.solids
    return replace(model, solids=(replace(sphere, radius=sphere.radius * OPEN),
                                  replace(box, size=tuple(n * OPEN for n in box.size))))


def table(scene: jaart.Scene) -> None:
    """A line for each raster."""
    print(f"{'raster':>6} {'delta':>8} {'goal':>6} {'delta_p':>8} {'delta_n':>8} "
          f"{'false hit':>9} {'false miss':>10} {'far':>5} {'evaluations/ray':>15}")
    for raster in RASTERS:
        settings = jaart.preset("thesis").replace(raster=raster)
        hits = jaart.render(scene, settings, camera(raster), SIZE)
        q = jaart.quality(hits, scene)
        print(f"{raster:6} {q.delta:8.4f} {GOALS[raster]:6} {q.delta_p:8.4f} {q.delta_n:8.4f} "
              f"{q.false_hit:9} {q.false_miss:10} {q.distance_miss:5} {hits.evaluations.mean():15.2f}")


if __name__ == "__main__":
    main()
