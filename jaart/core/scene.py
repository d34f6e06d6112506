"""What a file holds: a lattice of fill levels, or exact solids to be filled into one."""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from jaart.core.errors import FileError
from jaart.core.shapes import Solid

Array = NDArray[np.float64]
T = TypeVar("T")


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


@dataclass(frozen=True, eq=False)
class Scene:
    """One scene, frozen; what it costs to derive is kept in it (see `once`).

    source: path or built-in name; levels: fill levels (nx, ny, nz) in [0, 1], None where a model
    gives them; model: exact solids if known; spacing, origin: physical size of a cell and corner
    of the lattice, for display and export (lengths are in cells elsewhere); frame, frames: which of
    a series; time: its time in seconds; notes: what was repaired or left out on reading.
    Raises FileError for levels that are none.
    """

    source: str
    levels: Array | None = None
    model: Model | None = None
    spacing: tuple[float, float, float] = (1.0, 1.0, 1.0)
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    frame: int = 0
    frames: int = 1
    time: float | None = None
    notes: tuple[str, ...] = ()
    _kept: dict[Hashable, Any] = field(default_factory=dict, init=False, repr=False)
    _lock: Any = field(default_factory=threading.RLock, init=False, repr=False)

    def __post_init__(self) -> None:
        if (self.levels is None) == (self.model is None):
            raise FileError(self.source, "expected either fill levels or a model")
        if self.levels is not None:
            levels = frozen(self.levels)
            if levels.ndim != 3 or not levels.size or not (levels.min() >= 0 and levels.max() <= 1):
                raise FileError(self.source, f"expected levels (nx, ny, nz) from 0 to 1, found {levels.shape} values "
                                             f"from {levels.min(initial=1):g} to {levels.max(initial=0):g}", "levels")
            object.__setattr__(self, "levels", levels)

    @property
    def kind(self) -> str:
        """lattice or model."""
        return "lattice" if self.model is None else "model"

    def once(self, stage: str, key: Hashable, make: Callable[[], T]) -> T:
        """The result of a stage, made on first use; only the newest key of each stage is kept."""
        with self._lock:
            kept = self._kept.get(stage)
            if kept is None or kept[0] != key:
                kept = (key, make())
                self._kept[stage] = kept
            result: T = kept[1]
            return result
