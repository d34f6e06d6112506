"""Writes meshes to files that other programs read."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.contour import Indices, Mesh
from jaart.core.errors import FileError
from jaart.core.io.atomic import replacing
from jaart.core.telling import doing

#: Kinds of files, by suffix; .vtp keeps float64, the others hold single precision.
SUFFIXES = (".ply", ".stl", ".obj", ".vtp")

Vector = tuple[float, float, float]
Floats = NDArray[np.floating[Any]]


@doing("writing the mesh")
def save_mesh(mesh: Mesh, path: str | PathLike[str], spacing: Vector = (1.0, 1.0, 1.0),
              origin: Vector = (0.0, 0.0, 0.0)) -> None:
    """Write a mesh with its normals (.stl has none of vertices), whole or not at all.

    path: its suffix, one of SUFFIXES, says the kind of file; spacing, origin: of the scene, physical size of a cell
    and place of the lattice's corner, which the vertices are written in. Raises FileError.
    """
    path = Path(path)
    check_suffix(path)
    precision = np.float64 if path.suffix.lower() == ".vtp" else np.float32
    places = np.array(origin) + max(spacing) * mesh.vertices
    data = _poly_data(places.astype(precision), mesh.triangles, mesh.normals.astype(precision))
    with replacing(path) as part:
        writer = _writer(path.suffix.lower())
        writer.SetFileName(str(part))
        writer.SetInputData(data)
        writer.Update()  # as Write, but other threads go on meanwhile: that which answers Ctrl-C
        if writer.GetErrorCode():
            raise FileError(path, "cannot be written: is the disk full?")


def check_suffix(path: Path) -> None:
    """Raise FileError for a kind of file that is not written."""
    if path.suffix.lower() not in SUFFIXES:
        raise FileError(path, f"unknown kind of mesh {path.suffix!r}; expected {', '.join(SUFFIXES)}")


def _poly_data(places: Floats, triangles: Indices, normals: Floats) -> Any:
    """A mesh as VTK has it."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    points, cells, data = vtkPoints(), vtkCellArray(), vtkPolyData()
    points.SetData(numpy_to_vtk(places, deep=True))  # type: ignore[no-untyped-call]
    cells.SetData(3, numpy_to_vtkIdTypeArray(triangles.ravel(), deep=True))  # type: ignore[no-untyped-call]
    there = numpy_to_vtk(normals, deep=True)  # type: ignore[no-untyped-call]
    there.SetName("Normals")
    data.SetPoints(points)
    data.SetPolys(cells)
    data.GetPointData().SetNormals(there)
    return data


def _writer(suffix: str) -> Any:
    """VTK's writer of a kind of file."""
    if suffix == ".ply":
        from vtkmodules.vtkIOPLY import vtkPLYWriter

        return vtkPLYWriter()
    if suffix == ".vtp":
        from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

        return vtkXMLPolyDataWriter()
    from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter

    if suffix == ".obj":
        return vtkOBJWriter()
    writer = vtkSTLWriter()
    writer.SetFileTypeToBinary()
    return writer
