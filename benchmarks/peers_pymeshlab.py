"""The APSS surface of a cloud [Guennebaud & Gross 2007], by MeshLab: marching cubes of it, then Embree."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.cloud_normals import oriented, spacing
from benchmarks.contest import Absent, Contestant, why_absent
from benchmarks.peers_embree import Meshed, Triangles
from jaart.core.scene import Scene

#: Cubes along a spacing of the cloud: where they are wider, the surface ends between their corners.
CUBES = 1.25
#: Cubes along an edge at most, more take many minutes; beyond, the surface is smoothed over as many cubes more.
MOST = 300
#: MeshLab's own width of the weights, in spacings.
FILTER = 2.0


def apss(scene: Scene) -> Contestant | Absent:
    """The mesh, or a row that says why not."""
    name = "APSS + Embree"
    why = why_absent("pymeshlab", "open3d")
    return Absent(name, why) if why else Meshed(name, lambda: triangles_of(scene))


def triangles_of(scene: Scene) -> Triangles:
    """Marching cubes of the algebraic point set surface."""
    import pymeshlab

    points, normals, note = oriented(scene)
    across = float(np.ptp(points, axis=0).max()) / spacing(points)
    resolution = min(math.ceil(CUBES * across), MOST)
    width = max(FILTER, FILTER * across / resolution)
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=points, v_normals_matrix=normals))
    meshes.generate_marching_cubes_apss(resolution=resolution, filterscale=width)
    mesh = meshes.current_mesh()
    return Triangles(mesh.vertex_matrix(), mesh.face_matrix(), mesh.vertex_normal_matrix(),
                     f"{resolution} cubes along an edge, filter scale {width:.1f}, {note}")
