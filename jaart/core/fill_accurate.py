"""Fill levels from exact lengths: what solids cover of a line, integrated over the cell."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from jaart.core.interface_cells import interface_cells
from jaart.core.quadrature import integrate
from jaart.core.shapes import Array, Shape
from jaart.core.telling import tell

Ints = NDArray[np.intp]

#: Estimated error of a panel's area within a cell, and of a panel's length within a slice of it.
TOLERANCE = 2e-8, 4e-9
#: Cells integrated at a time: their lines fit into the processor's cache.
AT_ONCE = 256
#: Panels are as short as the thinnest solid, but not shorter than this.
THINNEST = 1 / 16
#: Panels narrower than this are rounding, and so are levels this close to 0 and 1.
NOTHING = 1e-12


def accurate(solids: Sequence[Shape], raster: int) -> Array:
    """Fill levels (raster, raster, raster) of a union of solids, in cells; the error stays below 1e-6.

    A cell's level is a double integral over the length that the solids cover of the lines through it
    along one axis, which their intervals give exactly. Kinks are looked for where the solids cross the
    edges of cells and slices and where they end; what else is not smooth is halved until it is.
    """
    levels, groups = interface_cells(solids, raster)
    done, total = 0, sum(len(cells) for _, cells in groups)
    for members, cells in groups:
        found = [solids[k] for k in members]
        steepest = _steepest(found, cells)
        for up in range(3):
            for piece in _pieces(cells[steepest == up]):
                levels[tuple(piece.T)] = _rounded(_levels(found, piece, up))
                done += len(piece)
                tell(done, total)
    return levels


def _pieces(cells: Ints) -> list[Ints]:
    return [cells[start:start + AT_ONCE] for start in range(0, len(cells), AT_ONCE)]


def _rounded(levels: Array) -> Array:
    """Levels in [0, 1]; those of cells that are full or empty but for rounding are 1 and 0."""
    return np.where(levels < NOTHING, 0.0, np.where(levels > 1 - NOTHING, 1.0, levels))


def _steepest(solids: Sequence[Shape], cells: Ints) -> Ints:
    """The axis (N,) along which the distance from the solids' surfaces changes most."""
    centre, change = cells + 0.5, np.zeros(cells.shape)
    for axis, step in enumerate(np.eye(3) / 2):
        for solid in solids:
            change[:, axis] += np.abs(solid.distance(centre + step) - solid.distance(centre - step))
    steepest: Ints = change.argmax(axis=1)
    return steepest


def _levels(solids: Sequence[Shape], cells: Ints, up: int) -> Array:
    """Levels (N,) of cells (N, 3) by lines along an axis."""
    x, y = (axis for axis in range(3) if axis != up)
    corner = cells.astype(np.float64)

    def area(cell: Ints, across: Array) -> Array:
        slices = _moved(corner[cell], (x, across))

        def length(which: Ints, along: Array) -> Array:
            return covered(solids, _moved(slices[which], (y, along)), up)

        ends = [slices, _moved(slices, (up, 1.0))]
        return integrate(length, *_panels(solids, ends, y), len(slices), TOLERANCE[1])

    edges = [_moved(corner, (y, b), (up, c)) for b in (0.0, 1.0) for c in (0.0, 1.0)]
    return integrate(area, *_panels(solids, edges, x), len(cells), TOLERANCE[0])


def _moved(points: Array, *steps: tuple[int, Array | float]) -> Array:
    """The points (R, 3), moved along some axes."""
    moved = points.copy()
    for axis, step in steps:
        moved[:, axis] += step
    return moved


def covered(solids: Sequence[Shape], origins: Array, axis: int) -> Array:
    """How much (R,) of the lines of length 1 from origins (R, 3) along an axis the union of solids covers."""
    spans = np.clip(_ends(solids, origins, axis), 0, 1)
    entry, leave = spans[:, 0], spans[:, 1]
    order = np.argsort(entry, axis=0)
    entry, leave = np.take_along_axis(entry, order, axis=0), np.take_along_axis(leave, order, axis=0)
    reached, total = np.zeros(len(origins)), np.zeros(len(origins))
    for begin, end in zip(entry, leave, strict=True):
        total += np.maximum(end - np.maximum(begin, reached), 0)
        reached = np.maximum(reached, end)
    return total


def _ends(solids: Sequence[Shape], origins: Array, axis: int) -> list[Array]:
    """Entry and exit (2, R) of each interval on lines along an axis, both 0 where there is none."""
    directions = np.broadcast_to(np.eye(3)[axis], origins.shape)
    spans = [span for solid in solids for span in solid.intervals(origins, directions)]
    return [np.nan_to_num([span.entry, span.exit], nan=0.0) for span in spans]


def _panels(solids: Sequence[Shape], lines: Sequence[Array], axis: int) -> tuple[Ints, Array, Array]:
    """Owner, low and high (P,) of the panels of each row: between the places in [0, 1] where its lines
    along an axis, given by their origins (R, 3), cross the solids or these end.
    """
    ends = np.unique(np.concatenate([solid.extremes()[:, axis] for solid in solids]))
    marks = [(ends[:, None] - lines[0][:, axis])]
    marks += [np.concatenate(_ends(solids, origins, axis)) for origins in lines]
    rows = np.ones((1, len(lines[0])))
    places = np.sort(np.concatenate([0 * rows, rows, np.clip(np.concatenate(marks), 0, 1)]), axis=0).T
    owner, which = np.nonzero(np.diff(places, axis=1) > NOTHING)
    low, high = places[owner, which], places[owner, which + 1]
    # no panel may step over a thin solid, or over the edge that two solids make
    longest = np.clip(min(solid.thickness for solid in solids), THINNEST, 1.0 if len(solids) == 1 else 0.5)
    parts = np.ceil((high - low) / longest - NOTHING).astype(np.intp)
    panel = np.repeat(np.arange(len(owner)), parts)
    number = np.arange(len(panel)) - np.repeat(np.cumsum(parts) - parts, parts)
    step = ((high - low) / parts)[panel]
    begin = low[panel] + number * step
    return owner[panel], begin, begin + step
