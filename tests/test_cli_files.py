"""What the command line writes: pictures, hits, rays, statistics."""

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from jaart.__main__ import main
from jaart.core.records import STATUS_NAMES
from tests.cli_calls import SMALL, fails


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


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
