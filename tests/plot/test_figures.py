"""Every figure in both themes: what is in it stands where the numbers say."""

from __future__ import annotations

import io
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from make_trace import TOLERANCE, make_trace
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from jaart.core.statistics import Histogram, Statistics
from jaart.plot.energy import draw_energy, energy_figure
from jaart.plot.projection import draw_projection, projection_figure
from jaart.plot.statistics import statistics_figure
from jaart.plot.style import LEGEND, OUTCOMES, THEMES, step_title
from jaart.plot.trace import shown_steps, trace_figure

HITS = make_trace((0.3, -6, 2.2), (0.25, 1, 0.1))
FAILS = make_trace((0.9, -6, 8.7), (0.3, 1, 0.1))
PASSES = make_trace((1.2, -6, 9.3), (0.1, 1, 0.02))
BESIDE = make_trace((-3, -6, 9.3), (0, 1, 0))
RAYS = {"hits": HITS, "fails": FAILS, "passes": PASSES, "beside": BESIDE}


def numbers():
    steps = Histogram(np.arange(1, 25), np.arange(24, 0, -1), 8.67)
    few = Histogram(np.arange(1, 4), np.array([1, 5, 2]), 2.1)
    return Statistics(400, 300, {"converged": 300, "background": 90, "cap": 10}, few, steps, steps, 17.5, 0.01, 0.2)


def drawn(figure):
    """The texts of a figure, after it has been drawn."""
    figure.savefig(io.BytesIO())
    return [t.get_text() for axes in figure.axes for t in axes.texts]


def test_the_rays_are_what_their_names_say():
    assert (HITS.status, HITS.steps) == ("converged", 3)
    assert abs(HITS.energy[-1]) < TOLERANCE
    assert FAILS.status == "left_trust"
    assert FAILS.start[-1] == 3
    assert PASSES.steps == 0
    assert len(PASSES.cells)
    assert not len(BESIDE.cells)


def test_the_hit_lies_on_the_sphere_that_the_surfels_sample():
    assert np.linalg.norm(HITS.point - 6.0) == pytest.approx(4.0, abs=0.1)


@pytest.mark.parametrize("theme", THEMES)
@pytest.mark.parametrize("name", RAYS)
def test_figures_of_a_ray_draw_in_the_theme(name, theme):
    trace = RAYS[name]
    for figure in (trace_figure(trace, theme=theme), energy_figure(trace, theme=theme),
                   projection_figure(trace, theme=theme)):
        drawn(figure)
        assert to_hex(figure.get_facecolor()) == THEMES[theme].face
        for axes in figure.axes:
            assert {text.get_color() for text in axes.texts if text.get_text()} <= set(vars(THEMES[theme]).values())


@pytest.mark.parametrize("theme", THEMES)
def test_energy_marks_each_step_on_the_curve_and_on_the_axis(theme):
    axes = Figure().add_subplot()
    spots = draw_energy(axes, HITS, 1, theme)
    for i in range(3):
        query, ahead = (next(s for s in spots if s.text.startswith(f"{kind}{i + 1}:")) for kind in "QH")
        assert (query.x, query.y, query.step) == (HITS.t_query[i], HITS.energy[i], i)
        assert (ahead.x, ahead.y, ahead.step) == (HITS.t_next[i], 0, i)
        assert np.interp(query.x, HITS.curves.t, HITS.curves.tangent) == pytest.approx(query.y, abs=0.05)
        assert ahead.x - query.x == pytest.approx(query.y)
    assert next(s for s in spots if s.text.startswith("hit")).x == HITS.t


def test_energy_shows_the_part_near_the_steps_or_the_whole_ray():
    axes, whole = Figure().subplots(2)
    draw_energy(axes, HITS, 0)
    draw_energy(whole, HITS, 0, whole=True)
    low, high = axes.get_xlim()
    assert low < HITS.t_query[0] < HITS.t < high < low + 6
    assert whole.get_xlim()[0] < HITS.borders[0] < HITS.borders[-1] < whole.get_xlim()[1]


def test_poles_do_not_flatten_the_curves():
    axes = Figure().add_subplot()
    draw_energy(axes, FAILS, FAILS.steps - 1)
    assert np.abs(FAILS.energy).max() > 10
    assert -2 < axes.get_ylim()[0] < 0 < axes.get_ylim()[1] < 3


def test_projection_shows_the_points_where_they_are():
    axes = Figure().add_subplot()
    spots = {s.text.split(":")[0]: s for s in draw_projection(axes, HITS, 0)}
    assert (spots["Q1"].x, spots["Q1"].y) == (HITS.t_query[0], 0)
    assert (spots["H1"].x, spots["H1"].y) == (HITS.t_next[0], 0)
    off = HITS.barycentre[0] - HITS.query[0]
    assert np.hypot(spots["a"].x - spots["Q1"].x, spots["a"].y) == pytest.approx(np.linalg.norm(off))
    assert (spots["Q3"].step, spots["hit"].step) == (2, None)
    assert sum(name.startswith("surfel") for name in spots) == len(HITS.neighbours[0])


def test_the_plane_runs_through_barycentre_and_next_point():
    axes = Figure().add_subplot()
    spots = {s.text.split(":")[0]: s for s in draw_projection(axes, HITS, 0)}
    line = next(one for one in axes.lines if one.get_color() == THEMES["light"].plane)
    start, end = line.get_xydata()
    along = (end - start) / np.linalg.norm(end - start)
    for name in ("a", "H1"):
        dx, dy = spots[name].x - start[0], spots[name].y - start[1]
        assert along[0] * dy - along[1] * dx == pytest.approx(0, abs=1e-9)


def test_the_window_stays_while_the_steps_of_a_start_go_by():
    limits = []
    for step in range(3):
        axes = Figure().add_subplot()
        draw_projection(axes, HITS, step)
        limits.append(axes.get_xlim())
    assert limits[0] == limits[1] == limits[2]


def test_a_title_says_step_start_and_outcome():
    first, second = step_title(FAILS, 1)
    assert first == f"Step 2 of {FAILS.steps} · start 1 of 4: left the trust region"
    assert f"{FAILS.energy[1]:+.3f}" in second
    assert "start" not in step_title(HITS, 0)[0]


def test_a_ray_without_steps_says_so():
    assert any("no step was taken" in text for text in drawn(projection_figure(PASSES)))
    assert any("passes the scene" in text for text in drawn(energy_figure(BESIDE)))


def test_at_most_four_steps_are_shown_and_the_chosen_one_is_among_them():
    assert shown_steps(HITS, 1) == [0, 1, 2]
    assert shown_steps(FAILS, 5) == [4, 5, 6, 7]
    assert shown_steps(PASSES, 0) == []
    long = make_trace((0.9, -6, 8.7), (0.3, 1, 0.1))
    object.__setattr__(long, "start", np.zeros(long.steps, np.int32))
    assert shown_steps(long, 4) == [0, 1, 4, 8]


def test_every_end_state_has_words():
    from jaart.core.records import STATUS_NAMES

    assert set(OUTCOMES) == {*STATUS_NAMES, "continue"}
    assert all(kind in vars(THEMES["light"]) for kind, _, _ in LEGEND)


@pytest.mark.parametrize("size", [(10.0, 3.0), (4.0, 7.0)])
def test_statistics_show_shares_and_counts(size):
    figure = statistics_figure(numbers(), "dark", size)
    assert any("300 of 400 rays hit" in text for text in drawn(figure))
    steps, cells, ends = figure.axes
    heights = [bar.get_height() for bar in steps.patches[:20]]
    assert sum(heights) == pytest.approx(100)
    assert heights[0] == pytest.approx(100 * 24 / 300)
    assert cells.get_xlabel() == "cells or balls visited"
    assert [label.get_text() for label in ends.get_yticklabels()] == ["too many steps", "background", "arrived"]


def test_statistics_of_nothing_draw():
    empty = Histogram(np.empty(0, np.int64), np.empty(0, np.int64), float("nan"))
    nothing = Statistics(9, 0, {"background": 9}, empty, empty, empty, float("nan"), 0.0, 0.0)
    assert "none" in drawn(statistics_figure(nothing))


def test_figures_become_svg(tmp_path: Path):
    for name, figure in (("trace", trace_figure(HITS)), ("statistics", statistics_figure(numbers()))):
        figure.savefig(tmp_path / f"{name}.svg")
        assert ET.parse(tmp_path / f"{name}.svg").getroot().tag.endswith("svg")
