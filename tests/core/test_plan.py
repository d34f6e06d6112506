"""A plan against what really runs: what is kept in the scene, which functions are called, what the hits depend on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import scipy.spatial

import jaart
from jaart.core import cell_table, cloud_surfels, filters, lights, meshes, picture, prepare, shade, surfels
from jaart.core.assemble import evaluator, plan_of, rule_of, searcher
from jaart.core.balls import CloudTracer
from jaart.core.camera import Camera
from jaart.core.chosen import arrival
from jaart.core.errors import SettingsError
from jaart.core.field import Energy
from jaart.core.io import load
from jaart.core.kernels import (
    centres,
    field,
    fitted,
    march,
    minimise,
    normals,
    probe,
    project,
    safe,
    stepping,
    tangent,
)
from jaart.core.kernels import records as r
from jaart.core.kernels.records import FIT_SIZE, Start
from jaart.core.meaning import check
from jaart.core.places import served
from jaart.core.plan import RESOLVED, Plan, plan
from jaart.core.render import render
from jaart.core.scene import Model, Scene, frozen
from jaart.core.settings import PARAMETERS, Settings, preset
from jaart.core.shapes import Sphere
from tests.core.cloud_scenes import fresh
from tests.core.kernel_calls import asked_cells, near_at, near_of, work_for

#: What a scene keeps of a stage after rays were traced.
KEPT = {"fill levels": "levels", "placement": "surfels", "estimated normals": "normals", "cell table": "cells",
        "balls": "balls", "mesh": "mesh"}
OPEN: dict[str, Any] = {"max_off_centre": "none", "max_nearest": "none"}
BOUNDS = {"off-centre bound": ("max_off_centre", 1e-9), "weight bound": ("min_weight", 90.0),
          "nearest bound": ("max_nearest", 1e-9), "angle bound": ("max_angle", 0.0), "sampling bound": ("min_gap", 1.0)}


def model() -> Scene:
    return Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.3),), 12))


def lattice() -> Scene:
    return Scene("levels", levels=prepare.levels(model(), Settings()))


def bare() -> Scene:
    return fresh("sphere", 300, bare=True)


def oriented() -> Scene:
    return fresh("sphere", 300)


MADE: dict[str, Callable[[], Scene]] = {"model": model, "lattice": lattice, "bare": bare, "cloud": oriented}
SETTINGS: dict[str, dict[str, Any]] = {
    "tangent": {}, "safe": {"search": "safe"}, "off_centre": {"method": "off_centre"},
    "surfel": {"method": "off_centre", "normal": "surfel"},
    "covariance": {"normal": "covariance", "neighbourhood": "knn"}, "cylinder": {"method": "cylinder", "h": 0.6},
    "polynomial": {"method": "polynomial", "search": "secant"}, "fill_level": {"method": "fill_level"},
    "isosurface": {"method": "isosurface", "subdivide": 1},
}
CASES = [(scene, name) for scene in MADE for name, given in SETTINGS.items()
         if not (given.get("method") in ("fill_level", "isosurface") and scene in ("bare", "cloud"))]


def counted(monkeypatch: pytest.MonkeyPatch, calls: list[str], module: Any, name: str, call: Any = None) -> None:
    """Have a module's function write its name down before it does what it does."""
    inner = call or getattr(module, name)

    def written(*args: Any, **more: Any) -> Any:
        calls.append(name)
        return inner(*args, **more)

    monkeypatch.setattr(module, name, written)


@pytest.mark.parametrize(("made", "name"), CASES)
def test_what_is_planned_is_what_a_scene_keeps(made: str, name: str) -> None:
    scene, settings = MADE[made](), Settings(**SETTINGS[name])
    planned = plan(scene, settings)
    assert not {"surfels", "cells", "balls", "mesh", "levels", "normals"} & set(scene._kept)
    hits = render(scene, settings, size=(12, 12))
    assert {stage: planned[stage].runs for stage in KEPT if stage != "placement" or scene.kind != "cloud"} == {
        stage: key in scene._kept for stage, key in KEPT.items() if stage != "placement" or scene.kind != "cloud"}
    tracer = prepare.prepared(scene, settings).tracer
    assert planned["centre fits"].runs == (isinstance(tracer, CloudTracer) and tracer.fits > 0)
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


@pytest.mark.parametrize("name", PARAMETERS["energy"].choices)
@pytest.mark.parametrize("emphasise", [False, True])
def test_an_energys_level_takes_a_normal_where_it_is_planned(name: str, emphasise: bool,
                                                             monkeypatch: pytest.MonkeyPatch) -> None:
    if emphasise and name == "angle":
        return  # refused
    scene, calls, asked = lattice(), list[str](), list[int]()
    settings = Settings(method="isosurface", energy=name, emphasise=emphasise, normal="covariance")
    values, near = check(scene, settings), near_of(PLANE)
    made = Energy(prepare.cells(scene, settings, values), plan_of(scene, settings, values), name, emphasise).asked
    python(monkeypatch, calls, tangent, normals)

    def evaluate(_: int, *args: Any) -> Any:
        asked.append(args[3])
        return tangent.tangent_covariance(*args)

    monkeypatch.setattr(field, "evaluate_at", evaluate)
    field.energy_at.py_func(near, (0.1, 0.0, 0.05), made, (0.0, 0.0, 1.0), work_for(near), np.zeros(FIT_SIZE))
    planned = plan(scene, settings)
    assert len(asked) == 1 and planned["covariance and eigenvector"].runs == ("covariance_sums" in calls)
    assert planned["Mahalanobis sum"].runs == (name == "mahalanobis")


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


# What is summed: the evaluators run as plain Python, with every function that they call counted.

PLANE = [(x, y, 0.01 * (x * x + y)) for x in np.linspace(-1, 1, 6) for y in np.linspace(-1, 1, 6)]
SUMS = {"weights and barycentre": "offset_sums", "sum of normals": "normal_sums",
        "covariance and eigenvector": "covariance_sums", "polynomial fit": "fit", "reference plane": "reference_plane"}


def python(monkeypatch: pytest.MonkeyPatch, calls: list[str], *modules: Any) -> None:
    """Have the kernels of some modules call each other as plain Python, counted; those beyond stay compiled."""
    for module in modules:
        for name, kernel in list(vars(module).items()):
            if hasattr(kernel, "py_func"):
                ours = any(kernel.py_func.__module__ == m.__name__ for m in modules)
                counted(monkeypatch, calls, module, name, kernel.py_func if ours else kernel)


@pytest.mark.parametrize("method", ["tangent", "polynomial", "projection", "off_centre"])
@pytest.mark.parametrize("normal", ["surfel", "covariance", "covariance_at_x"])
@pytest.mark.parametrize("made", ["lattice", "bare", "cloud"])
def test_what_an_evaluation_sums(made: str, normal: str, method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene, settings, calls = MADE[made](), Settings(method=method, normal=normal, patch=0.5), list[str]()
    values = check(scene, settings)
    kernel = evaluator(values).py_func
    python(monkeypatch, calls, tangent, fitted, project, normals)
    near = near_of(PLANE)
    rule = rule_of(scene, settings, values)
    v = kernel(near, (0.1, 0.0, 0.05), rule, r.VALUE_ONLY, work_for(near), np.zeros(FIT_SIZE))
    assert v.state == r.CONTINUE and v.f == v.f
    planned = plan(scene, settings)
    assert {stage: planned[stage].runs for stage in SUMS} == {stage: call in calls for stage, call in SUMS.items()}


SEARCHES = (stepping, probe, safe, march, minimise, centres)


@pytest.mark.parametrize("search", [s for s in PARAMETERS["search"].choices if s != "auto"])
def test_only_searches_that_are_said_to_ask_for_the_gradient(search: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene, settings, asked = lattice(), Settings(search=search), list[int]()
    ready, kernel = prepare.prepared(scene, settings).tracer, searcher(check(scene, settings)).py_func
    cells = prepare.surfels(scene, settings).cells

    def evaluate(_: int, *args: Any) -> Any:
        asked.append(args[3])
        return tangent.tangent_surfel(*args)

    python(monkeypatch, [], *SEARCHES)
    for module in SEARCHES:
        for name, call in (("evaluate_at", evaluate), ("surfels_near", near_at),
                           ("accept_at", lambda *args: args[5])):  # where the search says that it met the surface
            if hasattr(module, name):
                monkeypatch.setattr(module, name, call)
    top = cells[np.argmax(cells[:, 2])]
    start = Start((int(top[0]), int(top[1]), int(top[2])), (0.0, 0.0, 0.5), 5.0, 0.0, 0.0, 2.0, float("nan"), 1)
    end = served(ready.sites, lambda own, pool: kernel(
        own, ready.plan.rule, ready.plan.how, ready.plan.bounds, (0.0, 0.0, -1.0), start, np.empty((0, r.LOG_WIDTH)), 0,
        pool.work, pool.fit))
    assert end.state == r.CONVERGED
    assert plan(scene, settings)["gradient of f"].runs == (r.WITH_GRADIENT in asked)


@pytest.mark.parametrize("proof", [False, True])
def test_a_miss_is_proven_where_that_is_planned(proof: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[str] = []
    scene, settings = lattice(), Settings(search="safe", proof=proof)
    ready, kernel = prepare.prepared(scene, settings).tracer, searcher(check(scene, settings)).py_func
    cells = prepare.surfels(scene, settings).cells
    python(monkeypatch, [], safe, probe)
    monkeypatch.setattr(probe, "evaluate_at", lambda _, *args: tangent.tangent_surfel(*args))
    for module in (safe, probe):
        if hasattr(module, "surfels_near"):
            monkeypatch.setattr(module, "surfels_near", near_at)
    counted(monkeypatch, calls, safe, "proven", lambda *args: args[-1])
    top = cells[np.argmax(cells[:, 2])]
    start = Start((int(top[0]), int(top[1]), int(top[2])), (0.0, 0.0, 2.0), 5.0, 0.0, 0.0, 1.0, float("nan"), 1)
    end = served(ready.sites, lambda own, pool: kernel(
        own, ready.plan.rule, ready.plan.how, ready.plan.bounds, (0.0, 0.0, 1.0), start, np.empty((0, r.LOG_WIDTH)), 0,
        pool.work, pool.fit))
    assert end.state == r.BACKGROUND
    assert plan(scene, settings)["proof of misses"].runs == ("proven" in calls)


@pytest.mark.parametrize(("made", "name"), [("lattice", "tangent"), ("cloud", "polynomial"), ("lattice", "cylinder"),
                                             ("lattice", "fill_level")])
def test_the_shown_normal_takes_the_gradient_where_it_is_planned(made: str, name: str) -> None:
    scene, average = MADE[made](), Settings(**SETTINGS[name])
    gradient = average.replace(shading_normal="gradient")
    taken = [render(scene, one, size=(12, 12)).evaluations.sum() for one in (average, gradient)]
    assert plan(scene, gradient)["gradient of f"].runs == (taken[1] > taken[0])


# The values

@pytest.mark.parametrize(("made", "name"), CASES)
def test_the_values_are_those_that_rays_are_traced_with(made: str, name: str) -> None:
    scene, settings = MADE[made](), Settings(**SETTINGS[name])
    used = prepare.prepared(scene, settings).values
    for value in plan(scene, settings).values:
        expected = arrival(used) if value.name == "tolerance" else getattr(used, RESOLVED[value.name])
        assert value.value == expected and value.origin


def test_where_a_value_comes_from() -> None:
    origins = {v.name: v.origin for v in plan(oriented(), Settings(h="0.1d", search="safe")).values}
    assert (origins["h"], origins["search"]) == ("0.1 of the diagonal, as set", "as set")
    assert origins["neighbourhood"] == "a cloud has no cells" and origins["radius"] == "4 h"
    fine = {v.name: v.origin for v in plan(lattice(), Settings(tolerance=1e-9)).values}
    assert fine["radius"] == "where f jumps by no more than the tolerance, and half a cell's diagonal"
    hat = {v.name: v.origin for v in plan(lattice(), Settings(weight="hat")).values}
    assert hat["radius"] == "1 h, where the weight ends, and half a cell's diagonal"


# The record

def test_every_stage_is_named_in_every_scene() -> None:
    names = [tuple(s.name for s in plan(made(), Settings(method=method)).stages)
             for made in MADE.values() for method in ("tangent", "cylinder")]
    assert len(set(names)) == 1 and len(set(names[0])) == len(names[0])


def test_a_plan_is_of_two_parts_each_with_its_reason() -> None:
    made = plan(lattice())
    assert made.settings == preset("best") and isinstance(made, Plan)
    assert set(made.runs) | set(made.left_out) == set(made.stages)
    assert all(s.reason for s in made.stages)
    assert made.deciding(made["filter"]) == {"filter": "none"}
    assert made["polynomial fit"].settings == ("method", "degree", "patch")
    assert plan(lattice(), Settings())["polynomial fit"].settings == ("method",)
    with pytest.raises(KeyError, match="nonsense"):
        made["nonsense"]


def test_settings_that_make_no_sense_are_refused() -> None:
    with pytest.raises(SettingsError, match="needs a lattice"):
        plan(oriented(), Settings(method="fill_level"))


def test_a_plan_makes_nothing() -> None:
    scene = Scene("much", points=frozen(np.random.default_rng(1).uniform(size=(200, 3))))
    plan(scene, Settings(h=0.1, method="mahalanobis"))
    assert set(scene._kept) <= {"bounds"}
