"""Where [A]'s Table 1 breaks down: covariances from raw moments, E[ppᵀ] - mmᵀ, in the scene's own coordinates.

[A] takes 6.56 iterations at 1e-10 h and 10.4 at 1e-11 h, where half a one more was due. An object two diagonals from
the origin, its covariance from raw moments, does just that: entries of |x|² are rounded to eps·|x|², far more than
eps·h², the eigenvector turns by what is left of that, and steps of that size never end. Sums of p - x do not do it. An
explanation, not a proof: [A]'s program is not at hand. The raw moments are here alone, no setting of the program.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

import jaart
from benchmarks.vectors import unit
from jaart.core.samples import COUNT, standard_bumps
from jaart.core.scene import Scene

RAYS, STEPS, NEAR = 400, 100, 200
TOLERANCES = (1e-1, 1e-3, 1e-7, 1e-10, 1e-11, 1e-12, 1e-13)
#: Mean iterations of [A]'s Table 1.
TABLE_1 = {1e-1: 1.99, 1e-3: 2.91, 1e-7: 4.98, 1e-10: 6.56, 1e-11: 10.4}
#: h and the object's distance from the origin, in diagonals of its box.
H, AWAY = 0.004, 2.0


@dataclass(frozen=True, eq=False)
class Object:
    """Points (N, 3), h, and rays that begin h/2 above the surface, up to 60 degrees aslant."""

    points: np.ndarray
    h: float
    o: np.ndarray
    d: np.ndarray

    def moved(self, by: np.ndarray) -> Object:
        """The same elsewhere."""
        return Object(self.points + by, self.h, self.o + by, self.d)


def main() -> None:
    there = irregular()
    far = there.moved(AWAY * there.h / H * unit(np.array([[1.0, 0.7, 0.4]])))
    columns = {"raw, at origin": literal(there, True), "raw": literal(far, True), "p - x": literal(far, False),
               "Jaart": program(far)}
    print(f"{COUNT} points at random on the bumpy sphere, {AWAY:.0f} d from the origin, h = {H} d, {RAYS} rays, "
          f"at most {STEPS} steps: mean steps, and rays that do not arrive")
    print(f"{'tolerance':>9} {'[A]':>5} " + " ".join(f"{name:>15}" for name in columns))
    for i, tolerance in enumerate(TOLERANCES):
        cells = [f"{steps[i].clip(max=STEPS).mean():6.2f} {100 * (steps[i] > STEPS).mean():6.1f} %"
                 for steps in columns.values()]
        print(f"{tolerance:9.0e} {TABLE_1.get(tolerance, '-'):>5} " + " ".join(cells))


def irregular() -> Object:
    """As many points as [A]'s Rabbit has, as irregular as a scan's."""
    rng = np.random.default_rng(1)
    surface = standard_bumps()
    points = surface.points_along(unit(rng.normal(size=(COUNT, 3))))
    h = H * float(np.linalg.norm(np.ptp(points, axis=0)))
    middle = points[rng.integers(COUNT, size=RAYS)]
    up, aside = surface.exact_normal(middle), rng.normal(size=(RAYS, 3))
    slant = rng.uniform(0, np.radians(60), RAYS)[:, None]
    d = unit(np.sin(slant) * unit(np.cross(up, aside)) - np.cos(slant) * up)
    return Object(points, h, middle + rng.uniform(-0.5, 0.5, (RAYS, 3)) * h - 0.5 * h / np.cos(slant) * d, d)


def literal(thing: Object, raw: bool) -> np.ndarray:
    """Steps (tolerances, R) that [A]'s iteration takes until one is shorter, more than STEPS for never."""
    points = thing.points[cKDTree(thing.points).query(thing.o + 0.5 * thing.h * thing.d, NEAR)[1]]
    x, taken = thing.o.copy(), np.full((len(TOLERANCES), RAYS), STEPS + 1)
    for number in range(1, STEPS + 1):
        off, spread = (raw_moments if raw else about_mean)(points, x, thing.h)
        n = np.linalg.eigh(spread)[1][:, :, 0]
        step = (n * off).sum(axis=1) / (n * thing.d).sum(axis=1)
        x = x + step[:, None] * thing.d
        arrived = np.abs(step) < np.array(TOLERANCES)[:, None] * thing.h
        taken[arrived & (taken > STEPS)] = number
    return taken


def weights(points: np.ndarray, x: np.ndarray, h: float) -> np.ndarray:
    """Normalised Gaussian weights (R, N)."""
    w = np.exp(-((points - x[:, None]) ** 2).sum(axis=2) / h**2)
    return w / w.sum(axis=1, keepdims=True)


def raw_moments(points: np.ndarray, x: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    """a(x) - x and the covariance, both from sums of p and ppᵀ."""
    w = weights(points, x, h)
    mean = np.einsum("rn,rni->ri", w, points)
    return mean - x, np.einsum("rn,rni,rnj->rij", w, points, points) - mean[:, :, None] * mean[:, None]


def about_mean(points: np.ndarray, x: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    """The same from sums of p - x."""
    w = weights(points, x, h)
    off = np.einsum("rn,rni->ri", w, points - x[:, None])
    away = points - x[:, None] - off[:, None]
    return off, np.einsum("rn,rni,rnj->rij", w, away, away)


def program(thing: Object) -> np.ndarray:
    """The same steps of the program itself, whose searches begin where a ball promises the surface."""
    scene = Scene("irregular", points=thing.points)
    settings = jaart.Settings(normal="covariance", search="iterate", h=thing.h, radius=6 * thing.h,
                              max_iterations=STEPS)
    taken = []
    for tolerance in TOLERANCES:
        hits = jaart.render(scene, settings.replace(tolerance=tolerance), rays=(thing.o, thing.d))
        taken.append(np.where(hits.hit, hits.iterations, STEPS + 1))
    return np.array(taken)


if __name__ == "__main__":
    main()
