"""From a scene to what rays need, each stage made on first use and kept in the scene."""

from __future__ import annotations

import functools
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from threading import Event
from typing import Any, TypeVar, cast

from jaart.core import extents, meaning
from jaart.core.assemble import goes_together, plan_of
from jaart.core.balls import Cloud, CloudTracer
from jaart.core.cell_table import cell_table
from jaart.core.chosen import Chosen
from jaart.core.cloud_surfels import Points, alone, cloud_of, points_of
from jaart.core.cylinder import cylinder_tracer
from jaart.core.errors import NoRoom
from jaart.core.extents import extent, raster
from jaart.core.groups.surface import MESHES
from jaart.core.kernels.records import Cells
from jaart.core.mesh_tracer import mesh_tracer
from jaart.core.model import fill
from jaart.core.places import Places, places_of
from jaart.core.scene import Array, Scene, frozen
from jaart.core.settings import Settings
from jaart.core.shapes import Solid
from jaart.core.surfels import Surfels, make_surfels, stretched_shape
from jaart.core.tracers import LatticeTracer, Tracer, centres_for

__all__ = ["Prepared", "cells", "extent", "levels", "making_room", "prepared", "raster", "solids", "surfels"]

F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True, eq=False)
class Prepared:
    """A scene ready to be traced.

    tracer: what rays are sent through; found: makes its points, or has them; values: what the settings come to;
    seconds: wall time that the stages took which were not kept from before.
    """

    tracer: Tracer
    found: Callable[[], Surfels | Points]
    values: Chosen
    seconds: float

    @property
    def surfels(self) -> Surfels | Points:
        """The points with normals; where rays meet a mesh of the levels they are made now."""
        return self.found()


def levels(scene: Scene, settings: Settings) -> Array:
    """Fill levels (nx, ny, nz): read from a file, or filled from a model's solids [T Algorithms 3, 4]."""
    model = scene.model
    if model is None:
        assert scene.levels is not None
        return scene.levels
    return scene.once("levels", settings.key("levels"), lambda: frozen(
        fill(model, raster(scene, settings), settings.filling, settings.subdivision)))


def solids(scene: Scene, settings: Settings) -> tuple[Solid, ...] | None:
    """The exact solids in cells, None when nobody knows them."""
    if scene.model is None:
        return None
    return tuple(solid.scaled(raster(scene, settings)) for solid in scene.model.solids)


def surfels(scene: Scene, settings: Settings) -> Surfels:
    """One surfel for each interface cell [T §3.1]; none where a lattice holds no surface, and then its notes say so."""
    return scene.once("surfels", settings.key("surfels"),
                      lambda: make_surfels(levels(scene, settings), settings, extents.edges(scene)))


def cells(scene: Scene, settings: Settings, values: Chosen) -> Cells:
    """The neighbourhoods of a lattice's cells and the field of empty space."""
    def make() -> Cells:
        shape = stretched_shape(levels(scene, settings).shape, extents.edges(scene))
        return cell_table(surfels(scene, settings), shape, values, settings.k)

    return scene.once("cells", (settings.key("neighbours"), values.radius), make)


def tracer(scene: Scene, settings: Settings, values: Chosen, cancel: Event | None = None) -> Tracer:
    """What rays are sent through: made of the stages that the settings ask for."""
    if scene.kind == "cloud":
        return cloud_tracer(scene, settings, values)
    if values.method in MESHES:
        return mesh_tracer(scene, settings, values, lambda: cells(scene, settings, values),
                           plan_of(scene, settings, values), levels(scene, settings), cancel)
    if values.method == "cylinder":
        ball = settings.replace(neighbourhood="cell_ball")
        return cylinder_tracer(values, plan_of(scene, settings, values), lambda near: cells(scene, ball, near))
    uniform = values.stride if settings.traversal == "uniform" else 0.0
    plan, table = plan_of(scene, settings, values), cells(scene, settings, values)
    made, kept = table._replace(stretches=int(meaning.stretches(values)), uniform=uniform), None
    if meaning.fits_centres(scene, settings, values):
        key = (settings.key("neighbours"), values.radius, plan.rule, plan.how.evaluate)
        kept = scene.once("centres", key, lambda: centres_for(table.sites))
    return LatticeTracer(lambda: made, plan, kept, goes_together(scene, settings, values))


def balls(scene: Scene, settings: Settings, values: Chosen) -> Cloud:
    """A cloud's points in a grid, and the balls around them."""
    sized = values.method == "cylinder" or alone(scene)
    key = (settings.key("neighbours"), values.neighbourhood, values.radius, values.h if sized else 0.0,
           meaning.needs_normals(scene, settings, values))
    return scene.once("balls", key, lambda: cloud_of(scene, settings, values))


def cloud_tracer(scene: Scene, settings: Settings, values: Chosen) -> CloudTracer:
    """A cloud's balls, with what earlier rays of the same settings asked for."""
    plan, made = plan_of(scene, settings, values), balls(scene, settings, values)
    return scene.once("cloud_tracer", (id(made), plan), lambda: CloudTracer(
        made, plan, meaning.stretches(values), meaning.fits_centres(scene, settings, values)))


def points(scene: Scene, settings: Settings, values: Chosen) -> Surfels | Points:
    """The surfels of a lattice, or a cloud's points."""
    return points_of(scene, settings, values) if scene.kind == "cloud" else surfels(scene, settings)


def prepared(scene: Scene, settings: Settings, cancel: Event | None = None) -> Prepared:
    """Every stage that rays need; what was made before is kept.

    Raises SettingsError for settings that make no sense in the scene, Cancelled after cancel was set.
    """
    begin = time.perf_counter()
    values = meaning.check(scene, settings)
    made = tracer(scene, settings, values, cancel)
    return Prepared(made, lambda: points(scene, settings, values), values, time.perf_counter() - begin)


def making_room(work: F) -> F:
    """A function of a scene that is called once more where memory ends, with nothing kept of what earlier calls asked
    for: whoever looks at a huge scene from all sides asks for all of it in the end.
    """
    @functools.wraps(work)
    def again(scene: Scene, *args: Any, **named: Any) -> Any:
        before = _rooms(scene)
        try:
            return work(scene, *args, **named)
        except NoRoom as error:
            if error.room not in before.values():  # it was empty: no more will fit next time
                raise
            _let_go(scene, error)
        del before
        return work(scene, *args, **named)

    return cast(F, again)


def _let_go(scene: Scene, error: NoRoom) -> None:
    """Free the memory of the room that is full, and not that of one which another picture has made since."""
    for stage, room in _rooms(scene).items():
        if room is error.room:
            scene.forget(stage)
    scene.forget("centres")
    error.room = None
    traceback.clear_frames(error.__traceback__)  # they hold it, too


def _rooms(scene: Scene) -> dict[str, Places]:
    """Where something is kept that rays asked for, by the stages that hold it."""
    holders = {stage: scene.kept(stage) for stage in ("cells", "cloud_tracer")}
    rooms = {stage: places_of(holder.sites) for stage, holder in holders.items() if holder is not None}
    return {stage: room for stage, room in rooms.items() if room.kept.gathered}
