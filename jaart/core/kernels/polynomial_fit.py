"""Weighted least squares of heights over a plane by a polynomial g(u, v) of degree 0 to 4 [A 10].

Where the monomials are far from dependent on each other, as over points on all sides, by normal equations, whose sums
take one pass or a few over the points; else by reflections, which lose half as many digits.
"""

from __future__ import annotations

from math import nan, sqrt

import numpy as np

from jaart.core.kernels.blocks import VECTOR
from jaart.core.kernels.jit import kernel
from jaart.core.kernels.least_squares import factorise, rank_ratio, substitute
from jaart.core.kernels.moments import TO_EIGHTH, TO_FOURTH, number_of, sum_moments, sum_to_fourth
from jaart.core.kernels.normal_equations import eliminate, solve_eliminated, solve_six
from jaart.core.kernels.polynomial import of_means, terms, value
from jaart.core.kernels.records import COEFFICIENTS, Array, Unsigned

#: Columns of the scratch array: u, v, height, weight, then the system.
SCRATCH_COLUMNS = 4 + COEFFICIENTS + 1
#: A point of a smaller share of the largest weight does not count.
_NEGLIGIBLE = 1e-6
#: A smaller ratio of R's diagonal leaves too few digits.
_SINGULAR = 1e-7
#: Normal equations serve where a monomial's angle with those before it has a larger squared sine, and are refined once
#: where it is smaller than the second.
_DEPENDENT, _ROUGH = 1e-4, 0.1
#: The smallest float of full precision.
_TINY = 2.2250738585072014e-308
_ONE, _TWO, _THREE, _FOUR = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)
_VECTOR = np.uint64(VECTOR)
#: Behind a column of scratch: some moments, all of them, those of the heights, which become the solution, what is kept
#: of the pivots, the matrix.
_MOMENTS = np.uint64(TO_FOURTH)
_RIGHT = _MOMENTS + np.uint64(TO_EIGHTH)
_PIVOTS = _RIGHT + np.uint64(TO_FOURTH)
_MATRIX = _PIVOTS + np.uint64(COEFFICIENTS)


@kernel()
def _times(work: Array, a: Unsigned, b: Unsigned, to: Unsigned, rows: Unsigned) -> None:
    """Write a column times another into a third."""
    for i in range(rows):
        work[to + i] = work[a + i] * work[b + i]


@kernel()
def _write_roots(work: Array, rows: Unsigned, to: Unsigned) -> None:
    """Write the roots of the weights."""
    weight = _THREE * rows
    for i in range(rows):
        work[to + i] = sqrt(work[weight + i])


@kernel()
def _write_system(work: Array, rows: Unsigned, degree: int) -> None:
    """Write the monomials' columns and the heights', each row times the root of its weight."""
    first, height = _FOUR * rows, _TWO * rows
    _write_roots(work, rows, first)
    lower, to = first, first + rows  # where the last degree and this one begin
    for d in range(1, degree + 1):
        begin = to
        for j in range(d):
            _times(work, lower + np.uint64(j) * rows, np.uint64(0), to, rows)
            to += rows
        _times(work, begin - rows, rows, to, rows)
        lower, to = begin, to + rows
    _times(work, first, height, to, rows)


@kernel()
def by_reflections(work: Array, rows: Unsigned, degree: int, coefficients: Array) -> int:
    """Write the coefficients that least squares by reflections gives, and return the degree that the points allow."""
    _write_system(work, rows, degree)
    first, count = _FOUR * rows, np.uint64(terms(degree))
    right = first + count * rows
    factorise(work, first, rows, count, np.uint64(0))  # u is in the system by now
    while degree > 0 and rank_ratio(work, first, rows, np.uint64(terms(degree))) < _SINGULAR:
        degree -= 1
    substitute(work, first, rows, np.uint64(terms(degree)), right, coefficients)
    return degree


@kernel()
def _write_matrix(work: Array, degree: int, moments: Unsigned, to: Unsigned) -> None:
    """Write the upper triangle of the sums of products of two monomials, row by row."""
    n, row = np.uint64(terms(degree)), np.uint64(0)
    for d in range(np.uint64(degree + 1)):
        for i in range(d + _ONE):  # the monomial u^(d - i)·v^i
            column = row
            for e in range(d, np.uint64(degree + 1)):
                of_degree = moments + number_of(d + e, i)
                for j in range(i if e == d else np.uint64(0), e + _ONE):
                    work[to + row * n + column] = work[of_degree + j]
                    column += _ONE
            row += _ONE


@kernel()
def _write_rest(work: Array, rows: Unsigned, coefficients: Array, to: Unsigned) -> None:
    """Write what a polynomial leaves of each height, times its weight."""
    height, weight = _TWO * rows, _THREE * rows
    for i in range(rows):
        work[to + i] = work[weight + i] * (work[height + i] - value(coefficients, work[i], work[rows + i]))


@kernel()
def has_room(rows: Unsigned, degree: int) -> bool:
    """Whether the columns hold all that normal equations take, and are filled up to whole vectors."""
    n = np.uint64(terms(degree))
    return rows % _VECTOR == 0 and rows * np.uint64(SCRATCH_COLUMNS - 5) >= _MATRIX + n * n


@kernel()
def by_moments(work: Array, rows: Unsigned, degree: int, coefficients: Array) -> bool:
    """Write the coefficients that normal equations give; whether they could, with all digits but a few."""
    n, scratch = np.uint64(terms(degree)), _FOUR * rows
    behind = scratch + rows
    moments, right, pivots, matrix = behind + _MOMENTS, behind + _RIGHT, behind + _PIVOTS, behind + _MATRIX
    sum_moments(work, _THREE * rows, rows, degree, scratch, moments)
    sine = ratio = nan
    if degree != 2:
        _write_matrix(work, degree, moments, matrix)
        sine, ratio = eliminate(work, matrix, n, pivots)
    _times(work, _THREE * rows, _TWO * rows, scratch, rows)
    for _ in range(2):
        sum_to_fourth(work, scratch, rows, right)
        if degree == 2:
            sine, ratio = solve_six(work, moments, right)
        else:
            solve_eliminated(work, matrix, n, pivots, right)
        if not (sine > _DEPENDENT and ratio > _SINGULAR * _SINGULAR):
            return False
        for k in range(n):
            coefficients[k] += work[right + k]
        if sine > _ROUGH:
            return True
        _write_rest(work, rows, coefficients, scratch)
    return True


@kernel()
def _weights(work: Array, rows: Unsigned) -> tuple[float, int]:
    """Divide the weights by the largest; returns it, and the number of weights that count beside it."""
    weight, largest, many = _THREE * rows, 0.0, 0
    for i in range(rows):
        largest = max(largest, work[weight + i])
    per_largest = 1.0 / largest
    for i in range(rows):
        work[weight + i] *= per_largest
        many += work[weight + i] > _NEGLIGIBLE
    return largest, many


@kernel()
def _mean_height(work: Array, rows: Unsigned) -> float:
    """The weighted mean of the heights, taken from the first one, so that equal heights give exactly theirs."""
    height, weight = _TWO * rows, _THREE * rows
    origin, total, weights = work[height], 0.0, 0.0
    for i in range(rows):
        total += work[weight + i] * (work[height + i] - origin)
        weights += work[weight + i]
    return origin + total / weights


@kernel()
def fit(work: Array, rows: Unsigned, degree: int, patch: float, coefficients: Array) -> int:
    """Write g's coefficients into (15,), 0 beyond its degree, and return its degree, which may be lower.

    work: flat, at least SCRATCH_COLUMNS·rows long, the first four columns of `rows` values u, v, height and weight; u,
    the weights and the rest are overwritten; rows of zeros may fill the columns up, and normal equations serve only
    where they do so to whole vectors. patch: 0 when the polynomial is to pass through the points; else each stands for
    a patch of the surface with this variance along u and along v, and the polynomial's mean over it is to. The degree
    is lowered until 1.5 points a coefficient have weight and no column depends on others; degree 0 is the weighted
    mean. -1 and NaN where no point has weight.
    """
    for k in range(COEFFICIENTS):
        coefficients[k] = 0.0
    largest, many = _weights(work, rows)
    if not largest >= _TINY:
        coefficients[0] = nan
        return -1
    while degree > 0 and 3 * terms(degree) > 2 * many:
        degree -= 1
    if degree > 0:
        if not (has_room(rows, degree) and by_moments(work, rows, degree, coefficients)):
            degree = by_reflections(work, rows, degree, coefficients)
        of_means(coefficients, patch)
    if degree == 0:
        coefficients[0] = _mean_height(work, rows)
    return degree
