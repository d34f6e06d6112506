"""The window and the commands say the same of a scene."""

from __future__ import annotations

import numpy as np

from jaart.__main__ import main
from jaart.core.io import load
from jaart.core.meaning import check
from jaart.core.notes import notes
from jaart.core.samples import fibonacci
from jaart.core.settings import Settings, preset
from jaart.gui import tasks

SPHERE = '<SceneGraph raster="16"><Sphere radius="0.1"><location x="0.5" y="0.5" z="0.5"/></Sphere></SceneGraph>'


def test_of_a_solid_that_collapses(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "small.xml").write_text(SPHERE)
    scene, settings = load("small.xml"), preset("thesis").replace(h=1.4, radius=4.0)
    (said,) = notes(scene, settings)
    assert said.startswith("sphere 1 has a radius of 1.6: at h = 1.4 spheres below 1.715 (1.225 h) collapse")
    assert tasks._known(scene, settings, check(scene, settings)).notes == (said,)
    typed = ["--preset", "thesis", "--set", "h=1.4", "--set", "radius=4"]
    for command in (["render", "small.xml", "--size", "20x20", "-o", "p.png"],
                    ["trace", "small.xml", "--origin", "8,8,20", "--direction", "0,0,-1", "-o", "t.json"],
                    ["statistics", "small.xml", "--size", "20x20", "-o", "s.csv"]):
        assert main([*command, *typed]) == 0
        assert capsys.readouterr().err.count(f"jaart: note: {said}\n") == 1


def test_of_a_cloud_far_from_the_origin(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    np.savez("far.npz", points=fibonacci(300) + 1e6)
    scene, settings = load("far.npz"), Settings(tolerance=1e-12)
    (said,) = notes(scene, settings)
    assert said.startswith("coordinates up to 1e+06 are exact to 1.2e-10")
    assert tasks._known(scene, settings, check(scene, settings)).notes == (said,)
    assert main(["render", "far.npz", "--size", "20x20", "--set", "tolerance=1e-12", "-o", "p.png"]) == 0
    assert capsys.readouterr().err.count("jaart: note: coordinates up to 1e+06 are exact to 1.2e-10") == 1
