"""Linear least squares by Householder reflections, in place and column by column.

A system of `rows` equations for `count` unknowns stands in one flat array from `base` on: column after column of
the matrix, each contiguous so that its loops vectorise, then the right-hand side as one more column. Rows are
scaled by the square roots of their weights; rows of zeros change nothing and may fill the columns up to whole vectors,
for all loops go over whole columns. Numbers are unsigned, so that no index is checked for its sign.
"""

from __future__ import annotations

from math import inf, nan, sqrt

import numpy as np

from jaart.core.kernels.jit import kernel
from jaart.core.kernels.records import Array, Unsigned

_ONE: Unsigned = np.uint64(1)


@kernel()
def _square(work: Array, a: Unsigned, size: Unsigned) -> float:
    """Sum of the squares of `size` values from a on."""
    total = 0.0
    for i in range(size):
        total += work[a + i] * work[a + i]
    return total


@kernel()
def _reflect(work: Array, v: Unsigned, a: Unsigned, size: Unsigned, factor: float) -> None:
    """Subtract from the values at a their share along those at v: a - factor·<v, a>·v."""
    share = 0.0
    for i in range(size):
        share += work[v + i] * work[a + i]
    share *= factor
    for i in range(size):
        work[a + i] -= share * work[v + i]


@kernel()
def _copy_from(work: Array, a: Unsigned, first: Unsigned, size: Unsigned, to: Unsigned) -> None:
    """Copy the values at a, those before the first as 0."""
    for i in range(size):
        work[to + i] = work[a + i]
    for i in range(first):
        work[to + i] = 0.0


@kernel()
def factorise(work: Array, base: Unsigned, rows: Unsigned, count: Unsigned, v: Unsigned) -> None:
    """Turn a system into R·x = Qᵀb by reflections, R in the upper triangle [Householder 1958].

    rows: at least count; v: where there is room for one more column, the vector that is reflected along. What stood
    below the triangle is lost. As every column is reflected by those before it only, the first k columns leave the R of
    the system of k unknowns.
    """
    for k in range(count):
        column = base + k * rows
        _copy_from(work, column, k, rows, v)
        length = sqrt(_square(work, v, rows))
        if length == 0.0:
            continue
        diagonal = -length if work[v + k] > 0.0 else length
        work[v + k] -= diagonal
        factor = -1.0 / (diagonal * work[v + k])
        for j in range(k + _ONE, count + _ONE):
            _reflect(work, v, base + j * rows, rows, factor)
        work[column + k] = diagonal


@kernel()
def rank_ratio(work: Array, base: Unsigned, rows: Unsigned, count: Unsigned) -> float:
    """min |R_kk| / max |R_kk| of the first `count` columns of a factorised system: 0 when it is singular."""
    least, largest = inf, 0.0
    for k in range(count):
        size = abs(work[base + k * rows + k])
        least, largest = min(least, size), max(largest, size)
    return least / largest if largest > 0.0 else largest


@kernel()
def substitute(work: Array, base: Unsigned, rows: Unsigned, count: Unsigned, right: Unsigned, x: Array) -> None:
    """Write into x[:count] the solution for the first `count` unknowns of a factorised system.

    right: where the right-hand side begins, which is behind all the columns that were factorised.
    """
    for back in range(count):
        k = count - _ONE - back
        value = work[right + k]
        for j in range(k + _ONE, count):
            value -= work[base + j * rows + k] * x[j]
        x[k] = value / work[base + k * rows + k]


@kernel()
def solve(work: Array, base: Unsigned, rows: Unsigned, count: Unsigned, x: Array) -> float:
    """Write into x[:count] what minimises |A·x - b|, and return min |R_kk| / max |R_kk|.

    work: A's columns and b, overwritten, and room for one more column. Where there are fewer rows than unknowns x is
    NaN and the ratio 0.
    """
    if rows < count:
        for k in range(count):
            x[k] = nan
        return 0.0
    factorise(work, base, rows, count, base + (count + _ONE) * rows)
    substitute(work, base, rows, count, base + count * rows, x)
    return rank_ratio(work, base, rows, count)
