"""The measures that the comparison of `make bench` rests on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import jaart
from benchmarks import compare
from benchmarks.cases import Case, bumpy, model, widened
from benchmarks.contest import First, Jaart, View, why_absent
from benchmarks.footprint import peak
from benchmarks.standard import camera
from benchmarks.table import line
from benchmarks.timing import Spread, in_turns, ratios
from jaart.core import samples

SMALL = (24, 16)
ONCE = compare.Effort(2, 0.0, 0.0)


def test_the_error_is_none_for_hits_of_the_exact_surface():
    case = bumpy(2000, (SMALL,))
    view, surface = case.views[0], samples.standard_bumps()
    t, normal = surface.hit(view.blank.origin, view.blank.direction)
    hits = view.hits(np.where(np.isfinite(t), t, np.inf), normal, 0.0)
    assert hits.hit.sum() == np.isfinite(t).sum() > 50
    assert case.error(hits) < 1e-12
    assert case.error(view.hits(np.where(np.isfinite(t), t, np.inf) + 0.01, normal, 0.0)) > 0.01
    assert jaart.quality(hits, samples.bumpy_sphere(2000)).delta < 1e-12


def test_a_lattice_of_the_model_s_levels_is_met_as_the_model_is():
    case, exact = model(16, (SMALL,)), jaart.load("standard")
    for contestant in case.contestants[:2]:
        direct = jaart.render(exact, contestant.settings, case.views[0].camera, SMALL)
        assert np.array_equal(contestant.first(case.views[0]).hits.t, direct.t, equal_nan=True)


def test_a_peer_that_fails_is_a_row():
    class Broken:
        name, lazy = "broken", False

        def first(self, view: View) -> First:
            raise RuntimeError("no mesh came out")

    case = bumpy(500, (SMALL,))
    ours, = (c for c in case.contestants if c.name == "Jaart, best")
    rows = compare.rows_of([replace(case, contestants=(ours, Broken()))], ONCE)
    assert [row.note for row in rows] == ["", "failed: no mesh came out"]
    assert rows[0].hits > 50 and rows[1].rays_s is None
    assert "no mesh came out" in line(rows[1])


def test_a_failure_of_jaart_itself_is_none_of_the_rows():
    scene = jaart.Scene("three", points=np.eye(3))
    broken = Jaart("Jaart", scene, jaart.Settings(border="closed", method="fill_level"))
    view = View(jaart.Camera.fit(scene), SMALL, jaart.Settings())
    with pytest.raises(jaart.errors.JaartError):
        compare.rows_of([Case("three", (broken,), (view,))], ONCE)


def test_marching_cubes_of_a_ball_are_met_where_it_is():
    for needed in ("skimage", "open3d"):
        if why_absent(needed):
            pytest.skip(why_absent(needed))
    case = model(16, (SMALL,))
    rows = compare.rows_of([case], ONCE)
    assert rows[2].program == "marching cubes + Embree"
    assert rows[2].embree_ratio == 1.0
    assert abs(rows[2].error - 0.14) < 0.02
    assert abs(rows[2].hits - rows[1].hits) < 0.1 * rows[1].hits


def test_a_wide_picture_shows_as_much_from_top_to_bottom():
    square, wide = camera(16), widened(camera(16), (300, 200))
    _, top = square.rays((200, 200), np.array([100]))
    _, same = wide.rays((300, 200), np.array([150]))
    up = square.frame()[1]
    assert float((same @ up)[0]) == pytest.approx(float((top @ up)[0]), abs=2e-3)


def test_contestants_take_turns_and_slow_ones_drop_out():
    order: list[str] = []
    given = in_turns({"a": lambda: order.append("a"), "b": lambda: order.append("b")}, 3, float("inf"))
    assert order == ["a", "b"] * 3 and given["a"] == [None] * 3
    assert {name: len(made) for name, made in in_turns({"a": int, "b": int}, 3, 0.0).items()} == {"a": 1, "b": 1}


def test_a_spread_is_what_numpy_says():
    values = (3.0, 1.0, 2.0, 7.0, 5.0)
    low, high = np.percentile(values, (25, 75))
    assert (Spread(values).median, Spread(values).least, Spread(values).quartiles) == (3.0, 1.0, high - low)
    assert ratios((2.0, 9.0, 4.0), (1.0, 3.0)).values == (2.0, 3.0)
    assert ratios((), (1.0,)) is None


def test_memory_at_the_peak_is_seen():
    made, taken = peak(lambda: np.ones(1 << 23).sum())
    assert made == 1 << 23
    if taken is None:
        pytest.skip("the system does not tell")
    assert 60 < taken < 100
