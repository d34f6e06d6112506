"""Interface cells and gradients, against their definitions cell by cell."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from jaart.core.lattice import gradients, interface_cells

RNG = np.random.default_rng(4)
SHAPES = [(4, 5, 6), (1, 5, 4), (5, 1, 1), (1, 1, 1), (2, 2, 2)]


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
        assert np.array_equal(interface_cells(levels, neighbours, border), literal(levels, neighbours, border))


def test_the_border_of_a_full_lattice() -> None:
    levels = np.ones((4, 4, 4))
    assert not interface_cells(levels, border="open").any()
    assert interface_cells(levels, border="closed").sum() == 4**3 - 2**3


@pytest.mark.parametrize("shape", SHAPES)
def test_the_gradient_of_a_linear_field_is_exact(shape: tuple[int, int, int]) -> None:
    slope = np.array([0.25, -0.5, 2.0])
    x, y, z = np.indices(shape)
    expected = np.where(np.array(shape) > 1, slope, 0)
    assert np.array_equal(gradients(x * slope[0] + y * slope[1] + z * slope[2]), np.broadcast_to(expected, (*shape, 3)))


def test_closed_borders_see_nothing_outside() -> None:
    levels = RNG.uniform(size=(4, 3, 5))
    inner = gradients(np.pad(levels, 1))[1:-1, 1:-1, 1:-1]
    assert np.array_equal(gradients(levels, "closed"), inner)
    assert not gradients(np.ones((1, 1, 1)), "closed").any()


def test_open_borders_look_one_way() -> None:
    levels = np.zeros((3, 1, 1))
    levels[:, 0, 0] = 0.1, 0.4, 0.9
    assert gradients(levels)[:, 0, 0, 0] == pytest.approx([0.3, 0.4, 0.5], abs=1e-15)
    assert gradients(levels, "closed")[:, 0, 0, 0] == pytest.approx([0.2, 0.4, -0.2], abs=1e-15)


@pytest.mark.parametrize("border", ["open", "closed"])
def test_gradients_of_some_cells(border: str) -> None:
    levels = RNG.uniform(size=(4, 3, 5))
    cells = np.argwhere(RNG.uniform(size=levels.shape) < 0.3)
    assert np.array_equal(gradients(levels, border, cells), gradients(levels, border)[tuple(cells.T)])
