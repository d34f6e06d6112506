"""Rows 71 to 74: what compilers, threads and number formats do."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from jaart.core import prepare
from jaart.core.camera import Camera
from jaart.core.io import load
from jaart.core.kernels.jit import EXACT, STRICT, VECTOR
from jaart.core.parameter import Length
from jaart.core.records import STATUS, Hits
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.study.stability.case import Outcome, case, error_of
from jaart.core.study.stability.scenes import cloud, plane, shot, sphere
from jaart.core.tiles import TILE
from jaart.core.trace import trace

#: A picture of more tiles than threads.
SIZE = 160, 120
#: Freedoms of a compiler that make NaN or infinity what it likes.
UNSAFE = {"fast", "nnan", "ninf"}
#: The columns of hits that are numbers of the surface.
COLUMNS = ("t", "point", "normal", "energy", "off_centre", "iterations", "evaluations", "neighbours", "status")
#: The smallest number of float64 with all its digits, and the smallest of all.
NORMAL, LEAST = 2.2250738585072014e-308, 5e-324


@case(71, "NaN and infinity in every part of a ray, among rays that are none of these",
      "bad_ray for each; all others keep their bits, and a miss is NaN")
def nan_in_compiled_code() -> Outcome:
    """A compiler that may take NaN for impossible removes the tests for it; the kernels' flags forbid that."""
    scene, settings = sphere(400), Settings(h=Length(0.2))
    ways = np.tile((0.0, 0.0, -1.0), (60, 1))
    origins = np.column_stack((np.linspace(-2, 2, 60), np.zeros(60), np.full(60, 5.0)))
    good, bad = shot(scene, settings, origins, ways), np.arange(0, 60, 5)
    for number, ray in enumerate(bad):
        (origins if number < 6 else ways)[ray, number % 3] = (np.nan, np.inf, -np.inf, np.nan)[number % 4]
    mixed, others = shot(scene, settings, origins, ways), np.setdiff1d(np.arange(60), bad)
    named = int((mixed.status[bad] == STATUS["bad_ray"]).sum())
    same = all(np.array_equal(getattr(mixed, name)[others], getattr(good, name)[others], equal_nan=True)
               for name in COLUMNS)
    missed = bool(np.isnan(mixed.t[~mixed.hit]).all() and np.isfinite(mixed.t[mixed.hit]).all())
    flags = (VECTOR | STRICT | EXACT) & UNSAFE
    return Outcome(f"{named} of {len(bad)} bad_ray, the other {len(others)} {'the same' if same else 'differ'}, "
                   f"{int(mixed.hit.sum())} hits, unsafe flags: {', '.join(flags) or 'none'}",
                   named == len(bad) and same and missed and bool(mixed.hit.any()) and not flags)


@case(72, "pictures by 1, 2, 3 and 4 threads, of a lattice and a cloud", "the same bits in every column")
def pictures_by_any_number_of_threads() -> Outcome:
    """No sum runs over rays, and the order of each ray's own sums is fixed. Each picture has a scene of its own, and
    more tiles than threads.
    """
    lattice = partial(Scene, "lattice", levels=prepare.levels(load("standard"), Settings()))
    tried: list[tuple[Callable[[], Scene], Settings]] = [
        (lattice, Settings(method=method, search=search)) for method, search in
        (("tangent", "iterate"), ("polynomial", "secant"), ("tangent", "safe"), ("mahalanobis", "auto"))]
    tried += [(partial(sphere, 800), Settings(h=Length(0.15), method=method)) for method in ("tangent", "polynomial")]
    marks = [{_mark(render(make(), settings, size=SIZE, threads=threads)) for threads in (1, 2, 3, 4)}
             for make, settings in tried]
    same = sum(len(each) == 1 for each in marks)
    return Outcome(f"{same} of {len(marks)} pictures the same by all, each in {-(-SIZE[0] * SIZE[1] // TILE)} tiles",
                   same == len(marks) == len(set.union(*marks)) and SIZE[0] * SIZE[1] > 4 * TILE)


@case(73, "files with numbers of 32 bits, a lattice and a cloud; the cloud 1e4 sizes away as well",
      "read once into float64, with no bit changed; it is said where their steps are coarse")
def numbers_of_32_bits() -> Outcome:
    """All that is computed is float64, whatever the file holds, so the same numbers give the same hits."""
    levels = np.clip(8 - np.indices((16, 16, 16)).sum(axis=0) / 3.0, 0, 1).astype(np.float32)
    points = sphere(400).points
    assert points is not None
    near, far = points.astype(np.float32), (points + 2e4).astype(np.float32)
    lattice, ball, away = (_of_file(**arrays) for arrays in ({"levels": levels}, {"points": near}, {"points": far}))
    same = [_mark(_seen(scene)) == _mark(_seen(wide)) for scene, wide in (
        (lattice, Scene("wide", levels=levels.astype(float))), (ball, Scene("wide", points=near.astype(float))))]
    kept = all(a is not None and a.dtype == np.float64 and np.array_equal(a, b) for a, b in (
        (lattice.levels, levels), (ball.points, near), (away.points, far)))
    return Outcome(f"{sum(same)} of 2 pictures the same bits; near: {len(ball.notes)} notes, far: "
                   f"{'; '.join(away.notes)}",
                   all(same) and kept and not ball.notes and "float32 stores them in steps" in away.notes[0])


@case(74, "coordinates and origins of 5e-324, weights that underflow, and a cloud of size 1e-310",
      "denormals count as what they are beside 1; no weight is denormal; a cloud of nothing else is refused")
def denormals() -> Outcome:
    """Weights end at exp(-708) = 3e-308, the last with all its digits: nothing slow, and nothing that is lost."""
    settings, way = Settings(h=Length(0.8)), (0.0, 0.0, -1.0)
    flat = plane().points
    assert flat is not None
    tiny = np.where(flat == 0.0, LEAST, flat)
    hits = [shot(scene, settings, (origin, 0.2, 5.0), way) for scene in (plane(), cloud(tiny, plane().normals))
            for origin in (0.0, LEAST, -1e-310)]
    same = sum(bool(one.hit.all()) and one.t[0] == hits[0].t[0] for one in hits)
    seen = trace(plane(), Settings(h=Length(0.05), radius=Length(9.0)), (0.01, 0.0, 1.0), way)
    weights = np.concatenate(seen.weights)
    refused = error_of(lambda: cloud(1e-310 * flat))
    return Outcome(f"{same} of 6 at t = {hits[0].t[0]:g}; {len(weights)} weights from {weights.min():.1e} up; "
                   f"{refused}", same == 6 and seen.hit and len(weights) > 80 and weights.min() >= NORMAL
                   and "expected a cloud larger than" in refused)


def _mark(hits: Hits) -> str:
    """What stands for all bits of some hits."""
    return hashlib.sha256(b"".join(getattr(hits, name).tobytes() for name in COLUMNS)).hexdigest()


def _seen(scene: Scene) -> Hits:
    settings = Settings() if scene.kind == "lattice" else Settings(h=Length(0.2))
    middle = (8.0, 8.0, 8.0) if scene.kind == "lattice" else (0.0, 0.0, 0.0)
    return render(scene, settings, Camera.fit(scene) if middle[0] else Camera((3.0, -4.0, 5.0), middle), (40, 40))


def _of_file(**arrays: Any) -> Scene:
    with TemporaryDirectory() as name:
        np.savez(Path(name) / "numbers.npz", **arrays)
        return load(Path(name) / "numbers.npz")
