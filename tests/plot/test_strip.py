"""The strip of cells: boxes where they say, hatched to either side, nothing beyond them."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from jaart.plot.strip import Strip, _strokes


def drawn(ways, falling, limits=(0.0, 10.0)):
    """Where a figure of 400 × 100 pixels is not white, the lowest row first."""
    figure = Figure(figsize=(4, 1), dpi=100, facecolor="white")
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set_xlim(*limits)
    axes.add_artist(Strip(np.array(ways, float).reshape(-1, 2), np.array(falling, bool), 0.2, "white", "black", 1, 1))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[::-1, :, 0] < 200


def test_boxes_stand_where_they_say_and_fill_their_height():
    ink = drawn([(2, 4), (6, 7)], [False, True])
    columns = np.flatnonzero(ink.any(axis=0))
    assert set(columns) <= {*range(79, 162), *range(239, 282)}
    assert {80, 160, 240, 280} <= {*columns, *(columns + 1)}
    assert ink[:20].any(axis=1).all()
    assert not ink[23:].any()


@pytest.mark.parametrize("falling", [False, True])
def test_strokes_run_to_the_side_they_should_and_stay_within_their_box(falling):
    path = _strokes(np.array([[10.0, 37.0], [50.0, 52.0]]), np.array([falling, falling]), 5.0, 14.0, 6.0)
    ends = path.vertices.reshape(-1, 2, 2)
    along, up = (ends[:, 1] - ends[:, 0]).T
    assert (along > 0).all()
    assert np.allclose(up, -along if falling else along)
    x, y = path.vertices.T
    assert (((x >= 10) & (x <= 37)) | ((x >= 50) & (x <= 52))).all()
    assert ((y >= 5) & (y <= 14)).all()


@pytest.mark.parametrize("ways", [[], [(-5, -1)], [(-1e9, 1e9)]])
def test_what_is_not_in_view_is_not_drawn(ways):
    ink = drawn(ways, [False] * len(ways))
    assert ink.any() == (ways == [(-1e9, 1e9)])
