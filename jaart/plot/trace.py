"""One ray on a page: up to four steps in their planes, and the energies along it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from jaart.core.records import Trace
from jaart.plot import style
from jaart.plot.energy import draw_energy
from jaart.plot.projection import Up, draw_projection
from jaart.plot.style import THEMES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_ROW = 4


def trace_figure(trace: Trace, step: int | None = None, theme: str = "light", up: Up = (0.0, 0.0, 1.0),
                 level: float | None = None) -> Figure:
    """Steps of one start in a row, and the energies below.

    step: one that must be among them, the last of the ray when None; up: the camera's; level: below which a minimum
    counts, that of the settings when None.
    """
    from matplotlib.figure import Figure

    step = trace.steps - 1 if step is None else step
    chosen = shown_steps(trace, step)
    figure = Figure(figsize=(max(9.0, 4.0 * len(chosen)), 7.4 if chosen else 4.0), layout="constrained")
    style.blank(figure, THEMES[theme])
    grid = figure.add_gridspec(2 if chosen else 1, max(1, len(chosen)))
    for column, i in enumerate(chosen):
        axes = figure.add_subplot(grid[0, column])
        draw_projection(axes, trace, i, theme, up)
        if column:
            axes.set_ylabel("")
    draw_energy(figure.add_subplot(grid[-1, :]), trace, max(step, 0), theme, level=level)
    _legend(figure, theme)
    return figure


def shown_steps(trace: Trace, step: int) -> list[int]:
    """Up to four steps of the start that a step belongs to: its ends, the step, and between them."""
    if not trace.steps:
        return []
    same = np.flatnonzero(trace.start == trace.start[step])
    if len(same) <= _ROW:
        return [int(i) for i in same]
    rest = [i for i in (*same[[0, -1, 1]], *same[2:]) if i != step]
    return sorted([step, *(int(i) for i in rest[:_ROW - 1])])


def _legend(figure: Figure, theme: str) -> None:
    from matplotlib.lines import Line2D

    colours = THEMES[theme]
    handles = []
    for kind, _, name in style.LEGEND:
        if kind == "plane":
            handles.append(Line2D([], [], color=colours.plane, linewidth=1.8, label=name))
        else:
            look = style.marker("query" if kind == "surfel" else kind, colours)
            look |= {"markerfacecolor": colours.surfel} if kind == "surfel" else {}
            handles.append(Line2D([], [], label=name, **look))
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), frameon=False,
                  fontsize=style.TEXT, labelcolor=colours.text)
