"""One visual language for every panel, plot and legend: Okabe–Ito colours, markers, light and dark."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from jaart.plot import scale

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from jaart.core.records import Trace


@dataclass(frozen=True)
class Theme:
    """Colours by what they mean."""

    face: str
    text: str
    muted: str
    grid: str
    band: str
    query: str
    barycentre: str
    next: str
    hit: str
    plane: str
    surfel: str
    ray: str
    cell: str
    full_cell: str


THEMES = {
    "light": Theme(face="#ffffff", text="#1b1d21", muted="#5d636d", grid="#dfe2e7", band="#f1f3f6",
                   query="#0072b2", barycentre="#009e73", next="#e69f00", hit="#d55e00", plane="#cc79a7",
                   surfel="#80868f", ray="#000000", cell="#b4b9c1", full_cell="#6d737d"),
    "dark": Theme(face="#1e2126", text="#e6e8eb", muted="#a2a8b2", grid="#363b43", band="#262a30",
                  query="#56b4e9", barycentre="#00b386", next="#f0ad1e", hit="#f0701a", plane="#d98bb8",
                  surfel="#9aa1ab", ray="#ffffff", cell="#4d535d", full_cell="#878e99"),
}

#: Sizes in points.
TEXT, SMALL, MARK = 8.5, 7.5, 6.5

#: What is shown how, for legends: the Theme field of its colour, its sign, its name.
LEGEND = (("query", "●", "query Q"), ("barycentre", "◆", "barycentre a"), ("next", "○", "next H"),
          ("hit", "★", "hit"), ("plane", "━", "plane, n"), ("surfel", "●", "surfels"))

#: End states of rays and steps in words.
OUTCOMES = {
    "continue": "goes on", "converged": "arrived", "background": "background", "cap": "too many steps",
    "left_trust": "left the trust region", "parallel": "plane parallel to the ray",
    "few_neighbours": "no surfel near", "undefined_normal": "normal undefined", "bounded": "refused: off-centre",
    "floor": "arrived at the precision floor", "undecided": "neither hit nor proven miss", "bad_ray": "not a ray",
    "bounded_weight": "refused: little weight", "bounded_nearest": "refused: surfel too far",
    "bounded_angle": "refused: angle", "bounded_gap": "refused: no clear sheet",
}


@dataclass(frozen=True)
class Spot:
    """A place in an axes that answers the mouse: its text, and the step that it stands for."""

    x: float
    y: float
    text: str
    step: int | None = None


def marker(kind: str, theme: Theme, size: float = MARK) -> dict[str, Any]:
    """How `Axes.plot` draws a query, barycentre, next or hit."""
    colour = getattr(theme, kind)
    symbol = {"query": "o", "barycentre": "D", "next": "o", "hit": "*"}[kind]
    scale = {"barycentre": 0.85, "hit": 1.9}.get(kind, 1.0)
    inside, edge = (theme.face, colour) if kind == "next" else (colour, theme.face)
    return {"marker": symbol, "markersize": size * scale, "markerfacecolor": inside, "markeredgecolor": edge,
            "markeredgewidth": 1.6 if kind == "next" else 0.7, "linestyle": "none"}


def dress(axes: Axes, theme: Theme, xlabel: str = "", ylabel: str = "") -> None:
    """Give an axes the theme's colours and the common sizes."""
    axes.set_facecolor(theme.face)
    axes.locator_params(nbins=7)
    for side, spine in axes.spines.items():
        spine.set_color(theme.cell)
        spine.set_visible(side in ("left", "bottom"))
    axes.tick_params(colors=theme.muted, labelcolor=theme.muted, labelsize=SMALL, length=3, width=0.7, pad=2)
    axes.set_xlabel(xlabel, color=theme.text, fontsize=TEXT, labelpad=2)
    axes.set_ylabel(ylabel, color=theme.text, fontsize=TEXT, labelpad=2)


def edges(axes: Axes, theme: Theme, xlabel: str, ylabel: str) -> None:
    """The same, with edges that are drawn quickly, for figures that follow the mouse."""
    from jaart.plot.ruler import Ruler

    axes.set_facecolor(theme.face)
    axes.set_axis_off()
    axes.locator_params(nbins=7)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    axes.add_artist(Ruler(theme.cell, theme.muted, theme.text, SMALL, TEXT))


def line(axes: Axes, x: Any, y: Any, **look: Any) -> None:
    """A line that leaves the limits of an axes alone, made in a third of the time of `Axes.plot`."""
    from matplotlib.lines import Line2D

    axes.add_artist(Line2D(x, y, **look))


def title(axes: Axes, theme: Theme, first: str, second: str = "", raised: bool = False, left: float = 0.0) -> None:
    """One or two lines above an axes, flush left or so many inches further left.

    raised: leave the lower line to something else.
    """
    from jaart.plot.lettering import Words

    lines = [(second, SMALL, theme.muted, "normal")] if second else []
    lines.append((first, TEXT, theme.text, "bold"))
    for i, (text, size, colour, weight) in enumerate(lines):
        axes.add_artist(Words((0, 1), text, colour, size, (-72 * left, 4 + 12 * (i + raised)), weight, share=True))


def key(axes: Axes, theme: Theme, lines: list[tuple[str, dict[str, Any]]]) -> None:
    """The names of lines (name, how its sample is drawn) in a row above an axes."""
    from jaart.plot.lettering import Key

    axes.add_artist(Key(lines, theme.text, SMALL))


def legend(axes: Axes, theme: Theme, **where: Any) -> None:
    """A compact legend."""
    made = axes.legend(fontsize=SMALL, frameon=False, labelcolor=theme.text, handlelength=1.8, columnspacing=1.2,
                handletextpad=0.5, borderaxespad=0.2, **where)
    made.set_in_layout(False)


def place(figure: Figure, left: float = 0.55, right: float = 0.1, bottom: float = 0.42, top: float = 0.42) -> None:
    """Margins of a figure's only axes in inches: a fixed layout, drawn in half the time of a computed one."""
    width, height = figure.get_size_inches()
    for axis in (axes.yaxis for axes in figure.axes):
        texts = axis.get_major_formatter().format_ticks(list(axis.get_majorticklocs()))
        left = max(left, 0.24 + 0.065 * max(map(len, texts), default=0))
    figure.subplots_adjust(left / width, min(bottom / height, 0.45), 1 - right / width, 1 - min(top / height, 0.45))


def blank(figure: Figure, theme: Theme) -> None:
    """Empty a figure and give it the theme's ground."""
    figure.clear()
    figure.set_facecolor(theme.face)


def emptied(figure: Figure, theme: Theme) -> Axes:
    """The only axes of a figure with nothing in it: it is kept, for to make one takes long."""
    figure.set_facecolor(theme.face)
    if not figure.axes:
        return figure.add_subplot()
    axes = figure.axes[0]
    for artist in (*axes.lines, *axes.collections, *axes.patches, *axes.texts, *axes.artists):
        artist.remove()
    return axes


def say(axes: Axes, theme: Theme, message: str) -> None:
    """A message in place of a plot."""
    axes.set_axis_off()
    axes.text(0.5, 0.5, message, transform=axes.transAxes, ha="center", va="center", fontsize=TEXT + 1,
              color=theme.muted)


def note(axes: Axes, theme: Theme, message: str) -> None:
    """A message in the middle of a plot, readable over it."""
    axes.text(0.5, 0.5, message, transform=axes.transAxes, ha="center", va="center", fontsize=TEXT, zorder=10,
              color=theme.text, bbox={"facecolor": theme.face, "edgecolor": theme.cell, "alpha": 0.9, "linewidth": 0.7})


def label(axes: Axes, theme: Theme, texts: Iterable[tuple[float, float, str, str]], apart: float = 15.0) -> None:
    """Short labels (x, y, text, colour) in order of importance, left out where they would overlap.

    Names of queries (Q…) go above their place but within the axes, of next points (H…) below.
    apart: least distance of two labels in points. The axes must have its limits.
    """
    from jaart.plot.lettering import Words

    placed: list[tuple[float, float]] = []
    scale = 72.0 / axes.figure.dpi
    for x, y, text, colour in texts:
        dx, dy = (4, -11) if text.startswith("H") else (4, 4)
        px, py = axes.transData.transform((x, y)) * scale + (dx, dy)
        if all(abs(px - qx) > apart or abs(py - qy) > 0.6 * apart for qx, qy in placed):
            placed.append((px, py))
            words = Words((x, y), text, colour, SMALL, (dx, dy), "bold", inside=True, halo=theme.face)
            words.set_zorder(9)
            axes.add_artist(words)


def step_title(trace: Trace, step: int) -> tuple[str, str]:
    """The two title lines of a step: which one and how it ended; its numbers."""
    starts = f" · start {trace.start[step] + 1} of {trace.start[-1] + 1}" if trace.start[-1] else ""
    first = f"Step {step + 1} of {trace.steps}{starts}: {OUTCOMES[trace.outcome[step]]}"
    moved, off = (scale.step_text(trace, trace.energy[step], 3, "+"),
                  scale.step_text(trace, trace.off_centre[step], 3))
    second = (f"step {moved}   off-centre {off} {scale.unit(trace)}   "
              f"Σθ {trace.weight_sum[step]:.3g} of {len(trace.neighbours[step])} surfels")
    return first, second
