"""Words and edges that are drawn quickly stand where matplotlib would put them, in pictures and in files."""

from __future__ import annotations

import io
import re

import numpy as np
import pytest
from make_trace import make_trace
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties

from jaart.plot import lettering, style
from jaart.plot.energy import draw_energy
from jaart.plot.lettering import Look, Words, measure, pieces, put
from jaart.plot.projection import draw_projection
from jaart.plot.ruler import Ruler
from jaart.plot.style import THEMES, emptied, place

LIGHT = THEMES["light"]


RAYS = {"hits": make_trace((0.3, -6, 2.2), (0.25, 1, 0.1)), "fails": make_trace((0.9, -6, 8.7), (0.3, 1, 0.1)),
        "passes": make_trace((1.2, -6, 9.3), (0.1, 1, 0.02)), "beside": make_trace((-3, -6, 9.3), (0, 1, 0))}


def plain(size=(4.0, 3.0)):
    """A figure with an empty axes, and a canvas."""
    figure = Figure(figsize=size, dpi=100)
    axes = figure.add_axes((0.2, 0.2, 0.7, 0.7))
    axes.set_axis_off()
    return FigureCanvasAgg(figure), axes


def pixels(figure: Figure) -> np.ndarray:
    """The figure as the window draws it."""
    place(figure)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.array(canvas.buffer_rgba())


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


@pytest.mark.parametrize("text", ["Step 1 of 2: goes on", "−0.25", "$e_{oc}$"])
def test_a_word_that_is_copied_is_the_one_that_is_written(text):
    copied, written = RendererAgg(160, 40, 100.0), RendererAgg(160, 40, 100.0)
    for _ in range(2):
        copied.clear()
        put(copied, Look(text, 8.5, "#000000"), 12, 15)
    gc = written.new_gc()
    written.draw_text(gc, 12, 25, text, FontProperties(size=8.5), 0.0, ismath="$" in text)
    one, other = (np.asarray(r.buffer_rgba())[:, :, 3].astype(int) for r in (copied, written))
    assert one.any()
    assert abs(one - other).max() <= 2


def test_words_beside_a_place_that_is_not_in_view_are_left_out():
    canvas, axes = plain()
    axes.add_artist(Words((0.5, 0.5), "here", "black", 9, (0, 0), inside=True))
    seen = ink(canvas)
    axes.add_artist(Words((1.5, 0.5), "beyond", "black", 9, (-80, 30), inside=True))
    assert (ink(canvas) == seen).all()


@pytest.mark.parametrize("text", ["Step 1 of 2:  12.5", "e at −0.25", "$e_{oc}$ = 3", "", " ", "190\u2009344 rays"])
def test_a_text_is_all_its_pieces_in_order(text):
    look = Look(text, 8.5, "#000000")
    assert "".join(piece.text for piece in pieces(look)) == text
    whole = RendererAgg(1, 1, 100.0).get_text_width_height_descent(text, FontProperties(size=8.5), "$" in text)
    assert "$" in text or measure(look, 100.0) == pytest.approx(whole)


def test_other_numbers_take_no_new_rasters():
    canvas = RendererAgg(300, 40, 100.0)
    put(canvas, Look("step +0.1234567890 of 9 at t = 5", 8.5, "#000000"), 5, 15)
    before = lettering._raster.cache_info().misses
    put(canvas, Look("step +0.9072 of 31 at t = 46.85", 8.5, "#000000"), 5, 15)
    assert lettering._raster.cache_info().misses == before


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


@pytest.mark.parametrize("limits", [
    ((0.0, 1.0), (-3.0, 7.0)), ((231.2, 234.9), (1e-7, 3e-7)), ((3e6, 3e6 + 1), (0.0, 1e5)),
    ((-3e-4, 2e-4), (190.0, 196.0)), ((1e6, 1e6 + 3), (-0.02, 5e7)), ((190.0, 196.0), (-3e-4, 2e-4)),
    ((-0.02, 5e7), (1e6, 1e6 + 3))])
def test_numbers_stand_where_they_say_and_are_those_of_matplotlib(limits):
    canvas, axes = plain()
    axes.plot([5e3, 6e3], [0, 1])
    style.edges(axes, LIGHT, "t", "energy")
    axes.set_xlim(*limits[0])
    axes.set_ylim(*limits[1])
    canvas.draw()
    ruler = next(artist for artist in axes.artists if isinstance(artist, Ruler))
    drawn = {look.text for look, _, _ in ruler._texts()}
    assert {"t", "energy"} <= drawn
    for axis, at in ((axes.xaxis, 0), (axes.yaxis, 1)):
        low, high = limits[at]
        values = [v for v in axis.get_majorticklocs() if low <= v <= high]
        texts, formatter = [text for _, text in ruler._ticks(axis)], axis.get_major_formatter()
        assert 2 <= len(values) <= 9
        assert texts == formatter.format_ticks(values)
        places = axes.transData.transform([(v, v) for v in values])[:, at]
        assert [place for place, _ in ruler._ticks(axis)] == pytest.approx(list(places))
        shared = formatter.get_offset()
        assert not shared or shared in drawn
        assert meant(texts, shared) == pytest.approx(values, abs=0.01 * (high - low))


def meant(texts, shared):
    """The numbers that texts stand for, with the power of ten and the summand beside their edge."""
    power, summand = re.fullmatch(r"(?:1e(-?\d+))?([+-].+)?", ascii_of(shared)).groups(default="0")
    return np.array([float(ascii_of(text)) for text in texts]) * 10.0 ** int(power) + float(summand)


def ascii_of(text):
    """A number's text as Python reads it."""
    return text.replace("\N{MINUS SIGN}", "-")


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
    axes = emptied(figure, LIGHT)
    bare = len(axes.get_children())
    style.edges(axes, LIGHT, "x", "y")
    style.line(axes, [0, 1], [0, 1])
    style.title(axes, LIGHT, "first", "second")
    style.key(axes, LIGHT, [("a", {"color": "black"})])
    style.note(axes, LIGHT, "why")
    axes.fill_between([0, 1], [0, 1])
    assert emptied(figure, LIGHT) is axes
    assert len(axes.get_children()) == bare


@pytest.mark.parametrize("draw", [draw_energy, draw_projection])
@pytest.mark.parametrize("name", RAYS)
def test_an_axes_that_showed_other_rays_shows_the_same_as_a_new_one(draw, name):
    new, used = Figure(figsize=(4.3, 2.4), dpi=100), Figure(figsize=(4.3, 2.4), dpi=100)
    for other in RAYS.values():
        draw(emptied(used, THEMES["dark"]), other, 0, "dark")
        pixels(used)
    for figure in (new, used):
        draw(emptied(figure, LIGHT), RAYS[name], 0, "light")
    assert len(used.axes) == 1
    assert np.array_equal(pixels(used), pixels(new))


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


def test_a_label_at_the_upper_edge_of_an_axes_stays_below_it():
    axes = Figure(figsize=(4, 3), dpi=100).add_subplot()
    axes.set_ylim(0, 1)
    style.label(axes, LIGHT, [(0.2, 1.0, "Q2", "#0072b2"), (0.8, 0.5, "Q1", "#0072b2")])
    high, middle = axes.texts
    assert high.get_window_extent().y1 <= axes.bbox.y1
    assert middle.get_window_extent().y0 > axes.transData.transform((0.8, 0.5))[1]
