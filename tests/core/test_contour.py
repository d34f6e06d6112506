"""Meshes of levels: closed, turned outwards, normals from the gradient; nothing where nothing is known."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from jaart.core.contour import Mesh, contour

CENTRE, RADIUS = np.array([9.3, 8.6, 10.1]), 6.2


def ball(size: int = 20) -> np.ndarray:
    """The distance from a point, on a grid."""
    return np.linalg.norm(np.stack(np.indices((size,) * 3), axis=-1) - CENTRE, axis=-1)


def edges(mesh: Mesh) -> Counter[tuple[int, int]]:
    """How often each directed edge occurs."""
    triangles = mesh.triangles.tolist()
    return Counter((t[i], t[(i + 1) % 3]) for t in triangles for i in range(3))


def face_normals(mesh: Mesh) -> np.ndarray:
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    return np.cross(b - a, c - a)


def test_a_ball_is_closed_and_turned_outwards():
    mesh = contour(ball(), RADIUS)
    counted = edges(mesh)
    assert set(counted.values()) == {1}
    assert all((b, a) in counted for a, b in counted)
    assert len(mesh.vertices) - len(counted) // 2 + len(mesh) == 2
    middles = mesh.vertices[mesh.triangles].mean(axis=1) - CENTRE
    assert (np.einsum("ij,ij->i", face_normals(mesh), middles) > 0).all()
    outwards = (mesh.vertices - CENTRE) / np.linalg.norm(mesh.vertices - CENTRE, axis=1, keepdims=True)
    assert np.einsum("ij,ij->i", mesh.normals, outwards).min() > np.cos(np.radians(1))
    assert np.abs(np.linalg.norm(mesh.normals, axis=1) - 1).max() < 1e-14


def test_vertices_lie_on_the_grids_edges_where_the_values_pass_the_level_in_full_precision():
    values = ball()
    mesh = contour(values.copy(), RADIUS)
    whole = mesh.vertices == np.rint(mesh.vertices)
    assert (whole.sum(axis=1) >= 2).all()
    for vertex, axis in zip(mesh.vertices, (~whole).argmax(axis=1), strict=True):
        low = np.floor(vertex).astype(int)
        high = low.copy()
        high[axis] += 1
        a, b = values[tuple(low)], values[tuple(high)]
        assert vertex[axis] - low[axis] == pytest.approx((RADIUS - a) / (b - a), abs=1e-14)


def test_a_plane_is_met_exactly_whatever_the_steps_are():
    x, y, z = np.indices((7, 8, 9)).astype(float)
    step, origin = (0.5, 1.0, 0.25), (1.0, -2.0, 3.0)
    place = [o + s * n for o, s, n in zip(origin, step, (x, y, z), strict=True)]
    way = np.array([2.0, 1.0, -2.0]) / 3
    values = sum(w * p for w, p in zip(way, place, strict=True))
    level = float(np.median(values)) + 0.01
    mesh = contour(values, level, origin, step)
    assert len(mesh) > 20
    assert np.abs(mesh.vertices @ way - level).max() < 1e-14
    assert np.abs(mesh.normals - way).max() < 1e-13


def test_nothing_is_claimed_beside_what_is_unknown():
    values = ball()
    values[:, :, 10:] = np.nan
    mesh = contour(values, RADIUS)
    assert len(mesh) > 100
    assert mesh.vertices[:, 2].max() <= 9
    once = [edge for edge, n in edges(mesh).items() if edge[::-1] not in edges(mesh)]
    rim = np.unique(once)
    assert len(rim) > 10
    assert (mesh.vertices[rim, 2] == 9).all()


@pytest.mark.parametrize("values", [np.full((4, 4, 4), 2.0), np.zeros((4, 4, 4)), np.full((4, 4, 4), np.nan),
                                    np.zeros((1, 4, 4))])
def test_no_level_makes_no_triangle(values):
    mesh = contour(values, 1.0)
    assert len(mesh) == 0 and mesh.vertices.shape == (0, 3) and mesh.normals.shape == (0, 3)


def test_a_vanishing_gradient_leaves_the_triangles_normals():
    values = np.ones((3, 3, 3))
    values[1, 1, 1] = 0.0  # central differences vanish in the middle, and beside it at half the way
    mesh = contour(values, 0.25)
    assert len(mesh) == 8
    out = mesh.vertices - 1.0
    assert np.einsum("ij,ij->i", mesh.normals, out).min() > 0


def test_arrays_are_frozen():
    mesh = contour(ball(), RADIUS)
    assert not any(a.flags.writeable for a in (mesh.vertices, mesh.triangles, mesh.normals))
