"""Placements: their formulas solved back, their limits, and how far each is from the exact plane."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core import plic
from jaart.core.placements import ALONG_NORMAL, PLACEMENTS, box, exact, interpolated, offsets, sphere, sphere_half

RNG = np.random.default_rng(9)
NORMAL = RNG.normal(size=(300, 3))
NORMAL /= np.linalg.norm(NORMAL, axis=1, keepdims=True)
TO_BOUNDARY = 0.5 / np.abs(NORMAL).max(axis=1)
DIAGONAL = np.full((1, 3), 1 / np.sqrt(3))
LEVELS = [1e-300, 1e-12, 0.02, 1 / 6, 0.3, 0.5, 0.7, 5 / 6, 0.98, 1 - 1e-12, 1.0]


def every(level: float) -> np.ndarray:
    return np.full(len(NORMAL), level)


@pytest.mark.parametrize("level", LEVELS)
def test_the_cap_has_its_share_of_the_ball(level: float) -> None:
    for v, radius in ((sphere(every(level), NORMAL), TO_BOUNDARY), (sphere_half(every(level), NORMAL), 0.5)):
        height = v + radius
        cap, ball = np.pi * height**2 * (3 * radius - height) / 3, 4 / 3 * np.pi * radius**3
        assert np.allclose(cap / ball, level, rtol=0, atol=1e-15)


@given(level=st.floats(1e-300, 1e-3))
def test_the_smallest_cap(level: float) -> None:
    """s²(3 - 2s) = l for s = H/2r: an s of 1e-8 is still told to a bit of the ball's radius."""
    s = np.sqrt(level / 3)
    for _ in range(60):
        s = np.sqrt(level / (3 - 2 * s))
    v = sphere_half(np.array([level]), DIAGONAL)
    assert v == pytest.approx(s - 0.5, abs=3e-16)


@pytest.mark.parametrize("level", LEVELS)
def test_interpolated_between_two_exact_maps(level: float) -> None:
    diagonal = exact(np.array([level]), DIAGONAL)
    assert interpolated(np.array([level]), DIAGONAL) == pytest.approx(diagonal, abs=1e-15)
    assert interpolated(np.array([level]), np.eye(3)[:1]) == pytest.approx(level - 0.5, abs=1e-16)
    share = (TO_BOUNDARY - 0.5) / (np.sqrt(3) / 2 - 0.5)
    expected = level - 0.5 + share * (diagonal - level + 0.5)
    assert np.allclose(interpolated(every(level), NORMAL), expected, rtol=0, atol=1e-15)


def test_the_diagonal_as_the_thesis_cuts_it() -> None:
    """V(s) = (√3/2)s³, then less the three corners that stick out, then by symmetry [T figure 3.7]."""
    level = np.linspace(0, 1, 401)
    s = interpolated(level, np.repeat(DIAGONAL, 401, axis=0)) + np.sqrt(3) / 2
    below = np.minimum(s, np.sqrt(3) - s)
    volume = np.sqrt(3) / 2 * (below**3 - 3 * np.maximum(below - 1 / np.sqrt(3), 0) ** 3)
    assert np.allclose(np.where(s > np.sqrt(3) / 2, 1 - volume, volume), level, rtol=0, atol=1e-15)


@pytest.mark.parametrize("name", ["box", "sphere", "interpolated"])
def test_placements_reach_the_cells_faces(name: str) -> None:
    largest, row = np.abs(NORMAL).argmax(axis=1), np.arange(len(NORMAL))
    for level, at in ((0.0, -0.5), (0.5, 0.0), (1.0, 0.5)):
        offset = offsets(name, every(level), NORMAL)
        assert np.allclose(offset[row, largest] * np.sign(NORMAL[row, largest]), at, rtol=0, atol=1e-15)
        assert (np.abs(offset) <= 0.5 + 1e-15).all()


@pytest.mark.parametrize("name", PLACEMENTS)
def test_laws_of_every_placement(name: str) -> None:
    """Fuller is farther, empty the mirror of full, and a full cell has a point: on its face where that is aligned."""
    rising = [(offsets(name, every(level), NORMAL) * NORMAL).sum(axis=1) for level in LEVELS]
    assert (np.diff(rising, axis=0) > -1e-15).all()
    assert np.allclose(offsets(name, every(0.25), NORMAL), -offsets(name, every(0.75), NORMAL), rtol=0, atol=1e-15)
    assert np.isfinite(offsets(name, every(1.0), NORMAL)).all()
    for axis in range(3):
        full = offsets(name, np.ones(1), np.eye(3)[axis:axis + 1])[0]
        assert full == pytest.approx(0.5 * np.eye(3)[axis], abs=1e-16)


def test_the_exact_ones_lie_on_one_plane() -> None:
    for level in LEVELS:
        v = exact(every(level), NORMAL)
        assert np.allclose(plic.volume(v, NORMAL), level, rtol=0, atol=1e-15)
        for name in ("exact", "exact_centroid"):
            assert np.allclose((offsets(name, every(level), NORMAL) * NORMAL).sum(axis=1), v, rtol=0, atol=1e-15)
        assert (np.abs(offsets("exact_centroid", every(level), NORMAL)) <= 0.5).all()


@pytest.mark.parametrize(("name", "most"), [("box", 0.314), ("sphere", 0.210), ("sphere_half", 0.367),
                                            ("interpolated", 0.210)])
def test_how_far_the_thesis_is_from_the_exact_plane(name: str, most: float) -> None:
    """The largest error over normals and levels is known; it is reached, and not passed."""
    angle = np.linspace(0, 1, 41)
    normal = np.array([(a, b, 1.0) for a in angle for b in angle if a <= b])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    level = np.linspace(0, 1, 101)
    pairs = np.repeat(level, len(normal)), np.tile(normal, (len(level), 1))
    error = np.abs(ALONG_NORMAL[name](*pairs) - exact(*pairs)).max()
    assert most - 0.004 < error < most + 0.001


def test_box_is_linear_in_the_level() -> None:
    assert np.allclose(box(every(0.75), NORMAL), TO_BOUNDARY / 2, rtol=0, atol=1e-16)
