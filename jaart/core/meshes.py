"""The surfaces that are meshes: an energy's level [T §2.4.6], and the fill levels' own [T §2.1.1]."""

from __future__ import annotations

from dataclasses import replace
from threading import Event

import numpy as np

from jaart.core.contour import Mesh, contour
from jaart.core.errors import SettingsError
from jaart.core.field import Energy, Progress, energy_field, energy_gradients
from jaart.core.filters import filtered
from jaart.core.kernels.records import Vector
from jaart.core.scene import Array, frozen
from jaart.core.settings import Settings
from jaart.core.telling import doing, tell


def energy_mesh(energy: Energy, divisions: int, level: float, threads: int | None = None,
                cancel: Event | None = None, progress: Progress | None = None) -> Mesh:
    """The shell around all points whose energy is below a level [T §2.4.6].

    It has a sheet on each side of the points, and is open where no more surfels are near. divisions: samples along an
    edge of a cell; level: as the energy; progress: as of `energy_field`. The normals are the energy's own gradient.
    Raises SettingsError where the energy has no such level or would not fit into memory, Cancelled after cancel was
    set.
    """
    values, step = energy_field(energy, divisions, threads, cancel, progress), 1.0 / divisions
    between = _between(values[np.isfinite(values)])
    with doing("triangles"):
        mesh = _some(contour(values, level, step=(step, step, step)), level, energy.name, between)
    with doing("normals of the triangles"):
        gradient = energy_gradients(energy, mesh.vertices, threads, cancel, tell)
    size = np.linalg.norm(gradient, axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        normals = np.where((size > 0) & (size < np.inf), gradient / size, mesh.normals)
    return replace(mesh, normals=frozen(normals))


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
    with doing("triangles"):
        return _some(contour(-kept, -level, (x, y, z), spacing), level, "the fill level", _between(kept))


def _between(values: Array) -> str:
    if not values.size:
        return "is nowhere defined"
    return f"is between {values.min():g} and {values.max():g}"


def _some(mesh: Mesh, level: float, name: str, between: str) -> Mesh:
    if not len(mesh):
        raise SettingsError(f"level = {level:g}: no surface there, {name} {between} where it is sampled")
    return mesh
