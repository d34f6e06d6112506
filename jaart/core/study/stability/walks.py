"""Rows 39 to 43: rays through faces, edges and corners of the cells."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import traversal
from jaart.core.render import unit
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings
from jaart.core.study.stability.case import Outcome, case, largest
from jaart.core.study.stability.looks import thesis_sphere
from jaart.core.study.stability.scenes import shot
from jaart.core.trace import trace

#: Searches that end at a root of f, or cross it.
ROOTS = ("iterate", "secant", "newton", "march", "safe")
LONG_LISTS = Settings(tolerance=1e-10, max_iterations=100).replace(h=0.8, radius=6)
#: The lattice that random rays cross.
SHAPE = (20, 14, 17)


def _one_cell(edge: int) -> Scene:
    """A lattice of so many cells along each edge, one of them full."""
    filled = np.zeros((edge, edge, edge))
    filled[edge // 2, edge // 2, edge // 2] = 1.0
    return Scene("case", levels=filled)


def _cells(edge: int, origin: list[float], direction: list[float]) -> list[list[int]]:
    crossed: list[list[int]] = trace(_one_cell(edge), Settings(), origin, direction).cells.tolist()
    return crossed


@case(39, "a ray along -x that starts on a cell's face, x = 5 of 5 cells",
      "cells 4, 3, 2, 1, 0; from x = 4 cells 3, 2, 1, 0")
def start_on_a_face() -> Outcome:
    """The cell of a point on a face is the one that the ray runs into."""
    outer, inner = (_cells(5, [x, 2.5, 2.5], [-1, 0, 0]) for x in (5.0, 4.0))
    return Outcome(f"cells {', '.join(str(c[0]) for c in outer)}; {', '.join(str(c[0]) for c in inner)}",
                   outer == [[i, 2, 2] for i in (4, 3, 2, 1, 0)] and inner == [[i, 2, 2] for i in (3, 2, 1, 0)])


@case(40, "a diagonal through the corners of 8³ cells, along -(1, 1, 1)", "8 cells")
def diagonal_through_corners() -> Outcome:
    """Through a corner all three indices change at once."""
    crossed = _cells(8, [8, 8, 8], [-1, -1, -1])
    return Outcome(f"{len(crossed)} cells: {crossed[0]} to {crossed[-1]}",
                   crossed == [[i, i, i] for i in range(7, -1, -1)])


@case(41, "random rays through 20 x 14 x 17 cells, a third of them from and to corners of cells", "no loop: each ends "
      "within nx + ny + nz + 3 steps, in cells that touch", rays=(2000, 500))
def random_rays(count: int) -> Outcome:
    """Planes are crossed at a t that is computed from their index, never summed up."""
    rng = np.random.default_rng(41)
    origins, targets = rng.uniform(-5, 25, (count, 3)), rng.uniform(0, 1, (count, 3)) * SHAPE
    origins[::3], targets[::3] = np.round(origins[::3]), np.round(targets[::3])
    directions = np.where((origins == targets).all(axis=1, keepdims=True), 1.0, targets - origins)
    most, longest, broken = sum(SHAPE) + 3, 0, 0
    for o, d in zip(origins, unit(directions), strict=True):
        cells, borders = np.empty((most, 3), np.int32), np.empty(most + 1)
        n = traversal.crossed(o, d, SHAPE, cells, borders)
        longest, broken = max(longest, n), broken + (not _is_path(cells[:n], borders[:n + 1], o, d))
    return Outcome(f"{broken} of {count} rays broken; the longest takes {longest} of {most} steps",
                   broken == 0 and 0 < longest < most)


def _is_path(cells: NDArray[np.int32], borders: Array, o: Array, d: Array) -> bool:
    """Whether each cell is crossed once, beside the one before, and holds the ray between its borders."""
    if not len(cells):
        return True
    steps, way = np.diff(cells, axis=0), np.diff(borders)
    middle = o + (borders[:-1] + way / 2)[:, None] * d
    off = np.abs(middle - cells - 0.5) - 0.5
    return bool((np.abs(steps) <= 1).all() and (np.abs(steps).sum(axis=1) > 0).all() and (way >= 0).all()
                and (off < 1e-12).all())


@case(42, "rays along edges and corners of cells and within their faces, into a sphere",
      "the hits of rays 1e-9 beside: none is lost or made by who owns a face")
def along_edges_and_corners() -> Outcome:
    """Four rays beside each, lists of 6 cells, so that f is the same from every cell to 1e-16."""
    origins, directions = _aligned()
    rng, lost, worst, hits = np.random.default_rng(42), 0, 0.0, 0
    for search in ROOTS:
        settings = LONG_LISTS.replace(search=search)
        on = shot(thesis_sphere(), settings, origins, directions)
        hits += int(on.hit.sum())
        for _ in range(4):
            aside = 1e-9 * unit(np.cross(directions, rng.normal(size=origins.shape)))
            beside = shot(thesis_sphere(), settings, origins + aside, directions)
            lost += int((beside.hit != on.hit).sum())
            worst = largest(worst, np.abs(beside.t - on.t)[on.hit & beside.hit])
    return Outcome(f"{hits} hits of {len(ROOTS) * len(origins)} rays, {lost} other than beside; t differs by "
                   f"{worst:.1e} at most", lost == 0 and hits > 0 and worst < 1e-8)


def _aligned() -> tuple[Array, Array]:
    """Rays along edges, within faces, and through corners of the cells about the middle of the lattice."""
    rays = [(np.roll((-1.0, i, j + half), axis), np.roll((1.0, 0.0, 0.0), axis)) for axis in range(3)
            for i, j in itertools.product((5, 7, 8, 10, 11), repeat=2) for half in (0, 0.5)]
    for signs in itertools.product((1.0, -1.0), repeat=3):
        rays += [(8 - 9 * np.array(signs) + shift, np.array(signs)) for shift in ((0, 0, 0), (1, 0, 0), (0, -2, 1))]
    return np.array([o for o, _ in rays]), np.array([d for _, d in rays])


@case(43, "directions with 0.0 and -0.0 that run within faces", "the same cells and hit for both; a component of 0 "
      "never ends a cell")
def zero_and_minus_zero() -> Outcome:
    """The plane of such an axis is met at +inf, whatever the sign of its 0."""
    same, crossed = [], set()
    for axis, i, j in itertools.product(range(3), (5.0, 8.0, 11.0), (8.0, 8.5)):
        found = [trace(thesis_sphere(), Settings(), np.roll((-1.0, i, j), axis), np.roll((1.0, zero, zero), axis))
                 for zero in (0.0, -0.0)]
        same.append(np.array_equal(found[0].cells, found[1].cells) and found[0].hit and found[0].t == found[1].t)
        crossed.add(len(found[0].cells))
    return Outcome(f"{sum(same)} of {len(same)} pairs of rays the same, through {', '.join(map(str, crossed))} cells",
                   all(same) and crossed == {16})
