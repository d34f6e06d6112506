"""What is left out of a preset, and what a person typed and is refused for."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core.io import load
from jaart.core.meaning import check
from jaart.core.scene import Scene
from jaart.core.settings import PRESETS, Settings, parse, preset
from jaart.core.suited import suited

CLOUD = Scene("cloud", points=np.random.default_rng(1).uniform(size=(50, 3)))


@pytest.mark.parametrize("name", list(PRESETS))
@pytest.mark.parametrize("scene", [CLOUD, load("standard"), load("splash")], ids=["cloud", "model", "lattice"])
@pytest.mark.parametrize("method", [None, "off_centre", "polynomial", "projection", "cylinder"])
def test_every_preset_makes_sense_in_every_scene_and_with_every_surface(name: str, scene: Scene,
                                                                         method: str | None) -> None:
    typed = [] if method is None else [f"method={method}"]
    fitting, _ = suited(scene, parse(typed, preset(name)), ["method"][:len(typed)])
    check(scene, fitting)
    assert method in (None, fitting.method)
    assert suited(scene, fitting, ["method"][:len(typed)]) == (fitting, ())


def test_lengths_in_cells_mean_nothing_in_a_cloud() -> None:
    fitting, notes = suited(CLOUD, preset("thesis"))
    assert (fitting.h, fitting.radius, fitting.max_off_centre, fitting.neighbourhood) == ("auto",) * 4
    assert (fitting.tolerance, fitting.weight, fitting.search) == (0.125, "gaussian", "iterate")
    assert notes == ("left out of the preset, in cells, which a cloud has not: "
                     "h = 0.8, radius = 2, max_off_centre = 0.3",
                     "left out of the preset, without a meaning here: neighbourhood = cell_ball, filling = corners")


def test_shares_of_a_cloud_mean_nothing_on_a_lattice() -> None:
    fitting, notes = suited(load("standard"), preset("adamson-alexa"))
    assert (fitting.h, fitting.normal) == ("auto", "covariance_at_x")
    assert notes == ("left out of the preset, in shares of a cloud: h = 0.004d",)


def test_what_was_typed_stays() -> None:
    asked = parse(["h=0.01", "filling=corners"], preset("thesis"))
    fitting, _ = suited(CLOUD, asked, ["h", "filling"])
    assert (fitting.h, fitting.filling) == (asked.h, "corners")


def test_the_defaults_lose_nothing() -> None:
    assert suited(CLOUD, Settings()) == (Settings(), ())
