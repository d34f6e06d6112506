"""Normals for bare points: estimated from their neighbours, then turned to one side of the surface."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.cloud import kd_tree, local_points, offset
from jaart.core.nearest import nearest_others
from jaart.core.scene import Array, Scene, frozen
from jaart.core.telling import tell

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

Ints = NDArray[np.integer]
Vector = tuple[float, float, float]

#: Neighbours that a normal is estimated from, and along which orientation spreads.
NEIGHBOURS = 12
#: Points whose covariances are in memory at a time.
POINTS_AT_ONCE = 1 << 15
#: Normals are undefined where (λ1 - λ0)/λ2 of the neighbours is below: they lie along a line, or in one place.
SMALLEST_GAP = 1e-6
#: A lightest edge, since a weight of 0 is no edge to the graph routines.
LIGHTEST = 1e-9


@dataclass(frozen=True, eq=False)
class Oriented:
    """Unit normals (N, 3) of a cloud, and what a person should know of them.

    components: parts of the neighbour graph, each oriented by itself; undefined: normals that the neighbours
    do not define; agreeing: share of the graph's edges whose two normals point to the same side.
    """

    normal: Array
    components: int
    undefined: int
    agreeing: float

    @property
    def notes(self) -> tuple[str, ...]:
        """In words, what is not as it should be."""
        notes = []
        if self.components > 1:
            notes.append(f"the points fall into {self.components} parts, each oriented by itself")
        if self.undefined:
            many = "normals are" if self.undefined > 1 else "normal is"
            notes.append(f"{self.undefined} {many} undefined: the neighbours lie along a line or in one place")
        return tuple(notes)


def normals_of(scene: Scene, orient: str | Vector) -> Oriented:
    """Normals of a cloud without its own, as `oriented` makes them; kept in the scene.

    orient: as there; a viewpoint in the cloud's own coordinates.
    """
    def make() -> Oriented:
        local = orient if isinstance(orient, str) else tuple((np.asarray(orient) - offset(scene)).tolist())
        return oriented(local_points(scene), local, tree=lambda: kd_tree(scene))

    return scene.once("normals", orient, make)


def oriented(points: Array, orient: str | Vector = "spanning_tree", k: int = NEIGHBOURS,
             tree: Callable[[], cKDTree] | None = None) -> Oriented:
    """Normals of bare points (N, 3), estimated from k neighbours each and turned to one side.

    orient: "spanning_tree" spreads one side over each part of the surface and takes it for the outer one [Hoppe
    et al. 1992]; a viewpoint (x, y, z) has each normal turned towards it; "none" leaves them as they come; tree: makes
    one over the points, or has it.
    """
    index = nearest_others(points, k, tree)[1]
    normal, gap = estimated(points, index)
    graph = spanning_tree(normal, index) if orient == "spanning_tree" else _graph(np.ones(index.shape), index)
    components = parts(graph)
    if orient == "spanning_tree":
        normal = spread(points, normal, graph, components)
    elif not isinstance(orient, str):
        normal = towards(points, normal, np.array(orient))
    return Oriented(frozen(normal), int(components.max()) + 1, int((gap < SMALLEST_GAP).sum()), agreeing(normal, index))


def estimated(points: Array, index: Ints) -> tuple[Array, Array]:
    """Unit normals (N, 3) without orientation, and how well they are defined (N,): (λ1 - λ0)/λ2 in [0, 1].

    The eigenvector of the smallest eigenvalue of the covariance of a point and its neighbours [T §2.3.3]. index:
    (N, k) neighbours. Neighbours in one place give (0, 0, 1) and 0.
    """
    normal, gap = np.empty(points.shape), np.zeros(len(points))
    for begin in range(0, len(points), POINTS_AT_ONCE):
        tell(begin, len(points))
        part = slice(begin, begin + POINTS_AT_ONCE)
        normal[part], gap[part] = _estimated(points[part], points[index[part]])
    return normal, gap


def _estimated(points: Array, neighbours: Array) -> tuple[Array, Array]:
    """Of (n, 3) points with neighbours (n, k, 3); scaled to their reach, so that nothing under- or overflows."""
    around = np.concatenate((np.zeros((len(points), 1, 3)), neighbours - points[:, None]), axis=1)
    reach = np.abs(around).max(axis=(1, 2))
    around /= np.where(reach > 0, reach, 1)[:, None, None]
    around -= around.mean(axis=1, keepdims=True)
    values, vectors = np.linalg.eigh(around.transpose(0, 2, 1) @ around)
    normal = np.where((reach > 0)[:, None], vectors[:, :, 0], (0.0, 0.0, 1.0))
    largest = np.where(values[:, 2] > 0, values[:, 2], 1)
    return normal, (values[:, 1] - values[:, 0]) / largest


def parts(graph: Any) -> NDArray[np.int32]:
    """Which part (N,) of a graph each point belongs to, counted from 0."""
    from scipy.sparse.csgraph import connected_components

    labels: NDArray[np.int32] = connected_components(graph, directed=False)[1]
    return labels


def spanning_tree(normal: Array, index: Ints) -> Any:
    """A minimum spanning tree of each part of the graph of neighbours (N, k), edges weighted by 1 - |<n_i, n_j>|."""
    from scipy.sparse.csgraph import minimum_spanning_tree

    weight = 1 - np.abs(_cosines(normal, index))
    return minimum_spanning_tree(_graph(np.maximum(weight, 0) + LIGHTEST, index))


def spread(points: Array, normal: Array, tree: Any, part: NDArray[np.int32]) -> Array:
    """Normals (N, 3) turned to the outside of each part [Hoppe et al. 1992].

    The spanning tree is walked from one point of each part; a normal is turned when it points away from the one
    before it. Then the part is turned as a whole so that the normals at its extreme points along x, y, z point
    outwards.
    """
    before = _before(tree, _first_of_each(part))
    sign = np.where((normal * normal[before]).sum(axis=1) < 0, -1.0, 1.0)
    while (before != before[before]).any():  # each turn halves the way to the first point
        sign *= sign[before]
        before = before[before]
    turned = sign[:, None] * normal
    result: Array = turned * np.where(_outwards(points, turned, part) < 0, -1.0, 1.0)[part, None]
    return result


def towards(points: Array, normal: Array, viewpoint: Array) -> Array:
    """Normals (N, 3) turned to the side on which a point (3,) lies."""
    away = (normal * (np.asarray(viewpoint) - points)).sum(axis=1) < 0
    return np.where(away[:, None], -normal, normal)


def agreeing(normal: Array, index: Ints) -> float:
    """Share of the neighbours (N, k) whose normals point to the same side as their point's; 1 where there are none."""
    if not index.size:
        return 1.0
    return float(np.mean(_cosines(normal, index) > 0))


def _cosines(normal: Array, index: Ints) -> Array:
    """<n_i, n_j> of each point's normal and those of its neighbours (N, k)."""
    cosines: Array = np.einsum("ni,nki->nk", normal, normal[index])
    return cosines


def _outwards(points: Array, normal: Array, part: NDArray[np.int32]) -> Array:
    """For each part, how much the normals at its six extreme points along the axes point outwards, summed."""
    total = np.zeros(int(part.max()) + 1)
    for axis in range(3):
        order = np.lexsort((points[:, axis], part))
        starts = np.searchsorted(part[order], np.arange(len(total) + 1))
        total += normal[order[starts[1:] - 1], axis] - normal[order[starts[:-1]], axis]
    return total


def _before(tree: Any, firsts: Ints) -> Ints:
    """The point before each one (N,) on the way from the first of its part; a first one's is itself."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import breadth_first_order

    edges = coo_array(tree)
    count = edges.shape[0]
    row = np.concatenate((edges.row, np.full(len(firsts), count)))  # a root above all parts: one walk
    column = np.concatenate((edges.col, firsts))
    rooted = coo_array((np.ones(len(row)), (row, column)), shape=(count + 1, count + 1)).tocsr()
    before: Ints = breadth_first_order(rooted, count, directed=False)[1][:count].astype(np.intp)
    before[firsts] = firsts
    return before


def _first_of_each(part: NDArray[np.int32]) -> Ints:
    firsts: Ints = np.unique(part, return_index=True)[1]
    return firsts


def _graph(weight: Array, index: Ints) -> Any:
    """The sparse matrix of the edges from each point to its neighbours (N, k)."""
    from scipy.sparse import csr_array

    count, k = index.shape
    return csr_array((weight.ravel(), index.ravel(), np.arange(0, count * k + 1, k) if k else np.zeros(count + 1, int)),
                     shape=(count, count))
