"""A plan against what really runs: what is kept in the scene, which functions are called, what the hits depend on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.spatial

import jaart
from jaart.core import cell_table, cloud_surfels, filters, lights, meshes, picture, prepare, shade, surfels
from jaart.core.camera import Camera
from jaart.core.io import load
from jaart.core.plan import plan
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.settings import PARAMETERS, Settings
from tests.core.kernel_calls import asked_cells
from tests.core.plan_scenes import CASES, MADE, SETTINGS, counted, lattice, model, oriented

#: What a scene keeps of a stage after rays were traced.
KEPT = {"fill levels": "levels", "placement": "surfels", "estimated normals": "normals", "cell table": "cells",
        "balls": "balls", "mesh": "mesh"}
OPEN: dict[str, Any] = {"max_off_centre": "none", "max_nearest": "none"}
BOUNDS = {"off-centre bound": ("max_off_centre", 1e-9), "weight bound": ("min_weight", 90.0),
          "nearest bound": ("max_nearest", 1e-9), "angle bound": ("max_angle", 0.0), "sampling bound": ("min_gap", 1.0)}


@pytest.mark.parametrize(("made", "name"), CASES)
def test_what_is_planned_is_what_a_scene_keeps(made: str, name: str) -> None:
    scene, settings = MADE[made](), Settings(**SETTINGS[name])
    planned = plan(scene, settings)
    assert not {"surfels", "cells", "balls", "mesh", "levels", "normals"} & set(scene._kept)
    hits = render(scene, settings, size=(12, 12))
    assert {stage: planned[stage].runs for stage in KEPT if stage != "placement" or scene.kind != "cloud"} == {
        stage: key in scene._kept for stage, key in KEPT.items() if stage != "placement" or scene.kind != "cloud"}
    assert planned["centre fits"].runs == planned["first guess"].runs == (hits.fits > 0)
    assert planned["search"].runs == (hits.hit.any() and name not in ("cylinder", "fill_level", "isosurface"))


@pytest.mark.parametrize("name", PARAMETERS["filter"].choices)
def test_the_filter_and_the_gradient(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[str] = []
    for one in ("thesis", "median", "gauss"):
        counted(monkeypatch, calls, filters, one)
    counted(monkeypatch, calls, surfels, "gradients")
    scene, settings = lattice(), Settings(filter=name)
    planned = plan(scene, settings)
    prepare.surfels(scene, settings)
    assert calls == [name] * planned["filter"].runs + ["gradients"] * planned["gradient"].runs


@pytest.mark.parametrize("name", ["tangent", "fill_level", "isosurface"])
def test_the_energy_field(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[str] = []
    counted(monkeypatch, calls, meshes, "energy_field")
    scene, settings = lattice(), Settings(**SETTINGS[name])
    planned = plan(scene, settings)
    render(scene, settings, size=(4, 4))
    assert len(calls) == planned["energy field"].runs


@pytest.mark.parametrize(("made", "given"), [
    *(("lattice", given) for given in ({}, {"neighbourhood": "knn"}, {"neighbourhood": "cell_knn"},
                                       {"method": "cylinder"}, {"method": "fill_level"},
                                       {"method": "isosurface", "subdivide": 1})),
    ("cloud", {}), ("cloud", {"neighbourhood": "knn"}), ("cloud", {"method": "cylinder"})])
def test_trees_and_the_distance_field(made: str, given: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[str] = []
    scene, settings = MADE[made](), Settings(**given)
    planned = plan(scene, settings)
    counted(monkeypatch, calls, cell_table.table, "fill_empty")
    counted(monkeypatch, calls, scipy.spatial, "cKDTree")
    counted(monkeypatch, calls, cloud_surfels, "ball_tree")
    render(scene, settings, size=(4, 4))
    assert planned["distance field"].runs == ("fill_empty" in calls)
    assert planned["tree"].runs == (("ball_tree" if made == "cloud" else "cKDTree") in calls)


@pytest.mark.parametrize(("made", "given"), [("lattice", {}), ("cloud", {}), ("lattice", {"neighbourhood": "knn"}),
                                             ("lattice", {"neighbourhood": "cell_knn"})])
def test_neighbours_that_no_ray_asked_for(made: str, given: dict[str, Any]) -> None:
    scene, settings = MADE[made](), Settings(**given)
    tracer = prepare.prepared(scene, settings).tracer
    before = len(asked_cells(tracer.sites)) if made == "lattice" else np.count_nonzero(tracer.sites.slots)
    hits = render(scene, settings, size=(4, 4))
    assert before > 0 or 0 < hits.gathered <= hits.cells.sum()
    assert plan(scene, settings)["neighbours not asked for"].runs == (before > hits.cells.sum())


@pytest.mark.parametrize("made", ["lattice", "cloud"])
@pytest.mark.parametrize("search", [s for s in PARAMETERS["search"].choices if s != "auto"])
def test_first_guesses_are_kept_where_they_are_planned(made: str, search: str) -> None:
    scene, settings = MADE[made](), Settings(search=search)
    hits = render(scene, settings, size=(8, 8))
    assert hits.starts.any() and plan(scene, settings)["first guess"].runs == (hits.fits > 0)


@pytest.mark.parametrize(("given", "said"), [
    ({}, "each cell"), ({"traversal": "uniform", "step": 0.25}, "every 0.25 cells"), ({"method": "fill_level"}, None)])
def test_how_a_ray_comes_from_cell_to_cell(given: dict[str, Any], said: str | None) -> None:
    scene, settings = lattice(), Settings(**given)
    visited, exact = (render(scene, one, size=(12, 12)).cells for one in (settings, Settings()))
    one = plan(scene, settings)["traversal"]
    assert one.runs == (said is not None) and one.reason.startswith(said or "the tree of the triangles")
    assert (visited != exact).any() == bool(given)


@pytest.mark.parametrize("given", [
    {}, {"shadows": True}, {"light": ((30.0, 5.0, 30.0),)}, {"light": ((30.0, 5.0, 30.0),), "shadows": True},
    {"light": ((30.0, 5.0, 30.0),), "shadows": True, "shading": "diffuse"}, {"shading": "water"}, {"samples": 2}])
def test_what_comes_after_the_hits(given: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[str] = []
    counted(monkeypatch, calls, lights, "blocked")
    counted(monkeypatch, calls, shade, "water")
    counted(monkeypatch, calls, picture, "box_average")
    scene, settings = model(), Settings(**given)
    planned = plan(scene, settings)
    picture.picture(scene, settings, size=(12, 12))
    named = {"shadow rays": "blocked", "reflection and refraction": "water", "more samples": "box_average"}
    assert {stage: planned[stage].runs for stage in named} == {stage: call in calls for stage, call in named.items()}


@pytest.mark.parametrize("scene", [model(), lattice(), oriented(), load("bumpy")], ids=lambda s: s.source)
def test_the_exact_surface(scene: Scene) -> None:
    hits = render(scene, Settings(), size=(4, 4))
    assert plan(scene, Settings())["exact surface"].runs == (jaart.quality(hits, scene) is not None)


@pytest.mark.parametrize(("made", "name"), [("lattice", "tangent"), ("cloud", "tangent"), ("lattice", "cylinder"),
                                             ("cloud", "cylinder"), ("lattice", "fill_level")])
def test_bounds_refuse_hits_where_they_are_planned(made: str, name: str) -> None:
    scene, without = MADE[made](), Settings(**SETTINGS[name], **OPEN)
    eye = Camera.fit(prepare.extents.bounds(scene, without), size=(12, 12))
    hits = render(scene, without, eye, (12, 12))
    assert hits.hit.any() and not any(plan(scene, without)[bound].runs for bound in BOUNDS)
    for bound, (setting, severe) in BOUNDS.items():
        settings = without.replace(**{setting: severe})
        refused = (render(scene, settings, eye, (12, 12)).hit != hits.hit).any()
        assert plan(scene, settings)[bound].runs == refused, bound


@pytest.mark.parametrize(("made", "name"), [("lattice", "tangent"), ("cloud", "polynomial"), ("lattice", "cylinder"),
                                             ("lattice", "fill_level")])
def test_the_shown_normal_takes_the_gradient_where_it_is_planned(made: str, name: str) -> None:
    scene, average = MADE[made](), Settings(**SETTINGS[name])
    gradient = average.replace(shading_normal="gradient")
    taken = [render(scene, one, size=(12, 12)).evaluations.sum() for one in (average, gradient)]
    assert plan(scene, gradient)["gradient of f"].runs == (taken[1] > taken[0])
