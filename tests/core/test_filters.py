"""Filters on fill levels, against their definitions cell by cell."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from jaart.core.filters import filtered, gauss, median, thesis
from jaart.core.settings import Settings

RNG = np.random.default_rng(8)
SHAPES = [(4, 5, 6), (1, 5, 4), (5, 1, 1), (1, 1, 1)]
BLOCK = list(itertools.product((-1, 0, 1), repeat=3))


def block(levels: np.ndarray, cell: tuple[int, ...], border: str) -> list[float]:
    """The 27 levels around a cell: outside, the nearest one or 0."""
    held = []
    for offset in BLOCK:
        place = np.add(cell, offset)
        nearest = np.clip(place, 0, np.array(levels.shape) - 1)
        outside = border == "closed" and not np.array_equal(place, nearest)
        held.append(0.0 if outside else float(levels[tuple(nearest)]))
    return held


def levels_of(shape: tuple[int, int, int]) -> np.ndarray:
    return RNG.choice([0, 0.05, 0.1, 0.2, 0.25, 0.3, 0.8, 1], size=shape)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("border", ["open", "closed"])
def test_median_and_gauss(shape: tuple[int, int, int], border: str) -> None:
    levels = levels_of(shape)
    weight = [0.5 ** (3 + np.abs(o).sum()) for o in BLOCK]
    assert sum(weight) == 1
    for cell in np.ndindex(shape):
        held = block(levels, cell, border)
        assert median(levels, border)[cell] == sorted(held)[13]
        assert gauss(levels, border)[cell] == pytest.approx(np.dot(held, weight), abs=1e-15)


@pytest.mark.parametrize("shape", SHAPES)
def test_the_thesis_in_two_passes(shape: tuple[int, int, int]) -> None:
    levels = levels_of(shape)
    first = {cell: levels[cell] if levels[cell] >= 0.1 else 0.0 for cell in np.ndindex(shape)}
    for cell in np.ndindex(shape):
        beside = [first.get(tuple(np.add(cell, o)), 0.0) for o in BLOCK if np.abs(o).sum() == 1]
        assert thesis(levels)[cell] == (first[cell] if max(beside) > 0.25 else 0)


def test_thresholds_of_the_thesis() -> None:
    levels = np.zeros((4, 1, 1))
    pairs = {(0.1, 0.26): (0.1, 0), (0.1, 0.25): (0, 0), (0.09, 0.26): (0, 0), (0.3, 0.3): (0.3, 0.3)}
    for (first, second), kept in pairs.items():
        levels[:2, 0, 0] = first, second
        assert tuple(thesis(levels)[:2, 0, 0]) == kept
    alone = np.zeros((3, 3, 3))
    alone[1, 1, 1] = 1
    assert not thesis(alone).any()


def test_the_setting_chooses() -> None:
    levels = levels_of((4, 5, 6))
    assert filtered(levels, Settings(filter="none")) is levels
    assert np.array_equal(filtered(levels, Settings(filter="thesis")), thesis(levels))
    for border in ("open", "closed"):
        assert np.array_equal(filtered(levels, Settings(filter="median", border=border)), median(levels, border))
        assert np.array_equal(filtered(levels, Settings(filter="gauss", border=border)), gauss(levels, border))


@pytest.mark.parametrize("name", ["thesis", "median", "gauss"])
def test_levels_stay_levels(name: str) -> None:
    levels = RNG.uniform(size=(6, 5, 4)).round(1)
    levels.flags.writeable = False
    found = filtered(levels, Settings(filter=name))
    assert found.shape == levels.shape and found.dtype == np.float64 and not found.flags.writeable
    assert found.min() >= 0 and found.max() <= 1
    assert np.array_equal(filtered(np.ones((3, 4, 5)), Settings(filter=name)), np.ones((3, 4, 5)))
    assert not filtered(np.zeros((3, 4, 5)), Settings(filter=name)).any()
