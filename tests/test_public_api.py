"""The names that scripts and notebooks use, tried on the real thing."""

import numpy as np
import pytest

import jaart


def test_every_public_name_is_there():
    assert {getattr(jaart, name) is not None for name in jaart.__all__} == {True}
    assert set(jaart.__all__) <= set(dir(jaart))


def test_an_unknown_name_is_refused():
    with pytest.raises(AttributeError, match="no attribute 'rendr'"):
        getattr(jaart, "rendr")  # noqa: B009  attribute access is what is tested


def test_from_a_scene_to_hits_a_trace_and_errors():
    scene = jaart.load("standard")
    settings = jaart.Settings(h=0.8)
    assert settings.h == jaart.preset("thesis").h
    hits = jaart.render(scene, settings, size=(32, 32))
    ray = int(np.flatnonzero(hits.hit)[0])
    trace = jaart.trace(scene, settings, hits.origin[ray], hits.direction[ray])
    assert trace.t == hits.t[ray]
    assert trace.point.tolist() == hits.point[ray].tolist()
    assert 0 < jaart.quality(hits, scene).delta < 1


def test_a_picture_and_a_mesh():
    scene, settings = jaart.load("standard"), jaart.preset("thesis")
    hits, colours = jaart.picture(scene, settings, size=(24, 16))
    assert colours.shape == (16, 24, 3) and len(hits) == 24 * 16
    assert jaart.notes(scene, settings) == ()
    mesh = jaart.isosurface(scene, settings, "fill_level")
    assert len(mesh) > 100 and mesh.vertices.min() >= 0 and mesh.vertices.max() <= 16


def test_errors_are_of_one_family():
    assert isinstance(jaart.errors.FileError("a.npz", "is missing"), jaart.errors.JaartError)
    with pytest.raises(jaart.errors.FileError, match=r"nowhere\.npz"):
        jaart.load("nowhere.npz")


def test_a_camera_sees_the_scene_from_where_it_is_put():
    camera = jaart.Camera(eye=(8, -30, 8), target=(8, 8, 8), fov=40)
    hits = jaart.render(jaart.load("standard"), camera=camera, size=(24, 24))
    assert hits.hit.any()
    assert np.nanmin(hits.point[:, 1]) > 0
