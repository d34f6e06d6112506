"""Gradients of fill levels: exact on linear fields up to the border, and as defined, sum by sum."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core.gradients import central, gradients, smooth, youngs

RNG = np.random.default_rng(4)
SHAPES = [(4, 5, 6), (1, 5, 4), (5, 1, 1), (1, 1, 1), (2, 2, 2)]
KINDS = ["central", "youngs", "smooth"]
BORDERS = ["open", "closed"]


def every_cell(levels: np.ndarray) -> np.ndarray:
    return np.argwhere(np.ones(levels.shape, dtype=bool))


def literal(levels: np.ndarray, cell: tuple[int, ...], border: str, weight: dict[tuple[int, ...], float],
            axis: int) -> float:
    """Sum over offsets of a weight times the difference there: outside, 0 where closed, else the nearest cell's."""
    if border == "closed":
        levels, cell = np.pad(levels, 9), tuple(np.add(cell, 9))
    total = 0.0
    for offset, w in weight.items():
        place = np.clip(np.add(cell, offset), 0, np.array(levels.shape) - 1)
        row = np.moveaxis(levels, axis, 2)[tuple(np.delete(place, axis))]
        held = [i for i in (place[axis] - 1, place[axis] + 1) if 0 <= i < len(row)]
        low, high = (held[0], held[1]) if len(held) == 2 else sorted((held[0], place[axis]))
        total += w * (row[high] - row[low]) / (high - low)
    return total


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("kind", KINDS)
def test_the_gradient_of_a_linear_field_is_exact(shape: tuple[int, int, int], kind: str) -> None:
    slope = np.array([0.25, -0.5, 2.0])
    x, y, z = np.indices(shape)
    levels = x * slope[0] + y * slope[1] + z * slope[2]
    expected = np.where(np.array(shape) > 1, slope, 0)
    for smoothing in (0.1, 0.8, 1.7):
        found = gradients(levels, every_cell(levels), "open", kind, smoothing)
        assert np.allclose(found, expected, rtol=0 if kind != "smooth" else 4e-15, atol=0)


@pytest.mark.parametrize("border", BORDERS)
def test_youngs_sum_by_sum(border: str) -> None:
    levels = RNG.uniform(size=(3, 4, 5))
    cells = every_cell(levels)
    found = youngs(levels, cells, border)
    for axis in range(3):
        weight = {o: 0.25 * 0.5 ** np.abs(o).sum() for o in itertools.product((-1, 0, 1), repeat=3) if o[axis] == 0}
        assert sum(weight.values()) == 1
        expected = [literal(levels, tuple(cell), border, weight, axis) for cell in cells]
        assert found[:, axis] == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("border", BORDERS)
@pytest.mark.parametrize("sigma", [0.3, 0.5])
def test_smooth_sum_by_sum(border: str, sigma: float) -> None:
    levels = RNG.uniform(size=(3, 4, 3))
    reach = int(4 * sigma + 0.5)
    line = {i: math.exp(-i * i / (2 * sigma * sigma)) for i in range(-reach, reach + 1)}
    scale = sum(line.values()) ** 3
    weight = {(i, j, k): line[i] * line[j] * line[k] / scale for i, j, k in itertools.product(line, repeat=3)}
    cells = every_cell(levels)[::5]
    found = smooth(levels, cells, border, sigma)
    for axis in range(3):
        expected = [literal(levels, tuple(cell), border, weight, axis) for cell in cells]
        assert found[:, axis] == pytest.approx(expected, abs=2e-15)


def test_without_smoothing_it_is_the_central_difference() -> None:
    levels = RNG.uniform(size=(4, 5, 6))
    cells = every_cell(levels)
    for border, sigma in itertools.product(BORDERS, (1e-200, 0.01, 0.12)):
        assert np.allclose(smooth(levels, cells, border, sigma), central(levels, cells, border), rtol=0, atol=1e-15)


@pytest.mark.parametrize("kind", KINDS)
def test_closed_borders_see_nothing_outside(kind: str) -> None:
    levels = RNG.uniform(size=(4, 3, 5))
    cells = every_cell(levels)
    far = gradients(np.pad(levels, 5), cells + 5, "open", kind, 0.8)
    assert np.allclose(gradients(levels, cells, "closed", kind, 0.8), far, rtol=0, atol=1e-15)
    assert not gradients(np.ones((1, 1, 1)), np.zeros((1, 3), int), "closed", kind).any()


def test_open_borders_look_one_way() -> None:
    levels = np.zeros((3, 1, 1))
    levels[:, 0, 0] = 0.1, 0.4, 0.9
    for difference in (central, youngs):
        assert difference(levels, every_cell(levels))[:, 0] == pytest.approx([0.3, 0.4, 0.5], abs=1e-15)
        closed = difference(levels, every_cell(levels), "closed")[:, 0]
        assert closed == pytest.approx(np.array([0.2, 0.4, -0.2]) / (1 if difference is central else 4), abs=1e-15)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("axis", range(3))
def test_a_flat_surface_has_its_exact_normal(kind: str, axis: int) -> None:
    """Not a bit of the axes along it, or the centre of a full cell's polygon would jump to a corner."""
    levels = np.moveaxis(np.broadcast_to([1, 1, 1, 0.1, 0, 0, 0], (9, 8, 7)), 2, axis)
    found = gradients(levels, every_cell(levels), "open", kind, 0.8)
    assert not np.delete(found, axis, axis=1).any() and (found[:, axis] <= 0).all()


@pytest.mark.parametrize("kind", KINDS)
@given(levels=st.lists(st.sampled_from([0.0, 0.1, 0.3, 0.7, 1.0]), min_size=27, max_size=27),
       border=st.sampled_from(BORDERS), axes=st.permutations(range(3)))
def test_axes_exchanged_and_mirrored(kind: str, levels: list[float], border: str, axes: list[int]) -> None:
    field = np.reshape(levels, (3, 3, 3))
    one = gradients(field, every_cell(field), border, kind, 0.8).reshape(3, 3, 3, 3)
    turned = gradients(field.transpose(axes), every_cell(field), border, kind, 0.8).reshape(3, 3, 3, 3)
    assert np.allclose(turned, one.transpose(*axes, 3)[..., axes], rtol=0, atol=1e-14)
    mirrored = gradients(field[::-1], every_cell(field), border, kind, 0.8).reshape(3, 3, 3, 3)
    assert np.allclose(mirrored, one[::-1] * [-1, 1, 1], rtol=0, atol=1e-14)


@pytest.mark.parametrize("kind", KINDS)
def test_gradients_of_no_cells(kind: str) -> None:
    assert gradients(np.ones((3, 3, 3)), np.empty((0, 3), int), "open", kind).shape == (0, 3)
