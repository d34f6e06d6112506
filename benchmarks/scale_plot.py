"""Cost against size as a picture: preparation, bytes of each item and time of a ray, for lattices and clouds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from benchmarks.scale_table import KEEP, Row
from jaart.plot import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: A panel: title, label, whether its ordinate is logarithmic, and its fields with their lines.
PANELS = (("Preparation", "seconds", True, (("prep_s", "-"),)),
          ("Memory", "bytes an item; dashed: at the peak", True,
           (("peak_each", "--"), ("arrays_each", "-"))),
          ("Rays", "microseconds a ray", False, (("ray_us", "-"),)))
KINDS = {"lattice": ("query", "o"), "cloud": ("hit", "s")}


def cost(rows: Sequence[Row], theme: str = "light") -> Figure:
    """A panel for each cost; items are interface cells of a lattice, points of a cloud."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.5, 4.0))
    colours = style.THEMES[theme]
    style.blank(figure, colours)
    for number, (title, label, logarithmic, lines) in enumerate(PANELS, 1):
        axes = figure.add_subplot(1, len(PANELS), number)
        axes.set_xscale("log")
        axes.set_yscale("log" if logarithmic else "linear")
        for kind, (colour, mark) in KINDS.items():
            for name, stroke in lines:
                _line(axes, rows, kind, name, getattr(colours, colour), mark + stroke)
        if title == "Memory":
            axes.axhline(KEEP, color=colours.muted, linewidth=0.7)
        if not logarithmic:
            axes.set_ylim(bottom=0)
        _dress(axes, colours, label)
        style.title(axes, colours, title, "")
    figure.axes[0].legend(frameon=False, fontsize=style.SMALL, labelcolor=colours.text)
    figure.subplots_adjust(0.06, 0.15, 0.985, 0.88, wspace=0.25)
    return figure


def _line(axes: Axes, rows: Sequence[Row], kind: str, name: str, colour: str, stroke: str) -> None:
    own = [(row.items, getattr(row, name)) for row in rows if row.kind == kind and getattr(row, name) is not None]
    if own:
        axes.plot(*zip(*own, strict=True), stroke, color=colour, linewidth=1.3, markersize=style.MARK,
                  label=kind if stroke.endswith("-") and not stroke.endswith("--") else None)


def _dress(axes: Axes, colours: style.Theme, label: str) -> None:
    """The common looks."""
    axes.set_facecolor(colours.face)
    for side, spine in axes.spines.items():
        spine.set_color(colours.cell)
        spine.set_visible(side in ("left", "bottom"))
    axes.tick_params(which="both", colors=colours.muted, labelcolor=colours.muted, labelsize=style.SMALL)
    axes.grid(color=colours.grid, linewidth=0.5)
    axes.set_axisbelow(True)
    axes.margins(0.1)
    axes.set_xlabel("interface cells, points", color=colours.text, fontsize=style.TEXT)
    axes.set_ylabel(label, color=colours.text, fontsize=style.TEXT)
