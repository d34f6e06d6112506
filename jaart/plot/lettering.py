"""Words that are rasterised once and then copied: to lay out and render text takes most of the drawing of a figure.

A text is put together of its words, digits and formulas, so that new numbers take nothing new.
"""

from __future__ import annotations

import functools
import math
import re
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import Bbox, IdentityTransform
from numpy.typing import NDArray

#: Room around the letters of a raster [pixels]; how far a halo reaches [points].
_ROOM, _HALO = 3, 1.0
#: What is rasterised as a whole: a formula, a digit, a word, a space.
_PIECE = re.compile(r"\$[^$]*\$|[\d ]|[^\d $]+")


@dataclass(frozen=True)
class Look:
    """A line of text as it is seen: size in points, halo: its colour, "" for none, upright: read from below."""

    text: str
    size: float
    colour: str
    weight: str = "normal"
    halo: str = ""
    upright: bool = False


def measure(look: Look, dpi: float) -> tuple[float, float, float]:
    """Width, height and depth below the line of a text as it is read [pixels]."""
    found = [_measured(piece.text, piece.size, piece.weight, dpi) for piece in pieces(look)]
    width, above, depth = (sum(w for w, _, _ in found), max((h - d for _, h, d in found), default=0.0),
                           max((d for _, _, d in found), default=0.0))
    return width, above + depth, depth


def put(renderer: Any, look: Look, x: float, y: float) -> None:
    """Draw a text whose first letter stands at (x, y), pixels from the lower left."""
    gc = renderer.new_gc()
    if isinstance(renderer, RendererAgg):
        for piece in pieces(look):
            if piece.text != " ":
                raster, left, below = _raster(piece, renderer.dpi)
                renderer.draw_image(gc, round(x) - left, round(y) - below, raster)
            x += measure(piece, renderer.dpi)[0]
    else:
        _, height = renderer.get_canvas_width_height()
        _write(renderer, gc, look, x, height - y if renderer.flipy() else y, 90.0 if look.upright else 0.0)
    gc.restore()


@functools.lru_cache(maxsize=2048)
def pieces(look: Look) -> list[Look]:
    """The parts of a text that are rasterised one by one; with a halo, or read from below, it is one."""
    if look.halo or look.upright:
        return [look]
    return [replace(look, text=text) for text in _PIECE.findall(look.text)]


@functools.lru_cache(maxsize=4096)
def _measured(text: str, size: float, weight: str, dpi: float) -> tuple[float, float, float]:
    font = FontProperties(size=size, weight=weight)
    found = RendererAgg(1, 1, dpi).get_text_width_height_descent(text, font, ismath="$" in text)
    return float(found[0]), float(found[1]), float(found[2])


@functools.lru_cache(maxsize=2048)
def _raster(look: Look, dpi: float) -> tuple[NDArray[np.uint8], int, int]:
    """Pixels (h, w, 4) of a text, the lowest row first, and where in them its first letter stands."""
    width, height, depth = measure(look, dpi)
    left, below = _ROOM, _ROOM + math.ceil(depth)
    renderer = RendererAgg(math.ceil(width) + 2 * _ROOM, math.ceil(height) + 2 * _ROOM + 1, dpi)
    gc = renderer.new_gc()
    _write(renderer, gc, look, left, renderer.height - below, 0.0)
    pixels = np.array(renderer.buffer_rgba())[::-1]
    if look.upright:
        pixels, left, below = np.rot90(pixels, -1), below, left
        left = pixels.shape[1] - left
    return np.ascontiguousarray(pixels), left, below


def _write(renderer: Any, gc: Any, look: Look, x: float, y: float, angle: float) -> None:
    font, formula = FontProperties(size=look.size, weight=look.weight), "$" in look.text
    if look.halo:
        away = renderer.points_to_pixels(_HALO)
        gc.set_foreground(look.halo)
        for turn in range(8):
            dx, dy = away * math.cos(turn * math.pi / 4), away * math.sin(turn * math.pi / 4)
            renderer.draw_text(gc, x + dx, y + dy, look.text, font, angle, ismath=formula)
    gc.set_foreground(look.colour)
    renderer.draw_text(gc, x, y, look.text, font, angle, ismath=formula)


class Words(Text):
    """A line of text beside a place in an axes.

    at: the place, in its data or, with share, in shares of its width and height; away: from there to the first
    letter [points]; inside: left out where the place is not within the axes, and never above them; halo: a colour
    around the letters.
    """

    def __init__(self, at: tuple[float, float], text: str, colour: str, size: float, away: tuple[float, float],
                 weight: str = "normal", share: bool = False, inside: bool = False, halo: str = "") -> None:
        super().__init__(*at, text, color=colour, fontsize=size, fontweight=weight, parse_math="$" in text)
        self.look = Look(text, size, colour, weight, halo)
        self.away, self.share, self.inside = away, share, inside
        self.set_clip_on(inside)

    def draw(self, renderer: Any) -> None:
        """Copy its raster into the figure."""
        place = self._place()
        if self.get_visible() and not (self.inside and not self.axes.bbox.contains(*place)):
            put(renderer, self.look, *self._first(place))
        self.stale = False

    def get_window_extent(self, renderer: Any = None, dpi: float | None = None) -> Bbox:
        """The box around its letters [pixels]."""
        width, height, depth = measure(self.look, self._dpi())
        x, y = self._first(self._place())
        return Bbox.from_bounds(x, y - depth, width, height)

    def _place(self) -> tuple[float, float]:
        transform = self.axes.transAxes if self.share else self.axes.transData
        x, y = transform.transform(self.get_position())
        return float(x), float(y)

    def _first(self, place: tuple[float, float]) -> tuple[float, float]:
        scale = self._dpi() / 72
        x, y = place[0] + scale * self.away[0], place[1] + scale * self.away[1]
        if self.inside:
            _, height, depth = measure(self.look, self._dpi())
            y = min(y, self.axes.bbox.y1 - (height - depth))
        return x, y

    def _dpi(self) -> float:
        return float(self.axes.figure.dpi)


class Key(Artist):
    """What lines of an axes are called, in a row above it; lines: (name, properties of a sample)."""

    def __init__(self, lines: list[tuple[str, dict[str, Any]]], colour: str, size: float) -> None:
        super().__init__()
        self.set_in_layout(False)
        self.set_clip_on(False)
        self.looks = [Look(name, size, colour) for name, _ in lines]
        self.samples = [Line2D([], [], transform=IdentityTransform(), clip_on=False, **style) for _, style in lines]

    @property
    def texts(self) -> list[str]:
        """The names in order."""
        return [look.text for look in self.looks]

    def draw(self, renderer: Any) -> None:
        """Draw a sample of each line and its name."""
        em = renderer.points_to_pixels(self.looks[0].size) if self.looks else 0.0
        x, y = self.axes.bbox.x0 + 0.2 * em, self.axes.bbox.y1 + 0.55 * em
        for look, sample in zip(self.looks, self.samples, strict=True):
            sample.set_figure(self.axes.figure)
            sample.set_data([x, x + 1.8 * em], [y + 0.3 * em, y + 0.3 * em])
            sample.draw(renderer)
            put(renderer, look, x + 2.3 * em, y)
            x += 3.5 * em + measure(look, self.axes.figure.dpi)[0]
        self.stale = False
