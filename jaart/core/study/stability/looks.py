"""The sphere of the thesis, and looks at its surface everywhere along rays, in plain numpy and with all surfels.

What such looks find is the truth that a search is held against.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from jaart.core.prepare import prepared
from jaart.core.scene import Array, Model, Scene
from jaart.core.settings import Settings
from jaart.core.shape_sphere import Sphere

#: Looks along a ray in each round, and rounds that close in on the highest of them, to a tenth each.
LOOKS, ROUNDS = 21, 5
#: Rounds that close in on a silhouette: the last move of the thesis sphere's is below 1e-9.
MOVES = 5


@cache
def thesis_sphere(middle: tuple[float, float, float] = (0.5, 0.5, 0.5)) -> Scene:
    """A sphere of radius 4 cells in a lattice of 16³, filled as the thesis does; middle: in units of the lattice."""
    return Scene("case", model=Model((Sphere(middle, 0.25),), 16))


@dataclass(frozen=True, eq=False)
class Looks:
    """f of surfels with Gaussian weights and their own normals, from all of them at once.

    points, normals: (N, 3); h: feature size.
    """

    points: Array
    normals: Array
    h: float

    @classmethod
    def of(cls, scene: Scene, settings: Settings) -> Looks:
        """Those of a scene."""
        ready = prepared(scene, settings)
        return cls(ready.surfels.points, ready.surfels.normal, ready.values.h)

    def f(self, origins: Array, directions: Array, t: Array) -> Array:
        """f (R, K) at t (R, K) of rays (R, 3); above 0 inside."""
        x = origins[:, None] + t[..., None] * directions[:, None]
        square = np.square(x).sum(-1)[..., None] - 2 * (x @ self.points.T) + np.square(self.points).sum(-1)
        square -= square.min(axis=-1, keepdims=True)
        weight = np.exp(-square / self.h**2)
        off = weight @ self.points / weight.sum(-1)[..., None] - x
        normal = weight @ self.normals
        result: Array = (normal * off).sum(-1) / np.sqrt(np.square(normal).sum(-1))
        return result

    def highest(self, origins: Array, directions: Array, low: Array, high: Array) -> tuple[Array, Array]:
        """Where f is highest in low … high (R,), and how high it is there."""
        for _ in range(ROUNDS):
            t = np.linspace(low, high, LOOKS, axis=1)
            f = self.f(origins, directions, t)
            best, width = f.argmax(axis=1), (high - low) / (LOOKS - 1)
            at = t[np.arange(len(t)), best]
            low, high = at - width, at + width
        return at, f.max(axis=1)

    def silhouette(self, origins: Array, directions: Array, aside: Array, low: Array, high: Array) -> Array:
        """How far (R,) rays must be moved along aside (R, 3) until they only touch the surface.

        low, high: t between which they come nearest to it. f is about the depth below the surface.
        """
        moved = np.zeros(len(origins))
        for _ in range(MOVES):
            moved += self.highest(origins + moved[:, None] * aside, directions, low, high)[1]
        return moved

    def first(self, origins: Array, directions: Array, low: float, high: float, step: float) -> Array:
        """The first t (R,) from low to high where f rises above 0, NaN for none: looks at every step, and at the
        highest f between two of them where it comes within a step of 0; then halving.
        """
        t = np.arange(low, high, step)
        return np.array([self._first(o[None], d[None], t) for o, d in zip(origins, directions, strict=True)])

    def _first(self, o: Array, d: Array, t: Array) -> float:
        f, step = self.f(o, d, t[None])[0], t[1] - t[0]
        for k in range(1, len(t) - 1):
            inside = float(t[k])
            if -step < f[k] <= 0 and f[k] >= max(f[k - 1], f[k + 1]):
                at, depth = self.highest(o, d, t[k - 1:k], t[k + 1:k + 2])
                inside = float(at[0]) if depth[0] > 0 else np.nan
            elif f[k] <= 0:
                inside = np.nan
            if inside == inside:
                return self._root(o, d, float(t[k - 1]), inside)
        return float("nan")

    def _root(self, o: Array, d: Array, outside: float, inside: float) -> float:
        while outside < (middle := (outside + inside) / 2) < inside:
            if self.f(o, d, np.array([[middle]]))[0, 0] > 0:
                inside = middle
            else:
                outside = middle
        return inside
