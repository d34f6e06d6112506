"""Many small shapes as one mesh: templates and their copies, in plain arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Mesh:
    """Points (N, 3), elements (E, 2) for lines or (E, 3) for triangles, and a colour (N, 3) uint8 for each point."""

    points: Array
    elements: Ints
    colours: NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.elements)


def join(*meshes: Mesh) -> Mesh:
    """Meshes of the same kind of elements as one."""
    first = np.cumsum([0, *(len(m.points) for m in meshes[:-1])])
    return Mesh(np.concatenate([m.points for m in meshes]),
                np.concatenate([m.elements + n for m, n in zip(meshes, first, strict=True)]),
                np.concatenate([m.colours for m in meshes]))


def copies(template: tuple[Array, Ints], at: Array, axes: Array, scale: Array | float, colours: Array) -> Mesh:
    """A template at places (N, 3), its z axis turned to unit axes (N, 3).

    scale: (N,) or one number; colours: (3,) or (N, 3) from 0 to 255.
    """
    points, elements = template
    at = np.atleast_2d(at)
    count = len(at)
    sizes = np.broadcast_to(scale, count)
    turned = np.einsum("vk,nkd->nvd", points, frames(np.atleast_2d(axes))) * sizes[:, None, None] + at[:, None]
    numbers = elements[None] + (np.arange(count) * len(points))[:, None, None]
    each = np.repeat(np.broadcast_to(colours, (count, 3)), len(points), axis=0).astype(np.uint8)
    return Mesh(turned.reshape(-1, 3), numbers.reshape(-1, elements.shape[1]), each)


def frames(axes: Array) -> Array:
    """Right-handed frames (N, 3, 3), rows x, y, z, whose z are the unit axes (N, 3)."""
    helper = np.eye(3)[np.argmin(np.abs(axes), axis=1)]
    x = helper - (helper * axes).sum(axis=1, keepdims=True) * axes
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    return np.stack([x, np.cross(axes, x), axes], axis=1)


def disc(corners: int = 16) -> tuple[Array, Ints]:
    """A unit disc across z."""
    angle = np.arange(corners) * 2 * np.pi / corners
    rim = np.stack([np.cos(angle), np.sin(angle), np.zeros(corners)], axis=1)
    after = (np.arange(corners) + 1) % corners
    return np.vstack([[0, 0, 0], rim]), np.stack([np.zeros(corners, int), np.arange(corners) + 1, after + 1], axis=1)


def cone(radius: float, length: float, corners: int = 10) -> tuple[Array, Ints]:
    """A cone along z from its base at 0 to its tip."""
    points, base = disc(corners)
    points = np.vstack([points * radius, [0, 0, length]])
    return points, np.vstack([base[:, ::-1], base * [0, 1, 1] + [corners + 1, 0, 0]])


def bar(radius: float, length: float, corners: int = 8) -> tuple[Array, Ints]:
    """An open tube along z."""
    circle = disc(corners)[0][1:] * radius
    i = np.arange(corners)
    j = (i + 1) % corners
    return (np.vstack([circle, circle + np.array([0, 0, length])]),
            np.vstack([np.stack([i, j, i + corners], axis=1), np.stack([j, j + corners, i + corners], axis=1)]))


def arrow(length: float, radius: float) -> tuple[Array, Ints]:
    """A tube with a cone for its head, along z."""
    shaft, head = bar(0.3 * radius, length - 2.6 * radius, 6), cone(radius, 2.6 * radius)
    return (np.vstack([shaft[0], head[0] + np.array([0, 0, length - 2.6 * radius])]),
            np.vstack([shaft[1], head[1] + len(shaft[0])]))


def ball(rings: int = 8, sides: int = 14) -> tuple[Array, Ints]:
    """A unit sphere."""
    down, around = np.meshgrid(np.linspace(0, np.pi, rings + 1), np.arange(sides) * 2 * np.pi / sides, indexing="ij")
    points = np.stack([np.sin(down) * np.cos(around), np.sin(down) * np.sin(around), np.cos(down)], axis=-1)
    i, j = np.meshgrid(np.arange(rings), np.arange(sides), indexing="ij")
    a, b = i * sides + j, i * sides + (j + 1) % sides
    return points.reshape(-1, 3), np.concatenate([np.stack([a, a + sides, b], -1).reshape(-1, 3),
                                                  np.stack([b, a + sides, b + sides], -1).reshape(-1, 3)])


def diamond() -> tuple[Array, Ints]:
    """A unit octahedron."""
    points = np.vstack([np.eye(3), -np.eye(3)])
    faces = [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
    return points, np.array(faces)


def star() -> tuple[Array, Ints]:
    """Two unit tetrahedra through each other: a star from every side."""
    one = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]) / np.sqrt(3)
    faces = np.array([(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)])
    return np.vstack([one, -one]), np.vstack([faces, faces[:, ::-1] + 4])


def rings(corners: int = 24) -> tuple[Array, Ints]:
    """The lines of an open unit ball: three circles."""
    angle = np.arange(corners) * 2 * np.pi / corners
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(corners)], axis=1)
    pairs = np.stack([np.arange(corners), (np.arange(corners) + 1) % corners], axis=1)
    return (np.vstack([np.roll(circle, turn, axis=1) for turn in range(3)]),
            np.vstack([pairs + turn * corners for turn in range(3)]))


def box() -> tuple[Array, Ints]:
    """The 12 edges of the unit cube at the origin."""
    corners = np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)], dtype=float)
    edges = [(a, a | bit) for a in range(8) for bit in (1, 2, 4) if not a & bit]
    return corners, np.array(edges)
