"""Reads lattices from VTI, VTK's XML image files."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.errors import FileError
from jaart.core.io import vti_guard
from jaart.core.io.values import check_frame, check_memory, check_ratio, fill_levels
from jaart.core.scene import Scene

#: Names of arrays that are taken where there are several.
NAMES = ("levels", "fill")
#: A cell's longest edge in shortest ones; edges that differ by a smaller share are those of a cube.
LONGEST_EDGE, ROUNDED = 100.0, 1e-6

Vector = tuple[float, float, float]


def read(path: Path, frame: int | None = None) -> Scene:
    """The lattice in a VTI file: a scalar array of its cells, else of its points, which become cells' centres.

    The array is the one named levels or fill, else the only one. Raises FileError; document types
    and entities are refused, and so are rotated images.
    """
    frame = check_frame(path, frame, 1)
    vti_guard.check(path)
    reader, errors = _open(path)
    with _quiet():
        reader.UpdateInformation()
        extent = _extent(path, reader, errors)
        of_cells, name = _chosen(path, reader)
        shape = tuple(max(1, high - low + (not of_cells)) for low, high in extent)
        check_memory(path, math.prod(shape), "WholeExtent")
        check_ratio(path, math.prod(shape), path.stat().st_size)
        reader.Update()
    if errors:
        raise FileError(path, f"cannot be read as VTI: {errors[0]}; is the file whole?")
    image = reader.GetOutput()
    place = f"array {name!r}"
    levels, notes = fill_levels(path, place, _values(path, place, image, of_cells, name, shape))
    spacing, first = _spacing(path, image), [low - (not of_cells) / 2 for low, _ in extent]
    x, y, z = (o + f * s for o, f, s in zip(image.GetOrigin(), first, spacing, strict=True))
    return Scene(str(path), levels=levels, spacing=spacing, origin=(x, y, z), frame=frame, notes=notes)


def _open(path: Path) -> tuple[Any, list[str]]:
    """VTK's reader, and the list that its error messages will be put in."""
    from vtkmodules.vtkCommonCore import vtkCommand
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader

    errors: list[str] = []

    def note(_source: object, _event: str, text: str) -> None:
        errors.append(" ".join(text.partition("): ")[2].split()).rstrip("."))

    note.CallDataType = "string0"  # type: ignore[attr-defined]
    reader = vtkXMLImageDataReader()
    reader.AddObserver(vtkCommand.ErrorEvent, note)
    reader.AddObserver(vtkCommand.WarningEvent, note)
    reader.SetFileName(str(path))
    return reader, errors


@contextmanager
def _quiet() -> Iterator[None]:
    """Keeps VTK from printing what is raised as an error anyway."""
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before)


def _extent(path: Path, reader: Any, errors: list[str]) -> list[tuple[int, int]]:
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

    numbers = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT())
    if errors or numbers is None:
        raise FileError(path, f"cannot be read as VTI: {errors[0] if errors else 'no extent'}; is the file whole?")
    extent = list(zip(numbers[::2], numbers[1::2], strict=True))
    if any(low > high for low, high in extent):
        raise FileError(path, f"has extent {numbers}; expected low before high on each axis", "WholeExtent")
    return extent


def _chosen(path: Path, reader: Any) -> tuple[bool, str]:
    """Whether the array is of cells, and its name; only this one will be read."""
    cells, points = reader.GetCellDataArraySelection(), reader.GetPointDataArraySelection()
    for selection in (cells, points):
        held = [selection.GetArrayName(i) for i in range(selection.GetNumberOfArrays())]
        wanted = [name for name in NAMES if name in held] or held
        if held and (len(held) == 1 or wanted is not held):
            cells.DisableAllArrays()
            points.DisableAllArrays()
            selection.EnableArray(wanted[0])
            return selection is cells, wanted[0]
        if held:
            raise FileError(path, f"holds arrays {', '.join(held)}; expected one of them to be named levels or fill")
    raise FileError(path, "holds no array of cells or points")


def _values(path: Path, place: str, image: Any, of_cells: bool, name: str, shape: tuple[int, ...]) -> NDArray[Any]:
    """The array with x as its first axis; in the file x runs fastest."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    array = (image.GetCellData() if of_cells else image.GetPointData()).GetArray(name)
    if array is None or array.GetNumberOfComponents() != 1:
        raise FileError(path, "is no array of single numbers; expected fill levels", place)
    values: NDArray[Any] = vtk_to_numpy(array)  # type: ignore[no-untyped-call]
    if values.size != math.prod(shape):
        raise FileError(path, f"has {values.size} values; expected {math.prod(shape)} for {shape}", place)
    return values.reshape(shape, order="F")


def _spacing(path: Path, image: Any) -> Vector:
    """The edges of a cell; those that differ by rounding alone are made equal."""
    matrix = image.GetDirectionMatrix()
    if any(matrix.GetElement(i, j) != (i == j) for i in range(3) for j in range(3)):
        raise FileError(path, "is rotated; expected axes along x, y, z", "Direction")
    spacing = image.GetSpacing()
    if not all(0 < s < np.inf for s in spacing) or max(spacing) > min(spacing) * LONGEST_EDGE:
        raise FileError(path, f"is {spacing}; expected edges above 0, the longest up to {LONGEST_EDGE:g} times the "
                              "shortest", "Spacing")
    x, y, z = spacing
    return (x, x, x) if max(spacing) <= min(spacing) * (1 + ROUNDED) else (x, y, z)
