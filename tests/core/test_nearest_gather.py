"""The surfels nearest to a cell, gathered when asked for, against a list of all distances."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

from jaart.core import prepare
from jaart.core.cell_table import KNN_HALO, cell_table
from jaart.core.chosen import HALF_DIAGONAL, chosen
from jaart.core.empty_space import distances
from jaart.core.places import listed_near
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.surfels import Surfels

RNG = np.random.default_rng(7)
SHAPE = (9, 7, 11)


def surfels(cells: Any, offset: Any) -> Surfels:
    cells = np.array(cells, np.int32).reshape(-1, 3)
    return Surfels(cells, np.array(offset, float).reshape(-1, 3), np.tile((0.0, 0.0, 1.0), (len(cells), 1)))


def noise() -> Surfels:
    scene = Scene("noise", levels=RNG.uniform(0.05, 0.95, SHAPE), spacing=(1.0, 0.7, 0.4))
    return prepare.surfels(scene, Settings())


def sheet(offset: float) -> Surfels:
    """A plane of evenly spaced surfels, all of whose distances come in fours and more."""
    cells = [(i, j, 4) for i in range(9) for j in range(7)]
    return surfels(cells, [(0.0, 0.0, offset)] * len(cells))


MADE: dict[str, Surfels] = {
    "noise": noise(), "sheet": sheet(0.0), "leaning": sheet(0.375), "one": surfels([(4, 3, 5)], [(0.1, 0.2, -0.4)]),
    "two apart": surfels([(0, 0, 0), (8, 6, 10)], [(-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)]), "none": surfels([], []),
    "outside": surfels([(1, 1, 1), (2, 1, 1), (7, 5, 9)], [(-0.9, 0.7, 0.0), (0.8, 0.0, 0.6), (0.0, 1.2, 0.0)]),
}


def near_cells(found: Surfels, neighbourhood: str, k: int) -> tuple[np.ndarray, list[list[int]]]:
    """All cells, and the ids that are gathered for each."""
    values = chosen(Scene("levels", levels=np.zeros(SHAPE)), Settings(neighbourhood=neighbourhood, k=k))
    made = cell_table(found, SHAPE, values, k)
    cells = np.indices(SHAPE).reshape(3, -1).T
    first, ids, columns = listed_near(made.sites, cells)
    if len(found):
        asked = np.repeat(np.arange(len(cells)), np.diff(first))
        place = np.arange(len(ids)) - first[asked]
        size = np.diff(first)[asked]
        for axis in range(3):
            there = columns[6 * first[asked] + axis * size + place]
            assert np.array_equal(there, (found.cells[ids, axis] - cells[asked, axis]) + found.offset[ids, axis])
    away = distances(made.empty, cells)
    return cells, [ids[a:b].tolist() if d <= KNN_HALO else [-1] * (b - a)
                   for a, b, d in zip(first[:-1], first[1:], away, strict=True)]


def squares(found: Surfels, cell: np.ndarray) -> np.ndarray:
    apart = (found.cells - cell) + found.offset
    return apart[:, 0] * apart[:, 0] + apart[:, 1] * apart[:, 1] + apart[:, 2] * apart[:, 2]


@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize("k", [1, 3, 12, 60])
def test_the_nearest_and_of_equally_far_ones_the_first(name: str, k: int) -> None:
    found, some = MADE[name], 0
    for cell, ids in zip(*near_cells(found, "cell_knn", k), strict=True):
        away = np.abs(found.cells - cell).max(axis=1).min(initial=99)
        order = np.lexsort((np.arange(len(found)), squares(found, cell)))
        assert ids == (sorted(order[:k].tolist()) if away <= KNN_HALO else [])
        some += len(ids)
    assert (some > 0) == (len(found) > 0)


@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize("k", [1, 3, 12, 60])
def test_all_that_may_be_among_the_nearest_of_any_point(name: str, k: int) -> None:
    found, some = MADE[name], 0
    for cell, ids in zip(*near_cells(found, "knn", k), strict=True):
        away, apart = np.abs(found.cells - cell).max(axis=1).min(initial=99), squares(found, cell)
        if away > KNN_HALO:
            assert ids == []
            continue
        reach = math.sqrt(np.sort(apart)[min(k, len(found)) - 1]) * (1 + 1e-12) + 2 * HALF_DIAGONAL
        assert ids == np.flatnonzero(apart <= reach * reach).tolist()
        some += len(ids)
    assert (some > 0) == (len(found) > 0)


@pytest.mark.parametrize("k", [1, 5, 12, 60])
def test_those_that_another_program_finds(k: int) -> None:
    """Where no two distances are equal."""
    found = MADE["noise"]
    tree = cKDTree(found.points)
    (cells, nearest), (_, reached) = (near_cells(found, one, k) for one in ("cell_knn", "knn"))
    near = [i for i, ids in enumerate(nearest) if ids]
    middles = cells[near] + 0.5
    distance, expected = tree.query(middles, list(range(1, k + 1)))
    lists = tree.query_ball_point(middles, distance[:, -1] * (1 + 1e-12) + 2 * HALF_DIAGONAL, return_sorted=True)
    assert [nearest[i] for i in near] == np.sort(expected, axis=1).tolist()
    assert [reached[i] for i in near] == lists.tolist()
    assert len(near) > 200
