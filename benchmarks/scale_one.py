"""One size of the table of scale, measured in a process of its own; printed as a line of JSON.

`python -m benchmarks.scale_one lattice 64 512 512`.
"""

from __future__ import annotations

import ctypes
import dataclasses
import gc
import json
import statistics
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from mmap import mmap
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

import jaart
from benchmarks.footprint import MIB, highest, peak, resident
from benchmarks.scale_data import scene_of
from jaart.core import prepare
from jaart.core.places import Places, places_of
from jaart.core.prepare import Prepared
from jaart.core.suited import suited

#: Sizes whose picture loads the kernels before anything is measured.
WARM = {"lattice": 16, "cloud": 500}
#: Pictures with everything kept.
PICTURES = 5
#: Arrays that are named: those of at least so many bytes an item.
NAMED = 1.0


def measured(kind: str, size: int, picture: tuple[int, int]) -> dict[str, Any]:
    """The figures of one size: fields of benchmarks.scale_table.Row. Bytes are beyond the scene's own data."""
    warm = scene_of(kind, WARM[kind])
    jaart.render(warm, suited(warm, jaart.preset("best"))[0], size=(16, 16))
    scene = scene_of(kind, size)
    data, before = (scene.levels if kind == "lattice" else scene.points).nbytes, settled()
    begin = time.perf_counter()
    (settings, ready), grown = peak(lambda: made(scene))
    seconds = time.perf_counter() - begin
    prepared = settled()
    items, arrays = len(ready.surfels), named_arrays(scene)
    camera = jaart.Camera.fit(scene, size=picture)
    first = jaart.render(scene, settings, camera, picture)
    hits = [jaart.render(scene, settings, camera, picture) for _ in range(PICTURES)]
    places, place_bytes = touched(ready)
    return {"kind": kind, "size": size, "data_bytes": data, "items": items, "prep_s": seconds,
            "peak_bytes": None if grown is None else grown * MIB,
            "kept_bytes": None if before is None else prepared - before, "array_bytes": sum(arrays.values()),
            "first_s": seconds + first.ray_s,
            "ray_us": 1e6 * statistics.median(h.ray_s for h in hits) / len(first),
            "evaluations": int(first.evaluations.sum()) / max(1, int(first.hit.sum())), "hits": int(first.hit.sum()),
            "touched": places, "touched_bytes": place_bytes, "whole_bytes": highest(),
            "arrays": {name: round(n / items, 1) for name, n in arrays.items() if n / items >= NAMED}}


def made(scene: jaart.Scene) -> tuple[jaart.Settings, Prepared]:
    """The settings, some of which the scene chooses, and all that is there before the first ray."""
    settings = suited(scene, jaart.preset("best"))[0]
    ready = prepare.prepared(scene, settings)
    assert ready.tracer.sites.pool.size
    return settings, ready


def settled() -> int | None:
    """Resident bytes once everything free is handed back, None where the system does not tell."""
    gc.collect()
    with suppress(OSError, AttributeError, TypeError):
        ctypes.CDLL(None).malloc_trim(0)
    return resident()


def touched(ready: Prepared) -> tuple[int, int]:
    """Cells or balls whose neighbours were gathered, and the bytes of what was written down for them."""
    kept = places_of(ready.tracer.sites).kept
    return kept.gathered, kept.block_bytes


def named_arrays(scene: jaart.Scene) -> dict[str, int]:
    """Bytes of the arrays that a scene keeps beside its data, by stage and field, each memory once, largest first."""
    found: dict[str, int] = {}
    seen: set[int] = set()
    list(arrays_in((scene.levels, scene.points, scene.normals), "data", seen))
    for stage, (_, value) in scene._kept.items():
        for name, array in arrays_in(value, str(stage), seen):
            found[name] = found.get(name, 0) + array.nbytes
    return dict(sorted(found.items(), key=lambda pair: -pair[1]))


def arrays_in(value: Any, name: str, seen: set[int]) -> Iterator[tuple[str, np.ndarray]]:
    """Every array in a record of records."""
    if id(value) in seen:
        return
    if isinstance(value, np.ndarray):
        owner = value
        while isinstance(owner.base, np.ndarray):
            owner = owner.base
        as_used = isinstance(getattr(owner.base, "obj", owner.base), mmap)  # memory.sparse
        if id(owner) not in seen and not as_used:
            yield name, owner
        seen |= {id(owner), id(value)}
        value = owner.base
    for part, inner in parts(value):
        yield from arrays_in(inner, f"{name}.{part}", seen)


def parts(value: Any) -> list[tuple[str, Any]]:
    """The fields of a record, the members of a tuple; nothing of anything else."""
    if isinstance(value, cKDTree):  # what else it has, its nodes, only the system sees
        return [("data", value.data), ("indices", value.indices)]
    if isinstance(value, Places):
        return [("slots", value.slots), ("source", value.alive), ("chunks", tuple(value.chunks))]
    if dataclasses.is_dataclass(value):
        return list(vars(value).items())
    if hasattr(value, "_asdict"):
        return list(value._asdict().items())
    return [(str(i), v) for i, v in enumerate(value)] if isinstance(value, tuple) else []


if __name__ == "__main__":
    print(json.dumps(measured(sys.argv[1], int(sys.argv[2]), (int(sys.argv[3]), int(sys.argv[4])))))
