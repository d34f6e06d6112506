"""Fits of polynomials called one at a time, and the same in eighty digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import polynomial, polynomial_fit

Array = NDArray[np.float64]

#: Powers of u and v of each coefficient, in the order that the module promises.
POWERS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3),
          (4, 0), (3, 1), (2, 2), (1, 3), (0, 4)]


def fitted(u: Array, v: Array, height: Array, weight: Array, degree: int, patch: float = 0.0) -> tuple[int, Array]:
    """The degree that was used and the coefficients."""
    rows = len(u)
    work = np.full(polynomial_fit.SCRATCH_COLUMNS * rows, np.nan)
    work[:4 * rows] = np.concatenate([u, v, height, weight])
    coefficients = np.full(polynomial_fit.COEFFICIENTS, np.nan)
    return polynomial_fit.fit(work, np.uint64(rows), degree, patch, coefficients), coefficients


def g(c: Array, u: float, v: float) -> float:
    """The polynomial term by term."""
    return math.fsum(ck * u**i * v**j for ck, (i, j) in zip(c.tolist(), POWERS, strict=True))


def disc(rows: int, seed: int) -> tuple[Array, Array, Array]:
    """Points u, v of a disc of 2h and their Gaussian weights."""
    rng = np.random.default_rng(seed)
    r, angle = 2 * np.sqrt(rng.uniform(size=rows)), rng.uniform(0, 2 * np.pi, rows)
    return r * np.cos(angle), r * np.sin(angle), np.exp(-r * r)


def exact(u: Array, v: Array, height: Array, weight: Array, degree: int) -> Array:
    """The fit by normal equations in eighty digits."""
    terms = polynomial.terms(degree)
    with mpmath.workdps(80):
        a = mpmath.matrix([[mpmath.mpf(x)**i * mpmath.mpf(y)**j for i, j in POWERS[:terms]]
                           for x, y in zip(u.tolist(), v.tolist(), strict=True)])
        w = mpmath.diag(weight.tolist())
        return np.array([float(x) for x in mpmath.lu_solve(a.T * w * a, a.T * (w * mpmath.matrix(height.tolist())))])
