"""How far each cell is from the nearest with a surfel, against another program's distances."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import distance_transform_cdt

from jaart.core import empty_space
from jaart.core.bricks import BRICK, numbers_of
from jaart.core.kernels import table

SHAPES = [(7, 5, 9), (1, 1, 1), (1, 6, 1), (20, 31, 17), (40, 3, 300), (300, 2, 5)]


def chessboard(held: np.ndarray) -> np.ndarray:
    return distance_transform_cdt(~held, "chessboard") if held.any() else np.full(held.shape, 10_000)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("share", [0.0, 0.002, 0.02, 0.3])
def test_distances_are_the_chessboards(shape: tuple[int, int, int], share: float) -> None:
    held = np.random.default_rng(1).random(shape) < share
    empty = np.where(held, 0, 255).astype(np.uint8)
    table.fill_empty(empty)
    np.testing.assert_array_equal(empty, np.minimum(chessboard(held), 255))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("share", [0.0, 0.002, 0.02, 0.3])
@pytest.mark.parametrize("most", [1, 4, 40, 255])
@pytest.mark.parametrize("planes", [BRICK, 64])
def test_they_are_told_cell_by_cell_near_surfels_and_by_bricks_elsewhere(
        shape: tuple[int, int, int], share: float, most: int, planes: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(empty_space, "PLANES", planes)
    held = np.random.default_rng(1).random(shape) < share
    exact, cells = chessboard(held), np.indices(shape).reshape(3, -1).T
    made = empty_space.empty_space(np.argwhere(held).astype(np.int32), shape, most)
    told, exact = empty_space.distances(made, cells), exact[tuple(cells.T)]
    brick = numbers_of(shape, cells)[0]
    least = np.full(brick.max() + 1, 10_000)
    np.minimum.at(least, brick, exact)
    near = made.bricks[brick] >= 0
    np.testing.assert_array_equal(near, (least[brick] <= most) | (most == 255))
    np.testing.assert_array_equal(told[near], np.minimum(exact[near], 255))
    assert (told[~near] <= least[brick[~near]]).all()
    assert (told[~near] >= np.minimum(least[brick[~near]], 1000) - 3).all()
    assert (told[~near] > most).all()
    for halo in range(min(most, 3)):
        within = empty_space.bricks_within(made, halo)
        np.testing.assert_array_equal(within, least <= halo)
