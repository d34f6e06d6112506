"""Weighted sums of the monomials of u and v over columns of points, which a fit by normal equations takes.

A moment Σ t·uᵃ·vᵇ stands where the monomial does among coefficients: by degree a + b, in each by falling powers of u.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Unsigned

#: Moments up to the fourth degree, and those up to the eighth.
TO_FOURTH, TO_EIGHTH = 15, 45
_ZERO, _TWO, _FOUR = np.uint64(0), np.uint64(2), np.uint64(4)


@kernel(STRICT, inline=True)
def number_of(degree: Unsigned, b: Unsigned) -> Unsigned:
    """Where the monomial of a degree with vᵇ stands."""
    return ((degree * (degree + np.uint64(1))) >> np.uint64(1)) + b


@kernel(STRICT, inline=True)
def put(work: Array, to: Unsigned, values: Any) -> None:
    """Write numbers one behind another."""
    for i in range(len(values)):
        work[to + np.uint64(i)] = values[i]


@kernel()
def sum_to_fourth(work: Array, t: Unsigned, rows: Unsigned, to: Unsigned) -> None:
    """Write Σ t·uᵃ·vᵇ with a + b ≤ 4 in one pass; u and v are the first two columns, t: where a column begins."""
    s0 = s1 = s2 = s3 = s4 = s5 = s6 = s7 = s8 = s9 = s10 = s11 = s12 = s13 = s14 = 0.0
    for i in range(rows):
        u, v, w = work[i], work[rows + i], work[t + i]
        uu, uv, vv = u * u, u * v, v * v
        wu, wv = w * u, w * v
        wuu, wuv, wvv = w * uu, w * uv, w * vv
        s0 += w
        s1 += wu
        s2 += wv
        s3 += wuu
        s4 += wuv
        s5 += wvv
        s6 += wu * uu
        s7 += wv * uu
        s8 += wu * vv
        s9 += wv * vv
        s10 += wuu * uu
        s11 += wuu * uv
        s12 += wuu * vv
        s13 += wuv * vv
        s14 += wvv * vv
    put(work, to, (s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11, s12, s13, s14))


@kernel()
def _times(work: Array, t: Unsigned, a: Unsigned, b: Unsigned, rows: Unsigned, to: Unsigned) -> None:
    """Write a column times two others into a fourth."""
    for i in range(rows):
        work[to + i] = work[t + i] * work[a + i] * work[b + i]


@kernel()
def _lay(work: Array, found: Unsigned, a: Unsigned, b: Unsigned, to: Unsigned) -> None:
    """Lay moments of t·uᵃ·vᵇ up to the fourth degree among those of t."""
    for degree in range(np.uint64(5)):
        for j in range(degree + np.uint64(1)):
            work[to + number_of(a + b + degree, b + j)] = work[found + number_of(degree, j)]


@kernel()
def sum_moments(work: Array, weight: Unsigned, rows: Unsigned, degree: int, scratch: Unsigned, to: Unsigned) -> None:
    """Write Σ w·uᵃ·vᵇ with a + b ≤ 2·degree, degree 1 to 4.

    weight: where the column of w begins; scratch: room for a column and TO_FOURTH numbers; to: for TO_EIGHTH.
    Beyond the fourth degree they are those of w·u² and w·v², or of w·u⁴, w·u²v² and w·v⁴, which reach all.
    """
    sum_to_fourth(work, weight, rows, to)
    if degree < 3:
        return
    found, v = scratch + rows, rows
    _times(work, weight, _ZERO, _ZERO, rows, scratch)
    if degree == 4:
        _times(work, scratch, _ZERO, _ZERO, rows, scratch)
    sum_to_fourth(work, scratch, rows, found)
    _lay(work, found, _TWO if degree == 3 else _FOUR, _ZERO, to)
    _times(work, weight, v, v, rows, scratch)
    if degree == 4:
        _times(work, scratch, _ZERO, _ZERO, rows, scratch)
        sum_to_fourth(work, scratch, rows, found)
        _lay(work, found, _TWO, _TWO, to)
        _times(work, weight, v, v, rows, scratch)
        _times(work, scratch, v, v, rows, scratch)
    sum_to_fourth(work, scratch, rows, found)
    _lay(work, found, _ZERO, _TWO if degree == 3 else _FOUR, to)
