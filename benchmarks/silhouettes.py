"""Rays at silhouettes: the searches against a dense look at the same f, half of the rays grazing the surface.

`python -m benchmarks.silhouettes [RAYS]` takes 100,000 rays unless told otherwise. The margin of a grazing ray is
its distance from the ray that touches the reconstructed surface: 1e-6 to 1 h, as many on each side.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass

import numpy as np

import jaart
from benchmarks.dense import looked
from benchmarks.vectors import unit
from jaart.core import extents
from jaart.core.scene import Array, Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Box, Sphere, Torus

H = 0.8
#: So long lists, or a weight that ends by itself, leave no jump of f at the faces of cells.
LONG = {"radius": 6.0}
COMPACT = {"weight": "wendland"}
#: Rays with different margins beside each touching one.
BESIDE = 20
#: Two roots that are farther from each other are two.
SAME = 1e-6


def scenes() -> dict[str, tuple[Scene, Settings]]:
    """Each scene with the settings of its surface."""
    middle = (0.5, 0.5, 0.5)
    solids = {"sphere": Sphere(middle, 0.25), "box": Box(middle, (0.5, 0.4, 0.3)),
              "torus": Torus(middle, (0.0, 0.0, 1.0), 0.25, 0.11)}
    found = {name: (Scene(name, model=Model((solid,), 16)), settings(**LONG)) for name, solid in solids.items()}
    return {**found, "splash": (jaart.load("splash"), settings(**COMPACT))}


def settings(**values: object) -> Settings:
    """The tangent surface at its tightest, by the safe search."""
    return Settings(method="tangent", search="safe", h=H, tolerance=1e-10, max_iterations=100, **values)


@dataclass(frozen=True)
class Count:
    """How a search did on some rays, of which so many hit the surface.

    false_hits, false_misses: against the dense look, a hit before the first is a false one; rear: hits behind the
    first; evaluations: a ray.
    """

    rays: int
    hits: int
    false_hits: int
    false_misses: int
    rear: int
    evaluations: float


def counted(scene: Scene, search: Settings, rays: tuple[Array, Array], truth: Array) -> Count:
    """A search against the truth."""
    hits = jaart.render(scene, search, rays=rays)
    there = ~np.isnan(truth)
    with np.errstate(invalid="ignore"):
        false, rear = hits.hit & ~(hits.t >= truth - SAME), hits.hit & (hits.t > truth + SAME)
    return Count(len(truth), int(there.sum()), int(false.sum()), int((there & ~hits.hit).sum()), int(rear.sum()),
                 float(hits.evaluations.mean()))


def anywhere(scene: Scene, chosen: Settings, count: int, seed: int) -> tuple[Array, Array]:
    """Rays from all around through random points of the scene."""
    rng = np.random.default_rng(seed)
    low, high = extents.bounds(scene, chosen)
    targets, away = rng.uniform(low, high, (count, 3)), unit(rng.normal(size=(count, 3)))
    return targets - 2 * np.linalg.norm(high - low) * away, away


def grazing(scene: Scene, chosen: Settings, count: int, seed: int) -> tuple[Array, Array]:
    """Rays beside touching ones: from hits a ray is moved aside until it only just misses, by halving."""
    rng = np.random.default_rng(seed)
    number = -(-count // BESIDE)
    origins, away = anywhere(scene, chosen, 40 * number, seed + 1)
    hit = np.flatnonzero(~np.isnan(looked(scene, chosen, origins, away, 0.4)))[:number]
    origins, away = origins[hit], away[hit]
    aside = unit(np.cross(away, rng.normal(size=away.shape)))
    low, high = np.zeros(len(hit)), _outside(scene, chosen, origins, away, aside)
    for _ in range(45):
        middle = 0.5 * (low + high)
        there = ~np.isnan(looked(scene, chosen, origins + middle[:, None] * aside, away, 0.2))
        low, high = np.where(there, middle, low), np.where(there, high, middle)
    margins = 10 ** rng.uniform(-6, 0, (len(hit), BESIDE)) * H * np.tile((-1, 1), BESIDE // 2)
    moved = (low[:, None] + margins)[:, :, None] * aside[:, None]
    rays = (origins[:, None] + moved).reshape(-1, 3), np.repeat(away, BESIDE, axis=0)
    return rays[0][:count], rays[1][:count]


def _outside(scene: Scene, chosen: Settings, origins: Array, away: Array, aside: Array) -> Array:
    """How far aside each ray first misses, in steps of 0.3 cells."""
    far, todo = np.zeros(len(origins)), np.ones(len(origins), bool)
    while todo.any():
        far[todo] += 0.3
        moved = origins[todo] + far[todo, None] * aside[todo]
        todo[todo] = ~np.isnan(looked(scene, chosen, moved, away[todo], 0.4))
    return far


def compared(name: str, count: int) -> dict[tuple[str, str], Count]:
    """The counts of a scene, by kind of rays and search."""
    scene, chosen = scenes()[name]
    found = {}
    for kind, make in (("anywhere", anywhere), ("grazing", grazing)):
        rays = make(scene, chosen, count // 2, 5)
        truth = looked(scene, chosen, *rays)
        for search in ("safe", "iterate", "secant"):
            found[kind, search] = counted(scene, chosen.replace(search=search), rays, truth)
    return found


def main() -> None:
    total = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    print(f"{total} rays at sphere, box, torus and splash; h {H}, tolerance 1e-10 h, against a look every {0.05} h")
    print(f"{'scene':8} {'rays':9} {'search':8} {'rays':>6} {'hit':>6} {'false hits':>11} {'false misses':>13} "
          f"{'rear roots':>11} {'evaluations':>12}")
    for name in scenes():
        for (kind, search), c in compared(name, total // 4).items():
            print(f"{name:8} {kind:9} {search:8} {c.rays:6} {c.hits:6} {c.false_hits:11} {c.false_misses:13} "
                  f"{c.rear:11} {c.evaluations:12.1f}", flush=True)


if __name__ == "__main__":
    main()
