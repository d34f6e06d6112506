"""The surfaces that are meshes: an energy's level [T §2.4.6], and the fill levels' own [T §2.1.1]."""

from __future__ import annotations

from threading import Event

import numpy as np

from jaart.core.contour import Mesh, contour
from jaart.core.errors import SettingsError
from jaart.core.field import energy_field
from jaart.core.filters import filtered
from jaart.core.kernels.records import Cells, Plan, Vector
from jaart.core.scene import Array
from jaart.core.settings import Settings


def energy_mesh(cells: Cells, plan: Plan, settings: Settings, level: float, energy: str | None = None,
                direction: Vector | None = None, threads: int | None = None, cancel: Event | None = None) -> Mesh:
    """The shell around all points whose energy is below a level [T §2.4.6].

    It has a sheet on each side of the points. cells, plan: as for rays; settings: energy, emphasise, subdivide; level:
    as the energy; energy: in place of the settings', also tangent_step; direction: unit vector of that. Raises
    SettingsError where the energy has no such level or would not fit into memory, Cancelled after cancel was set.
    """
    name, divisions = energy or settings.energy, settings.subdivide
    values = energy_field(cells, plan, name, settings.emphasise, divisions, direction, threads, cancel)
    between = _between(values[np.isfinite(values)])
    step = 1.0 / divisions
    return _some(contour(values, level, step=(step, step, step)), level, name, between)


def level_mesh(levels: Array, settings: Settings, level: float, spacing: Vector = (1.0, 1.0, 1.0)) -> Mesh:
    """The surface around all that is filled above a level, each cell's level being that of its centre [T §2.1.1].

    levels: (nx, ny, nz), before the filter; settings: filter, and border: beyond the lattice is nothing, not even
    a surface (open), or empty (closed); spacing: edges of a cell along x, y, z in units of the longest. Raises
    SettingsError where there is no such level.
    """
    kept = filtered(levels, settings)
    first = 0.5
    if settings.border == "closed":
        kept, first = np.pad(kept, 1), -0.5
    x, y, z = (first * s for s in spacing)
    return _some(contour(-kept, -level, (x, y, z), spacing), level, "the fill level", _between(kept))


def _between(values: Array) -> str:
    if not values.size:
        return "is nowhere defined"
    return f"is between {values.min():g} and {values.max():g}"


def _some(mesh: Mesh, level: float, name: str, between: str) -> Mesh:
    if not len(mesh):
        raise SettingsError(f"level = {level:g}: no surface there, {name} {between} where it is sampled")
    return mesh
