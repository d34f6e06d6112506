"""Words copied from rasters, and edges drawn from the limits of an axes that is used again."""

from __future__ import annotations

import re

import numpy as np
import pytest
from make_trace import make_trace
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties

from jaart.plot import lettering
from jaart.plot.energy import draw_energy
from jaart.plot.lettering import Look, measure, pieces, put
from jaart.plot.projection import draw_projection
from jaart.plot.ruler import Ruler
from jaart.plot.style import THEMES, edges, emptied, place

RAYS = {"hits": make_trace((0.3, -6, 2.2), (0.25, 1, 0.1)), "fails": make_trace((0.9, -6, 8.7), (0.3, 1, 0.1)),
        "passes": make_trace((1.2, -6, 9.3), (0.1, 1, 0.02)), "beside": make_trace((-3, -6, 9.3), (0, 1, 0))}


def pixels(figure: Figure) -> np.ndarray:
    """The figure as the window draws it."""
    place(figure)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.array(canvas.buffer_rgba())


@pytest.mark.parametrize("draw", [draw_energy, draw_projection])
@pytest.mark.parametrize("name", RAYS)
def test_an_axes_that_showed_other_rays_shows_the_same_as_a_new_one(draw, name):
    new, used = Figure(figsize=(4.3, 2.4), dpi=100), Figure(figsize=(4.3, 2.4), dpi=100)
    for other in RAYS.values():
        draw(emptied(used, THEMES["dark"]), other, 0, "dark")
        pixels(used)
    for figure in (new, used):
        draw(emptied(figure, THEMES["light"]), RAYS[name], 0, "light")
    assert len(used.axes) == 1
    assert np.array_equal(pixels(used), pixels(new))


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


@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (-3e-4, 2e-4), (190.0, 196.0), (1e6, 1e6 + 3), (-0.02, 5e7)])
def test_the_numbers_of_an_edge_stand_where_they_say(low, high):
    axes = Figure(figsize=(5, 3), dpi=100).add_subplot()
    axes.plot([5e3, 6e3], [0, 1])
    edges(axes, THEMES["light"], "t", "energy")
    axes.set_xlim(low, high)
    axes.figure.draw_without_rendering()
    ruler = next(artist for artist in axes.artists if isinstance(artist, Ruler))
    ticks = ruler._ticks(axes.xaxis)
    texts = [look.text for look, _, _ in ruler._texts()]
    shared = axes.xaxis.get_major_formatter().get_offset()
    assert not shared or shared in texts
    power, offset = re.fullmatch(r"(?:1e(-?\d+))?([+-].+)?", plain(shared)).groups(default="0")
    shown = np.array([float(plain(text)) for _, text in ticks]) * 10.0 ** int(power) + float(offset)
    at = axes.transData.inverted().transform([(x, 0) for x, _ in ticks])[:, 0]
    assert len(ticks) >= 2
    assert abs(shown - at).max() < 0.01 * (high - low)


def plain(text: str) -> str:
    """A number's text as Python reads it."""
    return text.replace("\N{MINUS SIGN}", "-")
