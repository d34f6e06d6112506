"""Small clouds, rays through them, and where these meet the tangent surface by a look everywhere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core import prepare
from jaart.core.balls import CloudTracer
from jaart.core.chosen import Chosen
from jaart.core.samples import fibonacci, standard_bumps
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from tests.core.oracle_scene import Oracle
from tests.oracle.vectors import Vector

Array = NDArray[np.float64]
Rays = tuple[Array, Array]
Points = tuple[Array, Array]


def sphere(count: int) -> Points:
    return fibonacci(count), fibonacci(count)


def torus(count: int) -> Points:
    """Radii 1 and 0.4, around z."""
    number = np.arange(count)
    around, across = 2 * np.pi * number / count, 2 * np.pi * ((number * (np.sqrt(5) - 1) / 2) % 1)
    ring = np.stack((np.cos(around), np.sin(around), 0 * around), axis=1)
    normal = np.cos(across)[:, None] * ring + np.sin(across)[:, None] * np.array([0, 0, 1.0])
    return ring + 0.4 * normal, normal / np.linalg.norm(normal, axis=1, keepdims=True)


def sheets(count: int) -> Points:
    """Two even squares above each other, at z = 0 and z = 1, that face the same way."""
    x, y = np.meshgrid(*[np.linspace(-1, 1, round(np.sqrt(count / 2)))] * 2)
    one = np.stack((x.ravel(), y.ravel(), 0 * x.ravel()), axis=1)
    return np.concatenate((one, one + [0, 0, 1])), np.tile([0, 0, 1.0], (2 * len(one), 1))


def bumpy(count: int) -> Points:
    points = standard_bumps().points_along(fibonacci(count))
    return points, standard_bumps().exact_normal(points)


MADE = {"sphere": sphere, "torus": torus, "sheets": sheets, "bumpy": bumpy}


def fresh(name: str, count: int, bare: bool = False) -> Scene:
    """A cloud of its own, that nothing was traced in."""
    points, normals = MADE[name](count)
    return Scene(name, points=points, normals=None if bare else normals)


@cache
def cloud(name: str, count: int, bare: bool = False) -> Scene:
    return fresh(name, count, bare)


def unit(vectors: Any) -> Array:
    a = np.asarray(vectors, dtype=float)
    result: Array = a / np.linalg.norm(a, axis=-1, keepdims=True)
    return result


def rays(count: int, inside: bool = False, seed: int = 1) -> Rays:
    """Rays from all around at a distance of 3, or from everywhere inside, about the origin."""
    rng = np.random.default_rng(seed)
    targets = rng.uniform(-0.9, 0.9, (count, 3))
    if inside:
        return targets * 0.8, unit(rng.normal(size=(count, 3)))
    eyes = 3 * unit(rng.normal(size=(count, 3)))
    return eyes, unit(targets - eyes)


def tracer_of(scene: Scene, settings: Settings) -> CloudTracer:
    found = prepare.prepared(scene, settings).tracer
    assert isinstance(found, CloudTracer)
    return found


class CloudOracle(Oracle):
    """The oracle of a cloud: every point is looked at, so no list of a ball is taken for granted."""

    @classmethod
    def of(cls, scene: Scene, settings: Settings) -> CloudOracle:
        """The oracle of a cloud."""
        ready = prepare.prepared(scene, settings)
        return cls(ready.surfels.points.tolist(), ready.surfels.normal.tolist(), settings, ready.values, (0, 0, 0))

    def cell_of(self, x: Vector) -> tuple[int, int, int]:
        """A cloud has no cells."""
        return 0, 0, 0


@dataclass
class Everywhere:
    """The tangent surface of surfels with Gaussian weights, from all the points, and rays looked along closely."""

    points: Array
    normals: Array
    values: Chosen

    def f(self, x: Array) -> tuple[Array, Array, Array]:
        """f (K,), the off-centre value (K,) and n (K, 3) at points x (K, 3); NaN where nothing is in reach."""
        square = ((x[:, None] - self.points) ** 2).sum(axis=2)
        weights = np.where(square <= self.values.radius**2, np.exp(-square / self.values.h**2), 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            off = weights @ self.points / weights.sum(axis=1)[:, None] - x
            n = unit(weights @ self.normals)
        return (n * off).sum(axis=1), np.linalg.norm(off, axis=1), n

    def is_surface(self, x: Array) -> bool:
        """Whether a root of f is one: near its surfels, and f falls along n."""
        _, off, n = self.f(x[None])
        beside = self.f(np.stack((x + 1e-5 * n[0], x - 1e-5 * n[0])))[0]
        return bool(off[0] <= self.values.off_centre and beside[0] < beside[1])

    def first(self, o: Array, d: Array, step: float, far: float) -> float:
        """The first t of the surface on a ray, by a look at every step and halving; NaN for none."""
        ts = np.arange(0, far, step)
        values = self.f(o + ts[:, None] * d)[0]
        for k in np.flatnonzero(values[:-1] * values[1:] < 0):
            low, high = ts[k], ts[k + 1]
            while low < (middle := (low + high) / 2) < high:
                same = (self.f((o + middle * d)[None])[0][0] > 0) == (values[k] > 0)
                low, high = (middle, high) if same else (low, middle)
            if self.is_surface(o + low * d):
                return float(low)
        return float("nan")


def looked(scene: Scene, settings: Settings, along: Rays, step: float = 0.02, far: float = 6.0) -> Array:
    """The first t (R,) of each ray, see `Everywhere`."""
    assert scene.points is not None and scene.normals is not None
    surface = Everywhere(scene.points, scene.normals, prepare.prepared(scene, settings).values)
    return np.array([surface.first(o, d, step, far) for o, d in zip(*along, strict=True)])
