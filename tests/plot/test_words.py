"""Words and edges that are drawn quickly stand where matplotlib would put them, in pictures and in files."""

from __future__ import annotations

import io

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from jaart.plot import lettering, style
from jaart.plot.lettering import Words
from jaart.plot.ruler import Ruler
from jaart.plot.style import THEMES

LIGHT = THEMES["light"]


def plain(size=(4.0, 3.0)):
    """A figure with an empty axes, and a canvas."""
    figure = Figure(figsize=size, dpi=100)
    axes = figure.add_axes((0.2, 0.2, 0.7, 0.7))
    axes.set_axis_off()
    return FigureCanvasAgg(figure), axes


def ink(canvas):
    """First and last row and column of what is not white."""
    canvas.draw()
    rows, columns = np.nonzero(np.asarray(canvas.buffer_rgba())[:, :, :3].min(axis=2) < 160)
    return np.array([rows.min(), rows.max(), columns.min(), columns.max()])


@pytest.mark.parametrize("text", ["Step 2 of 3: goes on", "$e_{ts}$", "−0.5", "gy"])
def test_words_stand_where_matplotlib_would_put_them(text):
    canvas, axes = plain()
    axes.annotate(text, (0.3, 0.4), xytext=(5, 7), xycoords="axes fraction", textcoords="offset points", fontsize=8.5,
                  color="black", weight="bold")
    expected = ink(canvas)
    canvas, axes = plain()
    axes.add_artist(Words((0.3, 0.4), text, "black", 8.5, (5, 7), "bold", share=True))
    assert np.abs(ink(canvas) - expected).max() <= 1
    box = axes.texts[0].get_window_extent()
    top, bottom, left, right = expected
    height = canvas.figure.bbox.height
    assert box.x0 - 2 <= left
    assert right <= box.x1 + 2
    assert height - box.y1 - 2 <= top
    assert bottom <= height - box.y0 + 2


def test_words_beside_a_place_that_is_not_in_view_are_left_out():
    canvas, axes = plain()
    axes.add_artist(Words((0.5, 0.5), "here", "black", 9, (0, 0), inside=True))
    seen = ink(canvas)
    axes.add_artist(Words((1.5, 0.5), "beyond", "black", 9, (-80, 30), inside=True))
    assert (ink(canvas) == seen).all()


def test_the_same_words_are_rasterised_once():
    canvas, axes = plain()
    axes.add_artist(Words((0.5, 0.5), "once and for all", "black", 9, (0, 0), halo="#ffffff"))
    canvas.draw()
    before = lettering._raster.cache_info()
    canvas.draw()
    after = lettering._raster.cache_info()
    assert (after.misses - before.misses, after.hits - before.hits) == (0, 1)


def test_a_halo_keeps_letters_apart_from_what_is_below():
    canvas, axes = plain()
    axes.figure.set_facecolor("black")
    axes.add_artist(Words((0.5, 0.5), "Q1", "black", 9, (0, 0), halo="#ffffff"))
    canvas.draw()
    assert np.asarray(canvas.buffer_rgba())[:, :, :3].max() > 240


@pytest.mark.parametrize("limits", [((0, 1), (-3, 7)), ((231.2, 234.9), (1e-7, 3e-7)), ((3e6, 3e6 + 1), (0, 1e5))])
def test_numbers_stand_at_their_places_and_are_those_of_matplotlib(limits):
    canvas, axes = plain()
    style.edges(axes, LIGHT, "t", "energy")
    axes.set_xlim(*limits[0])
    axes.set_ylim(*limits[1])
    canvas.draw()
    ruler = next(artist for artist in axes.artists if isinstance(artist, Ruler))
    for axis, at in ((axes.xaxis, 0), (axes.yaxis, 1)):
        values = [v for v in axis.get_majorticklocs() if limits[at][0] <= v <= limits[at][1]]
        assert 3 <= len(values) <= 9
        texts = axis.get_major_formatter().format_ticks(values)
        places = axes.transData.transform([(v, v) for v in values])[:, at]
        assert [text for _, text in ruler._ticks(axis)] == texts
        assert [place for place, _ in ruler._ticks(axis)] == pytest.approx(list(places))
    drawn = {look.text for look, _, _ in ruler._texts()}
    assert {"t", "energy", axes.xaxis.get_major_formatter().get_offset()} <= drawn | {""}


def test_the_name_of_the_left_edge_reads_upwards_left_of_its_numbers():
    canvas, axes = plain()
    style.edges(axes, LIGHT, "", "energy [cells]")
    canvas.draw()
    box = next(artist for artist in axes.artists if isinstance(artist, Ruler)).get_window_extent()
    pixels = np.asarray(canvas.buffer_rgba())[:, :, :3].min(axis=2)
    left = pixels[:, :int(box.x0) + 12] < 160
    rows, columns = np.nonzero(left)
    assert columns.min() == pytest.approx(box.x0, abs=3)
    assert np.ptp(rows) > 5 * np.ptp(columns)
    assert (rows.min() + rows.max()) / 2 == pytest.approx(300 - (axes.bbox.y0 + axes.bbox.y1) / 2, abs=4)


def test_the_same_axes_is_emptied_and_kept():
    figure = Figure()
    axes = style.emptied(figure, LIGHT)
    bare = len(axes.get_children())
    style.edges(axes, LIGHT, "x", "y")
    style.line(axes, [0, 1], [0, 1])
    style.title(axes, LIGHT, "first", "second")
    style.key(axes, LIGHT, [("a", {"color": "black"})])
    style.note(axes, LIGHT, "why")
    axes.fill_between([0, 1], [0, 1])
    assert style.emptied(figure, LIGHT) is axes
    assert len(axes.get_children()) == bare


def test_letters_are_in_files_without_pixels():
    figure = Figure()
    axes = figure.add_subplot()
    style.edges(axes, LIGHT, "t along the ray", "energy")
    style.key(axes, LIGHT, [("$e_{ts}$", {"color": "black"})])
    for kind, sign in (("svg", b"<svg"), ("pdf", b"%PDF")):
        file = io.BytesIO()
        figure.savefig(file, format=kind)
        assert sign in file.getvalue()
        assert b"<image" not in file.getvalue()
