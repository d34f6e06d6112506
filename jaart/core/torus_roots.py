"""Where lines cross a torus: bracketed between the critical points of their quartic, polished on the distance."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: Newton steps or bisections for one root at most; it takes five to ten.
STEPS = 80
EPSILON = float(np.finfo(float).eps)


class Line(NamedTuple):
    """Lines q + t d, unit d, q their point closest to the torus' centre; each (R,).

    above, up: q and d along the torus' axis; away, mixed, across: |q|², <q, d> and |d|² across it.
    """

    above: Array
    up: Array
    away: Array
    mixed: Array
    across: Array

    def at(self, t: Array) -> tuple[Array, Array]:
        """Distance from the axis and height above the ring's plane (R,)."""
        square = self.away + t * (2 * self.mixed + t * self.across)
        return np.sqrt(np.maximum(square, 0)), self.above + t * self.up

    def of(self, which: Mask) -> Line:
        """Some of the lines."""
        return Line(*(values[which] for values in self))


def crossings(line: Line, major: float, minor: float) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Entry and exit t (R,) of the first and of the second interval inside; NaN where there is none.

    Outside the outer sphere nothing is inside, so the crossings lie between there and the quartic's
    minima, and between these and the maximum between them.
    """
    result = _nowhere(len(line.up)), _nowhere(len(line.up))
    with np.errstate(invalid="ignore"):
        near = line.away + line.above**2 <= (major + minor) ** 2
    line, rows = line.of(near), np.flatnonzero(near)
    first, middle, last = critical(line, major, minor)
    in_first, in_middle, in_last = (inside(line, t, major, minor) for t in (first, middle, last))
    far = np.full(len(rows), 1.01 * (major + minor))
    once = in_first & in_middle & in_last
    # of which interval, of which lines, and between which points inside and outside its ends lie
    for (entry, leave), use, begin, end in (
            (result[0], once, (first, -far), (last, far)),
            (result[0], in_first & ~once, (first, -far), (first, middle)),
            (result[1], in_last & ~once, (last, middle), (last, far))):
        some = line.of(use)
        entry[rows[use]] = root(some, begin[0][use], begin[1][use], major, minor)
        leave[rows[use]] = root(some, end[0][use], end[1][use], major, minor)
    return result


def _nowhere(count: int) -> tuple[Array, Array]:
    return np.full(count, np.nan), np.full(count, np.nan)


def inside(line: Line, t: Array, major: float, minor: float) -> Mask:
    """Whether the points at t are inside or on the torus."""
    away, above = line.at(t)
    held: Mask = (away - major) ** 2 + above**2 <= minor**2
    return held


def critical(line: Line, major: float, minor: float) -> tuple[Array, Array, Array]:
    """The critical points of t⁴ + 2 p t² - 8 R² <q, d> t + ..., rising; thrice the same where it has one.

    Based on the foot point, the quartic (|x|² + R² - r²)² - 4 R² |x across the axis|² has no cubic term.
    """
    p = line.away + line.above**2 + (major - minor) * (major + minor) - 2 * major**2 * line.across
    q = -2 * major**2 * line.mixed
    # t³ + p t + q = 0, by cosines where there are three roots, by Cardano's formula where there is one
    depth = np.sqrt(np.maximum(-p / 3, 0))
    with np.errstate(all="ignore"):
        cosine = np.where(depth > 0, -q / (2 * depth**3), 0)
        angle = np.arccos(np.clip(cosine, -1, 1)) / 3
        three = [2 * depth * np.cos(angle - turn * 2 * math.pi / 3) for turn in (2, 1, 0)]
        inner = np.cbrt(-np.copysign(np.abs(q) / 2 + np.sqrt(np.maximum(q**2 / 4 + p**3 / 27, 0)), q))
        one = np.where(inner == 0, 0, inner - p / (3 * inner))
    single = (np.abs(cosine) > 1) | (depth == 0)
    rising = np.sort([np.where(single, one, root) for root in three], axis=0)
    return rising[0], rising[1], rising[2]


def root(line: Line, low: Array, high: Array, major: float, minor: float) -> Array:
    """The crossing between low, inside, and high, outside: Newton's method, bisecting where it leaves them.

    It looks for the zero of the distance from the ring's middle line less the tube's radius.
    """
    low, high = low.copy(), high.copy()
    found = _guess(line, low, high, major, minor)
    active = np.arange(len(found))
    for _ in range(STEPS):
        t = found[active]
        away, above = line.at(t)
        offset = away - major
        value = (offset**2 + above**2 - minor**2) / (2 * minor)
        np.copyto(low, t, where=value <= 0)
        np.copyto(high, t, where=value > 0)
        with np.errstate(all="ignore"):
            slope = (offset * (line.mixed + t * line.across) / away + above * line.up) / minor
            newton = t - value / slope
            after = np.where((newton - low) * (newton - high) <= 0, newton, (low + high) / 2)
        found[active] = after
        # below that both the step and the distance are rounding
        going = (np.abs(after - t) > 2 * EPSILON * np.abs(t)) & (np.abs(value) > EPSILON * major)
        line, low, high, active = line.of(going), low[going], high[going], active[going]
        if not len(active):
            break
    return found


def _guess(line: Line, low: Array, high: Array, major: float, minor: float) -> Array:
    """Where to begin between low and high: at the crossing itself where <q, d> is 0 across the axis.

    There the quartic is t⁴ + 2 p t² + c, as it is for a torus and a line along the lattice's axes.
    """
    k = line.away + line.above**2 + (major - minor) * (major + minor)
    p = k - 2 * major**2 * line.across
    root = np.sqrt(np.maximum(p**2 - k**2 + 4 * major**2 * line.away, 0))
    square = np.where(np.abs(high) > np.abs(low), root - p, -root - p)
    guess = np.copysign(np.sqrt(np.maximum(square, 0)), low + high)
    return np.where((guess - low) * (guess - high) < 0, guess, (low + high) / 2)
