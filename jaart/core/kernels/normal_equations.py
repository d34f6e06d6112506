"""Linear least squares by normal equations: fewer operations than reflections, where columns are far from dependent.

The matrix of n unknowns stands in one flat array row by row, its upper triangle in use. Elimination leaves there U of
A = Uᵀ·D⁻¹·U, D its diagonal. Six unknowns, those of a polynomial of the second degree, are solved for in registers.
"""

from __future__ import annotations

from math import inf

import numpy as np

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.moments import put
from jaart.core.kernels.records import Array, Unsigned

#: Six coefficients of a system, and its right-hand side.
Row = tuple[float, float, float, float, float, float, float]
_ONE: Unsigned = np.uint64(1)


@kernel(STRICT)
def eliminate(work: Array, a: Unsigned, n: Unsigned, per_pivot: Unsigned) -> tuple[float, float]:
    """Turn a matrix into U; returns the least square of a sine, and the least pivot as a share of the largest.

    The sine is that of the angle between a column of the system and those before it; rounding grows by up to the
    product of all 1/sin². Both are 0 where a column depends on others, or is no number. per_pivot: room for n numbers,
    1/D.
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


@kernel(STRICT, inline=True)
def _less(row: Row, above: Row, share: float) -> Row:
    """A row less a share of one above it."""
    return (row[0] - share * above[0], row[1] - share * above[1], row[2] - share * above[2], row[3] - share * above[3],
            row[4] - share * above[4], row[5] - share * above[5], row[6] - share * above[6])


@kernel(STRICT, inline=True)
def _row(work: Array, m: Unsigned, numbers: tuple[int, int, int, int, int, int], right: Unsigned, k: int) -> Row:
    """A row of the system of second degree: six moments by their numbers, and the k-th right-hand side."""
    a, b, c, d, e, f = numbers
    return (work[m + np.uint64(a)], work[m + np.uint64(b)], work[m + np.uint64(c)], work[m + np.uint64(d)],
            work[m + np.uint64(e)], work[m + np.uint64(f)], work[right + np.uint64(k)])


@kernel(STRICT)
def solve_six(work: Array, m: Unsigned, right: Unsigned) -> tuple[float, float]:
    """Turn a right-hand side into the coefficients of degree 2, in place; returns what `eliminate` does.

    m: where the moments up to the fourth degree begin, see `moments`.
    """
    r0, r1 = _row(work, m, (0, 1, 2, 3, 4, 5), right, 0), _row(work, m, (1, 3, 4, 6, 7, 8), right, 1)
    r2, r3 = _row(work, m, (2, 4, 5, 7, 8, 9), right, 2), _row(work, m, (3, 6, 7, 10, 11, 12), right, 3)
    r4, r5 = _row(work, m, (4, 7, 8, 11, 12, 13), right, 4), _row(work, m, (5, 8, 9, 12, 13, 14), right, 5)
    whole1, whole2, whole3, whole4, whole5 = r1[1], r2[2], r3[3], r4[4], r5[5]
    q0 = 1.0 / r0[0]
    r1, r2, r3 = _less(r1, r0, r0[1] * q0), _less(r2, r0, r0[2] * q0), _less(r3, r0, r0[3] * q0)
    r4, r5 = _less(r4, r0, r0[4] * q0), _less(r5, r0, r0[5] * q0)
    q1 = 1.0 / r1[1]
    r2, r3 = _less(r2, r1, r1[2] * q1), _less(r3, r1, r1[3] * q1)
    r4, r5 = _less(r4, r1, r1[4] * q1), _less(r5, r1, r1[5] * q1)
    q2 = 1.0 / r2[2]
    r3, r4, r5 = _less(r3, r2, r2[3] * q2), _less(r4, r2, r2[4] * q2), _less(r5, r2, r2[5] * q2)
    q3 = 1.0 / r3[3]
    r4, r5 = _less(r4, r3, r3[4] * q3), _less(r5, r3, r3[5] * q3)
    q4 = 1.0 / r4[4]
    r5 = _less(r5, r4, r4[5] * q4)
    x5 = r5[6] / r5[5]
    x4 = (r4[6] - r4[5] * x5) * q4
    x3 = (r3[6] - r3[5] * x5 - r3[4] * x4) * q3
    x2 = (r2[6] - r2[5] * x5 - r2[4] * x4 - r2[3] * x3) * q2
    x1 = (r1[6] - r1[5] * x5 - r1[4] * x4 - r1[3] * x3 - r1[2] * x2) * q1
    x0 = (r0[6] - r0[5] * x5 - r0[4] * x4 - r0[3] * x3 - r0[2] * x2 - r0[1] * x1) * q0
    put(work, right, (x0, x1, x2, x3, x4, x5))
    sine = min(r1[1] / whole1, r2[2] / whole2, r3[3] / whole3, r4[4] / whole4, r5[5] / whole5)
    return sine, (min(r0[0], r1[1], r2[2], r3[3], r4[4], r5[5]) / max(r0[0], r1[1], r2[2], r3[3], r4[4], r5[5]))
