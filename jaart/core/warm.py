"""Load or compile kernels once in a process, so that no measured time holds a compilation.

Only what a scene needs: the cells of a lattice or the balls of a cloud, its surface and its search; the
energies along a ray when one is traced.
"""

from __future__ import annotations

import functools
import threading
from dataclasses import replace

import numpy as np

from jaart.core import assemble, cylinder, meaning, mesh_tracer
from jaart.core.addresses import compiled
from jaart.core.balls import CloudTracer
from jaart.core.cell_table import cell_table
from jaart.core.chosen import Chosen, chosen, counts_nearest
from jaart.core.cloud_surfels import cloud_of
from jaart.core.errors import SettingsError
from jaart.core.groups.surface import MESHES
from jaart.core.kernels import ball_ray, beams, energies, pinhole, ray, together, traversal
from jaart.core.kernels.records import LOG_WIDTH, Cells, Plan
from jaart.core.nearest import LEAST, nearest_others
from jaart.core.parameter import Length
from jaart.core.places import neighbours_of, served
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.surfels import Surfels
from jaart.core.telling import told
from jaart.core.tiles import columns_for
from jaart.core.tracers import NO_LOG, LatticeTracer

_LOCK = threading.RLock()
_O, _D = (1.5, 1.5, 9.0), (0.0, 0.0, -1.0)
_VIEW = pinhole.View(_O, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), _D, 1.0, 0, 1, 1)


def needs_compile(scene: Scene, settings: Settings, tracing: bool = False) -> bool:
    """Whether kernels will be compiled, which takes seconds, or only loaded from the user's cache.

    tracing: for a single ray with its log, not for pictures. False for settings that make no sense in the scene:
    nothing is compiled for them.
    """
    try:
        values = meaning.check(scene, settings)
    except SettingsError:
        return False
    abreast = not tracing and assemble.goes_together(scene, settings, values)
    of_lattice = together.trace_together if abreast else ray.trace_rays
    driver = ball_ray.trace_ball_rays if scene.kind == "cloud" else of_lattice
    return not all(compiled(f) for f in (driver, *assemble.kernels_of(scene, settings, values)))


def warm_up(scene: Scene, settings: Settings, tracing: bool = False) -> Chosen:
    """Run every kernel that rays through a scene need once; afterwards nothing compiles for them.

    tracing: those that follow a single ray, not those of pictures. Returns what the settings come to. Raises
    SettingsError for settings that make no sense in the scene.
    """
    warm_choice(scene)
    values = meaning.check(scene, settings)
    with _LOCK, told(None):
        _camera()
        if scene.kind != "cloud" and counts_nearest(values.neighbourhood):
            _nearest_cells()
        if scene.kind == "cloud":
            _cloud()
        else:
            _lattice(not tracing and assemble.goes_together(scene, settings, values))
        if tracing:
            _tracing()
        if tracing and scene.kind == "cloud":
            _balls_listed()
        assemble.plan_of(scene, settings, values)
        if values.method in MESHES:
            mesh_tracer.warm_up(values.method, *_small())
        if values.method == "cylinder":
            cylinder.warm_up()
    return values


def warm_choice(scene: Scene) -> None:
    """Run what the lengths of a cloud's settings are chosen by."""
    if scene.kind == "cloud":
        with _LOCK, told(None):
            _nearest_points()


@functools.cache
def _nearest_points() -> None:
    """The neighbours of an even cloud; a smaller one is not put into a grid."""
    x, y = np.divmod(np.arange(LEAST), 32.0)
    nearest_others(np.column_stack((x, y, 0.01 * x * y)), 2)


@functools.cache
def _nearest_cells() -> None:
    """The surfels nearest to a cell."""
    found = Surfels(np.array([[1, 1, 1]], np.int32), np.zeros((1, 3)), np.eye(3)[[2]])
    values = replace(chosen(Scene("small", levels=np.zeros((3, 3, 3))), Settings()), neighbourhood="cell_knn")
    neighbours_of(cell_table(found, (3, 3, 3), values, 1).sites, (1, 1, 1))


@functools.cache
def _camera() -> None:
    pinhole.write_rays(_VIEW, np.zeros(1, np.int64), np.zeros(1, np.int64), np.array([_O]), np.array([_D]),
                       np.empty((0, 0)), np.empty(0))


@functools.cache
def _small() -> tuple[Cells, Plan]:
    """Two surfels in a lattice, and the plan of the default settings."""
    scene = Scene("small", levels=np.zeros((3, 4, 3)))
    values = chosen(scene, Settings())
    found = Surfels(np.array([[1, 1, 1], [1, 2, 1]], np.int32), np.zeros((2, 3)), np.eye(3)[[2, 2]])
    return cell_table(found, (3, 4, 3), values, 1), assemble.plan_of(scene, Settings(), values)


@functools.cache
def _lattice(abreast: bool) -> None:
    """Two surfels, seen by one ray; abreast: by the driver of rays that search side by side."""
    cells, plan = _small()
    beams.write_blocks(_VIEW, cells.empty, 1, 0, 1, np.empty((1, 1)))
    log = NO_LOG if abreast else np.empty((2, LOG_WIDTH))
    LatticeTracer(lambda: cells, plan, together=abreast).trace(np.array([_O]), np.array([_D]), np.zeros(1, np.int64),
                                                               columns_for(1), log)


@functools.cache
def _small_cloud() -> CloudTracer:
    """Nine points on a plane."""
    points = np.array([(x, y, 0.1 * x * y) for x in (0.0, 1.0, 2.0) for y in (0.0, 1.0, 2.0)])
    scene = Scene("small", points=points, normals=np.tile((0.0, 0.0, 1.0), (9, 1)))
    settings = Settings(h=Length(1.0))
    return CloudTracer(cloud_of(scene, settings, chosen(scene, settings)), _small()[1], False, True)


@functools.cache
def _cloud() -> None:
    """The small cloud, seen once from above: promises, lists and a search."""
    _small_cloud().trace(np.array([_O]), np.array([_D]), np.zeros(1, np.int64), columns_for(1),
                         np.empty((2, LOG_WIDTH)))


@functools.cache
def _balls_listed() -> None:
    neighbours_of(_small_cloud().sites, (0, 0, 0))


@functools.cache
def _tracing() -> None:
    cells, plan = _small()
    traversal.crossed(np.array(_O), np.array(_D), (3, 4, 3), np.empty((13, 3), np.int32), np.empty(14))
    served(cells.sites, lambda own, pool: energies.sample(own, plan, _O, _D, np.array([7.5]), np.array([[1, 1, 1]]),
                                                          np.empty((4, 1)), pool.work, pool.fit))
    neighbours_of(cells.sites, (1, 1, 1))
    energies.write_weights(cells.sites, (1, 1, 1), (0.0, 0.0, 0.0), plan.rule, np.empty(4))
