"""From a scene to what rays need, each stage made on first use and kept in the scene."""

from __future__ import annotations

import time
from dataclasses import dataclass
from threading import Event

import numpy as np
from numpy.typing import NDArray

from jaart.core import memory
from jaart.core.errors import Cancelled, FileError, SettingsError
from jaart.core.kernels import table
from jaart.core.kernels.records import Cell, Cells, Search
from jaart.core.model import fill
from jaart.core.parameter import Length
from jaart.core.scene import Array, Scene, frozen
from jaart.core.settings import PARAMETERS, Settings
from jaart.core.shapes import Solid
from jaart.core.surfels import Surfels, make_surfels

#: The table is made for so many surfels at a time.
SURFELS_AT_ONCE = 1024
#: A smaller h, as a share of the largest coordinate, is no length any more: its square underflows.
SMALLEST_H = 1e-100


@dataclass(frozen=True, eq=False)
class Prepared:
    """A scene ready to be traced.

    cells, search: what the kernels are handed; surfels: those of the lattice; seconds: wall time that
    the stages took which were not kept from before.
    """

    cells: Cells
    search: Search
    surfels: Surfels
    seconds: float


def raster(scene: Scene, settings: Settings) -> int:
    """Cells along each edge of a model's lattice."""
    assert scene.model is not None
    return scene.model.raster if settings.raster == "file" else int(settings.raster)


def levels(scene: Scene, settings: Settings) -> Array:
    """Fill levels (nx, ny, nz): read from a file, or filled from a model's solids [T Algorithms 3, 4]."""
    model = scene.model
    if model is None:
        assert scene.levels is not None
        return scene.levels
    return scene.once("levels", settings.key("levels"), lambda: frozen(
        fill(model, raster(scene, settings), settings.filling, settings.subdivision)))


def extent(scene: Scene, settings: Settings) -> tuple[float, float, float]:
    """Size of the scene in cells; it begins at (0, 0, 0)."""
    shape = (raster(scene, settings),) * 3 if scene.levels is None else scene.levels.shape
    return float(shape[0]), float(shape[1]), float(shape[2])


def solids(scene: Scene, settings: Settings) -> tuple[Solid, ...] | None:
    """The exact solids in cells, None when nobody knows them."""
    if scene.model is None:
        return None
    return tuple(solid.scaled(raster(scene, settings)) for solid in scene.model.solids)


def surfels(scene: Scene, settings: Settings) -> Surfels:
    """One surfel for each interface cell [T §3.1]. Raises FileError for a lattice without any."""
    def make() -> Surfels:
        made = make_surfels(levels(scene, settings), settings)
        if not len(made):
            raise FileError(scene.source, _no_surface(made), "levels")
        return made

    return scene.once("surfels", settings.key("surfels"), make)


def _no_surface(found: Surfels) -> str:
    if found.without_normal:
        return f"no surface: {found.without_normal} interface cells, but the level changes at none of them"
    return "no interface: expected a cell with a level between 0 and 1, or a full cell beside an empty one"


def length(name: str, scene: Scene, settings: Settings) -> float:
    """A setting's length in cells: of the lattice's diagonal ("d"), of a cell ("s") or as it is.

    Raises SettingsError where that is out of the setting's range.
    """
    value: Length = getattr(settings, name)
    resolved = value.resolve(float(np.linalg.norm(extent(scene, settings))), 1.0)
    if value.unit:
        PARAMETERS[name].check(Length(resolved))
    return resolved


def cells(scene: Scene, settings: Settings, cancel: Event | None = None) -> Cells:
    """The cell_ball neighbour table and the field of empty space."""
    def make() -> Cells:
        shape = levels(scene, settings).shape
        return cell_table(surfels(scene, settings), (shape[0], shape[1], shape[2]),
                          length("radius", scene, settings), cancel)

    return scene.once("cells", settings.key("neighbours"), make)


def cell_table(found: Surfels, shape: Cell, radius: float, cancel: Event | None = None) -> Cells:
    """Every cell's surfels within the radius of its centre, in contiguous columns [T §3.1.3].

    shape: cells along each axis; radius: in cells. Raises SettingsError when the table would not fit into
    memory, Cancelled after cancel was set.
    """
    nobody, nothing = np.empty(0, np.int32), np.empty(0)
    first = np.zeros(shape[0] * shape[1] * shape[2] + 1, np.int64)
    _scan(found, radius, shape, first, first[1:], nobody, nothing, cancel)
    np.cumsum(first, out=first)
    needed = int(first[-1]) * (6 * 8 + 4)
    if needed > memory.limit():
        raise SettingsError(f"radius = {radius:g} cells: needs {memory.words(needed)} of memory, more than the "
                            f"{memory.words(memory.limit())} it may take")
    ids, columns = np.empty(first[-1], np.int32), np.empty(6 * first[-1])
    _scan(found, radius, shape, first, np.zeros(len(first) - 1, np.int64), ids, columns, cancel)
    empty = np.full(shape, 255, np.uint8)
    empty[tuple(found.cells.T)] = 0
    table.fill_empty(empty)
    return Cells(empty, first, ids, columns)


def _scan(found: Surfels, radius: float, shape: Cell, first: NDArray[np.int64], counted: NDArray[np.int64],
          ids: NDArray[np.int32], columns: Array, cancel: Event | None) -> None:
    """Count or write the surfels near each cell, a few surfels at a time so that it can be cancelled."""
    index, offset, normal = np.array(found.cells, np.int32), np.array(found.offset), np.array(found.normal)
    for begin in range(0, len(found), SURFELS_AT_ONCE):
        if cancel is not None and cancel.is_set():
            raise Cancelled("the neighbour table was cancelled")
        table.scan_near(index, offset, normal, begin, min(begin + SURFELS_AT_ONCE, len(found)), radius, shape,
                        first, counted, ids, columns)


def search(scene: Scene, settings: Settings) -> Search:
    """The settings of the iteration as the kernels take them, lengths in cells.

    The tolerance counts in h, but in radii where the radius is smaller: what h does ends there. Raises
    SettingsError for an h so small that no number of cells is left of it.
    """
    h, radius = length("h", scene, settings), length("radius", scene, settings)
    largest = max(extent(scene, settings))
    if h < SMALLEST_H * largest:
        raise SettingsError(f"h = {settings.h}: too small for coordinates up to {largest:g} cells, "
                            f"expected at least {SMALLEST_H * largest:g}")
    trust = radius if isinstance(settings.trust, str) else length("trust", scene, settings)
    return Search(h=h, arrived=settings.tolerance * min(h, radius), cap=settings.max_iterations, trust=trust,
                  growth=int(settings.bail == "growth"), max_off_centre=length("max_off_centre", scene, settings))


def prepared(scene: Scene, settings: Settings, cancel: Event | None = None) -> Prepared:
    """Every stage that rays need; what was made before is kept. Raises Cancelled after cancel was set."""
    begin = time.perf_counter()
    wanted = search(scene, settings)
    made = cells(scene, settings, cancel)
    return Prepared(made, wanted, surfels(scene, settings), time.perf_counter() - begin)
