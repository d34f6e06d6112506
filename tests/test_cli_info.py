"""What the command line says of scenes and settings."""

import json
from pathlib import Path

import numpy as np
import pytest

import jaart
from jaart.__main__ import main
from jaart.core import prepare
from jaart.core.settings import PARAMETERS, PRESETS
from tests.cli_calls import SMALL


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_info_says_what_a_scene_holds(capsys):
    assert main(["info", "standard", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["kind"] == "model"
    assert record["size"] == [16, 16, 16]
    surfels = prepare.surfels(jaart.load("standard"), jaart.preset("best"))
    assert (record["surfels"], record["without_normal"]) == (len(surfels), surfels.without_normal)
    assert record["interface_cells"] == record["surfels"] + record["without_normal"] > 400
    assert {s["shape"] for s in record["solids"]} == {"Sphere", "Box"}
    assert main(["info", "splash"]) == 0
    table = capsys.readouterr().out
    for word in ("lattice", "64×64×64", "surfels", "spacing", "frame"):
        assert word in table


def test_info_says_what_rays_would(capsys):
    np.savez("full.npz", levels=np.ones((4, 5, 6)))
    assert main(["info", "full.npz"]) == 0
    table = capsys.readouterr().out
    assert main(["render", "full.npz", "--size", "4x4", "--hits", "h.npz"]) == 0
    notes = [line for line in capsys.readouterr().err.splitlines() if line.startswith("jaart: note: 0 surfels")]
    assert len(notes) == 1
    assert f"  note             {notes[0].removeprefix('jaart: note: ')}" in table.splitlines()


def test_info_names_each_kind_of_solid_in_full(capsys):
    place = '<location x="0.5" y="0.5" z="0.5"/>'
    Path("m.xml").write_text(f"""<SceneGraph raster="12"><Torus major="0.25" minor="0.1" axis="z">{place}</Torus>
        <Ellipsoid width="0.2" height="0.4" depth="0.2">{place}</Ellipsoid>
        <Cylinder radius="0.1" height="0.8" axis="x">{place}</Cylinder></SceneGraph>""")
    assert main(["info", "m.xml"]) == 0
    solids = [line.split() for line in capsys.readouterr().out.splitlines() if "exact solid" in line]
    texts = [" ".join(words[2:]) for words in solids]
    assert texts == ["shape Torus centre (0.5, 0.5, 0.5) axis (0, 0, 1) major 0.25 minor 0.1",
                     "shape Ellipsoid centre (0.5, 0.5, 0.5) semi_axes (0.1, 0.2, 0.1)",
                     "shape Cylinder centre (0.5, 0.5, 0.5) axis (1, 0, 0) radius 0.1 height 0.8"]


def test_settings_lists_every_name_with_its_help_and_every_preset(capsys):
    assert main(["settings"]) == 0
    listed = capsys.readouterr().out
    words = " ".join(listed.split())
    for name, about in PARAMETERS.items():
        assert f"\n  {name:<15} default " in listed
        assert all(part in words for part in (about.help, about.source, about.group))
    assert max(len(line) for line in listed.splitlines()) <= 100
    for name, values in PRESETS.items():
        assert f"  {name}" in listed and all(f"{k}=" in words for k in values)


@pytest.mark.parametrize(("name", "said", "not_said"), [
    ("radius", "auto, or a finite number > 0 and <= 1e+06, alone or followed by d (diagonals) or s (spacings), in "
               "cells or cloud units", "placement"), ("Cloud", "orient", "radius"),
    ("raster", "for a model only", "h  "), ("thesis", "max_iterations=20 filling=corners", "default")])
def test_settings_says_what_one_name_stands_for(capsys, name, said, not_said):
    assert main(["settings", name]) == 0
    text = capsys.readouterr().out
    assert said in " ".join(text.split()) and not_said not in text


def test_a_preset_s_values_without_meaning_are_left_out_with_a_note(capsys):
    angle = ["--preset", "thesis", "--set", "method=angle"]
    assert main(["render", "splash", *SMALL, *angle, "--hits", "a.npz"]) == 0
    assert ("jaart: note: left out of the preset, without a meaning here: search = iterate, filling = corners"
            in capsys.readouterr().err.splitlines())
    assert main(["render", "standard", *SMALL, "--preset", "adamson-alexa", "--hits", "b.npz"]) == 0
    assert "in shares of a cloud: h = 0.004d" in capsys.readouterr().err
    assert np.load("b.npz")["hit"].any()
