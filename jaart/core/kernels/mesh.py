"""Rays against triangles: a tree walked nearest box first, and a test that leaks at no shared edge.

The test is that of Woop, Benthin & Wald 2013, Watertight Ray/Triangle Intersection. Two triangles see the edge they
share with the same rounding but for its sign, so that a ray that one of them does not claim is claimed by the other.
"""

from __future__ import annotations

from math import inf, nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import EXACT, STRICT, kernel
from jaart.core.kernels.packet import is_bad
from jaart.core.kernels.ray import no_hit, write_end
from jaart.core.kernels.records import Array, Out, RayEnd, Vector
from jaart.core.kernels.tree import DEEPEST, Tree, span
from jaart.core.kernels.unowned import unowned
from jaart.core.kernels.vectors import along, length, scaled

Ints = NDArray[np.int64]


class Faces(NamedTuple):
    """A mesh as rays meet it.

    vertices: (V, 3); triangles: (T, 3); normals: (V, 3) unit; tree: over the triangles' boxes; flat: 1 for the
    triangles' own normals, 0 for those interpolated between the vertices.
    """

    vertices: Array
    triangles: Ints
    normals: Array
    tree: Tree
    flat: int


class Shear(NamedTuple):
    """A ray turned and sheared so that it runs along z from the origin.

    x, y, z: which axis becomes which, z the direction's largest; by_x, by_y, by_z: the shear.
    """

    x: int
    y: int
    z: int
    by_x: float
    by_y: float
    by_z: float


class Meeting(NamedTuple):
    """Where a ray meets a triangle: t, infinite where it does not; the triangle; the shares of its three corners."""

    t: float
    triangle: int
    u: float
    v: float
    w: float


# exact, for a fused a·b - c·d is not the negative of c·d - a·b
@kernel(EXACT)
def shear_of(d: Vector) -> Shear:
    """The shear of a ray's direction."""
    z = 0
    if abs(d[1]) > abs(d[z]):
        z = 1
    if abs(d[2]) > abs(d[z]):
        z = 2
    x, y = (z + 1) % 3, (z + 2) % 3
    if d[z] < 0.0:
        x, y = y, x
    return Shear(x, y, z, d[x] / d[z], d[y] / d[z], 1.0 / d[z])


@kernel(EXACT)
def sheared(vertices: Array, number: int, o: Vector, shear: Shear) -> Vector:
    """A vertex as the sheared ray sees it."""
    p = (vertices[number, 0] - o[0], vertices[number, 1] - o[1], vertices[number, 2] - o[2])
    return p[shear.x] - shear.by_x * p[shear.z], p[shear.y] - shear.by_y * p[shear.z], shear.by_z * p[shear.z]


@kernel(EXACT)
def meet(faces: Faces, number: int, o: Vector, shear: Shear) -> Meeting:
    """Where a ray meets a triangle, from either side; its edges belong to it."""
    nothing = Meeting(inf, number, 0.0, 0.0, 0.0)
    a = sheared(faces.vertices, faces.triangles[number, 0], o, shear)
    b = sheared(faces.vertices, faces.triangles[number, 1], o, shear)
    c = sheared(faces.vertices, faces.triangles[number, 2], o, shear)
    u, v, w = c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]
    if (u < 0.0 or v < 0.0 or w < 0.0) and (u > 0.0 or v > 0.0 or w > 0.0):
        return nothing
    total = u + v + w
    if total == 0.0:
        return nothing
    u, v, w = u / total, v / total, w / total
    t = u * a[2] + v * b[2] + w * c[2]
    return Meeting(t, number, u, v, w) if t >= 0.0 else nothing


@kernel(EXACT)
def in_leaf(faces: Faces, node: int, o: Vector, shear: Shear, best: Meeting) -> Meeting:
    """The nearest meeting so far, after the triangles of a leaf; of equally near ones the lowest number."""
    tree = faces.tree
    for at in range(tree.first[node], tree.first[node] + tree.size[node]):
        found = meet(faces, tree.order[at], o, shear)
        if found.t < best.t or (found.t == best.t and found.t < inf and found.triangle < best.triangle):
            best = found
    return best


@kernel(STRICT)
def first_meeting(faces: Faces, o: Vector, d: Vector, any_hit: int, stack: Ints) -> tuple[Meeting, int]:
    """The nearest meeting of a ray, or any one, and how many nodes were visited; stack: (2·DEEPEST,)."""
    tree, shear = faces.tree, shear_of(d)
    inverse = (1.0 / d[0], 1.0 / d[1], 1.0 / d[2])
    best, visited, waiting = Meeting(inf, -1, 0.0, 0.0, 0.0), 0, 1
    stack[0] = 0
    while waiting > 0:
        waiting -= 1
        node = stack[waiting]
        enter, leave = span(tree.low, tree.high, node, o, inverse)
        if enter > leave or leave < 0.0 or enter > best.t:
            continue
        visited += 1
        if tree.size[node] > 0:
            best = in_leaf(faces, node, o, shear, best)
            if any_hit == 1 and best.t < inf:
                break
            continue
        one, other = node + 1, tree.first[node]
        if span(tree.low, tree.high, other, o, inverse)[0] < span(tree.low, tree.high, one, o, inverse)[0]:
            one, other = other, one
        stack[waiting], stack[waiting + 1] = other, one
        waiting += 2
    return best, visited


@kernel(STRICT)
def corner(values: Array, number: int) -> Vector:
    """A row of (V, 3)."""
    return values[number, 0], values[number, 1], values[number, 2]


@kernel(STRICT)
def face_normal(faces: Faces, number: int) -> Vector:
    """The triangle's own unit normal, outwards; zero where it has no area."""
    a = corner(faces.vertices, faces.triangles[number, 0])
    e = along(corner(faces.vertices, faces.triangles[number, 1]), a, -1.0)
    f = along(corner(faces.vertices, faces.triangles[number, 2]), a, -1.0)
    n = (e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0])
    size = length(n)
    return scaled(n, 1.0 / size) if size > 0.0 else n


@kernel(STRICT)
def normal_of(faces: Faces, met: Meeting) -> Vector:
    """The outward unit normal of a meeting: the vertices' one interpolated, or the triangle's own."""
    if faces.flat == 1:
        return face_normal(faces, met.triangle)
    corners, normals = faces.triangles, faces.normals
    n = scaled(corner(normals, corners[met.triangle, 0]), met.u)
    n = along(n, corner(normals, corners[met.triangle, 1]), met.v)
    n = along(n, corner(normals, corners[met.triangle, 2]), met.w)
    size = length(n)
    return scaled(n, 1.0 / size) if size > 0.0 else face_normal(faces, met.triangle)


@kernel(STRICT)
def trace_ray(faces: Faces, o: Vector, d: Vector, any_hit: int, stack: Ints) -> RayEnd:
    """How a ray ends; cells: nodes of the tree visited."""
    if is_bad(o, d):
        return no_hit(r.BAD_RAY)
    met, visited = first_meeting(faces, o, d, any_hit, stack)
    end = no_hit(r.BACKGROUND)
    if not met.t < inf:
        return RayEnd(end.state, end.t, end.point, end.n, end.energy, end.off, 0, 0, 0, visited, 0, nan, 0, -1)
    return RayEnd(r.CONVERGED, met.t, along(o, d, met.t), normal_of(faces, met), 0.0, end.off, 0, 0, 0, visited,
                  0, nan, 0, -1)


@kernel(STRICT)
def unowned_faces(faces: Faces) -> Faces:
    """A mesh, its arrays without owners."""
    tree = faces.tree
    return Faces(unowned(faces.vertices), unowned(faces.triangles), unowned(faces.normals),
                 Tree(unowned(tree.low), unowned(tree.high), unowned(tree.first), unowned(tree.size),
                      unowned(tree.order)), faces.flat)


@kernel(STRICT, entry=True, allocates=True)
def trace_rays(faces: Faces, any_hit: int, origins: Array, directions: Array, pixels: Ints, out: Out) -> None:
    """Trace some of the rays (R, 3) and write each into its row of the columns."""
    mesh, stack = unowned_faces(faces), np.empty(2 * DEEPEST, np.int64)
    for i in range(pixels.shape[0]):
        to = pixels[i]
        o = (origins[to, 0], origins[to, 1], origins[to, 2])
        d = (directions[to, 0], directions[to, 1], directions[to, 2])
        write_end(out, to, trace_ray(mesh, o, d, any_hit, stack))
