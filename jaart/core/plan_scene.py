"""The stages that make a scene ready for rays: levels, surfels and what counts near a place."""

from __future__ import annotations

from jaart.core import filters, meaning
from jaart.core.chosen import Chosen, counts_nearest
from jaart.core.groups.surface import MESHES, evaluates
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.stage import Stage, stage

_PICKED = "the mesh of the levels needs none; made once a ray is picked, for the energies along it"
_NO_LEVELS = "a cloud has no fill levels"


def scene_stages(scene: Scene, settings: Settings, values: Chosen) -> tuple[Stage, ...]:
    """What is made before the first ray, in its order."""
    surfels = _cloud(scene, settings, values) if scene.kind == "cloud" else _lattice(scene, settings)
    return (*surfels, _table(scene, settings, values), _unasked(scene, values), _distance_field(scene, values),
            _balls(scene, settings, values), _tree(scene), *_mesh(settings, values))


def _lattice(scene: Scene, settings: Settings) -> tuple[Stage, ...]:
    return (
        stage("fill levels", scene.kind == "model", f"the solids are filled, {settings.filling}",
              "they were read from the file", "raster", "filling", "subdivision"),
        stage("filter", filters.wanted(settings), settings.filter, "none is asked for", "filter"),
        stage("gradient", evaluates(settings), "a surfel lies along it, and its normal is against it", _PICKED,
              "method", "gradient", "smoothing"),
        stage("placement", evaluates(settings), "each interface cell gives a surfel", _PICKED,
              "method", "placement", "neighbours", "border"),
        Stage("estimated normals", False, "surfels of a lattice have the gradient's"))


def _cloud(scene: Scene, settings: Settings, values: Chosen) -> tuple[Stage, ...]:
    why_not = "the points have normals" if scene.normals is not None else "nothing asks for a side or a surfel's normal"
    return (
        *(Stage(name, False, _NO_LEVELS) for name in ("fill levels", "filter", "gradient")),
        Stage("placement", False, "the points are the surfels"),
        stage("estimated normals", meaning.estimates_normals(scene, settings, values),
              "the points have none, and these settings need some", why_not,
              "orient", "normal", "method", "search", "shading"))


def _table(scene: Scene, settings: Settings, values: Chosen) -> Stage:
    """The neighbourhoods of all cells."""
    if scene.kind == "cloud":
        return Stage("cell table", False, "a cloud has no cells")
    if not evaluates(values):
        return Stage("cell table", False, _PICKED, ("method",))
    if values.method == "cylinder":
        return Stage("cell table", True, "of all surfels that a cylinder in a cell may hold, gathered when a ray first "
                     "asks", ("method", "h"))
    return Stage("cell table", True, f"{_near(settings, values)} of each cell, gathered when a ray first asks",
                 ("neighbourhood", "radius", "k"))


def _balls(scene: Scene, settings: Settings, values: Chosen) -> Stage:
    """The balls that rays pierce."""
    if scene.kind != "cloud":
        return Stage("balls", False, "cells take their place")
    if values.method == "cylinder":
        return Stage("balls", True, "one of radius h around each point, that of its disc", ("method", "h"))
    return Stage("balls", True, f"those that cover the points; {_near(settings, values)} of each are "
                 "gathered when a ray first asks", ("ball_k", "neighbourhood", "radius", "k"))


def _unasked(scene: Scene, values: Chosen) -> Stage:
    """The neighbourhoods of places that no ray visits."""
    if scene.kind == "cloud":
        return Stage("neighbours not asked for", False, "a ball has none until a ray asks")
    if not evaluates(values):
        return Stage("neighbours not asked for", False, _PICKED, ("method",))
    return Stage("neighbours not asked for", False, "a cell has none until a ray asks")


def _distance_field(scene: Scene, values: Chosen) -> Stage:
    """How far each cell is from the nearest surfel."""
    if scene.kind == "cloud":
        return Stage("distance field", False, "a cloud has no cells")
    return stage("distance field", evaluates(values), "how many empty cells are around each, to be skipped at once",
                 _PICKED, "method")


def _tree(scene: Scene) -> Stage:
    """What finds balls along a ray."""
    if scene.kind == "cloud":
        return Stage("tree", True, "of the balls, for rays; of the points, where nearest ones are asked for")
    return Stage("tree", False, "a lattice needs none")


def _near(settings: Settings, values: Chosen) -> str:
    if counts_nearest(values.neighbourhood):
        return f"the {settings.k} nearest surfels"
    return f"surfels within {values.radius:.4g}"


def _mesh(settings: Settings, values: Chosen) -> tuple[Stage, ...]:
    sampled = meaning.weighs(values) and values.method in MESHES
    return (
        stage("energy field", sampled, f"the energy is sampled {settings.subdivide} times along each cell's edge",
              "no energy's isosurface is asked for", "method", "energy", "subdivide"),
        stage("mesh", values.method in MESHES, f"marching cubes at level {values.level:g}, in a tree",
              "rays search the surface itself", "method", "level"))
