"""A plan as a record: its values and where they come from, its stages and their reasons."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core import prepare
from jaart.core.chosen import arrival
from jaart.core.errors import SettingsError
from jaart.core.plan import RESOLVED, Plan, plan
from jaart.core.scene import Scene, frozen
from jaart.core.settings import Settings, preset
from tests.core.plan_scenes import CASES, MADE, SETTINGS, lattice, oriented


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
