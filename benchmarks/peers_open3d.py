"""Meshes of a cloud by Open3D: ball pivoting [Bernardini et al. 1999] and Poisson [Kazhdan & Hoppe 2013]."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.cloud_normals import oriented, spacing
from benchmarks.contest import Absent, Contestant, why_absent
from benchmarks.peers_embree import Meshed, Triangles
from benchmarks.timing import THREADS
from jaart.core.scene import Scene

#: Radii of the balls in spacings: the larger close what the smaller leave open.
RADII = (1.5, 2.0, 3.0)


def meshers(scene: Scene) -> list[Contestant | Absent]:
    """Both, or rows that say why not."""
    names = {"ball pivoting + Embree": pivoted, "Poisson + Embree": poisson}
    why = why_absent("open3d")
    return [Absent(name, why) if why else Meshed(name, lambda make=make: make(scene)) for name, make in names.items()]


def pivoted(scene: Scene) -> Triangles:
    """The cloud's points joined by triangles that a rolling ball rests on."""
    import open3d

    cloud, step, note = _cloud(scene)
    radii = open3d.utility.DoubleVector([step * r for r in RADII])
    return _triangles(open3d.geometry.TriangleMesh.create_from_point_cloud_ball_pivoting(cloud, radii), note)


def poisson(scene: Scene) -> Triangles:
    """The zero set of a function whose gradient are the normals, on an octree with cells as fine as the points."""
    import open3d

    cloud, step, note = _cloud(scene)
    depth = math.ceil(math.log2(float(np.ptp(scene.points, axis=0).max()) / step))
    mesh, _ = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(cloud, depth=depth, n_threads=THREADS)
    return _triangles(mesh, f"depth {depth}, {note}")


def _cloud(scene: Scene) -> tuple[Any, float, str]:
    """The cloud with normals, its spacing, and where the normals are from."""
    import open3d

    points, normals, note = oriented(scene)
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    cloud.normals = open3d.utility.Vector3dVector(normals)
    return cloud, spacing(points), note


def _triangles(mesh: Any, note: str) -> Triangles:
    mesh.compute_vertex_normals()
    return Triangles(np.asarray(mesh.vertices), np.asarray(mesh.triangles), np.asarray(mesh.vertex_normals), note)
