"""How far a lattice's neighbourhood reaches where nobody says: as far as the tolerance asks for."""

from __future__ import annotations

import math

import numpy as np
import pytest

from jaart.core.chosen import COARSE, HALF_DIAGONAL, chosen
from jaart.core.scene import Scene
from jaart.core.settings import PRESETS, Settings, preset

BASIN = Scene("basin", levels=np.broadcast_to([1.0, 0.5, 0.0], (3, 3, 3)))
CLOUD = Scene("points", points=np.eye(3))


def radius(scene: Scene = BASIN, **values: object) -> float:
    return chosen(scene, Settings(**values)).radius


@pytest.mark.parametrize("tolerance", [10, 0.125, COARSE])
def test_a_coarse_tolerance_leaves_the_radius_as_it_is(tolerance: float) -> None:
    assert radius(tolerance=tolerance) == 2.5 and radius(tolerance=tolerance, h=1.6) == 5.0


def test_at_the_end_surfels_weigh_a_tenth_of_the_tolerance() -> None:
    for h in (0.5, 0.8, 2.0):
        for tolerance in (1e-3, 1e-6, 1e-12):
            whole, around_x = (radius(h=h, tolerance=tolerance, neighbourhood=n) for n in ("cell_ball", "ball"))
            assert whole - HALF_DIAGONAL == pytest.approx(h * math.sqrt(-math.log(0.1 * tolerance)), rel=1e-14)
            assert around_x == pytest.approx(max(3.125 * h, whole - HALF_DIAGONAL), rel=1e-14)


def test_the_radius_grows_with_the_digits_up_to_the_floor() -> None:
    radii = [radius(tolerance=10.0 ** -n) for n in range(16)] + [radius(tolerance=t) for t in (2e-16, 1e-300, 0)]
    assert (np.diff(radii) >= 0).all() and radii[-1] == radii[-2] < 6 and math.isfinite(radii[-1])


def test_what_is_set_stays_and_so_does_what_has_no_tolerance() -> None:
    assert radius(tolerance=1e-12, radius=2) == 2.0
    assert radius(tolerance=1e-12, search="march") == radius(tolerance=1e-12, method="isosurface") == 2.5
    assert radius(tolerance=1e-12, weight="hat") == 0.8 + HALF_DIAGONAL
    assert radius(CLOUD, tolerance=1e-12, h=0.1) == pytest.approx(0.4)
    assert math.isinf(radius(tolerance=1e-12, neighbourhood="knn"))


def test_presets_keep_their_radius() -> None:
    radii = {name: chosen(BASIN, preset(name)).radius for name in PRESETS if name != "adamson-alexa"}
    assert radii == {"best": 2.5, "thesis": 2.0}
