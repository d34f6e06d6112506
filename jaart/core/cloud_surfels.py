"""The points of a cloud with what normals they have, and the balls around them, as rays need them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jaart.core import cloud, memory, orient
from jaart.core.balls import Cloud
from jaart.core.chosen import Chosen
from jaart.core.kernels.gather import Grid
from jaart.core.meaning import estimates_normals
from jaart.core.memory import COUNTED, check_near
from jaart.core.point_grid import cell_numbers, corners, order_of
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings
from jaart.core.tree import ball_tree

#: A grid over the points has at most so many cells along an axis.
MOST_CELLS = 1 << 20
#: In so many rows of cells points are counted one by one.
FEW_ROWS = 64


@dataclass(frozen=True, eq=False)
class Points:
    """A cloud's points (N, 3) in its own coordinates and normals (N, 3): its own, estimated, or 0 where nobody asked.

    notes: what a person should know of the normals.
    """

    points: Array
    normal: Array
    notes: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.points)


def points_of(scene: Scene, settings: Settings, values: Chosen) -> Points:
    """The points with the normals that the settings need."""
    points = scene.points
    assert points is not None
    if scene.normals is not None:
        return Points(points, scene.normals)
    if not estimates_normals(scene, settings, values):
        return Points(points, np.broadcast_to(np.zeros(3), points.shape))
    made = orient.normals_of(scene, settings.orient)
    return Points(points, made.normal, made.notes)


def has_normals(scene: Scene, settings: Settings, values: Chosen) -> bool:
    """Whether a cloud's points have normals, their own or estimated ones."""
    return scene.normals is not None or estimates_normals(scene, settings, values)


def cloud_of(scene: Scene, settings: Settings, values: Chosen) -> Cloud:
    """Points in a grid, balls that cover them and a tree over these, for a neighbourhood."""
    points = cloud.local_points(scene)
    normals = points_of(scene, settings, values).normal if has_normals(scene, settings, values) else np.empty((0, 3))
    if values.method == "cylinder":
        return _discs(scene, points, normals, values.h)
    kept, radii = cloud.cover(scene, settings.ball_k)
    centres = points[kept]
    if alone(scene):  # nothing but h says how large a single surfel is
        radii = np.full(len(kept), values.h)
    reach = radii + values.radius if values.neighbourhood == "ball" else _reach(scene, settings.k, kept, radii)
    what = f"k = {settings.k}" if math.isinf(values.radius) else f"radius = {values.radius:g}"
    grid = _grid(points, normals, float(np.median(reach)))
    _check(grid, centres, reach, what)
    return Cloud(grid, centres, radii, reach, ball_tree(centres, radii), cloud.offset(scene))


def _check(grid: Grid, centres: Array, reach: Array, what: str) -> None:
    """Raise SettingsError where the points near the balls that a picture asks for would not fit into memory."""
    if memory.room_for_all(max(len(centres), len(grid.keys)), 6):
        return
    some = slice(None, None, max(len(centres) // COUNTED, 1))
    near = [_near(grid, *ball) for ball in zip(centres[some], reach[some].tolist(), strict=True)]
    check_near(near, len(centres), 6 if len(grid.normals) else 3, what)


def _near(grid: Grid, centre: Array, reach: float) -> int:
    """How many points a ball holds; of one that reaches across many cells, how many those do."""
    low, high = (np.clip((centre + way - grid.low) // grid.edge, 0, grid.shape - 1).astype(np.int64)
                 for way in (-reach, reach))
    if (high - low + 1.0)[:2].prod() > len(grid.keys):
        return len(grid.keys)
    row = np.add.outer(np.arange(low[0], high[0] + 1) * grid.shape[1], np.arange(low[1], high[1] + 1)).ravel()
    first, end = np.searchsorted(grid.keys, (row * grid.shape[2] + low[2], row * grid.shape[2] + high[2] + 1))
    if len(row) > FEW_ROWS:
        return int((end - first).sum())
    points = np.concatenate([grid.points[a:b] for a, b in zip(first, end, strict=True)])
    return int((((points - centre) ** 2).sum(axis=1) <= reach * reach).sum())


def alone(scene: Scene) -> bool:
    """Whether all points of a cloud lie in one place, so that balls to their neighbours hold nothing."""
    return cloud.diagonal(scene) == 0.0


def _discs(scene: Scene, points: Array, normals: Array, h: float) -> Cloud:
    """A ball of radius h around each point, that of its disc: the cylinder about a hit reaches √2 h farther."""
    radii = np.full(len(points), h)
    reach = radii * (1 + math.sqrt(2)) * (1 + 1e-12)
    grid = _grid(points, normals, float(reach[0]))
    _check(grid, points, reach, f"h = {h:g}")
    return Cloud(grid, np.array(points), radii, reach, ball_tree(points, radii), cloud.offset(scene))


def _reach(scene: Scene, k: int, kept: NDArray[np.int64], radii: Array) -> Array:
    """How far the k nearest of any point in a ball may be from its centre: no more than its own k-th and 2ρ."""
    return (cloud.kth_distance(scene, max(k - 1, 1), kept) + 2 * radii) * (1 + 1e-12)


def _grid(points: Array, normals: Array, edge: float) -> Grid:
    """The points sorted by the cells of a grid, about as wide as a neighbourhood; normals: (N, 3), or (0, 3)."""
    low, high = corners(points)
    edge = max(edge, float((high - low).max()) / MOST_CELLS) or 1.0
    keys, shape = cell_numbers(points, low, high, edge)
    order = order_of(keys, shape)
    return Grid(low, edge, shape, keys[order], points[order], normals[order] if len(normals) else normals,
                order.astype(np.int32))
