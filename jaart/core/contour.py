"""From values on a grid to the triangles where they pass a level, with normals [T §2.1.1, 2.4.6]."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.scene import Array, frozen

Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]
Vector = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles, counted anticlockwise when seen from outside, where their normals point.

    vertices: (V, 3) in cells; triangles: (T, 3) numbers of vertices; normals: unit (V, 3).
    """

    vertices: Array
    triangles: Indices
    normals: Array

    def __len__(self) -> int:
        return len(self.triangles)


def contour(values: Array, level: float, origin: Vector = (0.0, 0.0, 0.0), step: Vector = (1.0, 1.0, 1.0)) -> Mesh:
    """The surface around all that is below a level, by marching cubes (as flying edges) [Lorensen & Cline 1987].

    values: (I, J, K), NaN where unknown: there is no surface in a cube with an unknown corner; it is changed.
    origin: place of the first value, step: from one to the next along each axis, in cells. The normals are the
    gradient, by central differences of the values, interpolated along the cubes' edges.
    """
    unknown = np.isnan(values)
    values[unknown] = level + 1.0  # above, and far enough to keep vertices apart
    found, triangles = _flying_edges(values, level)
    place, gradient = _on_edges(values, unknown, found, level)
    triangles = triangles[~_beside(place[triangles].mean(axis=1), unknown)]
    used, numbers = np.unique(triangles, return_inverse=True)
    vertices = np.array(origin) + place[used] * np.array(step)
    triangles = numbers.reshape(-1, 3).astype(np.int64)
    triangles.flags.writeable = False
    return Mesh(frozen(vertices), triangles, frozen(_unit(gradient[used] / np.array(step), vertices, triangles)))


def _flying_edges(values: Array, level: float) -> tuple[Array, Indices]:
    """Vertices (V, 3), in steps of the grid and single precision, and triangles of a level."""
    if min(values.shape) < 2 or not values.min() < level <= values.max():
        return np.empty((0, 3)), np.empty((0, 3), np.int64)
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

    image, edges = vtkImageData(), vtkFlyingEdges3D()
    image.SetDimensions(*values.shape[::-1])  # its x runs fastest, which is our z; so it turns the triangles round
    flat: Any = np.ascontiguousarray(values).ravel()
    image.GetPointData().SetScalars(numpy_to_vtk(flat))  # type: ignore[no-untyped-call]
    edges.SetInputData(image)
    edges.SetValue(0, level)
    edges.ComputeNormalsOff()
    edges.ComputeScalarsOff()
    edges.Update()
    output = edges.GetOutput()
    if output.GetNumberOfPolys() == 0:
        return np.empty((0, 3)), np.empty((0, 3), np.int64)
    vertices = vtk_to_numpy(output.GetPoints().GetData())  # type: ignore[no-untyped-call]
    triangles = vtk_to_numpy(output.GetPolys().GetConnectivityArray())  # type: ignore[no-untyped-call]
    return vertices[:, ::-1].astype(np.float64), triangles.reshape(-1, 3).astype(np.int64)


def _on_edges(values: Array, unknown: Mask, found: Array, level: float) -> tuple[Array, Array]:
    """Vertices (V, 3) in steps of the grid, each put on its edge anew in full precision, and the gradient there."""
    near = np.rint(found)
    axis = np.abs(found - near).argmax(axis=1)
    rows = np.arange(len(found))
    low = near.astype(np.int64)
    low[rows, axis] = np.minimum(np.floor(found[rows, axis]), np.array(values.shape)[axis] - 2)
    high = low.copy()
    high[rows, axis] += 1
    a, b = values[tuple(low.T)], values[tuple(high.T)]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (level - a) / (b - a)
    # a vertex that single precision put on a corner stays there
    share = np.where((share >= 0) & (share <= 1), share, found[rows, axis] - low[rows, axis])
    place = low.astype(np.float64)
    place[rows, axis] += share
    s = share[:, None]
    return place, (1 - s) * _gradient(values, unknown, low) + s * _gradient(values, unknown, high)


def _gradient(values: Array, unknown: Mask, at: Indices) -> Array:
    """Change of the values (N, 3) at points of the grid: central differences, one-sided beside what is unknown."""
    result = np.zeros((len(at), 3))
    for axis in range(3):
        ends = []
        for step in (-1, 1):
            end = at.copy()
            end[:, axis] = np.clip(at[:, axis] + step, 0, values.shape[axis] - 1)
            ends.append(np.where(unknown[tuple(end.T)][:, None], at, end))
        low, high = ends
        apart = high[:, axis] - low[:, axis]
        result[:, axis] = (values[tuple(high.T)] - values[tuple(low.T)]) / np.maximum(apart, 1)
    return result


def _beside(middles: Array, unknown: Mask) -> Mask:
    """Which triangles (T,) lie in a cube with an unknown corner; middles: of the triangles (T, 3)."""
    cube = np.minimum(np.floor(middles).astype(np.int64), np.array(unknown.shape) - 2)
    result = np.zeros(len(cube), bool)
    for corner in np.ndindex(2, 2, 2):
        result |= unknown[tuple((cube + np.array(corner)).T)]
    return result


def _unit(gradient: Array, vertices: Array, triangles: Indices) -> Array:
    """Unit normals (V, 3); the mean of the triangles around where the gradient vanishes."""
    size = np.linalg.norm(gradient, axis=1)
    missing = ~(size > 0)
    if missing.any():
        a, b, c = (vertices[triangles[:, i]] for i in range(3))
        across = np.cross(b - a, c - a)
        around = np.zeros_like(gradient)
        for i in range(3):
            np.add.at(around, triangles[:, i], across)
        gradient = np.where(missing[:, None], around, gradient)
        size = np.linalg.norm(gradient, axis=1)
    return np.where(size[:, None] > 0, gradient / np.where(size > 0, size, 1)[:, None], (0.0, 0.0, 1.0))
