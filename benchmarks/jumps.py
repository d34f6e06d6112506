"""How far f jumps at cell faces, by radius: what a neighbourhood that ends somewhere costs."""

from __future__ import annotations

import numpy as np

import jaart
from jaart.core.scene import Model, Scene
from jaart.core.shapes import Sphere

RADII = (2.0, 2.5, 3.0, 4.0, 5.0, 6.0)
RAYS = 300
H = 0.8


def main() -> None:
    scene = Scene("sphere", model=Model((Sphere((0.5, 0.5, 0.5), 0.25),), 16))
    towards = np.random.default_rng(7).normal(size=(RAYS, 3))
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    print(f"sphere of radius 4 cells, h {H}: jump of f at cell faces near the hit, {RAYS} rays to its centre")
    print(f"{'radius':>6} {'largest [h]':>12} {'median [h]':>12}")
    for radius in RADII:
        settings = jaart.preset("thesis").replace(radius=radius, h=H)
        found = np.concatenate([jumps(scene, settings, d) for d in towards]) / H
        print(f"{radius:6} {found.max():12.1e} {np.median(found):12.1e}")


def jumps(scene: Scene, settings: jaart.Settings, direction: np.ndarray) -> np.ndarray:
    """|f| jumps at the faces that a ray to the sphere's centre crosses near its hit.

    The ray meets the sphere head-on, so a step along it is f.
    """
    ray = jaart.trace(scene, settings, 8.0 - 20 * direction, direction)
    samples = len(ray.curves.t) // len(ray.cells)
    before, after = ray.curves.tangent[samples - 1:-1:samples], ray.curves.tangent[samples::samples]
    return np.abs(after - before)[np.abs(ray.borders[1:-1] - ray.t) < 1.0]


if __name__ == "__main__":
    main()
