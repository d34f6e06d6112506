"""Energies along a ray with the cells it crosses and the steps it took [T fig. 2.14, 2.28]."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from jaart.core.records import Trace
from jaart.plot import style
from jaart.plot.style import THEMES, Spot, Theme

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

#: Height of the strip of cells, as a share of the axes.
_STRIP = 0.055

#: The longest part of a ray (cells) that is shown unasked.
_LONG = 8.0


def energy_figure(trace: Trace, step: int = 0, theme: str = "light", size: tuple[float, float] = (6.4, 3.6)) -> Figure:
    """The energies along a ray, with the chosen step marked.

    size: inches.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    style.blank(figure, THEMES[theme])
    draw_energy(figure.add_subplot(), trace, step, theme)
    return figure


def draw_energy(axes: Axes, trace: Trace, step: int = 0, theme: str = "light", whole: bool = False) -> list[Spot]:
    """Draw the energies into an axes; returns the places that answer the mouse.

    whole: show the whole ray instead of its part near the steps.
    """
    colours = THEMES[theme]
    style.dress(axes, colours, "t along the ray [cells]", "energy [cells]")
    if not len(trace.cells):
        style.say(axes, colours, "This ray passes the scene.")
        return []
    axes.set_xlim(*_span(trace, step, whole))
    axes.set_ylim(*_range(trace, axes.get_xlim()))
    _cells(axes, trace, colours)
    _curves(axes, trace, colours)
    style.title(axes, colours, _title(trace, step), raised=True)
    style.legend(axes, colours, loc="lower left", bbox_to_anchor=(0, 1), ncols=3)
    return _steps(axes, trace, step, colours)


def _title(trace: Trace, step: int) -> str:
    if not trace.steps:
        return f"{style.OUTCOMES[trace.status].capitalize()}: no cell with a surfel on this ray"
    return f"Step {step + 1}: e_ts = {trace.energy[step]:+.4f} cells at t = {trace.t_query[step]:.3f}"


def _span(trace: Trace, step: int, whole: bool) -> tuple[float, float]:
    """Around all starts; around the chosen one where they lie too far apart to be told from each other."""
    if whole or not trace.steps:
        low, high = trace.borders[0], trace.borders[-1]
        return low - 0.02 * (high - low), high + 0.02 * (high - low)
    low, high = _ends(trace, np.ones(trace.steps, dtype=bool))
    if high - low > _LONG:
        low, high = _ends(trace, trace.start == trace.start[step])
    margin = max(0.75, 0.5 * (4.0 - (high - low)))
    return low - margin, high + margin


def _ends(trace: Trace, steps: NDArray[np.bool_]) -> tuple[float, float]:
    ends = np.concatenate([trace.t_query[steps], trace.t_next[steps & (np.abs(trace.energy) < 3.0)]])
    if trace.hit and steps[-1]:
        ends = np.append(ends, trace.t)
    return float(ends.min()), float(ends.max())


def _range(trace: Trace, span: tuple[float, float]) -> tuple[float, float]:
    inside = (trace.curves.t >= span[0]) & (trace.curves.t <= span[1])
    values = np.concatenate([trace.curves.tangent[inside], trace.curves.off_centre[inside],
                             trace.curves.mahalanobis[inside]])
    values = values[np.isfinite(values)]
    asked = trace.energy[np.isfinite(trace.energy) & (trace.t_query >= span[0]) & (trace.t_query <= span[1])]
    low = max(min(values.min(initial=0.0), asked.min(initial=0.0)), -1.0)
    high = max(min(values.max(initial=0.0), 1.2), min(asked.max(initial=0.0), 2.0), 0.5)
    low = min(low, -0.3 * high)
    return low - 0.15 * (high - low), high + 0.17 * (high - low)


def _cells(axes: Axes, trace: Trace, colours: Theme) -> None:
    from matplotlib import rc_context

    parts = np.stack([trace.borders[:-1], np.diff(trace.borders)], axis=1)
    left, right = axes.get_xlim()  # hatching is slow, so only what a zoom of twice the width may show
    seen = (parts.sum(axis=1) > 1.5 * left - 0.5 * right) & (parts[:, 0] < 1.5 * right - 0.5 * left)
    across = axes.get_xaxis_transform()
    axes.broken_barh(parts[::2].tolist(), (0, 1), transform=across, facecolor=colours.band, zorder=0)
    axes.vlines(trace.borders, 0, 1, transform=across, color=colours.grid, linewidth=0.7, zorder=0.5)
    for full in (False, True):
        for odd, hatch in enumerate(("/////", "\\\\\\\\\\")):
            chosen = parts[seen & (np.arange(len(parts)) % 2 == odd) & (trace.with_surfel == full)]
            edge = colours.full_cell if full else colours.cell
            with rc_context({"hatch.linewidth": 1.7 if full else 0.4}):
                axes.broken_barh(chosen.tolist(), (0, _STRIP), transform=across, zorder=2, hatch=hatch, edgecolor=edge,
                                 facecolor=colours.face, linewidth=1.8 if full else 0.4)
    axes.axhline(0, color=colours.muted, linewidth=0.8, zorder=1)


def _curves(axes: Axes, trace: Trace, colours: Theme) -> None:
    t = trace.curves.t
    axes.plot(t, _without_poles(trace.curves.tangent), color=colours.ray, linewidth=1.5, label="$e_{ts}$", zorder=4)
    axes.plot(t, trace.curves.off_centre, color=colours.barycentre, linewidth=1.2, dashes=(4, 1.5),
              label="$e_{oc}$", zorder=3)
    axes.plot(t, trace.curves.mahalanobis, color=colours.surfel, linewidth=1.2, dashes=(1, 1),
              label="$e_M$ [cells²]", zorder=3)


def _without_poles(values: Array) -> Array:
    """The values without the stroke from one side of a pole to the other."""
    values = values.copy()
    with np.errstate(invalid="ignore"):
        pole = (values[1:] * values[:-1] < 0) & (np.minimum(np.abs(values[1:]), np.abs(values[:-1])) > 1.0)
    values[1:][pole] = np.nan
    return values


def _steps(axes: Axes, trace: Trace, step: int, colours: Theme) -> list[Spot]:
    """All steps, those of other starts faint, the chosen one on top; a few artists in all, for speed."""
    low, high = axes.get_ylim()
    shown = np.clip(trace.energy, low + _STRIP * (high - low), high)
    number = np.arange(trace.steps)
    same = trace.start == trace.start[step] if trace.steps else np.zeros(0, bool)
    for chosen, alpha, scale in ((~same, 0.3, 0.7), (same & (number != step), 0.8, 0.7), (number == step, 1.0, 1.0)):
        if chosen.any():
            _stairs(axes, trace, np.flatnonzero(chosen), shown, colours, alpha)
            _marks(axes, trace, chosen, shown, colours, alpha, scale)
    spots = [spot for i in number for spot in _spots(trace, int(i), shown[i])]
    left, right = axes.get_xlim()
    style.label(axes, [(s.x, s.y, s.text[:s.text.index(":")], colours.query if s.text[0] == "Q" else colours.next)
                       for s in sorted(spots, key=lambda s: (s.step != step, -(s.step or 0)))
                       if left <= s.x <= right and same[s.step]])
    if trace.hit:
        axes.plot(trace.t, 0, zorder=8, **style.marker("hit", colours))
        spots.append(Spot(trace.t, 0.0, f"hit: t = {trace.t:.4f}"))
    return spots


def _stairs(axes: Axes, trace: Trace, steps: NDArray[np.intp], shown: Array, colours: Theme, alpha: float) -> None:
    """From each Q on the curve down to H on the axis, and from there to the next Q of the same start."""
    from matplotlib.collections import LineCollection

    q, h, start = trace.t_query, trace.t_next, trace.start
    down = [[(q[i], shown[i]), (h[i], 0)] for i in steps if np.isfinite(h[i])]
    on = [[(h[i], 0), (h[i], shown[i + 1])] for i in steps if i + 1 < trace.steps and start[i + 1] == start[i]]
    axes.add_collection(LineCollection(down, color=colours.next, linewidth=2.0 if alpha == 1 else 0.8, alpha=alpha,
                                       zorder=5), autolim=False)
    axes.add_collection(LineCollection(on, color=colours.query, linewidth=0.8, alpha=alpha, linestyle=":", zorder=5),
                        autolim=False)


def _marks(axes: Axes, trace: Trace, chosen: NDArray[np.bool_], shown: Array, colours: Theme, alpha: float,
           scale: float) -> None:
    size = scale * style.MARK
    axes.plot(trace.t_next[chosen], np.zeros(chosen.sum()), zorder=6 + scale, alpha=alpha,
              **style.marker("next", colours, size))
    axes.plot(trace.t_query[chosen], np.nan_to_num(shown[chosen]), zorder=6 + scale, alpha=alpha,
              **style.marker("query", colours, size))


def _spots(trace: Trace, i: int, shown: float) -> list[Spot]:
    t, t_next, energy = trace.t_query[i], trace.t_next[i], trace.energy[i]
    if not np.isfinite(energy):
        return [Spot(t, 0.0, f"Q{i + 1}: t = {t:.4f}, {style.OUTCOMES[trace.outcome[i]]}", i)]
    beyond = "" if shown == energy else " (beyond the plot)"
    return [Spot(t_next, 0.0, f"H{i + 1}: t = {t_next:.4f}", i),
            Spot(t, float(shown), f"Q{i + 1}: t = {t:.4f}, e_ts = {energy:+.4f} cells{beyond}", i)]
