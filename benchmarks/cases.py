"""The scenes of the comparison, each with its contestants, its pictures and the measure of its error."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

import jaart
from benchmarks import peers_embree, peers_open3d, peers_pymeshlab, standard
from benchmarks.contest import Absent, Contestant, Jaart, Size, View
from jaart.core import extents, prepare, samples
from jaart.core.records import Hits
from jaart.core.suited import suited

#: Where scanned clouds lie, as the tests find them.
DATA = Path(os.environ.get("JAART_DATA", Path(__file__).resolve().parents[2] / "shared" / "data")) / "clouds"
CLOUDS = {"bunny": "bun_zipper.ply", "dragon": "dragon_full.npz"}
SIZES = ((512, 512), (1920, 1080))
SMALL = (64, 48)
#: Presets that a cloud is shown with.
ON_CLOUDS = ("best", "adamson-alexa")


@dataclass(frozen=True)
class Case:
    """A scene. error: what is measured of hits where the surface is known, and in error_of its name and unit."""

    name: str
    contestants: tuple[Contestant | Absent, ...]
    views: tuple[View, ...]
    error: Callable[[Hits], float | None] | None = None
    error_of: str = ""


#: What makes each case of the whole comparison.
WHOLE: dict[str, Callable[[tuple[Size, ...]], Case]] = {
    **{f"standard {raster}^3": partial(lambda raster, sizes: model(raster, sizes), raster)
       for raster in (*standard.RASTERS, 128)},
    "splash": lambda sizes: splash(sizes),
    "bumpy": lambda sizes: bumpy(samples.COUNT, sizes),
    **{name: partial(lambda name, sizes: scanned(name, sizes), name) for name in CLOUDS},
}


def chosen(names: Sequence[str], sizes: tuple[Size, ...]) -> Iterator[Case]:
    """The named cases, all where none is named, each made when it is its turn."""
    yield from (make(sizes) for name, make in WHOLE.items() if name in names or not names)


def few() -> Iterator[Case]:
    """Small ones, for a short run."""
    yield from (model(raster, (SMALL,)) for raster in (16, 32))
    yield bumpy(2000, (SMALL,), ("best",))


def model(raster: int, sizes: tuple[Size, ...]) -> Case:
    """The standard model in a lattice; its data are the fill levels, for the thesis's preset those of the thesis."""
    exact, contestants = jaart.load("standard"), []
    for name in ("thesis", "best"):
        settings = jaart.preset(name).replace(raster=raster)
        lattice = jaart.Scene(f"standard {raster}", levels=prepare.levels(exact, settings))
        contestants.append(Jaart(f"Jaart, {name}", lattice, settings))
    last = contestants[-1]
    views = tuple(View(widened(standard.camera(raster), size), size, last.settings) for size in sizes)
    return Case(f"standard {raster}^3", (*contestants, peers_embree.marching_cubes(last.scene.levels)), views,
                lambda hits: jaart.quality(hits, exact).delta, "delta")


def splash(sizes: tuple[Size, ...]) -> Case:
    """The fluid simulation that comes with the program."""
    scene = jaart.load("splash")
    ours = tuple(Jaart(f"Jaart, {name}", scene, jaart.preset(name)) for name in ("thesis", "best"))
    return Case("splash", (*ours, peers_embree.marching_cubes(scene.levels)), fitted(scene, sizes))


def bumpy(count: int, sizes: tuple[Size, ...], presets: Sequence[str] = ON_CLOUDS) -> Case:
    """Points of a smooth surface that is known exactly."""
    scene = samples.bumpy_sphere(count)
    return Case(f"bumpy {count:,}", on_cloud(scene, presets), fitted(scene, sizes), partial(distance, scene),
                "mean distance [spacings]")


def scanned(name: str, sizes: tuple[Size, ...]) -> Case:
    """A scan, or a row that says where it was looked for."""
    path = DATA / CLOUDS.get(name, name)
    if not path.is_file():
        where = f"{path.name} is not in {DATA}; JAART_DATA names another folder"
        return Case(name, (Absent("every program", where),), ())
    scene = read(path)
    return Case(f"{name} {len(scene.points):,}", on_cloud(scene), fitted(scene, sizes))


def read(path: Path) -> jaart.Scene:
    """A cloud, of a PLY file its vertices alone."""
    if path.suffix != ".ply":
        return jaart.load(path)
    import pyvista

    return jaart.Scene(str(path), points=np.array(pyvista.read(path).points, np.float64))


def on_cloud(scene: jaart.Scene, presets: Sequence[str] = ON_CLOUDS) -> tuple[Contestant | Absent, ...]:
    """The contestants on a cloud."""
    ours = (Jaart(f"Jaart, {name}", scene, suited(scene, jaart.preset(name))[0]) for name in presets)
    return (*ours, *peers_open3d.meshers(scene), peers_pymeshlab.apss(scene))


def fitted(scene: jaart.Scene, sizes: tuple[Size, ...]) -> tuple[View, ...]:
    """The whole scene in view."""
    return tuple(View(jaart.Camera.fit(scene, size=size), size, jaart.Settings()) for size in sizes)


def widened(camera: jaart.Camera, size: Size) -> jaart.Camera:
    """The camera with as much in view from top to bottom as a square picture has."""
    slope = math.tan(math.radians(camera.fov) / 2) * max(size) / min(size)
    return camera.replace(fov=2 * math.degrees(math.atan(slope)))


def distance(scene: jaart.Scene, hits: Hits) -> float | None:
    """Mean distance of the hits from the exact surface, to first order, in spacings; None without hits."""
    exact, points = scene.exact, hits.point[hits.hit]
    if not len(points):
        return None
    aslant = (exact.exact_normal(points) * points).sum(axis=1) / np.linalg.norm(points, axis=1)
    return float(np.abs(exact.height(points) * aslant).mean()) / extents.spacing(scene)
