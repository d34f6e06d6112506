"""Fits of a polynomial by normal equations and by reflections, over the same points, in turns."""

from __future__ import annotations

import os

os.environ["JAART_CALL_KERNELS"] = "1"  # before any kernel is imported: single ones are called

import numpy as np

from benchmarks.timing import REPEATS, Spread, in_turns, ratios, timed
from jaart.core.kernels import polynomial_fit as p
from jaart.core.kernels.jit import kernel

#: Points near a place, and the degree: surfels of a lattice, 2.5 and more cells around, then balls of clouds.
SIZES = ((24, 1), (32, 2), (104, 2), (48, 3), (104, 3), (104, 4))
FITS = 20_000


@kernel(entry=True)
def many(columns, rows, degree, work, coefficients, by_moments) -> int:
    """The same fit again and again; returns how often it served."""
    served = 0
    for _ in range(FITS):
        for i in range(columns.shape[0]):
            work[i] = columns[i]
        for k in range(p.COEFFICIENTS):
            coefficients[k] = 0.0
        if by_moments:
            served += 1 if p.by_moments(work, rows, degree, coefficients) else 0
        else:
            served += 1 if p.by_reflections(work, rows, degree, coefficients) == degree else 0
    return served


def disc(rows: int) -> np.ndarray:
    """Columns u, v, height and weight of points on a disc of 2.5 h."""
    rng = np.random.default_rng(rows)
    r, angle = 2.5 * np.sqrt(rng.uniform(size=rows)), rng.uniform(0, 2 * np.pi, rows)
    u, v = r * np.cos(angle), r * np.sin(angle)
    return np.concatenate((u, v, 0.1 * u * u + 0.05 * rng.normal(size=rows), np.exp(-r * r)))


def main() -> None:
    print("points degree   moments us  reflections us  ratio   largest difference of a coefficient")
    for rows, degree in SIZES:
        columns, work, found = disc(rows), np.empty(p.SCRATCH_COLUMNS * rows), np.empty((2, p.COEFFICIENTS))

        def run(which: int, columns=columns, rows=rows, degree=degree, work=work, found=found) -> None:
            if many(columns, np.uint64(rows), degree, work, found[1 - which], which == 1) != FITS:
                raise SystemExit(f"{rows} points, degree {degree}: no fit")

        run(1)  # compiled, if need be
        given = in_turns({"moments": lambda: timed(lambda: run(1)), "reflections": lambda: timed(lambda: run(0))},
                         REPEATS, np.inf)
        m, r = (1e6 / FITS * Spread(tuple(given[name])).median for name in ("moments", "reflections"))
        ratio = ratios(given["moments"], given["reflections"]).median
        print(f"{rows:6} {degree:6}   {m:10.2f}  {r:14.2f}  {ratio:5.2f}   {np.abs(found[0] - found[1]).max():.0e}")


if __name__ == "__main__":
    main()
