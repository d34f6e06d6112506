"""`jaart isosurface` as a person or a script uses it."""

from __future__ import annotations

from pathlib import Path

import pytest

import jaart
from jaart.__main__ import main

COMMAND = ("isosurface", "standard", "--energy")


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def fails(capsys, status, *arguments):
    """The one line on stderr of a command that ends with that status, and leaves no file."""
    assert main([*COMMAND, *arguments]) == status
    out, err = capsys.readouterr()
    assert out == "" and not list(Path().iterdir())
    lines = err.splitlines()
    assert len(lines) == 1 and lines[0].startswith("jaart: ")
    return lines[0]


@pytest.mark.parametrize("arguments", [
    ("tangent", "--level", "0.2", "--subdivide", "3"), ("off_centre", "--set", "h=1.2", "radius=3", "--level", "0.3"),
    ("fill_level",), ("tangent_step", "--level", "0.3", "--direction", "0,0,-1"),
    ("tangent_step", "--camera", "eye=8,8,90", "target=8,8,8"),
    ("mahalanobis", "--set", "emphasise=true", "--level", "0.8"),
])
def test_a_mesh_is_made_and_written(capsys, arguments):
    assert main([*COMMAND, *arguments, "--output", "a.ply"]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[1] == "wrote a.ply"
    header = Path("a.ply").read_bytes()[:400].decode("ascii", "ignore")
    vertices, triangles = (line.split()[0] for line in said[0].split(", "))
    assert f"element vertex {vertices}\n" in header and f"element face {triangles}\n" in header


def test_the_command_makes_what_python_makes(capsys):
    assert main([*COMMAND, "tangent", "--level", "0.2", "--preset", "thesis", "-o", "a.obj"]) == 0
    mesh = jaart.isosurface(jaart.load("standard"), jaart.preset("thesis"), "tangent", 0.2)
    assert capsys.readouterr().out.startswith(f"{len(mesh.vertices)} vertices, {len(mesh)} triangles")


def test_the_direction_may_be_the_cameras(capsys):
    assert main([*COMMAND, "tangent_step", "--camera", "eye=8,8,90", "target=8,8,8", "-o", "a.ply"]) == 0
    assert main([*COMMAND, "tangent_step", "--direction", "0,0,-1", "-o", "b.ply"]) == 0
    assert Path("a.ply").read_bytes() == Path("b.ply").read_bytes()


@pytest.mark.parametrize(("arguments", "status", "message"), [
    (("tangent", "-o", "a.am"), 2, "expected a name that ends in .ply or .stl or .obj or .vtp"),
    (("tangent", "-o", "a.vti"), 2, "expected a name that ends in .ply"),
    (("weight", "-o", "a.ply"), 1, "--energy weight: expected tangent, tangent_step, off_centre"),
    (("tangent_step", "-o", "a.ply"), 2, "expected either --direction x,y,z or --camera"),
    (("tangent_step", "--direction", "0,0", "-o", "a.ply"), 2, "expected x,y,z"),
    (("tangent_step", "--direction", "0,0,0", "-o", "a.ply"), 1, "expected three finite numbers, not all 0"),
    (("tangent", "--direction", "0,0,1", "-o", "a.ply"), 2, "has no meaning without --energy tangent_step"),
    (("tangent", "--camera", "fov=3", "-o", "a.ply"), 2, "has no meaning without --energy tangent_step"),
    (("tangent", "--set", "energy=angle", "-o", "a.ply"), 2, "energy is what --energy says"),
    (("tangent", "--set", "tolerance=1", "-o", "a.ply"), 1, "tolerance has no meaning"),
    (("fill_level", "--subdivide", "3", "-o", "a.ply"), 2, "has no meaning with --energy fill_level"),
    (("fill_level", "--set", "h=1", "-o", "a.ply"), 1, "h has no meaning"),
    (("tangent", "--level", "x", "-o", "a.ply"), 1, "level = 'x': expected"),
    (("tangent", "--level", "40", "-o", "a.ply"), 1, "no surface there"),
    (("tangent", "-o", "nowhere/a.ply"), 1, "there is no folder"),
])
def test_what_makes_no_sense_is_refused_in_one_line(capsys, arguments, status, message):
    assert message in fails(capsys, status, *arguments)
