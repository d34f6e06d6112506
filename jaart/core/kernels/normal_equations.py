"""Linear least squares by normal equations: fewer operations than reflections, where columns are far from dependent.

The matrix of n unknowns stands in one flat array row by row, its upper triangle in use. Elimination leaves there U of
A = Uᵀ·D⁻¹·U, D its diagonal.
"""

from __future__ import annotations

from math import inf

import numpy as np

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Unsigned

_ONE: Unsigned = np.uint64(1)


@kernel(STRICT)
def eliminate(work: Array, a: Unsigned, n: Unsigned, per_pivot: Unsigned) -> tuple[float, float]:
    """Turn a matrix into U; returns the least square of a sine, and the least pivot as a share of the largest.

    The sine is that of the angle between a column of the system and those before it; 1/sin² is what the equations
    lose in digits. Both are 0 where a column depends on others, or is no number. per_pivot: room for n numbers, 1/D.
    """
    sine, least, largest = inf, inf, 0.0
    for k in range(n):
        work[per_pivot + k] = work[a + k * n + k]
    for k in range(n):
        row, whole = a + k * n, work[per_pivot + k]
        pivot = work[row + k]
        if not (pivot > 0.0 and whole < inf):
            return 0.0, 0.0
        sine, least, largest = min(sine, pivot / whole), min(least, pivot), max(largest, pivot)
        work[per_pivot + k] = 1.0 / pivot
        for i in range(k + _ONE, n):
            share = work[row + i] * work[per_pivot + k]
            for j in range(i, n):
                work[a + i * n + j] -= share * work[row + j]
    return sine, least / largest


@kernel(STRICT)
def solve_eliminated(work: Array, a: Unsigned, n: Unsigned, per_pivot: Unsigned, right: Unsigned) -> None:
    """Turn a right-hand side into the solution, in place."""
    for k in range(n):
        share = work[right + k] * work[per_pivot + k]
        for i in range(k + _ONE, n):
            work[right + i] -= share * work[a + k * n + i]
    for back in range(n):
        k = n - _ONE - back
        value = work[right + k]
        for j in range(k + _ONE, n):
            value -= work[a + k * n + j] * work[right + j]
        work[right + k] = value * work[per_pivot + k]
