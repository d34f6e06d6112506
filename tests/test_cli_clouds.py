"""What the commands do with clouds."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest

from jaart.__main__ import main
from jaart.core import cloud
from jaart.core.camera import Camera
from jaart.core.samples import COUNT, bumpy_sphere, fibonacci

SMALL = ["--size", "40x30"]


@pytest.fixture
def ball(tmp_path, monkeypatch):
    """3000 points of a sphere of radius 2 about (10, 20, 30), in a file in an empty folder."""
    monkeypatch.chdir(tmp_path)
    np.savez("ball.npz", points=2 * fibonacci(3000) + (10, 20, 30))
    return "ball.npz"


def test_info_of_the_built_in_cloud(capsys):
    assert main(["info", "bumpy", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    scene = bumpy_sphere()
    low, high = cloud.bounds(scene)
    assert (record["source"], record["kind"], record["points"], record["normals"]) == ("bumpy", "cloud", COUNT, False)
    assert (record["low"], record["high"]) == (low.tolist(), high.tolist())
    assert record["diagonal"] == cloud.diagonal(scene)
    assert record["spacing"] == cloud.spacing(scene)
    assert record["auto_h"] == pytest.approx(1.2 * record["spacing"], rel=0.1)
    assert (record["duplicates"], record["notes"]) == (0, [])


def test_info_says_in_words_what_was_repaired(tmp_path, capsys):
    normals = np.tile([0.0, 0, 2], (4, 1))
    np.savez(tmp_path / "x.npz", points=[[0.0, 0, 0], [3, 4, 0], [0, 0, 0], [6, 8, 0]], normals=normals, scan=[1])
    assert main(["info", str(tmp_path / "x.npz")]) == 0
    rows = [line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines()[1:]]
    assert ["points", "3"] in rows and ["normals", "one for each point"] in rows
    assert ["size", "6 × 8 × 0, diagonal 10"] in rows
    assert ["from", "(0, 0, 0)"] in rows and ["to", "(6, 8, 0)"] in rows
    assert ["spacing", "5, mean distance to the nearest point"] in rows
    for note in ("array scan left out", "4 normals were scaled to length 1", "1 exact duplicate of points merged"):
        assert ["note", note] in rows


def test_info_says_what_rays_would(tmp_path, capsys):
    np.savez(tmp_path / "x.npz", points=fibonacci(5))
    assert main(["info", str(tmp_path / "x.npz")]) == 0
    assert "  note             ball_k = 6: there are only 4 other points" in capsys.readouterr().out.splitlines()


def test_info_of_a_single_point(tmp_path, capsys):
    np.savez(tmp_path / "x.npz", points=[[1.0, 2, 3]])
    assert main(["info", str(tmp_path / "x.npz"), "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert (record["points"], record["spacing"], record["auto_h"], record["diagonal"]) == (1, 0, 0, 0)
    assert len(record["notes"]) == 1 and record["notes"][0].endswith("no spacing; expected h as a number")


def test_a_cloud_is_rendered_in_its_own_units_and_says_what_it_took(ball, capsys):
    assert main(["render", ball, *SMALL, "--hits", "h.npz", "--output", "p.png"]) == 0
    out, err = capsys.readouterr()
    hits = np.load("h.npz")
    away = np.linalg.norm(hits["point"][hits["hit"]] - (10, 20, 30), axis=1)
    assert 100 < hits["hit"].sum() < 1200 and np.abs(away - 2).max() < 0.02
    _, directions = Camera.fit((np.array((8.0, 18, 28)), np.array((12.0, 22, 32))), size=(40, 30)).rays((40, 30))
    assert np.abs(hits["direction"] - directions).max() < 0.01
    assert hits["shading_normal"] == "average" and hits["lowered"].sum() == 0
    assert "places gathered, " in out and "at their centres" in out and "wrote p.png, shading_normal = average" in out
    assert err == ""


def test_a_camera_in_cloud_units(ball):
    camera = ["--camera", "eye=10,20,40", "target=10,20,30", "ortho=8"]
    assert main(["render", ball, "--size", "8x8", *camera, "--set", "shading_normal=gradient", "--hits", "h.npz"]) == 0
    hits = np.load("h.npz")
    x = hits["origin"][:, :2] - (10, 20)
    np.testing.assert_array_equal(hits["hit"], np.hypot(x[:, 0], x[:, 1]) < 2)
    assert hits["shading_normal"] == "gradient"


def test_the_thesis_s_lengths_are_left_out_in_a_cloud(ball, capsys):
    assert main(["render", ball, *SMALL, "--preset", "thesis", "--hits", "h.npz"]) == 0
    err = capsys.readouterr().err
    assert "left out of the preset, in cells, which a cloud has not: h = 0.8, radius = 2, max_off_centre = 0.3" in err
    assert "left out of the preset, without a meaning here: neighbourhood = cell_ball, filling = corners" in err
    assert np.load("h.npz")["hit"].any()
    assert main(["render", ball, *SMALL, "--hits", "h.npz"]) == 0
    assert "left out" not in capsys.readouterr().err


@pytest.mark.parametrize("points", [np.linspace(-1, 1, 30)[:, None] * (1, 2, 3), np.full((2, 3), 0.5) + [[0], [1e-9]]])
def test_points_without_a_surface_are_said_to_have_none(points, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    np.savez("line.npz", points=points)
    assert main(["render", "line.npz", *SMALL, "--output", "a.png"]) == 0
    out, err = capsys.readouterr()
    count = int(out.split(" undefined_normal")[0].split()[-1])
    assert count > 0 and out.startswith("40x30: 0 of 1200 rays hit")
    assert (f"jaart: note: no normal is defined for {count} of the {count} rays that came near: points along a line or "
            "in one place have no surface\n") in err


def test_a_camera_is_refused_by_the_cloud_s_own_scale(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    np.savez("huge.npz", points=1e30 * fibonacci(500))
    camera = ["--camera", "eye=0,-5e30,0", "target=0,0,0"]
    assert main(["render", "huge.npz", *SMALL, *camera, "--hits", "h.npz"]) == 0
    assert np.load("h.npz")["hit"].sum() > 50
    capsys.readouterr()
    assert main(["render", "huge.npz", *SMALL, "--camera", "eye=0,-1e46,0", "--hits", "h.npz"]) == 1
    assert "rays from so far have no precision" in capsys.readouterr().err


def test_what_was_done_to_normals_and_balls_is_said_once(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    np.savez("four.npz", points=[[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.1]])
    assert main(["render", "four.npz", *SMALL, "--set", "normal=surfel", "--hits", "h.npz", "--output", "p.png"]) == 0
    notes = [line for line in capsys.readouterr().err.splitlines() if line.startswith("jaart: note: ")]
    assert sum("ball_k = 6: there are only 3 other points" in n for n in notes) == 1
    assert len(set(notes)) == len(notes)


def test_a_trace_in_a_cloud_names_its_balls(ball, capsys):
    ray = ["--origin", "10.3,20.2,40", "--direction", "0,0,-1"]
    for name in ("t.json", "t.csv", "t.svg"):
        assert main(["trace", ball, *ray, "--output", name]) == 0
    assert "pierced" in capsys.readouterr().out
    record = json.loads(Path("t.json").read_text(), parse_constant=pytest.fail)
    assert record["ray"]["status"] == "converged"
    assert record["ray"]["point"] == pytest.approx([10.3, 20.2, 30 + np.sqrt(4 - 0.13)], abs=0.01)
    balls, o = np.array(record["balls"]), np.array((10.3, 20.2))
    assert (np.hypot(*(balls[:, :2] - o).T) <= balls[:, 3]).all() and len(balls) > 1
    assert record["cells"]["cells"] == [] and "cell" not in record["surfels"]
    assert set(record["curves"]) == {"t", "tangent", "off_centre", "mahalanobis", "angle"}
    assert len(record["curves"]["angle"]) == len(record["curves"]["t"]) > 10
    rows = list(csv.DictReader(io.StringIO(Path("t.csv").read_text())))
    for row, step in zip(rows, record["steps"], strict=True):
        assert int(row["ball"]) == step["ball"]
        *centre, radius = record["balls"][step["ball"]]
        assert np.linalg.norm(np.subtract(step["query"], centre)) <= radius * (1 + 1e-9)
    assert "<svg" in Path("t.svg").read_text()


def test_statistics_of_the_built_in_cloud_hold_its_errors(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["statistics", "bumpy", *SMALL, "--output", "s.csv"]) == 0
    assert "spacings" in capsys.readouterr().out
    rows = {row[0]: row[2] for row in csv.reader(io.StringIO(Path("s.csv").read_text()))}
    assert 0 < float(rows["delta_p"]) < 0.2 and int(rows["hits"]) > 100
    assert main(["render", "bumpy", *SMALL, "--map", "distance_error", "--output", "e.png"]) == 0
    assert "spacings, what lies beyond" in capsys.readouterr().out
