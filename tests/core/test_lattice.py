"""Interface cells, against their definition cell by cell."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from jaart.core.lattice import interface_cells

RNG = np.random.default_rng(4)
SHAPES = [(4, 5, 6), (18, 4, 3), (9, 2, 3), (1, 5, 4), (5, 1, 1), (1, 1, 1), (2, 2, 2)]


def literal(levels: np.ndarray, neighbours: str, border: str) -> np.ndarray:
    """The definition: partly full, or full with an empty cell beside it."""
    offsets = [o for o in itertools.product((-1, 0, 1), repeat=3)
               if any(o) and (neighbours == "26" or np.abs(o).sum() == 1)]
    found = np.zeros(levels.shape, dtype=bool)
    for cell in np.ndindex(levels.shape):
        beside = [tuple(np.add(cell, o)) for o in offsets]
        held = [n for n in beside if all(0 <= i < s for i, s in zip(n, levels.shape, strict=True))]
        empty = any(levels[n] == 0 for n in held) or (border == "closed" and len(held) < len(beside))
        found[cell] = 0 < levels[cell] < 1 or (levels[cell] == 1 and empty)
    return found


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("neighbours", ["6", "26"])
@pytest.mark.parametrize("border", ["open", "closed"])
def test_interface_cells(shape: tuple[int, int, int], neighbours: str, border: str) -> None:
    for full in (0.5, 0.9, 1.0):
        levels = RNG.choice([0.0, 0.5, 1.0], p=[(1 - full) * 0.8, (1 - full) * 0.2, full], size=shape)
        found = interface_cells(levels, neighbours, border)
        assert np.array_equal(found, np.argwhere(literal(levels, neighbours, border)))


def test_the_border_of_a_full_lattice() -> None:
    levels = np.ones((4, 4, 4))
    assert not len(interface_cells(levels, border="open"))
    assert len(interface_cells(levels, border="closed")) == 4**3 - 2**3
