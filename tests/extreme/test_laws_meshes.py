"""Metamorphic laws of meshes: their vertices obey them; which way a polygon is cut into triangles need not.

A cell's polygon of four or more corners is cut along diagonals, and the image of a cut need not be the cut of the
image. So an image's vertices are the images of the vertices, while a hit may move by what lies between two cuts.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jaart.core import prepare
from jaart.core.mesh_tracer import MeshTracer
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from tests.extreme import law_scenes as law
from tests.extreme.law_scenes import SEEDS, Array, Setup
from tests.extreme.test_laws import IMAGES, Image, lattice_image

#: Wendland's weight, which no neighbourhood cuts off: samples on the faces of cells do not hang on whose they are.
METHODS = [Settings(method="fill_level"), Settings(method="isosurface", weight="wendland"),
           Settings(method="isosurface", weight="wendland", energy="mahalanobis", subdivide=1)]
every_method = pytest.mark.parametrize("tried", METHODS, ids=["fill_level", "tangent", "mahalanobis"])


def vertices(scene: Scene, tried: Settings) -> Array:
    """The corners (V, 3) of a scene's mesh."""
    tracer = prepare.prepared(scene, tried).tracer
    assert isinstance(tracer, MeshTracer)
    return tracer.mesh.vertices


@every_method
@settings(max_examples=5)
@given(SEEDS, st.tuples(*[st.integers(-2, 2)] * 3))
def test_a_moved_lattice_has_the_mesh_moved_and_its_hits(tried: Settings, seed: int, by: tuple[int, int, int]) -> None:
    """Vertices are kept in the lattice's frame, where each is rounded to an ulp of 16 cells or so."""
    setup = law.lattice(seed)
    assert setup.scene.levels is not None
    other = Setup(Scene("rolled", levels=np.roll(setup.scene.levels, by, (0, 1, 2))),
                  (setup.rays[0] + by, setup.rays[1]))
    one, two = law.hits(setup, tried), law.hits(other, tried)
    assert np.array_equal(one.hit, two.hit) and one.hit.sum() > 15
    cosine = np.abs((one.normal * one.direction).sum(axis=1))[one.hit]
    assert (np.abs(one.t - two.t)[one.hit] * np.maximum(cosine, 0.05) <= 1e-13).all()
    assert np.abs(vertices(setup.scene, tried) + by - vertices(other.scene, tried)).max() <= 2 * np.spacing(32.0)


@every_method
@settings(max_examples=5)
@given(SEEDS, IMAGES)
def test_an_image_of_a_lattice_has_the_images_of_the_vertices(tried: Settings, seed: int, image: Image) -> None:
    from scipy.spatial import cKDTree

    setup = law.lattice(seed)
    corners = vertices(setup.scene, tried)[:, image[0]]
    size = np.array(law.SHAPE)[list(image[0])]
    images = np.where(np.array(image[1]) < 0, size - corners, corners)
    found = vertices(lattice_image(setup, image).scene, tried)
    assert len(found) == len(images) > 100
    assert cKDTree(found).query(images)[0].max() <= 1e-12
