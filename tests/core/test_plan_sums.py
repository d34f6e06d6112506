"""What a plan says is summed, against kernels that run as plain Python with every function that they call counted."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from jaart.core import prepare
from jaart.core.assemble import evaluator, plan_of, rule_of, searcher
from jaart.core.field import Energy
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
from jaart.core.plan import plan
from jaart.core.settings import PARAMETERS, Settings
from tests.core.kernel_calls import near_at, near_of, work_for
from tests.core.plan_scenes import MADE, counted, lattice


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
    ready, kernel = prepare.prepared(scene, settings).tracer, searcher(scene, settings, check(scene, settings)).py_func
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
    ready, kernel = prepare.prepared(scene, settings).tracer, searcher(scene, settings, check(scene, settings)).py_func
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
