"""Nearest neighbours out of a grid, where points lie evenly, are those that a tree finds."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from jaart.core import cloud
from jaart.core.nearest import even_cells, in_tree, nearest_others
from jaart.core.samples import bumpy_sphere, fibonacci
from jaart.core.scene import Scene

RNG = np.random.default_rng(9)
LAYERS = np.stack(np.meshgrid(*(np.arange(n, dtype=float) for n in (40, 30, 2))), axis=-1).reshape(-1, 3)
EVEN = {
    "layers": LAYERS,
    "sphere": fibonacci(3000),
    "random sphere": fibonacci(5000)[RNG.integers(0, 5000, 4000)] + RNG.normal(size=(4000, 3)) * 1e-3,
    "volume": RNG.random((3000, 3)),
    "far away": fibonacci(3000) + 1e9,
    "twice": np.repeat(fibonacci(1500), 2, axis=0),
}
UNEVEN = {
    "cluster": np.concatenate([RNG.normal(size=(3000, 3)) * 1e-3, RNG.normal(size=(300, 3))]),
    "outlier": np.concatenate([fibonacci(3000), [[1e6, 0.0, 0.0]]]),
    "one place": np.zeros((2000, 3)),
    "few": fibonacci(50),
}


@pytest.mark.parametrize("name", [*EVEN, *UNEVEN])
@pytest.mark.parametrize("k", [1, 6, 20])
def test_neighbours_are_those_of_a_tree(name: str, k: int) -> None:
    points = (EVEN | UNEVEN)[name]
    distance, index = nearest_others(points, k)
    expected, which = np.empty((len(points), k)), np.empty((len(points), k), np.intp)
    in_tree(cKDTree(points), points, None, expected, which)
    assert np.array_equal(distance, expected)
    assert (index != np.arange(len(points))[:, None]).all()
    assert all(len(set(row)) == k for row in index.tolist())
    away = points[index] - points[:, None]
    assert np.allclose(np.sqrt((away * away).sum(axis=2)), distance, rtol=1e-12, atol=0)


@pytest.mark.parametrize("name", EVEN)
def test_even_points_are_put_into_a_grid(name: str) -> None:
    cells = even_cells(EVEN[name], 6)
    assert cells is not None and cells.first[-1] == len(cells.points) == len(EVEN[name])
    assert np.array_equal(EVEN[name][cells.order], cells.points)


@pytest.mark.parametrize("name", ["cluster", "outlier", "one place"])
def test_uneven_points_are_left_to_a_tree(name: str) -> None:
    assert even_cells(UNEVEN[name], 6) is None


def test_no_tree_is_made_for_an_even_cloud() -> None:
    even, uneven = bumpy_sphere(3000), Scene("uneven", points=UNEVEN["cluster"])
    for scene in (even, uneven):
        cloud.nearest(scene, 6)
    assert "kd_tree" not in even._kept and "kd_tree" in uneven._kept
