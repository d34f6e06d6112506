"""Precision and evaluations beside Table 1 of [A]: 67,038 points of a smooth bumpy sphere, positions alone.

200×400 rays, half of them hits, h = 0.004 d; everything is counted: the fits kept at balls' centres, the rays that
miss, the starts that are given up.
"""

from __future__ import annotations

import numpy as np

import jaart
from jaart.core import prepare, samples

SIZE = (200, 400)
TOLERANCES = (1e-1, 1e-3, 1e-7, 1e-10, 1e-11, 1e-13)
#: Mean iterations of [A]'s Table 1, for its tolerances.
TABLE_1 = {1e-1: 1.99, 1e-3: 2.91, 1e-7: 4.98, 1e-10: 6.56, 1e-11: 10.4}
#: Surfels farther than this many h weigh less than rounding.
REACH = 6
SETTINGS = {
    "preset adamson-alexa": {},
    "covariance about a(x)": {"normal": "covariance"},
    "the same, degree 3, balls to the 24th": {"normal": "covariance", "degree": 3, "ball_k": 24},
    "the same, secant": {"normal": "covariance", "degree": 3, "ball_k": 24, "search": "secant"},
}


def main() -> None:
    scene = jaart.load("bumpy")
    diagonal = float(np.linalg.norm(np.ptp(scene.points, axis=0)))
    camera = jaart.Camera(eye=(0.0, -8.0, 0.0), target=(0.0, 0.0, 0.0), ortho=3.72)
    exact_t, exact_n = samples.standard_bumps().hit(*rays(scene, camera))
    print(f"{len(scene.points)} points, {SIZE[0]}x{SIZE[1]} rays, {np.isfinite(exact_t).sum()} meet the exact surface, "
          f"h = 0.004 d, radius {REACH} h")
    print("[A]: 42,463 hits, 5.6 evaluations a hit, 1.98 with kept centres")
    for name, values in SETTINGS.items():
        settings = jaart.preset("adamson-alexa").replace(radius=f"{REACH * 0.004}d", **values)
        print(f"\n{name}")
        table(scene, settings, camera, diagonal, exact_t, exact_n)


def rays(scene: jaart.Scene, camera: jaart.Camera) -> tuple[np.ndarray, np.ndarray]:
    """Origins and directions of the picture's rays."""
    hits = jaart.render(scene, jaart.Settings(search="centres"), camera, SIZE)
    return hits.origin, hits.direction


def table(scene: jaart.Scene, settings: jaart.Settings, camera: jaart.Camera, diagonal: float,
          exact_t: np.ndarray, exact_n: np.ndarray) -> None:
    """A line for each tolerance."""
    reference = jaart.render(scene, settings.replace(tolerance=1e-14), camera, SIZE)
    print(f"{'tolerance':>9} {'[A]':>5} {'steps':>6} {'all a hit':>9} {'fits':>6} {'misses':>7} {'given up':>8} "
          f"{'hits':>6} {'median error':>12} {'largest':>8} {'to exact':>9} {'angle':>7}")
    h, spacing = 0.004 * diagonal, jaart.core.cloud.spacing(scene)
    for tolerance in TOLERANCES:
        hits = jaart.render(scene, settings.replace(tolerance=tolerance), camera, SIZE)
        hit, fits = hits.hit, prepare.prepared(scene, hits.settings).tracer.fits
        both = hit & reference.hit
        error = np.abs(hits.t - reference.t)[both] / h
        exact = hit & np.isfinite(exact_t)
        off = np.abs(hits.t - exact_t)[exact].mean() / spacing
        angle = np.degrees(np.arccos(np.minimum(np.abs((hits.normal * exact_n)[exact].sum(axis=1)), 1))).mean()
        given_up = hits.evaluations[hit].sum() - hits.iterations[hit].sum()
        print(f"{tolerance:9.0e} {TABLE_1.get(tolerance, '-'):>5} {hits.iterations[hit].mean():6.3f} "
              f"{(hits.evaluations.sum() + fits) / hit.sum():9.3f} {fits:6} {hits.evaluations[~hit].sum():7} "
              f"{given_up:8} {hit.sum():6} {np.median(error):10.1e} h {error.max():8.1e} {off:8.5f}s {angle:6.3f}°")


if __name__ == "__main__":
    main()
