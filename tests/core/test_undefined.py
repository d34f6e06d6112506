"""Where no normal is defined: it is said by its name, and no search takes it for a surface."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core.records import STATUS
from jaart.core.render import render
from jaart.core.samples import fibonacci
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.trace import trace

LINE = np.linspace(-1, 1, 15)[:, None] * (0.6, 0.0, 0.8)


def sheets(gap: float) -> Scene:
    """Two even squares above each other, points alone; h is 1."""
    steps = 0.45 * np.arange(-12, 13)
    x, y = (a.ravel() for a in np.meshgrid(steps, steps))
    top = np.column_stack((x, y, np.full(len(x), gap / 2)))
    return Scene("sheets", points=np.concatenate((top, top * (1, 1, -1))))


@pytest.mark.parametrize("search", ["iterate", "secant", "newton", "safe", "march"])
def test_rays_past_points_on_a_line_end_with_an_undefined_normal(search: str) -> None:
    """Also those that would start at what a ball keeps, which promises nothing."""
    around = fibonacci(12)
    settings = Settings(h=0.5, normal="covariance", search=search)
    origins = 0.05 * around[::-1] - 3 * around
    hits = render(Scene("line", points=LINE), settings, rays=(origins, around))
    assert (hits.status == STATUS["undefined_normal"]).all()
    assert trace(Scene("line", points=LINE), settings, origins[0], around[0]).status == "undefined_normal"
    aside = render(Scene("line", points=LINE), settings, rays=(origins + (0, 5, 0), around * (1, 0, 1)))
    assert (aside.status == STATUS["background"]).all()


@pytest.mark.parametrize("z", [0.5, 0.45, 0.4, 0.38, 0.35])
def test_a_change_of_sign_across_an_undefined_normal_is_no_hit(z: float) -> None:
    """Midway between two sheets 1.6 h apart the points' spread is the same along two axes."""
    settings = Settings(h=1.0, search="safe", normal="covariance", ball_k=100, tolerance=1e-9, radius=6.0,
                        max_nearest="none", max_off_centre="none")
    hits = render(sheets(1.6), settings, rays=(np.array([[0.2, 0.1, z]]), np.array([[0, 0, -1.0]])))
    assert hits.hit[0] and hits.point[0, 2] == pytest.approx(-0.589141, abs=1e-6)
