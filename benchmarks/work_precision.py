"""The comparison as a picture: error against time, a line for each program, both axes logarithmic."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from benchmarks.table import Row
from jaart.plot import style
from jaart.plot.style import Theme

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Programs in the order of their colours, and the field of the theme that each has.
COLOURS = ("query", "hit", "barycentre", "next", "plane", "full_cell", "ray")
MARKS = "os^vD<>"


def work_precision(rows: Iterable[Row], theme: str = "light") -> Figure:
    """Rays and first pictures of the standard model, and first pictures of the cloud whose surface is known."""
    from matplotlib.figure import Figure

    shown = [row for row in rows if row.error and row.rays_s]
    sizes = list(dict.fromkeys(row.size for row in shown))[:1]
    shown = [row for row in shown if row.size in sizes]
    model, cloud = ([row for row in shown if row.scene.startswith(name)] for name in ("standard", "bumpy"))
    names = list(dict.fromkeys(row.program for row in shown))
    colours = style.THEMES[theme]
    figure = Figure(figsize=(11.5, 4.2))
    style.blank(figure, colours)
    panels = (("Standard model: rays", "seconds a picture, everything kept", "rays_s", model, "δ"),
              ("Standard model: first picture", "seconds from the fill levels on", "first_s", model, "δ"),
              ("Bumpy sphere: first picture", "seconds from the points on", "first_s", cloud,
               "mean distance [spacings]"))
    for number, (title, xlabel, field, some, ylabel) in enumerate(panels, 1):
        axes = figure.add_subplot(1, len(panels), number)
        _panel(axes, colours, some, field, names)
        _dress(axes, colours, xlabel, ylabel)
        style.title(axes, colours, title, _scenes(some, sizes))
    figure.subplots_adjust(0.06, 0.22, 0.985, 0.87, wspace=0.27)
    _legend(figure, colours)
    return figure


def _panel(axes: Axes, colours: Theme, rows: list[Row], field: str, names: list[str]) -> None:
    """A line for each program: from the coarsest scene to the finest."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    for number, name in enumerate(names):
        own = [row for row in rows if row.program == name]
        if own:
            axes.plot([getattr(row, field) for row in own], [row.error for row in own], label=name, linewidth=1.3,
                      color=getattr(colours, COLOURS[number % len(COLOURS)]), markersize=style.MARK,
                      marker=MARKS[number % len(MARKS)])
    if not rows:
        style.note(axes, colours, "not measured")


def _dress(axes: Axes, colours: Theme, xlabel: str, ylabel: str) -> None:
    """The common looks, with ticks of logarithmic axes."""
    from matplotlib.ticker import LogLocator, NullLocator

    axes.set_facecolor(colours.face)
    axes.margins(0.12)
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 60 * low else (1.0, 3.0), numticks=8))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(NullLocator())
    for side, spine in axes.spines.items():
        spine.set_color(colours.cell)
        spine.set_visible(side in ("left", "bottom"))
    axes.tick_params(colors=colours.muted, labelcolor=colours.muted, labelsize=style.SMALL, length=3,
                     width=0.7, pad=2)
    axes.grid(color=colours.grid, linewidth=0.5)
    axes.set_axisbelow(True)
    axes.set_xlabel(xlabel, color=colours.text, fontsize=style.TEXT)
    axes.set_ylabel(ylabel, color=colours.text, fontsize=style.TEXT)


def _scenes(rows: list[Row], sizes: list[str]) -> str:
    """What the points of a panel stand for."""
    scenes = list(dict.fromkeys(row.scene.partition(" ")[2] for row in rows))
    return f"{', '.join(scenes)} at {', '.join(sizes)}" if scenes else ""


def _legend(figure: Figure, colours: Theme) -> None:
    """One legend for all panels, below them."""
    entries = {label: handle for axes in figure.axes
               for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    if entries:
        figure.legend(entries.values(), entries.keys(), loc="lower center", ncols=len(entries), frameon=False,
                      fontsize=style.SMALL, labelcolor=colours.text)
