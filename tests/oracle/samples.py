"""Clouds whose surfaces are known exactly."""

from __future__ import annotations

import math
import random

from tests.oracle.vectors import along, frame, times

Points = list[list[float]]


def level(half: int, spacing: float, z: float = 0.0, up: float = 1.0) -> tuple[Points, Points]:
    """A square lattice of surfels at height z about the z axis, (2·half + 1)² of them, with normals (0, 0, up)."""
    at = [i * spacing for i in range(-half, half + 1)]
    return [[x, y, z] for x in at for y in at], [[0.0, 0.0, up] for _ in at for _ in at]


def slab(half: int, spacing: float, s: float) -> tuple[Points, Points]:
    """Two such sheets, at heights s and -s, with normals outwards."""
    (top, up), (bottom, down) = level(half, spacing, s), level(half, spacing, -s, -1.0)
    return top + bottom, up + down


def tube(radius: float, around: int, half: int, spacing: float) -> tuple[Points, Points]:
    """Surfels of a cylinder about the z axis."""
    turns = [2 * math.pi * k / around for k in range(around)]
    normals = [[math.cos(a), math.sin(a), 0.0] for a in turns]
    heights = [i * spacing for i in range(-half, half + 1)]
    return [[radius * n[0], radius * n[1], z] for z in heights for n in normals], [n for _ in heights for n in normals]


def rings(radius: float, count: int, each: int = 4) -> tuple[Points, Points]:
    """A sphere of rings about the z axis at evenly spaced heights.

    By Archimedes every ring stands for the same area, so that on the axis sums over the cloud are the midpoint rule
    for integrals over the sphere: their error falls like 1/count².
    """
    normals = []
    for i in range(count):
        z = (2 * i + 1) / count - 1
        across = math.sqrt(1 - z * z)
        turns = [2 * math.pi * k / each for k in range(each)]
        normals += [[across * math.cos(a), across * math.sin(a), z] for a in turns]
    return [times(n, radius) for n in normals], normals


def spiral(radius: float, count: int, centre: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> tuple[Points, Points]:
    """Evenly spread surfels of a sphere."""
    golden, normals = math.pi * (3 - math.sqrt(5)), []
    for i in range(count):
        z = 1 - (2 * i + 1) / count
        across = math.sqrt(1 - z * z)
        normals.append([across * math.cos(i * golden), across * math.sin(i * golden), z])
    return [along(centre, n, radius) for n in normals], normals


def tilted_plane(n: list[float], centre: list[float], count: int = 60, reach: float = 2.0,
                 seed: int = 1) -> tuple[Points, Points]:
    """Random points of the plane through the centre with unit normal n."""
    rng = random.Random(seed)
    u, v = frame(n)
    places = [(rng.uniform(-reach, reach), rng.uniform(-reach, reach)) for _ in range(count)]
    return [along(along(centre, u, a), v, b) for a, b in places], [list(n) for _ in places]


def cloudlet(count: int = 25, seed: int = 2, noise: float = 0.15) -> tuple[Points, Points]:
    """Surfels near a curved sheet over the origin, with noisy unit normals: a case with no symmetry at all."""
    rng = random.Random(seed)
    points, normals = [], []
    for _ in range(count):
        x, y = rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5)
        points.append([x, y, 0.2 * x * x - 0.1 * x * y + 0.05 * y + rng.gauss(0, noise)])
        m = [-0.4 * x + 0.1 * y + rng.gauss(0, noise), 0.1 * x - 0.05 + rng.gauss(0, noise), 1.0]
        normals.append(times(m, 1 / math.hypot(*m)))
    return points, normals
