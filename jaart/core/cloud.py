"""Clouds: their bounds, their own frame, how densely their points lie, and the balls around them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels.cover import in_question, keep
from jaart.core.memory import ITEM, check, pieces
from jaart.core.nearest import nearest_others, tree_over
from jaart.core.pieces import do_each
from jaart.core.point_grid import corners
from jaart.core.scene import Array, Scene, frozen
from jaart.core.telling import tell

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

#: The frame's origin lies on a grid of at most this share of the cloud's longest edge.
GRID = 1 / 8
#: Neighbours from whose distance the density is taken, and after how many medians such a distance is an outlier's.
DENSITY_K, OUTLIER = 6, 10.0
#: The proposed h in lengths of a point's own square.
AUTO_H = 1.2
#: Points whose neighbours are looked for at a time.
ASKED = 1 << 14
#: A ball grows until it would hold so many points of an even sample, by so much at most.
FILLED, GROWN = 10.14, 1.3
#: Share of a ball's radius, as it was, that must lie in a grown one before it is left out.
CORE = 0.5


def bounds(scene: Scene) -> tuple[Array, Array]:
    """Lowest and highest corner (3,) of the box around a cloud's points, in its own coordinates."""
    def make() -> tuple[Array, Array]:
        low, high = corners(_points(scene))
        return frozen(low), frozen(high)

    return scene.once("bounds", (), make)


def diagonal(scene: Scene) -> float:
    """Length of the diagonal of the box around a cloud's points: the unit "d" of its lengths [A §6]."""
    low, high = bounds(scene)
    return float(np.linalg.norm(high - low))


def offset(scene: Scene) -> Array:
    """Origin (3,) of the frame in which a cloud is computed: the middle of its box, on a coarse grid.

    The grid's step is a power of two, at most GRID of the box's longest edge: a cloud that lies about the
    origin keeps its coordinates, and x - offset is exact for coordinates that were float32, and wherever
    |x| >= |x - offset|; elsewhere it is off by 2^-53 of the cloud's size at most. A cloud moved by a multiple of
    the step, or scaled by a power of two, is computed with the same bits.
    """
    low, high = bounds(scene)
    middle, edge = low + (high - low) / 2, float((high - low).max())
    if edge == 0:
        return frozen(middle)
    step = 2.0 ** math.floor(math.log2(edge * GRID))
    return frozen(np.round(middle / step) * step + 0.0)


def local_points(scene: Scene) -> Array:
    """A cloud's points (N, 3) relative to `offset`: what kernels see. Rays have the same offset subtracted."""
    def make() -> Array:
        points = _points(scene)
        check(ITEM * len(points), f"a cloud of {len(points)} points")
        return frozen(points - offset(scene)) if offset(scene).any() else points

    return scene.once("local_points", (), make)


def nearest(scene: Scene, k: int) -> tuple[Array, NDArray[np.int32]]:
    """Distances (N, k) from each point to its k nearest others, rising, and which they are (N, k).

    k: at least 1; clipped to N - 1, so a single point has none.
    """
    def make() -> tuple[Array, NDArray[np.int32]]:
        return nearest_others(local_points(scene), k, lambda: kd_tree(scene))

    return scene.once("nearest", k, make)


def kd_tree(scene: Scene) -> cKDTree:
    """A tree over `local_points` that finds nearest ones."""
    return scene.once("kd_tree", (), lambda: tree_over(local_points(scene)))


def kth_distance(scene: Scene, k: int, some: NDArray[np.int64]) -> Array:
    """Distance (M,) from some points to the k-th nearest other of each; 0 where there is no other."""
    k, found, points = min(k, len(_points(scene)) - 1), np.zeros(len(some)), local_points(scene)
    if k < 1:
        return found
    tree = kd_tree(scene)

    def find(piece: slice) -> None:
        found[piece] = tree.query(points[some[piece]], [k + 1])[0][:, 0]

    do_each(find, list(pieces(len(some), ASKED)), progress=tell)
    return found


def spacing(scene: Scene) -> float:
    """Mean distance from a point to the nearest one elsewhere: the unit "s" of a cloud's lengths.

    0 when there is no point elsewhere.
    """
    return _density(scene)[0]


def square(scene: Scene) -> float:
    """Edge of the square of surface that a point has to itself on average, 1/sqrt(points per area).

    From the mean distance to the 6th neighbour: on an evenly sampled surface pi·distance²/6 is that square. It
    is the spacing of a regular cloud, but of an irregular or noisy one about twice `spacing`, which pairs of
    close points make small. 0 when there is no other point.
    """
    return _density(scene)[1]


def _density(scene: Scene) -> tuple[float, float]:
    """`spacing` and `square`, of the neighbours that balls are made of by default."""
    def make() -> tuple[float, float]:
        distance = nearest(scene, DENSITY_K)[0]
        if not (k := distance.shape[1]):
            return 0.0, 0.0
        first, last = distance[:, :1], distance[:, -1]
        apart, inner = first[first > 0], last[last <= OUTLIER * np.median(last)]
        return (float(apart.mean()) if len(apart) else 0.0), float(inner.mean()) * math.sqrt(math.pi / k)

    return scene.once("density", (), make)


def auto_h(scene: Scene) -> float:
    """The feature size proposed for a cloud: AUTO_H times `square`.

    The same for even and random samples of a surface: it opens no holes in either and shrinks a radius R by
    h²/2R. 0 when there is no other point.
    """
    return AUTO_H * square(scene)


def ball_radii(scene: Scene, ball_k: int) -> Array:
    """Radius (N,) of the ball around each point, which reaches to its ball_k-th nearest neighbour [A §5].

    ball_k: at least 1; clipped to N - 1, which jaart.core.notes says. A single point has a ball of radius 0.
    """
    def make() -> Array:
        distance = nearest(scene, ball_k)[0]
        return frozen(distance[:, -1] if distance.shape[1] else np.zeros(len(distance)))

    return scene.once("ball_radii", ball_k, make)


def grown_radii(radii: Array, k: int) -> Array:
    """Radii (N,) of balls that reached to the k-th neighbour, grown; those of outliers as they are.

    On a surface a ball holds twice as many points where its square is twice as large. What a far point's ball held, if
    it grew, might be the whole scene.
    """
    by = min(max(math.sqrt(FILLED / max(k, 1)), 1.0), GROWN)
    return radii * np.where(radii <= OUTLIER * np.median(radii), by, 1.0)


def cover(scene: Scene, ball_k: int) -> tuple[NDArray[np.int64], Array]:
    """Balls that are enough: numbers, rising, of the points that they are around, and their radii.

    A ball grows and stands for those beside it whose inner half, of what they were, it holds. Large balls choose first,
    so which are kept does not hang on the order of the points. With k = 6, of an even sample about half are kept, of
    random, scanned and merged ones 30 of a hundred. The union loses some of its rim; of a surface that the points
    sample it loses next to nothing.
    """
    def make() -> tuple[NDArray[np.int64], Array]:
        distance, index = nearest(scene, ball_k)
        radii = ball_radii(scene, ball_k)
        grown, cores = grown_radii(radii, index.shape[1]), CORE * radii
        asked, kept = np.zeros(len(index), bool), np.ones(len(index), bool)
        in_question(distance, index, grown, cores, asked)
        some = np.flatnonzero(asked)
        order = some[_large_first(grown[some], local_points(scene)[some])]
        rank = np.empty(len(index), np.int32)
        rank[order] = np.arange(len(order))
        keep(distance, index, grown, cores, order, rank, kept)
        if ball_k == DENSITY_K:
            _density(scene)
        scene.forget("nearest")  # all that is asked of it is known
        numbers = np.flatnonzero(kept)
        return numbers, frozen(grown[numbers])

    return scene.once("cover", ball_k, make)


def _large_first(radii: Array, points: Array) -> NDArray[np.int64]:
    """Numbers of balls by falling radius, those of the same radius by where they are."""
    order = np.argsort(-radii).astype(np.int64, copy=False)
    same = np.diff(radii[order]) == 0
    tied = np.flatnonzero(np.append(same, False) | np.append(False, same))
    some = order[tied]
    order[tied] = some[np.lexsort((*points[some].T, -radii[some]))]
    return order


def _points(scene: Scene) -> Array:
    assert scene.points is not None
    return scene.points
