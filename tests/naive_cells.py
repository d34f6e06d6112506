"""Which cells a ray passes, by brute force in rational arithmetic: a part of the slow oracle, see naive.py."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

Vector = Sequence[float]
Cell = tuple[int, int, int]


@dataclass
class Crossing:
    """A cell and the exact stretch of a ray inside it, t >= 0."""

    cell: Cell
    enter: Fraction
    leave: Fraction


def crossed_cells(origin: Vector, direction: Vector, extent: Cell) -> list[Crossing]:
    """Every cell whose half-open box the ray passes for a positive length of t > 0, in order.

    Brute force over all cells, in rational arithmetic on the floats as they are.
    """
    found = [c for c in _met(origin, direction, extent, closed=False) if c.leave > c.enter]
    return sorted(found, key=lambda c: c.enter)


def touched_cells(origin: Vector, direction: Vector, extent: Cell) -> set[Cell]:
    """Every cell whose closed box the ray meets at some t >= 0, the crossed ones included."""
    return {c.cell for c in _met(origin, direction, extent, closed=True)}


def _met(origin: Vector, direction: Vector, extent: Cell, *, closed: bool) -> list[Crossing]:
    slabs = [[_slab(Fraction(origin[k]), Fraction(direction[k]), i, closed) for i in range(extent[k])]
             for k in range(3)]
    found = []
    for i, j, k in product(*(range(n) for n in extent)):
        spans = [slabs[0][i], slabs[1][j], slabs[2][k]]
        if any(span is None for span in spans):
            continue
        enter = max(Fraction(0), *(span[0] for span in spans if span and span[0] is not None))
        leaves = [span[1] for span in spans if span and span[1] is not None]
        if leaves and enter <= min(leaves):
            found.append(Crossing((i, j, k), enter, min(leaves)))
    return found


def _slab(o: Fraction, d: Fraction, i: int, closed: bool) -> tuple[Fraction | None, Fraction | None] | None:
    """The t for which o + t·d lies in [i, i+1]; (None, None) = for every t, None = for none."""
    if d == 0:
        inside = i <= o <= i + 1 if closed else i <= o < i + 1
        return (None, None) if inside else None
    near, far = sorted(((i - o) / d, (i + 1 - o) / d))
    return near, far


def on_faces(cell: Cell, origin: Vector, direction: Vector) -> list[Cell]:
    """The cell a ray crosses, and for a ray that runs within faces those on the other side of them."""
    below = [(0, 1) if d == 0 and o > 0 and o == math.floor(o) else (0,)
             for o, d in zip(origin, direction, strict=True)]
    return [(cell[0] - i, cell[1] - j, cell[2] - k) for i, j, k in product(*below)]
