"""The surface of a scene as a mesh: an energy's level [T §2.4.6], or that of the fill levels [T §2.1.1]."""

from __future__ import annotations

from threading import Event
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from jaart.core import prepare
from jaart.core.assemble import plan_of
from jaart.core.contour import Mesh
from jaart.core.errors import RayError, SettingsError
from jaart.core.extents import edges
from jaart.core.field import DIRECTED, ENERGIES, Energy, Progress
from jaart.core.groups.surface import MESHES
from jaart.core.kernels.records import Vector
from jaart.core.meshes import energy_mesh, level_mesh
from jaart.core.render import unit
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.telling import stoppable
from jaart.core.warm import warm_up

#: What may be asked for.
NAMES = (*ENERGIES, "fill_level")


@prepare.making_room
def isosurface(scene: Scene, settings: Settings | None = None, energy: str | None = None,
               level: float | str | None = None, subdivide: int | None = None, *, direction: ArrayLike | None = None,
               threads: int | None = None, cancel: Event | None = None, progress: Progress | None = None) -> Mesh:
    """The mesh of a lattice's surface, as `render` meets it with method = isosurface or fill_level.

    energy: a name of NAMES; level: as the energy, or "auto"; subdivide: samples along an edge of a cell; each in place
    of the settings' when given; direction: (3,) of a ray, for tangent_step alone, whose |e_ts| [T 2.20] it enters;
    threads: as many as the machine has when None; progress(done, all) is called from the caller's thread. Energies
    have a sheet on each side of the points. Raises SettingsError for what makes no sense or has no surface, RayError
    for a direction that is none, Cancelled after cancel was set.
    """
    asked = asked_settings(settings or Settings(), energy, level, subdivide)
    name = energy or asked.energy
    along = _direction(name, direction)
    with stoppable(cancel):
        values = warm_up(scene, asked)
        if asked.method == "fill_level":
            return level_mesh(prepare.levels(scene, asked), asked, values.level, edges(scene))
        made = Energy(prepare.cells(scene, asked, values), plan_of(scene, asked, values), name,
                      asked.emphasise, along)
        return energy_mesh(made, asked.subdivide, values.level, threads, cancel, progress)


def asked_settings(settings: Settings, energy: str | None = None, level: float | str | None = None,
                   subdivide: int | None = None) -> Settings:
    """A mesh's settings: those given, with what is named beside them. Raises SettingsError for no energy's name."""
    if energy is not None and energy not in NAMES:
        raise SettingsError(f"energy = {energy}: expected {', '.join(NAMES)}")
    changed: dict[str, Any] = {"level": level, "subdivide": subdivide}
    if energy is None:
        changed["method"] = settings.method if settings.method in MESHES else "isosurface"
    elif energy == "fill_level":
        changed["method"] = "fill_level"
    else:
        changed["method"], changed["energy"] = "isosurface", "tangent" if energy == DIRECTED else energy
    return settings.replace(**{name: value for name, value in changed.items() if value is not None})


def _direction(energy: str, direction: ArrayLike | None) -> Vector:
    """The unit direction that e_ts needs. Raises SettingsError where it is missing or means nothing."""
    if energy != DIRECTED:
        if direction is not None:
            raise SettingsError(f"direction: has no meaning for {energy}; expected energy = {DIRECTED}")
        return 0.0, 0.0, 1.0
    if direction is None:
        raise SettingsError(f"energy = {DIRECTED}: expected a direction, the ray's")
    d = np.array(direction, dtype=np.float64)
    if d.shape != (3,) or not np.isfinite(d).all() or not d.any():
        raise RayError(f"direction {d.tolist()}: expected three finite numbers, not all 0")
    x, y, z = unit(d[None])[0].tolist()
    return x, y, z
