"""The rays of a picture side by side and each by itself: the same bits, CPU seconds of one thread in turns."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

import jaart
from benchmarks import standard
from benchmarks.timing import REPEATS, Spread, in_turns, ratios
from jaart.core import extents, prepare
from jaart.core.kernels.pinhole import EDGE
from jaart.core.tiles import columns_for, in_blocks
from jaart.core.tracers import LatticeTracer

RASTERS = (32, 64, 128)


def main() -> None:
    print("thesis, 512x512     side by side ms   alone ms   ratio, quartiles apart")
    for raster in RASTERS:
        settings = jaart.preset("thesis").replace(raster=raster)
        scene = jaart.Scene("model", levels=prepare.levels(jaart.load("standard"), settings))
        compare(f"standard {raster}^3", scene, settings, standard.camera(raster))
    scene, settings = jaart.load("splash"), jaart.preset("thesis")
    compare("splash", scene, settings, jaart.Camera.fit(extents.bounds(scene, settings), size=standard.SIZE))


def compare(name: str, scene: jaart.Scene, settings: jaart.Settings, camera: jaart.Camera) -> None:
    """Print both times of a picture's rays, in its order and from where its blocks begin; columns must be the same."""
    tracer = prepare.prepared(scene, settings).tracer
    if not isinstance(tracer, LatticeTracer) or not tracer.together:
        raise SystemExit(f"{name}: its rays do not go side by side")
    origins, directions = camera.rays(standard.SIZE)
    begins = tracer.blocks(camera.view(standard.SIZE)).repeat(EDGE, axis=0).repeat(EDGE, axis=1).ravel()
    drivers = {"together": tracer, "alone": replace(tracer, together=False)}
    outs, pixels = {way: columns_for(len(origins)) for way in drivers}, in_blocks(standard.SIZE, 1)

    def run(way: str) -> float:
        begin = time.process_time()
        drivers[way].trace(origins, directions, pixels, outs[way], begins=begins)
        return time.process_time() - begin

    for way in drivers:
        run(way)  # compiled, and what is near the cells gathered
    for made, alone in zip(outs["together"], outs["alone"], strict=True):
        np.testing.assert_array_equal(made, alone)
    given = in_turns({way: lambda way=way: run(way) for way in drivers}, REPEATS, np.inf)
    a, b = (1e3 * Spread(tuple(given[way])).median for way in drivers)
    ratio = ratios(given["together"], given["alone"])
    print(f"{name:18} {a:17.1f} {b:10.1f}   {ratio.median:5.2f}, {ratio.quartiles:.2f}")


if __name__ == "__main__":
    main()
