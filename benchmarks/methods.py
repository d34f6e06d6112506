"""δ of every method at its best setting on a grid of h and radius, the standard model at 16³, 32³ and 64³.

h from 0.5 to 1.6 by 0.1, radius from 1.5 to 4 by 0.5; tried at 128×128, the best again at 512×512. The lattice is
closed: nothing is outside the model's cube.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterable
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

import jaart
from benchmarks.standard import RASTERS, SIZE, camera

H = [round(0.5 + 0.1 * i, 1) for i in range(12)]
RADIUS = [1.5 + 0.5 * i for i in range(6)]
TRIAL = (128, 128)
#: Better surfels than the thesis's, for every method.
SURFELS = {"placement": "exact", "gradient": "youngs", "border": "closed", "tolerance": 0.01}
METHODS: dict[str, dict[str, Any]] = {
    "tangent, thesis's surfels": {"method": "tangent", "placement": "box", "gradient": "central", "border": "closed",
                                  "filling": "corners"},
    "tangent": {"method": "tangent"},
    "tangent, true normal": {"method": "tangent", "shading_normal": "gradient"},
    "tangent, covariance": {"method": "tangent", "normal": "covariance"},
    "polynomial, degree 1": {"method": "polynomial", "degree": 1},
    "polynomial, degree 2": {"method": "polynomial", "degree": 2},
    "polynomial, degree 3": {"method": "polynomial", "degree": 3},
    "polynomial, degree 2, patch 1": {"method": "polynomial", "degree": 2, "patch": 1.0},
    "polynomial, degree 3, patch 1": {"method": "polynomial", "degree": 3, "patch": 1.0},
    "polynomial, degree 2, patch 1, secant": {"method": "polynomial", "degree": 2, "patch": 1.0, "search": "secant"},
    "projection, degree 2": {"method": "projection", "degree": 2},
    "off_centre": {"method": "off_centre"},
    "mahalanobis": {"method": "mahalanobis"},
    "mahalanobis, emphasised": {"method": "mahalanobis", "emphasise": True},
    "angle": {"method": "angle"},
    "cylinder": {"method": "cylinder"},
}
MESHES = {"fill_level": {"method": "fill_level"},
          "fill_level, Gauss filter": {"method": "fill_level", "filter": "gauss"},
          "isosurface of |f|, 4 samples a cell": {"method": "isosurface", "subdivide": 4}}


def main(names: Iterable[str] = ()) -> None:
    scene, chosen = jaart.load("standard"), list(names) or [*METHODS, *MESHES]
    print(f"{'method':40} {'raster':>6} {'h':>4} {'radius':>6} {'delta':>7} {'angle':>7} {'false hit':>9} "
          f"{'false miss':>10} {'far':>5}", flush=True)
    rows = [row for name in chosen for raster in RASTERS for row in [best(scene, name, raster)]]
    output = Path("out")
    output.mkdir(exist_ok=True)
    with (output / "methods.csv").open("w", newline="") as stream:
        csv.writer(stream).writerows(rows)


def best(scene: jaart.Scene, name: str, raster: int) -> list[Any]:
    """The line of a method at a raster: its best setting, rendered again in full size."""
    fixed = {"raster": raster, **SURFELS, **(METHODS.get(name) or MESHES[name])}
    grid = [{}] if name in MESHES else [{"h": h, "radius": r} for h, r in product(H, RADIUS)]
    tried = [(delta(scene, {**fixed, **values}, TRIAL)[0], i) for i, values in enumerate(grid)]
    values = grid[min(tried)[1]]
    error, q = delta(scene, {**fixed, **values}, SIZE)
    angle = float(np.nanmean(q.angle))
    print(f"{name:40} {raster:6} {values.get('h', '-'):>4} {values.get('radius', '-'):>6} {error:7.4f} {angle:6.2f}° "
          f"{q.false_hit:9} {q.false_miss:10} {q.distance_miss:5}", flush=True)
    return [name, raster, values.get("h"), values.get("radius"), error, angle, q.false_hit, q.false_miss,
            q.distance_miss]


def delta(scene: jaart.Scene, values: dict[str, Any], size: tuple[int, int]) -> tuple[float, Any]:
    """δ and all errors of the standard model with some settings."""
    q = jaart.quality(jaart.render(scene, jaart.Settings(**values), camera(values["raster"]), size), scene)
    return q.delta, q


if __name__ == "__main__":
    main(sys.argv[1:])
