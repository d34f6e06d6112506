"""Where the search of a cell begins, and whether there is one: by the polynomial at the cell's centre, which is kept.

It begins where the ray meets the polynomial. A ray that neither does so nor crosses the polynomial's plane is not
searched in the cell.
"""

from __future__ import annotations

from math import nan

from jaart.core.kernels import records as r
from jaart.core.kernels.accept import ended
from jaart.core.kernels.address import fetch, floats_at, load, set_once, wholes_at
from jaart.core.kernels.blocks import ASKED, FITTED, LINE, ROWS, is_short
from jaart.core.kernels.call import evaluate_at
from jaart.core.kernels.guess import GUESS_WIDTH, HEIGHT, N_X, N_Y, N_Z, STATE, meets, write_guess
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import place_number, surfels_near
from jaart.core.kernels.records import Array, Bounds, Cell, End, Rule, Search, Sites, Spent, Start, Vector
from jaart.core.kernels.stepping import steps_from
from jaart.core.kernels.vectors import dot

#: From so far before the point where a ray enters the cell to so far beyond it the surface is looked for, in h.
BEFORE, BEYOND = 0.5, 2.5
#: Bytes of a row.
_ROW = 8 * GUESS_WIDTH


@kernel(STRICT, inline=True)
def fetch_row(sites: Sites, cell: Cell) -> None:
    """Fetch ahead what is kept at a cell's centre, if anything is kept of cells."""
    number, pool = place_number(sites, cell), sites.pool
    if pool[ROWS] > 0 and number >= 0:
        fetch(wholes_at(pool[ASKED], 1), number)
        for line in range(3):
            fetch(wholes_at(pool[ROWS] + _ROW * number, 1), line * LINE)


@kernel(STRICT)
def row_at(sites: Sites, cell: Cell, rule: Rule, evaluate: int, work: Array, fit: Array) -> int:
    """Address of what is kept at a cell's centre, made by the first ray that asks; 0 where there is no room for it.

    Two threads that make the same row write the same numbers.
    """
    number, pool = place_number(sites, cell), sites.pool
    asked, address = wholes_at(pool[ASKED], number + 1), pool[ROWS] + _ROW * number
    if number < 0 or load(asked, number) != 0:
        return address if number >= 0 else 0
    near = surfels_near(sites, cell)
    if is_short(pool):
        return 0
    taken = fit[r.EIGENVECTORS]  # what is kept for all rays is none's
    v = evaluate_at(evaluate, near, (0.0, 0.0, 0.0), rule, r.QUICK, work, fit)
    fit[r.EIGENVECTORS] = taken
    write_guess(floats_at(address, GUESS_WIDTH), v, fit)
    if set_once(asked, number, 1) == 0:
        pool[FITTED] += 1
    return address


@kernel(STRICT)
def keeps_away(row: Array, base: Vector, d: Vector, low: float, high: float) -> bool:
    """Whether base + s·d is on one side of the plane that a row keeps for s in low … high."""
    n = (row[N_X], row[N_Y], row[N_Z])
    height, slope = row[HEIGHT] - dot(n, base), dot(n, d)
    return (height - slope * low) * (height - slope * high) > 0.0


@kernel(STRICT)
def guess(row: Array, start: Start, d: Vector, h: float) -> float:
    """The s where a search should begin; NaN where the surface keeps away from the ray."""
    if int(row[STATE]) != r.CONTINUE:
        return start.s
    low, high = max(start.low, -BEFORE * h), min(start.high, BEYOND * h)
    s = meets(row, start.base, d, low, high, h)
    return s if s == s or keeps_away(row, start.base, d, low, high) else start.s


@kernel(STRICT)
def guessed_search(sites: Sites, rule: Rule, how: Search, bounds: Bounds, d: Vector, start: Start, rows: Array,
                   row: int, work: Array, fit: Array) -> End:
    """`steps_from` from where the polynomial at the cell's centre says; no step where the surface keeps away."""
    address = row_at(sites, start.cell, rule, how.evaluate, work, fit)
    s = guess(floats_at(address, GUESS_WIDTH), start, d, rule.h) if address != 0 else start.s
    if s != s:
        return ended(r.BACKGROUND, nan, nan, Spent(0, 0, 0, 0), nan)
    begin = Start(start.cell, start.base, start.t, s, start.low, start.high, start.before, start.number)
    return steps_from(sites, rule, how, bounds, d, begin, rows, row, work, fit)
