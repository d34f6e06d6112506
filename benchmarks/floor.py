"""The floor of float64: how many regular rays come how near to the exact hit, and what that takes.

A sphere of 2000 surfels, h = 0.12 R, rays that meet it at up to 60 degrees. Exact is the root of the same f, taken with
more digits than float64 has. Then the same sphere far from the origin: t is as good as before, but a point is given in
coordinates whose last place is worth more.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import jaart
from benchmarks.vectors import unit
from jaart.core.samples import fibonacci
from jaart.core.scene import Scene
from tests.reference.tangent import Tangent, dot, mpf

SURFELS, RAYS, H = 2000, 300, 0.12
STEEPEST = np.radians(60)
#: Height in h that rays begin at.
ABOVE = 0.5
#: Surfels lighter by exp(-60) change nothing that a float64 could show.
NEGLIGIBLE = 60.0
SEARCHES = ("iterate", "secant", "newton", "safe")
TOLERANCES = (1e-1, 1e-3, 1e-7, 1e-10, 1e-12, 1e-14)
FLOOR = 1e-14
#: Distances from the origin, in R, and rays that are sent at each.
SHIFTS, SHIFTED_RAYS = (0.0, 1e3, 1e6, 1e9), 60
SETTINGS = jaart.Settings(h=H, radius=6 * H, max_iterations=100)


@dataclass(frozen=True, eq=False)
class Rays:
    """Origins and unit directions (R, 3), and the exact t of each hit."""

    o: np.ndarray
    d: np.ndarray
    t: list[Any]

    def error(self, hits: jaart.Hits) -> np.ndarray:
        """How far each t is off, in h; infinity where there is none."""
        off = [float(abs(mpf(t) - exact)) / H if hit else np.inf
               for t, exact, hit in zip(hits.t.tolist(), self.t, hits.hit, strict=True)]
        return np.array(off)

    def places(self, hits: jaart.Hits) -> tuple[float, float]:
        """The largest error of a coordinate of a point: in h, and in units in the last place of its largest."""
        exact = [[mpf(p) + t * mpf(q) for p, q in zip(o, d, strict=True)]
                 for o, d, t in zip(self.o.tolist(), self.d.tolist(), self.t, strict=True)]
        off = np.array([[float(abs(mpf(c) - e)) for c, e in zip(point, place, strict=True)]
                        for point, place in zip(hits.point.tolist(), exact, strict=True)])
        return float(off.max()) / H, float((off.max(axis=1) / np.spacing(np.abs(hits.point).max(axis=1))).max())


def main() -> None:
    print(f"sphere of {SURFELS} surfels, h {H} R, {RAYS} rays at up to 60 degrees, errors against 25 digits")
    for normal in ("surfel", "covariance"):
        scene, settings = sphere(), SETTINGS.replace(normal=normal)
        table(scene, settings, regular(scene, settings, RAYS))
    print(f"\nthe same sphere far from the origin, {SHIFTED_RAYS} rays, newton, tolerance {FLOOR:.0e} h")
    print(f"{'away [R]':>10} {'floor':>7} {'t, largest':>11} {'point, largest':>14} {'in last places':>14}")
    for shift in SHIFTS:
        scene = sphere(shift)
        rays = regular(scene, SETTINGS, SHIFTED_RAYS, shift)
        hits = jaart.render(scene, SETTINGS.replace(search="newton", tolerance=FLOOR), rays=(rays.o, rays.d))
        error, (off, ulps) = rays.error(hits), rays.places(hits)
        print(f"{shift:10.0e} {100 * (error <= FLOOR).mean():5.1f} % {error.max():9.1e} h {off:12.1e} h {ulps:14.2f}")


def table(scene: Scene, settings: jaart.Settings, rays: Rays) -> None:
    """A line for each search and tolerance."""
    print(f"\nnormal {settings.normal}: rays within the tolerance and within {FLOOR:.0e} h, evaluations a ray")
    print(f"{'search':>8} {'tolerance':>9} {'within':>9} {'floor':>7} {'largest':>9} {'steps':>6} {'evaluations':>11}")
    for search in SEARCHES:
        for tolerance in TOLERANCES:
            hits = jaart.render(scene, settings.replace(search=search, tolerance=tolerance), rays=(rays.o, rays.d))
            error = rays.error(hits)
            print(f"{search:>8} {tolerance:9.0e} {100 * (error <= tolerance).mean():7.1f} % "
                  f"{100 * (error <= FLOOR).mean():5.1f} % {error.max():7.1e} h {hits.iterations.mean():6.2f} "
                  f"{hits.evaluations.mean():11.2f}")


def sphere(shift: float = 0.0) -> Scene:
    """The sphere of radius 1, so far from the origin along (1, 1, 1)."""
    around = fibonacci(SURFELS)
    return Scene("sphere", points=around + shift / np.sqrt(3), normals=around)


def starts(count: int, shift: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Rays that begin above the surface, which lies h²/2R below the surfels, and slant by up to 60 degrees."""
    rng = np.random.default_rng(3)
    up, aside = (unit(rng.normal(size=(count, 3))) for _ in range(2))
    slant = rng.uniform(0, STEEPEST, count)[:, None]
    d = unit(np.sin(slant) * unit(np.cross(up, aside)) - np.cos(slant) * up)
    return (1 - H * H / 2) * up - ABOVE * H / np.cos(slant) * d + shift / np.sqrt(3), d


def regular(scene: Scene, settings: jaart.Settings, count: int, shift: float = 0.0) -> Rays:
    """Those rays with their exact t: one more step from the best t, with f and n to 25 digits.

    The step's own error is a hundredth of what it mends: h²/2R² and what uneven points add.
    """
    hits = jaart.render(scene, settings.replace(search="newton", tolerance=0), rays=starts(count, shift))
    normal = "surfel" if settings.normal == "auto" else settings.normal
    surface, t = Tangent(scene.points, scene.normals, H, normal, NEGLIGIBLE), []
    for o, d, near in zip(hits.origin.tolist(), hits.direction.tolist(), hits.t.tolist(), strict=True):
        way = [mpf(c) for c in d]
        here = surface.at([mpf(p) + mpf(near) * q for p, q in zip(o, way, strict=True)])
        t.append(mpf(near) + here.f / dot(here.n, way))
    return Rays(hits.origin, hits.direction, t)


if __name__ == "__main__":
    main()
