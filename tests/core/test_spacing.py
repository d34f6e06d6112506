"""Lattices whose cells are no cubes: a surface lies where it is, whatever the cells are like."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core import extents, plic, prepare
from jaart.core.camera import Camera
from jaart.core.render import render
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings
from jaart.core.surfels import stretched_shape

#: Physical edges of a cell, and how many cells there are.
SPACING, SHAPE = (0.5, 1.0, 0.25), (24, 12, 60)
#: A plane through the lattice's middle, in physical units; its normal out of the fluid.
NORMAL = np.array((0.3, -0.4, 0.866)) / np.linalg.norm((0.3, -0.4, 0.866))
MIDDLE = np.array(SHAPE) * SPACING / 2


def tilted() -> Scene:
    """Fill levels of the half space below the plane, exact in every cell."""
    across = NORMAL * SPACING
    length = np.linalg.norm(across)
    centres = (np.stack(np.meshgrid(*map(np.arange, SHAPE), indexing="ij"), axis=-1) + 0.5) * SPACING
    distance = ((MIDDLE - centres) @ NORMAL).ravel() / length
    return Scene("tilted", levels=filled(distance, across / length).reshape(SHAPE), spacing=SPACING)


def filled(distance: Array, normal: Array) -> Array:
    """Volumes below planes at such distances from the centres of unit cubes: `plic.distance` undone by halving."""
    low, high = np.zeros(len(distance)), np.ones(len(distance))
    half = np.abs(normal).sum() / 2
    across = np.tile(normal, (len(distance), 1))
    for _ in range(60):
        middle = (low + high) / 2
        below = plic.distance(np.clip(middle, 1e-300, 1 - 1e-16), across) < distance
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.where(distance <= -half, 0.0, np.where(distance >= half, 1.0, high))


def test_lengths_count_in_the_longest_edge() -> None:
    scene = tilted()
    assert extents.edges(scene) == (0.5, 1.0, 0.25)
    assert extents.extent(scene, Settings()) == (12, 12, 15)
    assert stretched_shape(SHAPE, extents.edges(scene)) == (12, 12, 15)


@pytest.mark.parametrize("method", ["tangent", "polynomial", "fill_level"])
def test_an_oblique_plane_is_met_where_it_is(method: str) -> None:
    scene = tilted()
    settings = Settings(method=method, placement="exact")
    low, high = extents.bounds(scene, settings)
    hits = render(scene, settings, Camera.fit((low, high), direction=(0.2, -0.5, 1.0)), size=(48, 48))
    inner = hits.hit & ((hits.point > low + 2.5) & (hits.point < high - 2.5)).all(axis=1)
    assert inner.sum() > 100
    away = (hits.point[inner] - MIDDLE / max(SPACING)) @ NORMAL
    bent = np.linalg.norm(np.cross(hits.normal[inner], NORMAL), axis=1)
    bounds = {"tangent": (0.03, 0.04), "polynomial": (0.03, 0.04), "fill_level": (0.05, 0.2)}[method]
    assert np.abs(away).max() < bounds[0]
    assert bent.max() < bounds[1]
    assert (hits.normal[inner] @ NORMAL > 0).all()


def test_a_lattice_of_cubes_is_what_it_was() -> None:
    levels = tilted().levels
    assert levels is not None
    cubes, large = Scene("a", levels=levels), Scene("b", levels=levels, spacing=(3.0, 3.0, 3.0))
    one, other = (render(s, size=(16, 16)) for s in (cubes, large))
    np.testing.assert_array_equal(one.t, other.t)
    assert prepare.cells(cubes, Settings(), prepare.prepared(cubes, Settings()).values).empty.shape == SHAPE
