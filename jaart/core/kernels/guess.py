"""The plane or polynomial at the centre of a cell or ball: kept, it says where a ray should begin [A §5, 6]."""

from __future__ import annotations

from math import nan
from typing import Any

import numpy as np

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.polynomial import line_polynomial, line_quadratic
from jaart.core.kernels.records import COEFFICIENTS, FIT_SIZE, Array, Value, Vector
from jaart.core.kernels.roots import first_root_above
from jaart.core.kernels.vectors import dot, frame

_ZERO: Any = np.int64(0)
#: A row of guesses: state, normal, f, degree, off-centre vector, weight, shift, then the polynomial's coefficients.
STATE, N_X, N_Y, N_Z, HEIGHT, DEGREE, OFF_X, OFF_Y, OFF_Z, WEIGHT, SHIFT, FIT = range(12)
GUESS_WIDTH = FIT + COEFFICIENTS


@kernel(STRICT)
def write_guess(row: Array, v: Value, fit: Array) -> None:
    """Keep the surface at a centre in a row."""
    row[STATE], row[HEIGHT], row[DEGREE] = v.state, v.f, v.degree
    row[N_X], row[N_Y], row[N_Z] = v.n
    row[OFF_X], row[OFF_Y], row[OFF_Z] = v.off
    row[WEIGHT], row[SHIFT] = v.weight, v.shift
    for i in range(COEFFICIENTS):
        row[FIT + i] = fit[i]


@kernel(STRICT)
def read_guess(row: Array, fit: Array) -> Value:
    """The surface that a row keeps; its polynomial is written into fit."""
    for i in range(COEFFICIENTS):
        fit[i] = row[FIT + i]
    return Value(int(row[STATE]), row[HEIGHT], (row[N_X], row[N_Y], row[N_Z]), (row[OFF_X], row[OFF_Y], row[OFF_Z]),
                 row[WEIGHT], row[SHIFT], (nan, nan, nan), int(row[DEGREE]))


@kernel(STRICT)
def show_centre(row: Array, fit: Array) -> None:
    """Lay what a row keeps behind the coefficients of a fit, where the search of centres looks for it."""
    for i in range(GUESS_WIDTH):
        fit[FIT_SIZE + i] = row[i]


@kernel(STRICT)
def is_near(row: Array, x: Vector, distance: float) -> bool:
    """Whether a point, relative to the centre, is within a distance of what a row keeps, or nothing is kept."""
    return int(row[STATE]) != r.CONTINUE or abs(row[HEIGHT] - dot((row[N_X], row[N_Y], row[N_Z]), x)) < distance


@kernel(STRICT)
def meets(row: Array, base: Vector, d: Vector, low: float, high: float, h: float) -> float:
    """The first s in low … high at which base + s·d meets what a row keeps; NaN for none.

    base: relative to the centre; h: the unit of the polynomial.
    """
    if int(row[STATE]) != r.CONTINUE:
        return nan
    n = (row[N_X], row[N_Y], row[N_Z])
    if row[DEGREE] == 0.0:
        s = (row[HEIGHT] - dot(n, base)) / dot(n, d)
        return s if low <= s <= high else nan
    (e1, e2), per_h = frame(n), 1.0 / h
    at = (dot(base, e1) * per_h, dot(base, e2) * per_h, dot(base, n) * per_h)
    to = (dot(d, e1), dot(d, e2), dot(d, n))
    line = line_quadratic(row[FIT:], at, to) if row[DEGREE] <= 2.0 else line_polynomial(row[FIT:], at, to)
    return first_root_above(line, low * per_h, high * per_h) * h
