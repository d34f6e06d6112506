"""Energies along a ray with the cells it crosses and the steps it took [T fig. 2.14, 2.28]."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.records import Trace
from jaart.plot import scale, searched, style
from jaart.plot.style import THEMES, Spot, Theme

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

#: Height of the strip of cells or balls, as a share of the axes.
_STRIP = 0.055
#: Balls overlap, so they are drawn in so many rows.
_ROWS = 3

#: The longest part of a ray (cells or radii of balls) that is shown unasked.
_LONG = 8.0


def energy_figure(trace: Trace, step: int = 0, theme: str = "light", size: tuple[float, float] = (6.4, 3.6),
                  level: float | None = None) -> Figure:
    """The energies along a ray, with the chosen step marked.

    size: inches; level: below which a minimum counts, that of the settings when None.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    style.blank(figure, THEMES[theme])
    draw_energy(figure.add_subplot(), trace, step, theme, level=level)
    return figure


def draw_energy(axes: Axes, trace: Trace, step: int = 0, theme: str = "light", whole: bool = False,
                level: float | None = None) -> list[Spot]:
    """Draw the energies into an axes; returns the places that answer the mouse.

    whole: show the whole ray instead of its part near the steps; level: below which a minimum counts, that of the
    settings when None.
    """
    colours, unit = THEMES[theme], scale.unit(trace)
    if not len(scale.stretches(trace)):
        style.say(axes, colours, "This ray passes the scene.")
        return []
    style.edges(axes, colours, f"t along the ray [{unit}]", f"energy [{unit}]")
    axes.set_xlim(*_span(trace, step, whole))
    axes.set_ylim(*_range(trace, axes.get_xlim()))
    (_balls if scale.is_cloud(trace) else _cells)(axes, trace, colours)
    _across(axes, 0, color=colours.muted, linewidth=0.8, zorder=1)
    named = _curves(axes, trace, colours) + _level(axes, trace, level, colours)
    style.title(axes, colours, _title(trace, step), raised=True)
    style.key(axes, colours, named)
    if not (trace.steps or trace.hit or np.isfinite(trace.curves.tangent).any()):
        style.note(axes, colours, scale.no_steps(trace))
    return _steps(axes, trace, step, colours)


def _across(axes: Axes, y: float, **look: Any) -> None:
    """A line across the whole axes."""
    style.line(axes, (0, 1), (y, y), transform=axes.get_yaxis_transform(), **look)


def _title(trace: Trace, step: int) -> str:
    if not trace.steps:
        return f"{style.OUTCOMES[trace.status].capitalize()}: {'hit at once' if trace.hit else 'no step was taken'}"
    return f"Step {step + 1}: {_value(trace, step)} at t = {scale.text(trace, trace.t_query[step], 3)}"


def _value(trace: Trace, step: int) -> str:
    """The energy that is searched at a step, in words."""
    name, value = searched.energy_name(trace), searched.at_steps(trace)[step]
    if name in ("tangent", "off_centre"):
        sign = "+" if name == "tangent" else ""
        return f"{searched.SIGNS[name]} = {scale.step_text(trace, value, 4, sign)} {scale.unit(trace)}"
    return f"{searched.SIGNS[name]} = {value:.4g}"


def _span(trace: Trace, step: int, whole: bool) -> tuple[float, float]:
    """Around all starts; around the chosen one where they lie too far apart to be told from each other."""
    if whole or not trace.steps:
        ways = scale.stretches(trace)
        low, high = float(ways.min()), float(ways.max())
        return low - 0.02 * (high - low), high + 0.02 * (high - low)
    low, high = _ends(trace, np.ones(trace.steps, dtype=bool))
    size = scale.size(trace)
    if high - low > _LONG * size:
        low, high = _ends(trace, trace.start == trace.start[step])
    margin = max(0.75 * size, 0.5 * (4.0 * size - (high - low)))
    return low - margin, high + margin


def _ends(trace: Trace, steps: NDArray[np.bool_]) -> tuple[float, float]:
    led = steps & (np.abs(trace.energy) < 3.0 * scale.size(trace)) & ~np.array(searched.looks(trace))
    ends = np.concatenate([trace.t_query[steps], trace.t_next[led]])
    if trace.hit and steps[-1]:
        ends = np.append(ends, trace.t)
    return float(ends.min()), float(ends.max())


def _range(trace: Trace, span: tuple[float, float]) -> tuple[float, float]:
    inside, size = (trace.curves.t >= span[0]) & (trace.curves.t <= span[1]), scale.size(trace)
    values = np.concatenate([curve[inside] for curve, *_ in _drawn(trace)])
    values = values[np.isfinite(values)]
    asked = trace.energy[np.isfinite(trace.energy) & (trace.t_query >= span[0]) & (trace.t_query <= span[1])]
    low = max(min(values.min(initial=0.0), asked.min(initial=0.0)), -1.0 * size)
    high = max(min(values.max(initial=0.0), 1.2 * size), min(asked.max(initial=0.0), 2.0 * size), 0.5 * size)
    low = min(low, -0.3 * high)
    return low - 0.15 * (high - low), high + 0.17 * (high - low)


def _drawn(trace: Trace) -> list[tuple[Array, str, str]]:
    """The curves as they are drawn, their names in the legend, and what they are called in searched.SIGNS.

    e_M and e_angle are no lengths: in a cloud they are drawn in the scale of its balls.
    """
    curves, size = trace.curves, scale.size(trace)
    square, one = ("$e_M$ [cells²]", r"$e_{\angle}$") if not scale.is_cloud(trace) else (
        f"$e_M$ / {size:.2g}", rf"$e_{{\angle}}$ · {size:.2g}")
    return [(_without_poles(curves.tangent, size), "$e_{ts}$", "tangent"),
            (curves.off_centre, "$e_{oc}$", "off_centre"),
            (curves.mahalanobis / size, square, "mahalanobis"), (curves.angle * size, one, "angle")]


def _in_scale(trace: Trace, name: str, values: Array | float) -> Array | float:
    """Values of an energy as they are drawn."""
    return values * {"mahalanobis": 1 / scale.size(trace), "angle": scale.size(trace)}.get(name, 1.0)


def _strips(axes: Axes, ways: Array, low: float, high: float, **look: Any) -> None:
    """Rectangles from t to t (N, 2), between two shares of the height of the axes."""
    from matplotlib.collections import PolyCollection

    heights = np.broadcast_to((low, high, high, low), (len(ways), 4))
    corners = np.stack([ways[:, (0, 0, 1, 1)], heights], axis=2)
    axes.add_collection(PolyCollection(corners, transform=axes.get_xaxis_transform(), **look), autolim=False)


def _cells(axes: Axes, trace: Trace, colours: Theme) -> None:
    from matplotlib.collections import LineCollection

    from jaart.plot.strip import Strip

    ways = scale.stretches(trace)
    _strips(axes, ways[::2], 0, 1, facecolor=colours.band, zorder=0)
    borders = np.stack(np.broadcast_arrays(trace.borders[:, None], (0.0, 1.0)), axis=2)
    axes.add_collection(LineCollection(list(borders), transform=axes.get_xaxis_transform(), color=colours.grid,
                                       linewidth=0.7, zorder=0.5), autolim=False)
    falling = np.arange(len(ways)) % 2 == 1
    for full in (False, True):
        chosen = trace.with_surfel == full
        if chosen.any():
            axes.add_artist(Strip(ways[chosen], falling[chosen], _STRIP, colours.face,
                                  colours.full_cell if full else colours.cell, *((1.8, 1.7) if full else (0.4, 0.4))))


def _balls(axes: Axes, trace: Trace, colours: Theme) -> None:
    """The balls' stretches of the ray, in rows; the ground is tinted where any is."""
    ways = scale.stretches(trace)
    _strips(axes, ways, 0, 1, facecolor=colours.band, zorder=0)
    for row in range(_ROWS):
        _strips(axes, ways[row::_ROWS], row * _STRIP / _ROWS, (row + 1) * _STRIP / _ROWS, zorder=2,
                facecolor=colours.cell, edgecolor=colours.full_cell, linewidth=0.8)


def _curves(axes: Axes, trace: Trace, colours: Theme) -> list[tuple[str, dict[str, Any]]]:
    """Draw the energies; returns their names and looks."""
    t = trace.curves.t
    apart = np.diff(t) > 3 * np.median(np.diff(t)) if len(t) > 1 else np.zeros(0, bool)
    gaps = np.flatnonzero(apart) + 1  # between balls that do not touch, nothing is known
    looks: dict[str, dict[str, Any]] = {
        "tangent": {"color": colours.ray, "linewidth": 1.5, "zorder": 4},
        "off_centre": {"color": colours.barycentre, "linewidth": 1.2, "dashes": (4, 1.5), "zorder": 3},
        "mahalanobis": {"color": colours.surfel, "linewidth": 1.2, "dashes": (1, 1), "zorder": 3},
        "angle": {"color": colours.plane, "linewidth": 1.2, "dashes": (5, 1.5, 1, 1.5), "zorder": 3}}
    drawn = _drawn(trace)
    for values, label, name in drawn:
        style.line(axes, np.insert(t, gaps, np.nan), np.insert(values, gaps, np.nan), label=label, **looks[name])
    return [(label, looks[name]) for _, label, name in drawn]


def _level(axes: Axes, trace: Trace, level: float | None, colours: Theme) -> list[tuple[str, dict[str, Any]]]:
    """The line below which a minimum is a hit, where the search minimises; returns its name and look."""
    if level is None and not isinstance(trace.settings.level, str):
        level = trace.settings.level
    if level is None or not searched.minimises(trace):
        return []
    name, look = searched.energy_name(trace), {"color": colours.hit, "linewidth": 1.0, "dashes": (6, 2), "zorder": 2.5}
    at = float(_in_scale(trace, name, level))
    for sign in (1, -1) if name == "tangent" and not trace.settings.emphasise else (1,):
        _across(axes, sign * at, label="level" if sign == 1 else None, **look)
    return [("level", look)]


def _without_poles(values: Array, size: float) -> Array:
    """The values without the stroke from one side of a pole to the other."""
    values = values.copy()
    with np.errstate(invalid="ignore"):
        pole = (values[1:] * values[:-1] < 0) & (np.minimum(np.abs(values[1:]), np.abs(values[:-1])) > size)
    values[1:][pole] = np.nan
    return values


def _steps(axes: Axes, trace: Trace, step: int, colours: Theme) -> list[Spot]:
    """All steps, those of other starts faint, the chosen one on top; a few artists in all, for speed."""
    low, high = axes.get_ylim()
    shown = np.clip(_in_scale(trace, searched.energy_name(trace), searched.at_steps(trace)),
                    low + _STRIP * (high - low), high)
    number = np.arange(trace.steps)
    same = trace.start == trace.start[step] if trace.steps else np.zeros(0, bool)
    for chosen, alpha, smaller in ((~same, 0.3, 0.7), (same & (number != step), 0.8, 0.7), (number == step, 1.0, 1.0)):
        if chosen.any() and not searched.looks(trace):
            _stairs(axes, trace, np.flatnonzero(chosen), shown, colours, alpha)
        if chosen.any():
            _marks(axes, trace, chosen, shown, colours, alpha, smaller)
    spots = [spot for i in number for spot in _spots(trace, int(i), shown[i])]
    left, right = axes.get_xlim()
    named = [(s.x, s.y, s.text[:s.text.index(":")], colours.query if s.text[0] == "Q" else colours.next)
             for s in sorted(spots, key=lambda s: (s.step != step, -(s.step or 0)))
             if left <= s.x <= right and same[s.step]]
    style.label(axes, colours, named)
    if trace.hit:
        style.line(axes, [trace.t], [0], zorder=8, **style.marker("hit", colours))
        spots.append(Spot(trace.t, 0.0, f"hit: t = {scale.text(trace, trace.t)}"))
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
           smaller: float) -> None:
    size = smaller * style.MARK
    if not searched.looks(trace):
        style.line(axes, trace.t_next[chosen], np.zeros(chosen.sum()), zorder=6 + smaller, alpha=alpha,
                   **style.marker("next", colours, size))
    style.line(axes, trace.t_query[chosen], np.nan_to_num(shown[chosen]), zorder=6 + smaller, alpha=alpha,
               **style.marker("query", colours, size))


def _spots(trace: Trace, i: int, shown: float) -> list[Spot]:
    t, t_next, value = trace.t_query[i], trace.t_next[i], searched.at_steps(trace)[i]
    where = f"Q{i + 1}: t = {scale.text(trace, t)}"
    if not np.isfinite(value):
        return [Spot(t, 0.0, f"{where}, {style.OUTCOMES[trace.outcome[i]]}", i)]
    beyond = "" if shown == _in_scale(trace, searched.energy_name(trace), value) else " (beyond the plot)"
    query = Spot(t, float(shown), f"{where}, {_value(trace, i)}{beyond}", i)
    if searched.looks(trace):
        return [query]
    return [Spot(t_next, 0.0, f"H{i + 1}: t = {scale.text(trace, t_next)}", i), query]
