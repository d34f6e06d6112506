"""Normals that turn one way, for the peers: those of the cloud, or estimated by the quickest that is installed."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from benchmarks.contest import why_absent
from benchmarks.timing import THREADS
from benchmarks.vectors import unit
from jaart.core.records import Array
from jaart.core.scene import Scene

#: Neighbours of a plane.
NEAR = 16


def oriented(scene: Scene) -> tuple[Array, Array, str]:
    """Points (N, 3), unit normals (N, 3), and where these are from.

    The topmost point's normal must look up, as it does from a closed surface; else all are turned round.
    """
    points = np.array(scene.points)
    if scene.normals is not None:
        return points, np.array(scene.normals), "normals of the cloud"
    library = "Open3D" if why_absent("pymeshlab") else "PyMeshLab"
    normals = (_by_open3d if library == "Open3D" else _by_pymeshlab)(points)
    up = normals[points[:, 2].argmax(), 2] >= 0
    return points, normals if up else -normals, f"normals by {library}"


def spacing(points: Array) -> float:
    """Mean distance of a point from its nearest neighbour."""
    return float(cKDTree(points).query(points, 2, workers=THREADS)[0][:, 1].mean())


def _by_pymeshlab(points: Array) -> Array:
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=points))
    meshes.compute_normal_for_point_clouds(k=NEAR)
    return unit(meshes.current_mesh().vertex_normal_matrix())


def _by_open3d(points: Array) -> Array:
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(NEAR))
    cloud.orient_normals_consistent_tangent_plane(NEAR)
    return np.array(cloud.normals)
