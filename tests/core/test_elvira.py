"""Normals that match the levels: exact on faces up to their edges, harmless on round surfaces."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core import plic
from jaart.core.elvira import elvira
from jaart.core.gradients import smooth
from jaart.core.lattice import interface_cells
from jaart.core.model import fill
from jaart.core.scene import Model
from jaart.core.shapes import Sphere

RNG = np.random.default_rng(12)


def slab(normal: np.ndarray, at: float, n: int = 9) -> np.ndarray:
    """Exact levels below the plane <normal, x> = at."""
    centres = (np.moveaxis(np.indices((n, n, n)), 0, -1) + 0.5).reshape(-1, 3)
    return plic.volume(at - centres @ normal, np.broadcast_to(normal, centres.shape)).reshape(n, n, n)


def degrees(one: np.ndarray, two: np.ndarray) -> np.ndarray:
    """Angles between the directions of vectors (N, 3)."""
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(one, two), axis=1), (one * two).sum(axis=1)))


def block(low: np.ndarray, high: np.ndarray, n: int) -> np.ndarray:
    """Exact levels of a box."""
    edge = np.arange(n)
    covered = [np.clip(np.minimum(edge + 1, b) - np.maximum(edge, a), 0, 1) for a, b in zip(low, high, strict=True)]
    return np.einsum("i,j,k->ijk", *covered)


def test_planes_are_met_exactly_where_a_side_shows_them() -> None:
    exact = []
    for _ in range(20):
        normal = RNG.normal(size=3)
        normal /= np.linalg.norm(normal)
        levels = slab(normal, normal.sum() * 4.5 + RNG.uniform(-0.5, 0.5))
        cells = np.argwhere(interface_cells(levels))
        cells = cells[((cells > 0) & (cells < 8)).all(axis=1)]
        error = degrees(-elvira(levels, cells), np.broadcast_to(normal, (len(cells), 3)))
        assert error.max() < 8
        exact += list(error < 1e-6)
    assert np.mean(exact) > 0.6


@pytest.mark.parametrize("low", [3.2, 3.0, 3.77])
def test_a_face_keeps_its_normal_up_to_the_edge(low: float) -> None:
    corners = np.full(3, low), np.array([8.5, 9.25, 7.4])
    levels = block(*corners, 12)
    cells = np.argwhere((levels > 0) & (levels < 1))
    faces = [(cells[:, a] < at) & (cells[:, a] + 1 > at) for a in range(3) for at in (corners[0][a], corners[1][a])]
    single = np.sum(faces, axis=0) == 1
    normal = (np.array(faces).T @ np.repeat(np.eye(3), 2, axis=0) * np.where(cells < 6, -1, 1))[single]
    assert single.sum() > 50
    assert degrees(-elvira(levels, cells)[single], normal).max() < 1e-6
    assert degrees(-smooth(levels, cells)[single], normal).max() > 30


@pytest.mark.parametrize(("raster", "most"), [(16, 0.7), (32, 0.3), (48, 0.1)])
def test_a_sphere_is_hardly_touched(raster: int, most: float) -> None:
    sphere = Sphere((0.5, 0.52, 0.49), 0.25)
    levels = fill(Model((sphere,), raster), raster, "corners", 20)
    cells = np.argwhere(interface_cells(levels))
    found, smoothed = elvira(levels, cells), smooth(levels, cells)
    outward = cells + 0.5 - np.array(sphere.centre) * raster
    assert degrees(-found, outward).mean() < degrees(-smoothed, outward).mean() + most


def test_what_is_outside_is_no_evidence() -> None:
    """At an open border only sides inside the lattice are looked at; a closed one is a lattice with a margin."""
    levels = block(np.array([2.0, -1, -1]), np.array([9.0, 4.5, 9.0]), 8)
    cells = np.argwhere(interface_cells(levels))
    assert degrees(-elvira(levels, cells), np.eye(3)[np.where(cells[:, 1] == 4, 1, 0)] *
                   np.where(cells[:, [1]] == 4, 1, -1))[cells[:, 0] != 2].max() < 1e-6
    closed = elvira(levels, cells, "closed")
    assert np.allclose(closed, elvira(np.pad(levels, 5), cells + 5), rtol=0, atol=1e-15)


def test_axes_exchanged_and_mirrored() -> None:
    levels = block(np.array([2.3, 1.6, 2.9]), np.array([6.1, 5.5, 5.8]), 8)
    cells = np.argwhere((levels > 0) & (levels < 1))
    one = elvira(levels, cells)
    turned = elvira(np.ascontiguousarray(levels.transpose(2, 0, 1)), cells[:, [2, 0, 1]])
    mirrored = elvira(levels[:, ::-1], cells * [1, -1, 1] + [0, 7, 0])
    assert degrees(turned, one[:, [2, 0, 1]]).max() < 1e-6
    assert degrees(mirrored, one * [1, -1, 1]).max() < 1e-6


def test_cells_without_a_gradient_have_none() -> None:
    alone = np.zeros((5, 5, 5))
    alone[2, 2, 2] = 0.5
    assert not elvira(alone, np.array([[2, 2, 2]])).any()
    assert elvira(alone, np.empty((0, 3), int)).shape == (0, 3)
    assert not elvira(np.full((1, 1, 1), 0.5), np.zeros((1, 3), int)).any()
