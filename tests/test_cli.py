"""The command line as a person or a script uses it: options, files, exit statuses, messages."""

import csv
import io
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import jaart
from jaart import cli_arguments
from jaart.__main__ import main
from jaart.core import prepare
from jaart.core.records import STATUS_NAMES
from jaart.core.resources import resource
from jaart.core.settings import PARAMETERS, PRESETS

SMALL = ["--size", "40x30"]


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def fails(capsys, status, *arguments):
    """The one line on stderr of a command that ends with that status, and leaves no file."""
    before = set(Path().iterdir())
    assert main(list(arguments)) == status
    out, err = capsys.readouterr()
    assert out == ""
    assert set(Path().iterdir()) == before
    lines = [line for line in err.splitlines() if not line.startswith("jaart: note: ")]
    assert len(lines) == 1 and lines[0].startswith("jaart: ")
    return lines[0]


# What is typed

@pytest.mark.parametrize(("typed", "parsed"), [
    (["--set", "a=1", "b=2", "--json"], ["--set", "a=1", "--set", "b=2", "--json"]),
    (["--set", "a=1", "--set", "b=2"], ["--set", "a=1", "--set", "b=2"]),
    (["--camera=eye=1,2,3", "up=0,0,1", "x.npz"], ["--camera=eye=1,2,3", "--camera", "up=0,0,1", "x.npz"]),
    (["--camera", "eye=-1,2,3", "fov=20", "--set", "h=1", "radius=2s"],
     ["--camera", "eye=-1,2,3", "--camera", "fov=20", "--set", "h=1", "--set", "radius=2s"]),
    (["--set", "a=1", "x.npz", "b=2"], ["--set", "a=1", "x.npz", "b=2"]),
    (["--output", "a=1", "b=2"], ["--output", "a=1", "b=2"]),
    (["--set", "a=1", "--", "b=2"], ["--set", "a=1", "--", "b=2"]),
    (["--set"], ["--set"]),
])
def test_several_assignments_may_follow_one_flag(typed, parsed):
    assert cli_arguments.spread(typed) == parsed


@pytest.mark.parametrize(("typed", "parsed"), [
    ([], ["gui"]), (["splash"], ["gui", "splash"]), (["a.npz", "--frame", "3"], ["gui", "a.npz", "--frame", "3"]),
    (["render", "x"], ["render", "x"]), (["--version"], ["--version"]),
])
def test_without_a_verb_the_window_is_meant(typed, parsed):
    assert cli_arguments.complete(typed, {"render", "gui", "info"}) == parsed


def test_a_misspelt_verb_is_no_scene(capsys):
    assert "did you mean render?" in fails(capsys, 2, "rendr", "standard")


@pytest.mark.parametrize("arguments", [
    ["render"], ["render", "standard", "--size", "5"], ["render", "standard", "--size", "5x"],
    ["render", "standard", "--threads", "0"], ["render", "standard", "--nonsense"],
    ["render", "standard", "--output", "a.jpg"], ["render", "standard", "--hits", "a.npy"],
    ["render", "standard", "--rays", "a.npz"], ["render", "standard", "--camera"],
    ["render", "standard", "--rays", "a.npz", "--hits", "b.npz", "--camera", "fov=3"],
    ["trace", "standard", "--pixel", "1,1"], ["trace", "standard", "--output", "a.json"],
    ["trace", "standard", "--output", "a.json", "--pixel", "1"],
    ["trace", "standard", "--output", "a.json", "--pixel", "1,1", "--origin", "1,1,1"],
    ["trace", "standard", "--output", "a.json", "--origin", "1,1,1"],
    ["trace", "standard", "--output", "a.json", "--origin", "1,1", "--direction", "1,1,1"],
    ["trace", "standard", "--output", "a.txt", "--pixel", "1,1"],
    ["trace", "standard", "--output", "a.csv", "--origin", "1,1,1", "--direction", "1,1,1", "--camera", "fov=3"],
    ["statistics", "standard"], ["statistics", "standard", "--output", "a.png"],
    ["gui", "standard", "--pick", "1;2"], ["gui", "standard", "--screenshot", "a.txt"],
])
def test_wrong_usage_ends_with_2(capsys, arguments):
    fails(capsys, 2, *arguments)


@pytest.mark.parametrize(("arguments", "said"), [
    (["render", "nowhere.npz"], "nowhere.npz: no such file"),
    (["render", "standard", "--size", "0x5"], "size 0x5: expected a width and a height from 1 to 16384"),
    (["render", "standard", "--size", "5x20000"], "size 5x20000"),
    (["render", "standard", "--set", "raduis=3"], "did you mean radius?"),
    (["render", "standard", "--set", "radius=-3"], "radius = '-3': expected"),
    (["render", "standard", "--set", "shading=diffuse", "ambient=0.2"], "ambient has no meaning beside"),
    (["render", "standard", "--set", "proof=true"], "proof has no meaning beside the other settings; it needs search = "
                                                    "safe"),
    (["render", "standard", "--set", "search=safe", "proof=true"], "proof = true: bounds are known for the tangent"),
    (["render", "standard", "--set", "search=safe", "proof=true"], "; expected method = tangent, not polynomial"),
    (["render", "standard", "--camera", "eye=1e300,0,0"], "camera eye = 1e+300,0,0: rays from so far have no prec"),
    (["render", "standard", "--camera", "eye=1e15,0,0"], "expected less than 1e+15 from the scene"),
    (["trace", "bumpy", "--pixel", "1,1", "--camera", "eye=0,-1e20,0", "--output", "a.csv"], "have no precision"),
    (["render", "standard", "--camera", "ortho=1e20"], "camera ortho = 1e+20: rays from so far"),
    (["render", "standard", "--camera", "up=0,0,0"], "camera: up has zero length"),
    (["render", "splash", "--set", "raster=20"], "raster has no meaning in a lattice; it is for a model"),
    (["render", "standard", "--preset", "worst"], "no preset is called 'worst'"),
    (["render", "standard", "--map", "mood"], "no map is called 'mood'"),
    (["render", "splash", "--map", "normal_error"], "needs an exact surface"),
    (["render", "bumpy", "--set", "placement=exact"], "placement has no meaning in a cloud; it is for a lattice"),
    (["render", "bumpy", "--preset", "thesis", "--set", "neighbourhood=cell_ball"], "neighbourhood = cell_ball: a cl"),
    (["render", "splash", "--set", "ball_k=3"], "ball_k has no meaning in a lattice; it is for a cloud"),
    (["render", "splash", "--set", "method=off_centre", "search=newton"], "search = newton: a least energy"),
    (["statistics", "splash", "--set", "raster=9", "--output", "a.csv"], "raster has no meaning in a lattice"),
    (["trace", "splash", "--pixel", "1,1", "--set", "orient=none", "--output", "a.csv"], "orient has no meaning in a"),
    (["settings", "raduis"], "did you mean radius?"),
    (["render", "standard", "--camera", "eye=1,2"], "camera eye"),
    (["render", "standard", "--output", "none/a.png"], "there is no folder 'none'"),
    (["render", "standard", "--rays", "none.npz", "--hits", "a.npz"], "none.npz: cannot be read"),
    (["render", "splash", "--frame", "99"], "frame 99"),
    (["trace", "standard", "--pixel", "512,0", "--output", "a.csv"], "pixel 512,0: expected"),
    (["trace", "standard", "--pixel", "0,-1", "--output", "a.csv"], "pixel 0,-1: expected"),
    (["trace", "standard", "--origin", "0,0,0", "--direction", "0,0,0", "--output", "a.csv"], "zero length"),
    (["trace", "standard", "--origin", "0,nan,0", "--direction", "0,0,1", "--output", "a.csv"], "finite"),
    (["info", "nowhere"], "nowhere: no such file"),
])
def test_what_cannot_be_done_ends_with_1_and_says_why(capsys, arguments, said):
    assert said in fails(capsys, 1, *arguments)


def test_a_folder_is_no_output(capsys, tmp_path):
    (tmp_path / "a.png").mkdir()
    assert "is a folder" in fails(capsys, 1, "render", "standard", "--output", "a.png")


def test_without_a_display_the_window_says_so(capsys, monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        monkeypatch.delenv(name, raising=False)
    assert "no display" in fails(capsys, 1)


def test_version_and_help(capsys):
    assert main(["--version"]) == 0
    assert f"jaart {jaart.__version__}" in capsys.readouterr().out
    for arguments in (["-h"], ["--help"], ["render", "-h"], ["trace", "--help"], ["info", "-h"], ["gui", "-h"],
                      ["statistics", "-h"], ["settings", "-h"]):
        assert main(arguments) == 0
        said = capsys.readouterr().out
        assert "Usage: jaart" in said
        assert ("Exit status: 0 done, 1 failed or refused, 2 typed wrongly, 130 interrupted.\n" in said) == (
            arguments in (["-h"], ["--help"]))


def test_it_runs_as_a_module():
    done = subprocess.run([sys.executable, "-m", "jaart", "--version"], capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(Path(jaart.__file__).parents[1])}, check=True)
    for word in ("jaart", "python", "numpy", "numba", "expat"):
        assert word in done.stdout


# What is written

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


def test_render_writes_a_picture_named_after_the_scene(capsys):
    assert main(["render", "standard", *SMALL]) == 0
    out, err = capsys.readouterr()
    picture = np.asarray(Image.open("standard.png"))
    assert picture.shape == (30, 40, 3)
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 10
    assert "wrote standard.png" in out and "rays hit" in out
    assert "%|" not in err, "a progress bar in a pipe"


def test_every_map_has_its_own_picture():
    pictures = set()
    for name in ("shaded", "iterations", "evaluations", "off_centre", "depth", "status", "distance_error",
                 "normal_error"):
        assert main(["render", "standard", *SMALL, "--map", name, "--output", f"{name}.png"]) == 0
        pictures.add(np.asarray(Image.open(f"{name}.png")).tobytes())
    assert len(pictures) == 8


@pytest.mark.parametrize(("before", "more"), [
    ([], ["samples=2"]), ([], ["shading=water"]), (["light=35,23,29"], ["light=35,23,29", "shadows=true"])])
def test_more_rays_change_the_picture_and_not_the_hits(before, more):
    for name, values in (("a", before), ("b", more)):
        set_ = ["--set", *values] if values else []
        assert main(["render", "standard", *SMALL, *set_, "--output", f"{name}.png", "--hits", f"{name}.npz"]) == 0
    a, b = (np.asarray(Image.open(name)).astype(int) for name in ("a.png", "b.png"))
    assert (np.abs(a - b).max(axis=2) > 8).sum() > 10
    np.testing.assert_array_equal(np.load("a.npz")["t"], np.load("b.npz")["t"])


def test_hits_hold_every_array_and_no_picture_is_written_beside_them():
    assert main(["render", "standard", *SMALL, "--hits", "h.npz"]) == 0
    assert [p.name for p in Path().iterdir()] == ["h.npz"]
    hits = np.load("h.npz")
    assert set(hits) == {"origin", "direction", "hit", "t", "point", "normal", "status", "status_names", "off_centre",
                         "starts", "eigenvectors", "gradients", "gathered", "fits",
                         "energy", "iterations", "evaluations", "neighbours", "cells", "lowered", "gap",
                         "shading_normal", "prep_s", "ray_s"}
    assert hits["hit"].dtype == bool and hits["status"].dtype == np.uint8
    assert tuple(hits["status_names"]) == STATUS_NAMES
    assert hits["point"].shape == (1200, 3) and hits["prep_s"].shape == hits["ray_s"].shape == ()
    along = hits["origin"] + hits["t"][:, None] * hits["direction"]
    np.testing.assert_allclose(hits["point"][hits["hit"]], along[hits["hit"]], atol=1e-9)
    assert np.isnan(hits["t"][~hits["hit"]]).all() and 0 < hits["hit"].sum() < 1200


def test_the_rays_of_a_picture_as_a_list_give_the_same_hits():
    assert main(["render", "standard", *SMALL, "--hits", "picture.npz", "--threads", "1"]) == 0
    picture = np.load("picture.npz")
    np.savez("rays.npz", origins=picture["origin"], directions=picture["direction"])
    assert main(["render", "standard", "--rays", "rays.npz", "--hits", "list.npz"]) == 0
    listed = np.load("list.npz")
    for name in set(picture) - {"prep_s", "ray_s"}:
        np.testing.assert_array_equal(listed[name], picture[name], err_msg=name)


@pytest.mark.parametrize(("arrays", "said"), [
    ({"origins": np.zeros((2, 3))}, "'directions': is missing"),
    ({"origins": np.zeros((2, 2)), "directions": np.zeros((2, 3))}, "has shape (2, 2)"),
    ({"origins": np.zeros((2, 3)), "directions": np.ones((3, 3))}, "(2, 3) and (3, 3)"),
    ({"origins": np.array([["a"] * 3]), "directions": np.ones((1, 3))}, "expected plain numbers"),
])
def test_bad_rays_are_refused_by_array(capsys, arrays, said):
    np.savez("rays.npz", **arrays)
    assert said in fails(capsys, 1, "render", "standard", "--rays", "rays.npz", "--hits", "h.npz")


def test_rays_that_are_none_are_counted_and_the_first_is_named(capsys):
    directions = np.tile([0.0, 0, 1], (6, 1))
    directions[1:] = 0
    np.savez("rays.npz", origins=np.tile([8.0, 8, -3], (6, 1)), directions=directions)
    assert main(["render", "standard", "--rays", "rays.npz", "--hits", "h.npz"]) == 0
    assert "jaart: note: 5 of 6 rays are no rays (bad_ray), the first is number 1, counted from 0" in (
        capsys.readouterr().err)
    assert (np.load("h.npz")["status"] == STATUS_NAMES.index("bad_ray")).tolist() == [False] + 5 * [True]


def test_truncated_rays_are_refused(capsys):
    np.savez("rays.npz", origins=np.zeros((50, 3)), directions=np.ones((50, 3)))
    Path("rays.npz").write_bytes(Path("rays.npz").read_bytes()[:700])
    assert "is no whole .npz file" in fails(capsys, 1, "render", "standard", "--rays", "rays.npz", "--hits", "h.npz")


def test_camera_and_settings_reach_the_rays():
    camera = ["--camera", "eye=8,-30,8", "target=8,8,8", "--camera", "ortho=20"]
    assert main(["render", "standard", *SMALL, *camera, "--set", "h=0.9", "--hits", "a.npz"]) == 0
    assert main(["render", "standard", *SMALL, *camera, "--hits", "b.npz"]) == 0
    a, b = np.load("a.npz"), np.load("b.npz")
    np.testing.assert_array_equal(a["direction"], np.broadcast_to((0.0, 1.0, 0.0), (1200, 3)))
    np.testing.assert_array_equal(a["origin"], b["origin"])
    both = a["hit"] & b["hit"]
    assert (a["t"][both] != b["t"][both]).any()


def test_a_trace_is_the_picture_s_ray_and_its_json_is_complete(capsys):
    assert main(["render", "standard", *SMALL, "--hits", "h.npz"]) == 0
    hits = np.load("h.npz")
    ray = int(np.flatnonzero(hits["hit"])[0])
    assert main(["trace", "standard", *SMALL, "--pixel", f"{ray % 40},{ray // 40}", "--output", "t.json"]) == 0
    assert f"pixel {ray % 40},{ray // 40}: converged at t" in capsys.readouterr().out
    record = json.loads(Path("t.json").read_text(), parse_constant=pytest.fail)
    assert record["ray"]["t"] == hits["t"][ray]
    assert record["ray"]["point"] == hits["point"][ray].tolist()
    assert len(record["steps"]) == hits["evaluations"][ray]
    assert len(record["cells"]["borders"]) == len(record["cells"]["cells"]) + 1
    used = set(record["surfels"]["index"])
    for step in record["steps"]:
        assert len(step["neighbours"]) == len(step["weights"]) and set(step["neighbours"]) <= used
        assert sum(step["weights"]) == pytest.approx(1)
        assert all(len(step[name]) == 3 for name in ("cell", "query", "barycentre", "normal", "next"))
    assert len({len(v) for v in record["curves"].values()}) == 1
    assert record["settings"]["h"] == "auto" and record["balls"] == []
    assert set(record["curves"]) == {"t", "tangent", "off_centre", "mahalanobis", "angle"}


def test_a_ray_that_misses_has_null_for_its_hit():
    assert main(["trace", "standard", "--origin", "-5,-5,-5", "--direction", "-1,0,0", "--output", "t.json"]) == 0
    record = json.loads(Path("t.json").read_text(), parse_constant=pytest.fail)
    assert record["ray"]["status"] == "background"
    assert record["ray"]["t"] is None and record["ray"]["point"] == [None] * 3 and record["steps"] == []


def test_a_trace_as_table_and_as_plots():
    ray = ["--origin", "-3,8.1,6.2", "--direction", "2,0,0"]
    assert main(["trace", "standard", *ray, "--output", "t.json"]) == 0
    assert main(["trace", "standard", *ray, "--output", "t.csv"]) == 0
    rows = list(csv.DictReader(io.StringIO(Path("t.csv").read_text())))
    steps = json.loads(Path("t.json").read_text())["steps"]
    assert len(rows) == len(steps) > 0
    for row, step in zip(rows, steps, strict=True):
        assert [float(row[f"query_{a}"]) for a in "xyz"] == step["query"]
        assert (float(row["energy"]), row["outcome"]) == (step["energy"], step["outcome"])
        assert [int(row[f"cell_{a}"]) for a in "ijk"] == step["cell"]
        off = np.subtract(step["barycentre"], step["query"])
        assert float(row["angle"]) == step["angle"] == pytest.approx(abs(off @ step["normal"]) / np.linalg.norm(off))
    for name in ("a.svg", "b.svg"):
        assert main(["trace", "standard", *ray, "--output", name]) == 0
    assert Path("a.svg").read_bytes() == Path("b.svg").read_bytes()
    assert "<svg" in Path("a.svg").read_text()


def test_preview_names_a_picture_and_plots(capsys):
    assert main(["preview", "standard", "--output", "out"]) == 0
    named = {line.removeprefix("wrote ") for line in capsys.readouterr().out.splitlines()}
    assert named == {str(p) for p in Path("out").iterdir()}
    assert {Path(name).suffix for name in named} == {".png", ".svg"}


def test_statistics_as_table_and_as_plots(capsys):
    assert main(["render", "standard", *SMALL, "--hits", "h.npz"]) == 0
    hits = np.load("h.npz")
    for name in ("s.csv", "s.svg"):
        assert main(["statistics", "standard", *SMALL, "--output", name]) == 0
    assert "against the exact surface" in capsys.readouterr().out
    rows = list(csv.DictReader(io.StringIO(Path("s.csv").read_text())))
    numbers = {(row["statistic"], row["bin"]): float(row["value"]) for row in rows}
    assert numbers["rays", ""] == 1200 and numbers["hits", ""] == hits["hit"].sum()
    assert numbers["end state", "converged"] == (hits["status"] == STATUS_NAMES.index("converged")).sum()
    assert sum(int(b) * v for (name, b), v in numbers.items() if name == "cells") == hits["cells"].sum()
    assert 0 < numbers["delta", ""] < 1
    assert "<svg" in Path("s.svg").read_text()


# Settings

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


# Interruption

def test_ctrl_c_leaves_no_half_file(tmp_path):
    splash = str(resource("splash.npz"))
    command = [sys.executable, "-m", "jaart", "render", splash, "--size", "5000x5000", "--hits", "h.npz",
               "--output", "p.png", "--threads", "2"]
    process = subprocess.Popen(command, env={**os.environ, "PYTHONPATH": str(Path(jaart.__file__).parents[1])},
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stderr.readline().startswith("jaart: note: ")  # it has read the scene and is about to trace
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=120)
    assert (process.returncode, out) == (130, ""), err
    assert err.splitlines()[-1] == "jaart: interrupted"
    assert list(tmp_path.iterdir()) == []
