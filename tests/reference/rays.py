"""The rays of the reference: 100 uniform, 50 grazing, 25 along axes, faces, edges and corners, 25 from far away.

Drawn from a fixed seed; what the file keeps are the rays themselves, so nothing hangs on how they were drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from jaart.core.render import unit
from tests.reference.scenes import NORMALS, Surfels
from tests.reference.tangent import Array
from tests.reference.tracer import Doubtful, Tracer

SEED = 20
UNIFORM, GRAZING, ALIGNED, FAR = 100, 50, 25, 25
#: A silhouette is found to this, in h, and a hit so near to it has at most this slope of f.
SILHOUETTE, FLAT = 1e-9, 1e-2


@dataclass(frozen=True, eq=False)
class Ray:
    """A ray: what it was drawn for, scene and normal, its margin to the silhouette in h (inside below 0) or NaN."""

    stratum: str
    scene: str
    normal: str
    margin: float
    o: Array
    d: Array


def directed(towards: Array) -> Array:
    """A direction of length 1 that the program takes as it is."""
    return unit(unit(np.array(towards, float)[None]))[0]


def rays(surfels: dict[str, Surfels]) -> Iterator[Ray]:
    """All 200, in order."""
    rng = np.random.default_rng(SEED)
    pairs = [(scene, normal) for scene in ("cloud", "lattice") for normal in NORMALS]
    for i in range(UNIFORM):
        scene, normal = pairs[i % 4]
        yield Ray("uniform", scene, normal, np.nan, *uniform(rng, surfels[scene], 2.0))
    for i in range(GRAZING):
        scene, normal = pairs[i % 4]
        yield grazing(rng, scene, normal, surfels[scene], 10 ** rng.uniform(-6, 0) * (-1) ** (i // 4))
    for i in range(ALIGNED):
        scene, normal = pairs[i % 4]
        yield Ray("aligned", scene, normal, np.nan, *aligned(rng, scene, surfels[scene], i // 4))
    for i in range(FAR):
        scene, normal = ("cloud", "lattice", "moved", "moved")[i % 4], NORMALS[(i // 4 + i) % 2]
        away = 2.0 if scene == "moved" else 10 ** rng.uniform(2, 8)
        yield Ray("far", scene, normal, np.nan, *uniform(rng, surfels[scene], away))


def uniform(rng: np.random.Generator, found: Surfels, away: float) -> tuple[Array, Array]:
    """A ray through a point of the box around the surfels, from so many of its diagonals away."""
    low, high = found.points.min(axis=0), found.points.max(axis=0)
    d = directed(rng.normal(size=3))
    return rng.uniform(low, high) - away * np.linalg.norm(high - low) * d, d


def grazing(rng: np.random.Generator, scene: str, normal: str, found: Surfels, margin: float) -> Ray:
    """A ray past a silhouette of the reconstructed surface, inside for a margin below 0; drawn until it is one."""
    tracer = Tracer(found.surface(scene, normal))
    h = tracer.surface.h
    while True:
        d = directed(rng.normal(size=3))
        aside = directed(np.cross(d, rng.normal(size=3)))
        one = rng.integers(len(found.points))
        middle = found.points[one] - 0.5 * h * found.normals[one]

        def origin(b: float, middle: Array = middle, aside: Array = aside, d: Array = d) -> Array:
            return middle + b * aside - 4 * tracer.reach * d

        try:
            edge = silhouette(tracer, origin, d)
        except Doubtful:
            continue
        if edge is not None and (tracer.guess(origin(edge + margin * h), d) is not None) == (margin < 0):
            return Ray("grazing", scene, normal, margin, origin(edge + margin * h), d)


def silhouette(tracer: Tracer, origin: Callable[[float], Array], d: Array) -> float | None:
    """How far aside a ray must go to pass the surface, by halving; None where it does not pass smoothly."""
    h, low, high = tracer.surface.h, 0.0, 2 * tracer.reach
    if tracer.guess(origin(low), d) is None:
        return None
    while high - low > SILHOUETTE * h:
        middle = (low + high) / 2
        low, high = (low, middle) if tracer.guess(origin(middle), d) is None else (middle, high)
    o = origin(low - SILHOUETTE * h)
    t = tracer.guess(o, d)
    if t is None:
        return None
    x, step = o - tracer.quick.middle + t * d, 1e-3 * h
    f = tracer.quick.at(np.stack((x + step * d, x - step * d)))[0]
    return low if abs(f[0] - f[1]) < 2 * step * FLAT else None


def aligned(rng: np.random.Generator, scene: str, found: Surfels, number: int) -> tuple[Array, Array]:
    """A ray along an axis or a diagonal: of a lattice in faces, along edges and through corners; of a cloud through a
    point. Every third begins in the scene.
    """
    axis, side = number % 3, (-1.0) ** number
    d = side * np.eye(3)[axis] if number < 4 else directed(side * np.array([1.0, 1.0, number % 2]))
    if scene == "cloud":
        return found.points[rng.integers(len(found.points))] - (4.0 if number % 3 else 0.25) * d, d
    on = rng.integers(3, 8, size=3).astype(float)
    on[axis - 1] += 0.0 if number % 2 else 0.5
    return on - (16.0 if number % 3 else 0.0) * d, d
