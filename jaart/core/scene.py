"""What a file holds: a lattice of fill levels, exact solids to be filled into one, or a cloud of points."""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from jaart.core.errors import FileError
from jaart.core.shapes import Solid
from jaart.core.telling import STAGES, doing

Array = NDArray[np.float64]
T = TypeVar("T")

#: Larger coordinates, and clouds smaller than its inverse, would overflow where they are squared.
LARGEST = 1e100
#: How far the square of a unit normal may be from 1.
UNIT = 1e-9


def frozen(values: Any) -> Array:
    """A read-only float64 array of the values; copies only what is not one already."""
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.flags.writeable:
        array = array.copy() if isinstance(values, np.ndarray) and np.may_share_memory(array, values) else array
        array.flags.writeable = False
    return array


@dataclass(frozen=True)
class Model:
    """Exact solids in the unit cube, and the lattice they are filled into [T §3.3.3].

    solids: in units of the cube; raster: cells along each edge.
    """

    solids: tuple[Solid, ...]
    raster: int


class Exact(Protocol):
    """A surface that is known exactly."""

    def hit(self, origins: Array, directions: Array) -> tuple[Array, Array]:
        """First t > 0 (R,) of rays (R, 3) and the unit normals (R, 3) there, outwards; NaN where a ray misses."""


@dataclass(frozen=True, eq=False)
class Scene:
    """One scene, frozen; what it costs to derive is kept in it (see `once`).

    It holds one of three. levels: fill levels (nx, ny, nz) in [0, 1]; model: exact solids; points:
    a cloud (N, 3) in its own units, N >= 1, with or without unit normals (N, 3).
    source: path or built-in name; spacing, origin: physical size of a cell and corner of the lattice,
    for display and export (lengths are in cells elsewhere); frame, frames: which of a series; time:
    its time in seconds; merged: exact duplicates of points left out; notes: what was repaired or left out
    on reading; exact: the surface that a cloud's points lie on, where it is known.
    Raises FileError for anything else.
    """

    source: str
    levels: Array | None = None
    model: Model | None = None
    points: Array | None = None
    normals: Array | None = None
    spacing: tuple[float, float, float] = (1.0, 1.0, 1.0)
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    frame: int = 0
    frames: int = 1
    time: float | None = None
    merged: int = 0
    notes: tuple[str, ...] = ()
    exact: Exact | None = None
    _kept: dict[Hashable, Any] = field(default_factory=dict, init=False, repr=False)
    _lock: Any = field(default_factory=threading.RLock, init=False, repr=False)

    def __post_init__(self) -> None:
        if sum(held is not None for held in (self.levels, self.model, self.points)) != 1:
            raise FileError(self.source, "expected either fill levels, a model or points")
        if self.normals is not None and self.points is None:
            raise FileError(self.source, "expected no normals without points", "normals")
        for name, check in (("levels", _check_levels), ("points", _check_points), ("normals", _check_normals)):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, frozen(getattr(self, name)))
                check(self)

    @property
    def known(self) -> bool:
        """Whether its surface is known exactly, by its solids or as it is."""
        return self.model is not None or self.exact is not None

    @property
    def kind(self) -> str:
        """lattice, model or cloud."""
        return "cloud" if self.points is not None else "lattice" if self.model is None else "model"

    def once(self, stage: str, key: Hashable, make: Callable[[], T]) -> T:
        """The result of a stage, made on first use; only the newest key of each stage is kept."""
        with self._lock:
            kept = self._kept.get(stage)
            if kept is None or kept[0] != key:
                with doing(STAGES.get(stage, "")):
                    kept = (key, make())
                self._kept[stage] = kept
            result: T = kept[1]
            return result

    def kept(self, stage: str) -> Any:
        """The result of a stage if it is kept, else None."""
        with self._lock:
            return self._kept.get(stage, (None, None))[1]

    def forget(self, stage: str) -> None:
        """Let go of the result of a stage that nothing needs again."""
        with self._lock:
            self._kept.pop(stage, None)


def _check_levels(scene: Scene) -> None:
    levels = scene.levels
    assert levels is not None
    if levels.ndim != 3 or not levels.size or not (levels.min() >= 0 and levels.max() <= 1):
        raise FileError(scene.source, f"expected levels (nx, ny, nz) from 0 to 1, found {levels.shape} values "
                                      f"from {levels.min(initial=1):g} to {levels.max(initial=0):g}", "levels")


def _check_points(scene: Scene) -> None:
    points = scene.points
    assert points is not None
    if points.ndim != 2 or points.shape[1] != 3 or not len(points):
        raise FileError(scene.source, f"expected points (N, 3), at least one, found {points.shape}", "points")
    if not (largest := np.abs(points).max()) <= LARGEST:
        raise FileError(scene.source, f"expected coordinates up to {LARGEST:g}, found {largest:g}", "points")
    if 0 < (size := np.ptp(points, axis=0).max()) < 1 / LARGEST:
        raise FileError(scene.source, f"expected a cloud larger than {1 / LARGEST:g}, found {size:g}", "points")


def _check_normals(scene: Scene) -> None:
    normals = scene.normals
    assert normals is not None and scene.points is not None
    if normals.shape != scene.points.shape:
        raise FileError(scene.source, f"expected one for each of {len(scene.points)} points, found {normals.shape}",
                        "normals")
    off = np.abs((normals * normals).sum(axis=1) - 1)
    if not off.max() <= UNIT:
        raise FileError(scene.source, f"expected unit vectors, not so at [{(~(off <= UNIT)).argmax()}]", "normals")
