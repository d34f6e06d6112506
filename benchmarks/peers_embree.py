"""Triangles met by Embree, through Open3D: all rays in one batch, as many threads as the machine has."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.contest import Absent, Contestant, First, View, why_absent
from benchmarks.timing import THREADS
from jaart.core.records import Array, Hits

LEVEL = 0.5


@dataclass(frozen=True, eq=False)
class Triangles:
    """vertices (V, 3), triangles (T, 3), normals (V, 3) to interpolate; note: how they came about."""

    vertices: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray
    note: str = ""


class Embree:
    """A mesh in Embree's tree."""

    def __init__(self, mesh: Triangles) -> None:
        import open3d

        self.mesh, self.tensor = mesh, open3d.core.Tensor
        self.scene = open3d.t.geometry.RaycastingScene(nthreads=THREADS)
        self.scene.add_triangles(np.ascontiguousarray(mesh.vertices, np.float32),
                                 np.ascontiguousarray(mesh.triangles, np.uint32))
        # the tree is built when it is first asked
        self.scene.cast_rays(self.tensor(np.array([[0, 0, 0, 0, 0, 1]], np.float32)), nthreads=THREADS)

    def shoot(self, view: View) -> Hits:
        """The first triangle on each ray. The time is that of the rays; normals are interpolated after it."""
        rays = self.tensor(view.floats)
        begin = time.perf_counter()
        met = self.scene.cast_rays(rays, nthreads=THREADS)
        seconds = time.perf_counter() - begin
        t = met["t_hit"].numpy().astype(np.float64)
        return view.hits(t, self._normals(met, np.isfinite(t)), seconds)

    def _normals(self, met: Any, hit: np.ndarray) -> Array:
        """Normals (R, 3), unit, of the vertices around each hit, NaN elsewhere."""
        u, v = met["primitive_uvs"].numpy()[hit].T.astype(np.float64)
        corners = self.mesh.normals[self.mesh.triangles[met["primitive_ids"].numpy()[hit].astype(np.int64)]]
        mixed = np.einsum("ri,rij->rj", np.stack((1 - u - v, u, v), axis=1), corners)
        normals = np.full((len(hit), 3), np.nan)
        with np.errstate(divide="ignore", invalid="ignore"):
            normals[hit] = mixed / np.linalg.norm(mixed, axis=1, keepdims=True)
        return normals


@dataclass
class Meshed:
    """A program that makes triangles of a scene and sends the rays through Embree."""

    name: str
    make: Callable[[], Triangles]
    lazy: bool = False

    def first(self, view: View) -> First:
        """The first picture, mesh and tree made for it."""
        begin = time.perf_counter()
        mesh = self.make()
        meshed = time.perf_counter()
        embree = Embree(mesh)
        ready = time.perf_counter()
        return First(embree.shoot(view), ready - begin, embree.shoot, ready - meshed,
                     f"{len(mesh.triangles)} triangles" + (f", {mesh.note}" if mesh.note else ""))


def marching_cubes(levels: Array) -> Contestant | Absent:
    """Marching cubes of fill levels (nx, ny, nz), with the normals that it gives, and Embree."""
    name = "marching cubes + Embree"
    why = why_absent("skimage.measure", "open3d")
    return Absent(name, why) if why else Meshed(name, lambda: triangles_of(levels))


def triangles_of(levels: Array) -> Triangles:
    """The mesh where the levels are half, in cells: a level stands at the centre of its cell."""
    from skimage.measure import marching_cubes as march

    vertices, triangles, normals, _ = march(np.asarray(levels), LEVEL)
    return Triangles(vertices + 0.5, triangles, normals)
