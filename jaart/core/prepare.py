"""From a scene to what rays need, each stage made on first use and kept in the scene."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from jaart.core.errors import FileError
from jaart.core.kernels import table
from jaart.core.kernels.records import Cells, Search
from jaart.core.model import fill
from jaart.core.parameter import Length
from jaart.core.records import Surfels
from jaart.core.scene import Array, Scene, frozen
from jaart.core.settings import Settings
from jaart.core.shapes import Solid
from jaart.core.surfels import make_surfels


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
            raise FileError(scene.source, "no interface: expected a cell with a level between 0 and 1, or a full cell "
                                          "beside an empty one", "levels")
        return made

    return scene.once("surfels", settings.key("surfels"), make)


def length(value: Length, scene: Scene, settings: Settings) -> float:
    """A length in cells: of the lattice's diagonal ("d"), of a cell ("s") or as it is."""
    return value.resolve(float(np.linalg.norm(extent(scene, settings))), 1.0)


def cells(scene: Scene, settings: Settings) -> Cells:
    """The cell_ball neighbour table and the field of empty space."""
    def make() -> Cells:
        shape = levels(scene, settings).shape
        return cell_table(surfels(scene, settings), (shape[0], shape[1], shape[2]),
                          length(settings.radius, scene, settings))

    return scene.once("cells", settings.key("neighbours"), make)


def cell_table(found: Surfels, shape: tuple[int, int, int], radius: float) -> Cells:
    """Every cell's surfels within the radius of its centre, in contiguous columns [T §3.1.3].

    shape: cells along each axis; radius: in cells.
    """
    index, offset, normal = np.array(found.cells, np.int32), np.array(found.offset), np.array(found.normal)
    first = np.zeros(shape[0] * shape[1] * shape[2] + 1, np.int64)
    table.count_near(index, offset, radius, shape, first)
    np.cumsum(first, out=first)
    ids, columns = np.empty(first[-1], np.int32), np.empty(6 * first[-1])
    table.write_near(index, offset, normal, radius, shape, first, ids, columns)
    empty = np.full(shape, 255, np.uint8)
    empty[tuple(index.T)] = 0
    table.fill_empty(empty)
    return Cells(empty, first, ids, columns)


def search(scene: Scene, settings: Settings) -> Search:
    """The settings of the iteration as the kernels take them, lengths in cells."""
    h = length(settings.h, scene, settings)
    trust = settings.radius if isinstance(settings.trust, str) else settings.trust
    return Search(h=h, arrived=settings.tolerance * h, cap=settings.max_iterations,
                  trust=length(trust, scene, settings), growth=int(settings.bail == "growth"),
                  max_off_centre=length(settings.max_off_centre, scene, settings))


def prepared(scene: Scene, settings: Settings) -> Prepared:
    """Every stage that rays need; what was made before is kept."""
    begin = time.perf_counter()
    made = cells(scene, settings)
    return Prepared(made, search(scene, settings), surfels(scene, settings), time.perf_counter() - begin)
