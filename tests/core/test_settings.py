"""The settings: validation, text, what depends on what."""

from __future__ import annotations

import dataclasses

import pytest

from jaart.core.errors import SettingsError
from jaart.core.parameter import STAGES, Length
from jaart.core.settings import PARAMETERS, PRESETS, Settings, parse, preset


def test_every_parameter_is_fully_declared() -> None:
    for name, p in PARAMETERS.items():
        assert p.name == name and p.label and p.group and p.help.endswith("."), name
        assert p.stage in STAGES, name
        assert bool(p.needs) == (p.when is not None), name
        assert p.check(p.default) == p.default, name
        assert not p.choices or p.kind in ("choice", "length", "number", "integer", "vector", "vectors"), name


def test_thesis_preset_has_the_values_of_the_thesis() -> None:
    s = preset("thesis")
    assert (s.method, s.search, s.weight, s.normal, s.neighbourhood, s.placement, s.gradient, s.traversal) == (
        "tangent", "iterate", "gaussian", "surfel", "cell_ball", "box", "central", "exact")
    assert (s.h, s.radius, s.max_off_centre) == (Length(0.8), Length(2.0), Length(0.3))
    assert s.tolerance * s.h.value == pytest.approx(0.1)
    assert s.max_iterations == 20
    with pytest.raises(SettingsError, match="there are best, thesis"):
        preset("fast")


@pytest.mark.parametrize("name", PRESETS)
def test_presets_are_valid(name: str) -> None:
    assert preset(name) == Settings(**PRESETS[name])


def test_parse_reads_texts_on_top_of_a_base() -> None:
    base = Settings(h=Length(1.5))
    s = parse(["radius = 3", "light=1,2,3", "raster=32", "trust=radius", "bail=growth"], base)
    assert s == base.replace(radius=3, light=(1.0, 2.0, 3.0), raster=32, bail="growth")
    assert (s.h, s.radius) == (Length(1.5), Length(3.0))
    assert parse([]) == Settings()


@pytest.mark.parametrize(("text", "says"), [
    ("h", "expected name=value"), ("h=", "h = ''"), ("h=0", "> 0"), ("h=nan", "finite"),
    ("radus=2", "did you mean radius"),
    ("zzz=2", "no setting is called 'zzz'"), ("weight=cubic", "expected gaussian"), ("raster=1", ">= 2"),
    ("max_iterations=0", ">= 1"), ("max_iterations=1_0", "whole number"), ("tolerance=1_0", "finite number"),
    ("light=1_0,0,0", "x,y,z"), ("tolerance=-1", ">= 0"),
    ("light=1,2", "x,y,z or several of them apart by ; or headlight"),
])
def test_parse_names_what_is_wrong(text: str, says: str) -> None:
    with pytest.raises(SettingsError) as error:
        parse([text])
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_settings_are_frozen_equal_and_hashable() -> None:
    typed, given = Settings(h="0.8"), Settings(h=Length(0.8))
    assert typed == given != Settings() and hash(typed) == hash(given)
    with pytest.raises(dataclasses.FrozenInstanceError):
        Settings().h = Length(1.0)  # type: ignore[misc]
    with pytest.raises(SettingsError):
        Settings(h=-1)  # type: ignore[arg-type]
    with pytest.raises(SettingsError, match="no setting is called"):
        Settings().replace(colour="red")


@pytest.mark.parametrize("name", PARAMETERS)
def test_a_change_enters_its_stage_and_those_after_it(name: str) -> None:
    about = PARAMETERS[name]
    other = {"choice": about.choices[-1:], "length": ("1.125",), "number": ("2",) if about.low == 1 else ("0.5",),
             "integer": ("3",), "vector": ("4,5,6",), "vectors": ("4,5,6",), "flag": ("true",)}[about.kind][0]
    changed = Settings().replace(**{name: other})
    if changed == Settings():
        assert len(about.choices) == 1
        return
    for stage in STAGES:
        differs = changed.key(stage) != Settings().key(stage)
        assert differs == (STAGES.index(stage) >= STAGES.index(about.stage))


def test_shading_numbers_matter_to_phong_only() -> None:
    for name in ("ambient", "diffuse", "specular", "shininess"):
        assert PARAMETERS[name].matters(Settings())
        assert not PARAMETERS[name].matters(Settings(shading="diffuse"))
    assert PARAMETERS["h"].matters(Settings(shading="diffuse"))
