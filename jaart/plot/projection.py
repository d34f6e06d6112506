"""One step of the iteration in the plane through x_i, a(x_i) and x_{i+1} [T §3.4, fig. 3.20]."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from jaart.core.projection import Plane, plane, section
from jaart.core.records import Trace
from jaart.plot import scale, style
from jaart.plot.style import THEMES, Spot, Theme

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Up = tuple[float, float, float]

#: Half the window at least and at most, and length of the normals, in cells or radii of balls.
_NEAR, _FAR, _NORMAL = 2.0, 4.0, 0.45


def projection_figure(trace: Trace, step: int = 0, theme: str = "light", up: Up = (0.0, 0.0, 1.0),
                      size: tuple[float, float] = (5.2, 4.4)) -> Figure:
    """One step in its plane.

    up: the camera's, for a ray that fixes no plane; size: inches.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    style.blank(figure, THEMES[theme])
    draw_projection(figure.add_subplot(), trace, step, theme, up)
    return figure


def draw_projection(axes: Axes, trace: Trace, step: int = 0, theme: str = "light", up: Up = (0.0, 0.0, 1.0),
                    short: bool = False) -> list[Spot]:
    """Draw one step into an axes; returns the places that answer the mouse.

    short: a title of one line.
    """
    colours = THEMES[theme]
    if not trace.steps:
        style.say(axes, colours, scale.no_steps(trace))
        return []
    style.edges(axes, colours, f"t along the ray [{scale.unit(trace)}]", f"distance from the ray [{scale.unit(trace)}]")
    flat = plane(trace, step, up)
    axes.set_aspect("equal", adjustable="datalim")
    _window(axes, trace, step)
    (_balls if scale.is_cloud(trace) else _cells)(axes, trace, step, flat, colours)
    style.line(axes, (0, 1), (0, 0), transform=axes.get_yaxis_transform(), color=colours.ray, linewidth=1.3, zorder=3)
    spots = _surfels(axes, trace, step, flat, colours)
    _plane(axes, trace, step, flat, colours)
    spots += _points(axes, trace, step, flat, colours)
    first, second = style.step_title(trace, step)
    aside = "" if flat.through == "barycentre" else f"   plane through {flat.through}: a lies on the ray"
    style.title(axes, colours, first, "" if short else second + aside)
    _free_limits(axes)
    return spots


def _free_limits(axes: Axes) -> None:
    """Let the equal aspect widen the window: only limits that are not fixed may be changed by it."""
    axes.set_xlim(*axes.get_xlim(), auto=True)
    axes.set_ylim(*axes.get_ylim(), auto=True)


def _window(axes: Axes, trace: Trace, step: int) -> None:
    """The same window for all steps of a start that fit into it, so that stepping does not jump."""
    same, size = trace.start == trace.start[step], scale.size(trace)
    ends = np.concatenate([trace.t_query[same], trace.t_next[same & (np.abs(trace.energy) < _FAR * size)]])
    middle, half = (ends.min() + ends.max()) / 2, max(_NEAR * size, (ends.max() - ends.min()) / 2 + 0.7 * size)
    if half > _FAR * size:
        middle, half = trace.t_query[step], _FAR * size
    axes.set_xlim(middle - half, middle + half)
    axes.set_ylim(-0.75 * half, 0.75 * half)
    axes.dataLim.set_points(axes.viewLim.get_points())  # so that the equal aspect widens it and cuts nothing off


def _cells(axes: Axes, trace: Trace, step: int, flat: Plane, colours: Theme) -> None:
    from matplotlib.collections import PolyCollection

    left, right = axes.get_xlim()  # more than is seen at first: one may zoom and move
    near = (trace.borders[1:] > 2 * left - right) & (trace.borders[:-1] < 2 * right - left)
    for full in (False, True):
        shapes = [section(flat, cell) for cell in trace.cells[near & (trace.with_surfel == full)]]
        axes.add_collection(PolyCollection(
            [s for s in shapes if len(s)], facecolor=colours.band if full else "none", zorder=1.0 + 0.2 * full,
            edgecolor=colours.full_cell if full else colours.cell, linewidth=1.9 if full else 0.7), autolim=False)


def _balls(axes: Axes, trace: Trace, step: int, flat: Plane, colours: Theme) -> None:
    """The balls as the plane cuts them; the one that the search is in stands out, as many may hold the query."""
    from matplotlib.collections import EllipseCollection

    centres, radii = trace.balls[:, :3], trace.balls[:, 3]
    cut = np.sqrt(np.maximum(radii**2 - flat.heights(centres)**2, 0.0))
    own = scale.own_ball(trace, step)
    for full in (False, True):
        shown = (cut > 0) & (own == full)
        across = 2 * cut[shown]
        axes.add_collection(EllipseCollection(
            across, across, np.zeros(len(across)), units="xy", offsets=flat.coordinates(centres[shown]).reshape(-1, 2),
            transOffset=axes.transData, facecolor=colours.band if full else "none", zorder=1.0 + 0.2 * full,
            edgecolor=colours.full_cell if full else colours.cell, linewidth=1.4 if full else 0.6), autolim=False)


def _surfels(axes: Axes, trace: Trace, step: int, flat: Plane, colours: Theme) -> list[Spot]:
    from matplotlib.collections import LineCollection, PathCollection
    from matplotlib.path import Path
    from matplotlib.transforms import IdentityTransform

    near, weights = trace.neighbours[step], trace.weights[step]
    if not len(near):
        return []
    points = flat.coordinates(trace.surfels.points[near])
    tips = points + _NORMAL * scale.size(trace) * flat.components(trace.surfels.normal[near])
    share = weights / weights.max()
    alpha = 0.3 + 0.7 * share
    axes.add_collection(LineCollection(list(np.stack([points, tips], axis=1)), color=colours.surfel, alpha=alpha,
                                       linewidth=1.0, zorder=2.0), autolim=False)
    axes.add_collection(PathCollection(
        [Path.circle(radius=0.5)], 3 + 75 * share, offsets=points, offset_transform=axes.transData, alpha=alpha,
        color=colours.surfel, transform=IdentityTransform(), linewidth=0, zorder=2.1), autolim=False)
    heights, of = flat.heights(trace.surfels.points[near]), scale.unit(trace)
    return [Spot(x, y, f"surfel {i}: weight {w:.3f}, {scale.text(trace, abs(z), 2)} {of} "
                       f"{'before' if z > 0 else 'behind'} the plane")
            for i, (x, y), w, z in zip(near, points, weights, heights, strict=True)]


def _plane(axes: Axes, trace: Trace, step: int, flat: Plane, colours: Theme) -> None:
    """H(x_i) as it cuts the drawing plane, and n(x_i) as it projects."""
    a = flat.coordinates(trace.barycentre[step])
    normal = flat.components(trace.step_normal[step])
    length = np.linalg.norm(normal)
    if not length > 1e-6:
        return
    size = scale.size(trace)
    along = 50.0 * size * np.array([-normal[1], normal[0]]) / length
    style.line(axes, *np.stack([a - along, a + along]).T, color=colours.plane, linewidth=1.8, zorder=4)
    tip, turned = a + 0.8 * size * normal, float(np.degrees(np.arctan2(normal[1], normal[0]))) - 90
    style.line(axes, *np.stack([a, tip]).T, color=colours.plane, linewidth=1.8, zorder=5, marker=(3, 0, turned),
               markersize=7, markevery=[1])


def _points(axes: Axes, trace: Trace, step: int, flat: Plane, colours: Theme) -> list[Spot]:
    others = [i for i in range(trace.steps) if i != step]
    spots = [_spot(trace, trace.query[i], (trace.t_query[i], 0), f"Q{i + 1}", i) for i in others]
    style.line(axes, trace.t_query[others], np.zeros(len(others)), zorder=5, alpha=0.45,
               **style.marker("query", colours, 0.6 * style.MARK))
    here = f"{step + 1}"
    spots += _chosen(axes, trace, step, flat, colours)
    if trace.hit:
        style.line(axes, [trace.t], [0], zorder=7, **style.marker("hit", colours))
        spots.append(_spot(trace, trace.point, (trace.t, 0), "hit"))
    left, right = axes.get_xlim()
    texts = {f"Q{here}": colours.query, f"H{here}": colours.next, "a": colours.barycentre}
    style.label(axes, colours, [(s.x, s.y, name, texts[name]) for s in spots if (name := s.text.split(":")[0]) in texts
                       and left <= s.x <= right], apart=13)
    return spots


def _chosen(axes: Axes, trace: Trace, step: int, flat: Plane, colours: Theme) -> list[Spot]:
    """The query, its barycentre, the next point, and the ways to them."""
    query, a, t_next = (trace.t_query[step], 0.0), flat.coordinates(trace.barycentre[step]), trace.t_next[step]
    spots = [_spot(trace, trace.query[step], query, f"Q{step + 1}", step)]
    style.line(axes, query[:1], query[1:], zorder=6, **style.marker("query", colours))
    if np.isfinite(a).all():
        style.line(axes, [query[0], a[0]], [0, a[1]], color=colours.barycentre, linewidth=1.2, dashes=(3, 1.5),
                   zorder=4)
        style.line(axes, a[:1], a[1:], zorder=6.2, **style.marker("barycentre", colours))
        spots.append(_spot(trace, trace.barycentre[step], tuple(a), "a"))
    if np.isfinite(t_next):
        style.line(axes, [query[0], t_next], [0, 0], color=colours.next, linewidth=2.4, zorder=3.5)
        style.line(axes, [t_next], [0], zorder=6.4, **style.marker("next", colours))
        spots.append(_spot(trace, trace.next_point[step], (t_next, 0), f"H{step + 1}", step))
    return spots


def _spot(trace: Trace, point: Array, flat: tuple[float, ...], name: str, step: int | None = None) -> Spot:
    where = ", ".join(scale.text(trace, c, 3) for c in point)
    return Spot(float(flat[0]), float(flat[1]), f"{name}: ({where})", step)
