"""The command line as a person or a script uses it: options, exit statuses, messages."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import jaart
from jaart import cli_arguments
from jaart.__main__ import main
from jaart.core.resources import resource
from tests.cli_calls import fails


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


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
