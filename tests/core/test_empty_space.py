"""How far each cell is from the nearest with a surfel, against another program's distances."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import distance_transform_cdt

from jaart.core.kernels import table


@pytest.mark.parametrize("shape", [(7, 5, 9), (1, 1, 1), (1, 6, 1), (20, 31, 17), (40, 3, 300)])
@pytest.mark.parametrize("share", [0.0, 0.002, 0.02, 0.3])
def test_distances_are_the_chessboards(shape: tuple[int, int, int], share: float) -> None:
    held = np.random.default_rng(1).random(shape) < share
    empty = np.where(held, 0, 255).astype(np.uint8)
    table.fill_empty(empty)
    expected = np.minimum(distance_transform_cdt(~held, "chessboard"), 255) if held.any() else np.full(shape, 255)
    np.testing.assert_array_equal(empty, expected)
