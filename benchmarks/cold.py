"""The first picture of a cloud or a lattice, for which all is gathered that its rays ask for, beside the second."""

from __future__ import annotations

import os
import statistics
import time
from pathlib import Path

import jaart
from benchmarks.standard import SIZE, camera
from jaart.core import prepare
from jaart.core.places import places_of
from jaart.core.warm import warm_up

#: Pictures of which medians are taken.
REPEATS = 7
DATA = Path(os.environ.get("JAART_DATA", Path(__file__).resolve().parents[2] / "shared" / "data")) / "clouds"


def row(name: str, scene: jaart.Scene, settings: jaart.Settings, view: jaart.Camera | None = None) -> None:
    """The preparation, the first picture and the median of those that follow, with the processor's time of both; what
    was gathered for it, and what a hit took.
    """
    warm_up(scene, settings)
    begin = time.process_time()
    first = jaart.render(scene, settings, view, SIZE)
    used, begin = time.process_time() - begin, time.process_time()
    warm = statistics.median(jaart.render(scene, settings, view, SIZE).ray_s for _ in range(REPEATS))
    later = (time.process_time() - begin) / REPEATS
    kept, hits = places_of(prepare.prepared(scene, settings).tracer.sites).kept, int(first.hit.sum())
    print(f"{name:12} {first.prep_s:8.2f} {first.ray_s:8.2f} {used:8.2f} {warm:8.2f} {later:8.2f} {kept.gathered:9} "
          f"{kept.fits:9} {first.cells.sum() / hits:8.1f} {first.evaluations.sum() / hits:8.2f} "
          f"{kept.block_bytes / kept.gathered:8.0f} {kept.table_bytes / 2**20:9.1f} {kept.block_bytes / 2**20:10.1f}")


def main() -> None:
    print(f"{'scene':12} {'prep_s':>8} {'first_s':>8} {'cpu_s':>8} {'warm_s':>8} {'cpu_s':>8} {'places':>9} "
          f"{'fits':>9} {'visits':>8} {'evals':>8} {'B/place':>8} {'table MiB':>9} {'blocks MiB':>10}")
    row("bumpy", jaart.load("bumpy"), jaart.Settings())
    for name, file in (("elephant", "elephant_44460.npz"), ("dragon", "dragon_full.npz")):
        if (DATA / file).exists():
            row(name, jaart.load(str(DATA / file)), jaart.Settings())
    for preset in ("thesis", "best"):
        row(f"64^3 {preset}", jaart.load("standard"), jaart.preset(preset).replace(raster=64), camera(64))


if __name__ == "__main__":
    main()
