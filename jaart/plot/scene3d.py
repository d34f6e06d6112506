"""One step of a traced ray as a few meshes, and from where to look at it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jaart.core.projection import plane
from jaart.core.records import Trace
from jaart.plot import glyphs, scale
from jaart.plot.glyphs import Mesh, copies, join
from jaart.plot.style import THEMES, Theme

Array = NDArray[np.float64]
Up = tuple[float, float, float]
View = tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]

#: Radius of a mark, of the largest surfel, of the plane's patch, and length of normals, in cells or radii of balls.
_MARK, _SURFEL, _PATCH, _NORMAL = 0.075, 0.3, 1.4, 0.42


@dataclass(frozen=True)
class Part:
    """How a mesh is drawn: width of lines in pixels, 0 for faces; opacity of faces."""

    width: float = 0.0
    opacity: float = 1.0


#: The meshes of a step in the order they are drawn.
PARTS = {"cells": Part(1.2), "full_cells": Part(2.4), "open": Part(1.8), "solids": Part(), "plane": Part(opacity=0.4)}


def step_meshes(trace: Trace, step: int, theme: str = "light") -> dict[str, Mesh]:
    """The meshes of one step by the names of PARTS; those with nothing in them are left out."""
    colours, size = THEMES[theme], scale.size(trace)
    low, high = span(trace, step)
    meshes = {
        **(_balls(trace, step, colours) if scale.is_cloud(trace) else _cells(trace, low, high, colours)),
        "open": copies(glyphs.rings(), trace.next_point[step], trace.direction, _MARK * 1.25 * size,
                       rgb(colours.next)),
        "solids": join(*_surfels(trace, step, colours), *_marks(trace, step, colours), *_ways(trace, step, colours),
                       *_ray(trace, low, high, colours)),
        "plane": copies(glyphs.disc(48), trace.barycentre[step], trace.step_normal[step], _PATCH * size,
                        rgb(colours.plane)),
    }
    return {name: mesh for name, mesh in meshes.items() if len(mesh) and np.isfinite(mesh.points).all()}


def span(trace: Trace, step: int) -> tuple[float, float]:
    """The part of the ray that holds the steps of one start, with the hit if it is theirs, at most 6 cells or radii."""
    same, size = trace.start == trace.start[step], scale.size(trace)
    ends = np.concatenate([trace.t_query[same], trace.t_next[same & (np.abs(trace.energy) < 3.0 * size)]])
    low, high = float(ends.min()), float(ends.max())
    if high - low > 6.0 * size:
        low, high = trace.t_query[step] - 3.0 * size, trace.t_query[step] + 3.0 * size
    return low - 1.2 * size, high + 1.2 * size


def view(trace: Trace, step: int, kind: str = "oblique", up: Up = (0.0, 0.0, 1.0)) -> View:
    """Where to look from, where to, and which way is up.

    kind: "side": straight onto the plane of the 2D projector; "ray": along the ray; "oblique": from
    between the two and above.
    """
    flat = plane(trace, step, up)
    low, high = span(trace, step)
    target = trace.origin + 0.5 * (low + high) * trace.direction
    away = {"side": flat.normal, "ray": -flat.u, "oblique": 0.78 * flat.normal - 0.5 * flat.u + 0.38 * flat.v}[kind]
    eye = target + away / np.linalg.norm(away) * (2.3 * scale.size(trace) + 1.25 * (high - low))
    return tuple(eye), tuple(target), tuple(flat.v)


def rgb(colour: str) -> Array:
    """"#rrggbb" as numbers from 0 to 255."""
    return np.array([int(colour[i:i + 2], 16) for i in (1, 3, 5)], dtype=float)


def _boxes(trace: Trace, chosen: NDArray[np.bool_], colour: str) -> Mesh:
    cells = trace.cells[chosen].astype(float).reshape(-1, 3)
    return copies(glyphs.box(), cells, np.tile([0.0, 0.0, 1.0], (len(cells), 1)), 1.0, rgb(colour))


def _cells(trace: Trace, low: float, high: float, colours: Theme) -> dict[str, Mesh]:
    near = (trace.borders[1:] >= low - 1) & (trace.borders[:-1] <= high + 1)
    return {"cells": _boxes(trace, near & ~trace.with_surfel, colours.cell),
            "full_cells": _boxes(trace, near & trace.with_surfel, colours.full_cell)}


def _balls(trace: Trace, step: int, colours: Theme) -> dict[str, Mesh]:
    """Balls that hold the query, or the next point, as three circles each; the one that is searched stands out."""
    centres, radii = trace.balls[:, :3], trace.balls[:, 3]
    holds, leads = (np.linalg.norm(centres - x, axis=1) <= radii for x in (trace.query[step], trace.next_point[step]))
    own = scale.own_ball(trace, step)
    parts = (("cells", (holds | leads) & ~own, colours.cell), ("full_cells", own, colours.full_cell))
    return {name: copies(glyphs.rings(48), centres[chosen], np.tile([0.0, 0.0, 1.0], (int(chosen.sum()), 1)),
                         radii[chosen], rgb(colour)) for name, chosen, colour in parts}


def _ray(trace: Trace, low: float, high: float, colours: Theme) -> list[Mesh]:
    start, end = trace.origin + low * trace.direction, trace.origin + high * trace.direction
    size = scale.size(trace)
    return [_bar(start, end, 0.016 * size, colours.ray),
            copies(glyphs.cone(0.07, 0.24), end, trace.direction, size, rgb(colours.ray))]


def _ways(trace: Trace, step: int, colours: Theme) -> list[Mesh]:
    """The off-centre vector and the step itself, where they are defined and not zero."""
    query = trace.query[step]
    ways = ((trace.barycentre[step], 0.022, colours.barycentre), (trace.next_point[step], 0.034, colours.next))
    size = scale.size(trace)
    return [_bar(query, end, radius * size, colour) for end, radius, colour in ways
            if np.linalg.norm(end - query) > 1e-9 * size]


def _bar(start: Array, end: Array, radius: float, colour: str) -> Mesh:
    length = float(np.linalg.norm(end - start))
    return copies(glyphs.bar(radius, length), start, (end - start) / length, 1.0, rgb(colour))


def _surfels(trace: Trace, step: int, colours: Theme) -> list[Mesh]:
    """Discs and their normals; the weight gives the size, and how far the colour stands out."""
    near, weights = trace.neighbours[step], trace.weights[step]
    if not len(near):
        return []
    share = (weights / weights.max())[:, None]
    colour = rgb(colours.face) + (0.45 + 0.55 * share) * (rgb(colours.surfel) - rgb(colours.face))
    points, normals, size = trace.surfels.points[near], trace.surfels.normal[near], scale.size(trace)
    if not normals.any():  # bare points
        return [copies(glyphs.ball(4, 8), points, np.tile([0.0, 0.0, 1.0], (len(near), 1)),
                       size * (0.03 + 0.07 * np.sqrt(share[:, 0])), colour)]
    return [copies(glyphs.disc(), points, normals, size * (0.06 + (_SURFEL - 0.06) * np.sqrt(share[:, 0])), colour),
            copies(glyphs.arrow(_NORMAL, 0.035), points, normals, size, colour)]


def _marks(trace: Trace, step: int, colours: Theme) -> list[Mesh]:
    """Query, barycentre and its normal, and the hit; what is undefined is left out."""
    along, size = trace.direction, scale.size(trace)
    marks = [copies(glyphs.ball(), trace.query[step], along, _MARK * size, rgb(colours.query))]
    if np.isfinite(trace.barycentre[step]).all():
        marks.append(copies(glyphs.diamond(), trace.barycentre[step], along, 1.4 * _MARK * size,
                            rgb(colours.barycentre)))
        if np.isfinite(trace.step_normal[step]).all():
            marks.append(copies(glyphs.arrow(1.0, 0.075), trace.barycentre[step], trace.step_normal[step], size,
                                rgb(colours.plane)))
    if trace.hit:
        marks.append(copies(glyphs.star(), trace.point, along, 1.9 * _MARK * size, rgb(colours.hit)))
    return marks
