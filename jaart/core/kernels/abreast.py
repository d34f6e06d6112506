"""Rays of a packet that search side by side: Adamson & Alexa's iteration with the surfels' averaged normals.

Only the sums over the surfels are taken ray by ray; what follows from them is a chain of a root, divisions and
comparisons, each waiting for the last, and goes in vectors. All of it is what `step_search`, `tangent_surfel` and
`accept` compute for a ray alone, with the same roundings.
"""

from __future__ import annotations

from math import nan, sqrt

import numpy as np

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import EXACT, STRICT, kernel
from jaart.core.kernels.normals import CANCELLED
from jaart.core.kernels.packet import (
    ABREAST,
    AT,
    DIRECTION,
    FOUND,
    LEAVE,
    LEFT,
    ORIGIN,
    STATE,
    WALKING,
    T,
    X,
    Y,
    Z,
    axes_in,
    spot_in,
)
from jaart.core.kernels.packet import ROOM as WALKED
from jaart.core.kernels.place import along_axis
from jaart.core.kernels.records import Array, Unsigned, Vector
from jaart.core.kernels.stepping import PARALLEL, ROUNDING
from jaart.core.kernels.traversal import onward
from jaart.core.kernels.vectors import along, dot, length, scaled

#: Columns behind those of a walk. BASE: the ray's point at T from the centre of the cell that the search begins in; S:
#: from there along the ray; CELL, POINT: where f is asked for; WEIGHT, PULL, TURN: Σθ, Σθ(p - x), Σθn; END: how the
#: search ends, CONTINUE while it goes on; ENERGY, OFF, NORMAL: last step, off-centre value, n(x); STEPS: of this start;
#: STARTS, EVALUATIONS, USED: of all.
_COLUMN = [np.uint64(WALKED + 64 * i) for i in range(27)]
BASE, S, CELL, POINT, WEIGHT = _COLUMN[0], _COLUMN[3], _COLUMN[4], _COLUMN[7], _COLUMN[10]
PULL, TURN, END, ENERGY, OFF = _COLUMN[11], _COLUMN[14], _COLUMN[17], _COLUMN[18], _COLUMN[19]
NORMAL, STEPS, STARTS, EVALUATIONS, USED = _COLUMN[20], _COLUMN[23], _COLUMN[24], _COLUMN[25], _COLUMN[26]
#: Floats that a packet takes whose rays search side by side.
ROOM = WALKED + 64 * 27
#: What a ray does beside walking: it searches, has hit, or has to be traced alone.
SEARCHING, MET, ALONE = 3.0, 4.0, 5.0
_GOES_ON, _PARALLEL, _LEFT_TRUST = float(r.CONTINUE), float(r.PARALLEL), float(r.LEFT_TRUST)
_CONVERGED, _FLOOR, _CAP = float(r.CONVERGED), float(r.FLOOR), float(r.CAP)
_BOUNDED, _UNDEFINED = float(r.BOUNDED), float(r.UNDEFINED_NORMAL)


@kernel(STRICT, inline=True)
def vector_in(p: Array, column: Unsigned, lane: Unsigned) -> Vector:
    """Three numbers of a ray, in three columns."""
    return p[column + X + lane], p[column + Y + lane], p[column + Z + lane]


@kernel(STRICT, inline=True)
def put_where(p: Array, column: Unsigned, lane: Unsigned, where: bool, value: float) -> None:
    """Write a number where something holds."""
    p[column + lane] = value if where else p[column + lane]


@kernel(STRICT, inline=True)
def put_vector(p: Array, column: Unsigned, lane: Unsigned, where: bool, value: Vector) -> None:
    """Write three numbers where something holds."""
    put_where(p, column + X, lane, where, value[0])
    put_where(p, column + Y, lane, where, value[1])
    put_where(p, column + Z, lane, where, value[2])


@kernel(STRICT)
def forget(p: Array, first: Unsigned) -> None:
    """Let a vector of rays begin with nothing searched."""
    for i in range(ABREAST):
        lane = first + i
        p[STARTS + lane] = p[EVALUATIONS + lane] = p[USED + lane] = p[STEPS + lane] = 0.0
        p[END + lane] = _GOES_ON


@kernel(EXACT)
def base_on(p: Array, first: Unsigned) -> None:
    """Write where rays that have found a cell are, from its centre."""
    for i in range(ABREAST):
        lane = first + i
        found = p[STATE + lane] == FOUND
        o, d, cell = vector_in(p, ORIGIN, lane), vector_in(p, DIRECTION, lane), vector_in(p, AT, lane)
        centre = cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5
        base = along((o[0] - centre[0], o[1] - centre[1], o[2] - centre[2]), d, p[T + lane])
        put_vector(p, BASE, lane, found, base)
        put_vector(p, POINT, lane, found, along(base, d, 0.0))
        put_vector(p, CELL, lane, found, cell)


@kernel(EXACT)
def begin(p: Array, first: Unsigned) -> int:
    """Begin a search where the rays of a vector have found a cell; returns how many do."""
    base_on(p, first)  # apart: in one loop there would be more columns than the compiler puts into vectors
    searching = 0
    for i in range(ABREAST):
        lane = first + i
        found = p[STATE + lane] == FOUND
        put_where(p, S, lane, found, 0.0)
        put_where(p, STEPS, lane, found, 0.0)
        put_where(p, ENERGY, lane, found, nan)
        put_where(p, OFF, lane, found, nan)
        put_where(p, END, lane, found, _GOES_ON)
        put_where(p, STARTS, lane, found, p[STARTS + lane] + 1.0)
        put_where(p, STATE, lane, found, SEARCHING)
        searching += 1 if found else 0
    return searching


@kernel(EXACT, inline=True)
def is_hit(end: float) -> bool:
    """Whether a search ended with a hit."""
    return (end == _CONVERGED) | (end == _FLOOR)


@kernel(EXACT, inline=True)
def end_before(defined: bool, slope: float) -> float:
    """How a search ends from whose place no step leads on, see `state_before`; CONTINUE where one does."""
    return (_PARALLEL if abs(slope) < PARALLEL else _GOES_ON) if defined else _UNDEFINED


@kernel(EXACT, inline=True)
def end_after(inside: bool, step: float, slope: float, rounding: float, arrived: float) -> float:
    """How a search ends after a step, see `state_after`; CONTINUE where it goes on.

    inside: whether the step led where hits count; rounding: a shorter one, seen along the ray, says nothing.
    """
    floor = not abs(step * slope) > rounding
    return (_CONVERGED if abs(step) < arrived else (_FLOOR if floor else _GOES_ON)) if inside else _LEFT_TRUST


@kernel(EXACT, inline=True)
def end_of(end: float, steps: float, cap: float, off: float, bound: float) -> float:
    """How a search ends with its hit judged and its steps counted."""
    hit = is_hit(end)
    return (_BOUNDED if off > bound else end) if hit else (_CAP if end == _GOES_ON and steps >= cap else end)


@kernel(EXACT)
def step(p: Array, nx: float, ny: float, nz: float, h: float, arrived: float, trust: float, cap: float, bound: float,
         first: Unsigned) -> int:
    """One step of every search of a vector from the sums that were taken [T 2.12, 2.13, 2.14]; how many go on."""
    searching = 0
    for i in range(ABREAST):
        lane = first + i
        goes = p[STATE + lane] == SEARCHING and p[END + lane] == _GOES_ON
        d, t, x = vector_in(p, DIRECTION, lane), p[T + lane], vector_in(p, POINT, lane)
        per_weight = 1.0 / p[WEIGHT + lane]
        off, m = scaled(vector_in(p, PULL, lane), per_weight), scaled(vector_in(p, TURN, lane), per_weight)
        size = sqrt(dot(m, m))
        defined = size > CANCELLED
        n = scaled(m, 1.0 / size if defined else nan)
        f, slope, away = dot(n, off), dot(n, d), length(off)
        step = f / slope
        s, cell = p[S + lane] + step, vector_in(p, AT, lane)
        to = along(vector_in(p, BASE, lane), d, s)
        to_i, to_x, of_x = along_axis(cell[0], to[0], nx)
        to_j, to_y, of_y = along_axis(cell[1], to[1], ny)
        to_k, to_z, of_z = along_axis(cell[2], to[2], nz)
        inside = of_x and of_y and of_z and max(-t, -trust) <= s <= trust and t + s > 0.0
        before = end_before(defined, slope)
        after = end_after(inside, step, slope, ROUNDING * (abs(s) + h + length(x)), arrived)
        end = end_of(after if before == _GOES_ON else before, p[STEPS + lane], cap, away, bound)
        put_where(p, END, lane, goes, end)
        put_where(p, ENERGY, lane, goes, step)
        put_where(p, OFF, lane, goes, away)
        put_where(p, S, lane, goes, s)
        put_vector(p, NORMAL, lane, goes, n)
        put_vector(p, CELL, lane, goes, (to_i, to_j, to_k))
        put_vector(p, POINT, lane, goes, (to_x, to_y, to_z))
        searching += 1 if goes and end == _GOES_ON else 0
    return searching


@kernel(STRICT)
def go_on(p: Array, nx: float, ny: float, nz: float, first: Unsigned) -> None:
    """Let the rays of a vector whose search hit nothing walk on from the cell that it began in."""
    for i in range(ABREAST):
        lane = first + i
        searched = p[STATE + lane] == SEARCHING
        hit = is_hit(p[END + lane])
        t, spot = onward(axes_in(p, lane, nx, ny, nz), spot_in(p, lane), 0.0)
        inside = 0.0 <= spot[0] < nx and 0.0 <= spot[1] < ny and 0.0 <= spot[2] < nz and t < p[LEAVE + lane]
        leads = searched and not hit
        put_where(p, STATE, lane, searched, MET if hit else (WALKING if inside else LEFT))
        put_where(p, T, lane, leads, t)
        put_vector(p, AT, lane, leads, spot)
