"""Rays against triangles: the same as an exact test says, no leak at edges or corners, the first hit of many."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from jaart.core.contour import Mesh, contour
from jaart.core.kernels import mesh as kernels
from jaart.core.kernels import records as r
from jaart.core.kernels.records import Out
from jaart.core.mesh_tracer import faces_of
from jaart.core.scene import frozen
from jaart.core.tiles import columns_for

RNG = np.random.default_rng(11)


def mesh_of(vertices, triangles, normals=None) -> Mesh:
    corners = np.array(triangles, np.int64)
    corners.flags.writeable = False
    vertices = np.array(vertices, float)
    normals = np.tile([0.0, 0, 1], (len(vertices), 1)) if normals is None else normals
    return Mesh(frozen(vertices), corners, frozen(normals))


def shot(mesh: Mesh, origins, directions, flat=False, any_hit=0) -> Out:
    o, d = np.array(origins, float).reshape(-1, 3), np.array(directions, float).reshape(-1, 3)
    d = np.ascontiguousarray(np.broadcast_to(d, o.shape))
    out = columns_for(len(o))
    kernels.trace_rays(faces_of(mesh, flat), any_hit, o, d, np.arange(len(o)), out)
    return out


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def icosphere(times: int = 2) -> Mesh:
    """A closed mesh about the origin whose edges and corners are known."""
    g = (1 + 5**0.5) / 2
    vertices = [[0, 1, g], [0, -1, g], [0, 1, -g], [0, -1, -g], [1, g, 0], [-1, g, 0], [1, -g, 0], [-1, -g, 0],
                [g, 0, 1], [-g, 0, 1], [g, 0, -1], [-g, 0, -1]]
    points = unit(np.array(vertices, float))
    near = [(a, b, c) for a in range(12) for b in range(a) for c in range(b)
            if max(np.linalg.norm(points[i] - points[j]) for i, j in ((a, b), (b, c), (a, c))) < 1.1]
    points = list(points)
    for _ in range(times):
        middle: dict[frozenset[int], int] = {}
        finer = []
        for a, b, c in near:
            new = []
            for edge in ((a, b), (b, c), (c, a)):
                key = frozenset(edge)
                if key not in middle:
                    middle[key] = len(points)
                    points.append(unit(points[edge[0]] + points[edge[1]]))
                new.append(middle[key])
            finer += [(a, new[0], new[2]), (b, new[1], new[0]), (c, new[2], new[1]), tuple(new)]
        near = finer
    return mesh_of(points, near, np.array(points))


def exact_t(corners, o, d) -> Fraction | None:
    """t of a ray and a triangle in exact arithmetic; None when it misses (edges belong to the triangle)."""
    a, b, c = ([Fraction(float(x)) for x in p] for p in corners)
    o, d = [Fraction(float(x)) for x in o], [Fraction(float(x)) for x in d]

    def cross(p, q):
        return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]

    def dot(p, q):
        return sum(x * y for x, y in zip(p, q, strict=True))

    def minus(p, q):
        return [x - y for x, y in zip(p, q, strict=True)]

    n = cross(minus(b, a), minus(c, a))
    if dot(n, d) == 0:
        return None
    t = dot(n, minus(a, o)) / dot(n, d)
    p = [x + t * y for x, y in zip(o, d, strict=True)]
    sides = [dot(n, cross(minus(q, s), minus(p, s))) for s, q in ((a, b), (b, c), (c, a))]
    return t if t >= 0 and all(s >= 0 for s in sides) else None


def test_random_triangles_are_hit_where_exact_arithmetic_says():
    corners = RNG.normal(size=(40, 3, 3))
    mesh = mesh_of(corners.reshape(-1, 3), np.arange(120).reshape(-1, 3))
    origins = 3 * RNG.normal(size=(150, 3))
    directions = unit(RNG.normal(size=(150, 3)) - origins)
    out = shot(mesh, origins, directions)
    hits = 0
    for i, (o, d) in enumerate(zip(origins, directions, strict=True)):
        ts = [t for t in (exact_t(one, o, d) for one in corners) if t is not None]
        assert (out.status[i] == r.CONVERGED) == bool(ts)
        if ts:
            hits += 1
            assert out.t[i] == pytest.approx(float(min(ts)), rel=1e-12)
            assert out.point[i].tolist() == pytest.approx((o + out.t[i] * d).tolist(), abs=1e-12)
    assert 30 < hits < 150


def test_no_ray_from_inside_leaks_at_corners_and_edges():
    mesh = icosphere(3)
    corners = mesh.vertices[mesh.triangles]
    share = RNG.random((len(corners), 1))
    targets = np.concatenate([mesh.vertices, (corners[:, 0] + corners[:, 1]) / 2,
                              share * corners[:, 1] + (1 - share) * corners[:, 2]])
    for origin in ([0.0, 0.0, 0.0], [0.1, -0.2, 0.3], [-0.5, 0.25, 0.125]):
        d = unit(targets - origin)
        out = shot(mesh, np.tile(origin, (len(d), 1)), d)
        assert (out.status == r.CONVERGED).all()
        assert np.abs(out.t - np.linalg.norm(targets - origin, axis=1)).max() < 1e-12


@pytest.mark.parametrize("away", [3.0, 1e3, 1e6])
def test_no_ray_from_outside_leaks_through_a_lattices_aligned_faces(away):
    values = np.ones((9, 9, 9))
    values[2:7, 2:7, 2:7] = -1.0
    mesh = contour(values, 0.0)
    grid = np.arange(2.0, 6.01, 0.25)
    x, y = (g.ravel() for g in np.meshgrid(grid, grid))
    for axis in range(3):
        for side in (-1.0, 1.0):
            o, d = np.insert(np.stack([x, y], 1), axis, 4 + side * away, axis=1), np.zeros(3)
            d[axis] = -side
            out = shot(mesh, o, d)
            assert (out.status == r.CONVERGED).all()
            assert np.abs(out.t - (away - 2.5)).max() < 1e-9
            assert np.abs(out.normal[:, axis] - side).max() < 0.5


def test_the_first_of_many_is_found_and_any_hit_is_one_of_them():
    mesh = icosphere(2)
    inner = mesh_of(np.concatenate([mesh.vertices, 0.5 * mesh.vertices]),
                    np.concatenate([mesh.triangles, mesh.triangles + len(mesh.vertices)]))
    o, target = unit(RNG.normal(size=(300, 3))) * 4, 0.4 * RNG.normal(size=(300, 3))
    first, any_one = shot(inner, o, unit(target - o)), shot(inner, o, unit(target - o), any_hit=1)
    alone = shot(mesh, o, unit(target - o))
    assert first.t.tolist() == pytest.approx(alone.t.tolist(), nan_ok=True)
    assert (first.status == any_one.status).all() and len(set(first.status.tolist())) == 2
    hit = first.status == r.CONVERGED
    assert (any_one.t[hit] >= first.t[hit]).all()
    assert any_one.cells.sum() < first.cells.sum() < 300 * len(faces_of(inner, False).tree.size) / 4


def test_normals_are_the_vertices_interpolated_or_the_triangles_own():
    normals = unit(np.array([[1.0, 0, 1], [0, 1, 1], [-1, -1, 2]]))
    mesh = mesh_of([[0, 0, 0], [3, 0, 0], [0, 3, 0]], [[0, 1, 2]], normals)
    o = [[0.5, 1.0, 2.0]]
    share = np.array([1 - 0.5 / 3 - 1.0 / 3, 0.5 / 3, 1.0 / 3])
    assert shot(mesh, o, [0, 0, -1]).normal[0].tolist() == pytest.approx(unit(share @ normals).tolist(), abs=1e-15)
    assert shot(mesh, o, [0, 0, -1], flat=True).normal[0].tolist() == [0, 0, 1]
    assert shot(mesh, [[0.5, 1, -2]], [0, 0, 1], flat=True).normal[0].tolist() == [0, 0, 1]


def test_rays_without_meaning_are_named_and_an_origin_on_the_mesh_hits_at_once():
    mesh = mesh_of([[0, 0, 0], [3, 0, 0], [0, 3, 0]], [[0, 1, 2]])
    out = shot(mesh, [[np.nan, 0, 1], [1, 1, 1], [1, 1, np.inf], [1, 1, 0], [1, 1, 1]],
               [[0, 0, -1], [0, 0, -2], [0, 0, -1], [0, 0, -1], [0, 1, 0]])
    assert out.status.tolist() == [r.BAD_RAY, r.BAD_RAY, r.BAD_RAY, r.CONVERGED, r.BACKGROUND]
    assert out.t[3] == 0 and out.energy[3] == 0
    assert np.isnan(out.t[[0, 1, 2, 4]]).all() and np.isnan(out.normal[4]).all()
    assert not out.iterations.any() and not out.evaluations.any() and not out.neighbours.any()


def test_triangles_without_area_are_no_hits():
    mesh = mesh_of([[0, 0, 0], [3, 0, 0], [1, 0, 0], [0, 3, 0]], [[0, 1, 2], [0, 0, 3], [3, 3, 3]])
    assert shot(mesh, [[1, 0, 1], [0, 1, 1], [0, 3, 1]], [0, 0, -1]).status.tolist() == [r.BACKGROUND] * 3
