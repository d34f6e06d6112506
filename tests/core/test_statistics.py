"""Statistics of a picture whose rays are counted by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from jaart.core.quality import quality
from jaart.core.records import STATUS, Hits, Quality
from jaart.core.settings import Settings
from jaart.core.statistics import Histogram, statistics, table


@pytest.fixture
def hits():
    """Six rays: three hits, one given up, one that passes, one that crosses no cell."""
    names = ("converged", "converged", "floor", "left_trust", "background", "background")
    nothing = np.full((6, 3), np.nan)
    return Hits(
        origin=nothing, direction=nothing, t=nothing[:, 0], point=nothing, normal=nothing, energy=nothing[:, 0],
        off_centre=nothing[:, 0], iterations=np.array([2, 2, 4, 7, 0, 0], np.int32),
        evaluations=np.array([2, 5, 4, 23, 0, 0], np.int32), neighbours=np.array([20, 50, 40, 230, 0, 0], np.int32),
        cells=np.array([1, 3, 3, 9, 2, 0], np.int32), lowered=np.array([0, 2, 0, 1, 0, 0], np.int32), gap=nothing[:, 0],
        status=np.array([STATUS[n] for n in names], np.uint8), starts=np.array([1, 2, 1, 3, 0, 0], np.int32),
        eigenvectors=np.zeros(6, np.int32), gradients=np.zeros(6, np.int32), settings=Settings(), prep_s=0.5,
        ray_s=0.25)


def test_counts_and_means(hits):
    s = statistics(hits)
    assert (s.rays, s.hits) == (6, 3)
    assert s.status == {"converged": 2, "background": 2, "left_trust": 1, "floor": 1}
    assert s.iterations.values.tolist() == [1, 2, 3, 4]
    assert s.iterations.counts.tolist() == [0, 2, 0, 1]
    assert s.iterations.mean == pytest.approx(8 / 3)
    assert (s.evaluations.rays, s.evaluations.mean) == (4, 8.5)
    assert (s.cells.rays, s.cells.mean) == (5, 3.6)
    assert (s.neighbours, s.lowered) == (10, 3)
    assert s.quality is None


def test_the_last_bar_takes_all_above(hits):
    names, shares = statistics(hits).evaluations.shares()
    assert len(names) == 20
    assert names[-1] == "20+"
    assert shares[[1, 3, 4, 19]].tolist() == [25, 25, 25, 25]
    assert shares.sum() == 100


def test_bars_end_with_the_last_value():
    names, shares = Histogram(np.arange(1, 6), np.array([1, 0, 0, 0, 3]), 4.2).shares(width=2)
    assert names == ["1–2", "3–4", "5–6"]
    assert shares.tolist() == [25, 0, 75]


def test_rays_that_do_nothing_have_no_histogram(hits):
    background = {"iterations": hits.iterations * 0, "evaluations": hits.evaluations * 0, "neighbours": hits.cells * 0,
                  "cells": hits.cells * 0, "status": np.full(6, STATUS["background"], np.uint8)}
    s = statistics(Hits(**{**vars(hits), **background}))
    assert s.hits == 0
    assert s.evaluations.shares() == ([], pytest.approx([]))
    assert math.isnan(s.cells.mean)
    assert math.isnan(s.neighbours)


def test_the_table_holds_every_number(hits):
    nothing = np.full(6, np.nan)
    rows = table(statistics(hits, Quality(0.1, 0.2, 0.3, 4, 1, 2, 3, nothing, nothing)))
    assert rows[0] == ("statistic", "bin", "value")
    assert {len(row) for row in rows} == {3}
    for row in (("rays", "", 6), ("hits", "", 3), ("evaluations of a lower degree", "", 3),
                ("end state", "left_trust", 1), ("iterations", "2", 2),
                ("evaluations", "23", 1), ("cells", "3", 2), ("delta_p", "", 0.2), ("false_miss", "", 2)):
        assert row in rows
    assert sum(value for name, _, value in rows if name == "end state") == 6


def test_what_is_not_defined_is_empty_in_the_table(hits):
    nothing = np.full(6, np.nan)
    idle = Hits(**{**vars(hits), "evaluations": hits.evaluations * 0})
    rows = {name: value for name, _, value in
            table(statistics(idle, Quality(math.nan, math.nan, math.nan, 0, 0, 0, 0, nothing, nothing)))}
    assert rows["delta"] == rows["delta_n"] == rows["mean evaluations"] == rows["mean neighbours"] == ""
    assert rows["relevant"] == 0 and rows["rays"] == 6


def test_the_table_agrees_with_a_picture():
    from jaart.core.io import load
    from jaart.core.render import render

    scene = load("standard")
    hits = render(scene, size=(32, 32))
    s = statistics(hits, quality(hits, scene))
    rows = table(s)
    assert sum(value for name, _, value in rows if name == "evaluations") == (hits.evaluations > 0).sum()
    assert sum(int(b) * v for name, b, v in rows if name == "cells") == hits.cells.sum()
    assert ("delta", "", s.quality.delta) in rows
