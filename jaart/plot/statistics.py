"""The statistics of a picture: steps and cells a ray, end states, errors [T fig. 2.26]."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.colours import COLOURS
from jaart.core.statistics import Histogram, Statistics
from jaart.plot import style
from jaart.plot.style import THEMES, Theme

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


#: Margins in inches: of numbers on an axis, of the names of end states, of the right side.
_LEFT, _NAMES, _RIGHT = 0.6, 1.45, 0.8


def statistics_figure(statistics: Statistics, theme: str = "light", size: tuple[float, float] = (10.0, 3.0)) -> Figure:
    """Histograms, end states and errors of a picture.

    size: inches.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=size)
    draw_statistics(figure, statistics, theme)
    return figure


def statistics_pixels(statistics: Statistics, theme: str, size: tuple[int, int], ratio: float) -> NDArray[np.uint8]:
    """The figure as pixels (height, width, RGBA), made without a window, in any thread.

    size: (width, height) on the screen; ratio: pixels of the device for each of the screen.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = statistics_figure(statistics, theme, (max(size[0], 10) / 100, max(size[1], 10) / 100))
    figure.set_dpi(100 * ratio)
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    return np.array(canvas.buffer_rgba())


def draw_statistics(figure: Figure, statistics: Statistics, theme: str = "light") -> None:
    """Draw the statistics into a figure: side by side where it is wide, else one below the other."""
    colours = THEMES[theme]
    style.blank(figure, colours)
    notes = _notes(statistics)
    width, height = figure.get_size_inches()
    steps, cells, ends = (figure.add_axes(box) for box in _boxes(width, height, len(notes)))
    _steps(steps, statistics, colours)
    _histogram(cells, statistics.cells, colours, "Cells or balls a ray", "cells or balls visited", colours.full_cell)
    _ends(ends, statistics, colours, notes)


def _boxes(width: float, height: float, notes: int) -> list[tuple[float, float, float, float]]:
    """Places of the three plots in a figure of so many inches, as shares of it; room for lines of notes."""
    top, below, last = 0.45, 0.42, 0.12 + 0.15 * notes
    if width > 1.6 * height:
        each = (width - _LEFT - 0.65 - _NAMES - _RIGHT) / 20
        tall = height - below - top
        inches = [(_LEFT, below, 7 * each, tall), (_LEFT + 7 * each + 0.65, below, 6 * each, tall),
                  (width - _RIGHT - 7 * each, last, 7 * each, height - last - top)]
    else:
        each = height / 3
        across, tall = width - _LEFT - _RIGHT, each - below - top
        inches = [(_LEFT, 2 * each + below, across, tall), (_LEFT, each + below, across, tall),
                  (_NAMES, last, width - _NAMES - _RIGHT, each - last - top)]
    return [(x / width, y / height, max(w, 0.2) / width, max(h, 0.2) / height) for x, y, w, h in inches]


def _steps(axes: Axes, statistics: Statistics, colours: Theme) -> None:
    every, last = statistics.evaluations, statistics.iterations
    _histogram(axes, every, colours, "Iterations a ray", "iterations (all, or the hit's start)", colours.query, "all")
    _, shares = last.shares()
    if len(shares):
        edges = np.arange(len(shares) + 1) - 0.5
        axes.stairs(shares, edges, color=colours.hit, linewidth=1.6, label=f"hit, mean {last.mean:.2f}")
        axes.set_ylim(0, 1.08 * max(shares.max(), axes.get_ylim()[1] / 1.08))
    if every.rays:
        style.legend(axes, colours, loc="lower left", bbox_to_anchor=(-0.16, 1), ncols=2)


def _histogram(axes: Axes, histogram: Histogram, colours: Theme, title: str, xlabel: str, colour: str,
               label: str = "") -> None:
    width = 1 if not len(histogram.values) or label else max(1, -(-int(histogram.values[-1]) // 20))
    names, shares = histogram.shares(width)
    style.title(axes, colours, title, "" if label or not len(shares) else f"mean {histogram.mean:.2f}",
                raised=bool(label))
    if not len(shares):
        style.say(axes, colours, "none")
        return
    style.dress(axes, colours, xlabel, "share of rays [%]")
    axes.bar(range(len(shares)), shares, width=0.86, color=colour, label=f"{label}, mean {histogram.mean:.2f}")
    axes.grid(axis="y", color=colours.grid, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.set_ylim(0, 1.08 * shares.max())
    inches = axes.bbox.width / axes.figure.dpi
    every = math.ceil(len(names) * (0.08 * max(len(n) for n in names) + 0.08) / inches)
    ticks = [*range(0, len(names) - every, every), len(names) - 1]
    axes.set_xticks(ticks, [names[i] for i in ticks])


def _ends(axes: Axes, statistics: Statistics, colours: Theme, notes: list[str]) -> None:
    """End states in the colours that the picture's status map has."""
    status = sorted(statistics.status.items(), key=lambda item: item[1])
    style.dress(axes, colours)
    left = _NAMES - _LEFT if axes.get_position().x0 < 0.6 else 0.0  # below the others, else beside them
    style.title(axes, colours, f"{_number(statistics.hits)} of {_number(statistics.rays)} rays hit", left=left)
    names, counts = [style.OUTCOMES[n] for n, _ in status], [c for _, c in status]
    bars = axes.barh(range(len(names)), counts, height=0.7,
                     color=[np.divide(COLOURS[n], 255.0) for n, _ in status])
    axes.bar_label(bars, [f"{_number(c)}  ({_share(c, statistics.rays)})" for c in counts], padding=3,
                   fontsize=style.SMALL, color=colours.text)
    axes.set_yticks(range(len(names)), names, color=colours.text)
    axes.set_xticks([])
    axes.set_xlim(0, 2.2 * max(counts, default=1))
    axes.set_ylim(-0.6, max(2.5, len(names) - 0.4))
    axes.spines["bottom"].set_visible(False)
    axes.set_xlabel("\n".join(notes), fontsize=style.SMALL, color=colours.text, loc="left")


def _notes(statistics: Statistics) -> list[str]:
    notes = [f"{statistics.neighbours:.1f} surfels an iteration" if statistics.neighbours > 0 else "no iteration",
             f"prepared in {1000 * statistics.prep_s:.0f} ms, rays in {1000 * statistics.ray_s:.0f} ms"]
    q = statistics.quality
    if q is not None and not q.relevant:
        notes.append("δ: no relevant rays")
    elif q is not None:
        notes += ["   ".join(f"{name} = {_error(value)}" for name, value in
                             (("δ", q.delta), ("δ_p", q.delta_p), ("δ_n", q.delta_n))),
                  f"false hits {_number(q.false_hit)}, misses {_number(q.false_miss)}, "
                  f"far {_number(q.distance_miss)} of {_number(q.relevant)}"]
    return notes


def _error(error: float) -> str:
    """A measured error to four places, or to three digits where it is small."""
    return f"{error:.4f}" if not 0 < error < 0.01 else f"{error:.3g}"


def _share(count: int, rays: int) -> str:
    percent = 100 * count / max(1, rays)
    return "< 0.1 %" if 0 < percent < 0.1 else f"{percent:.1f} %"


def _number(count: int) -> str:
    return f"{count:,}".replace(",", "\u2009")
