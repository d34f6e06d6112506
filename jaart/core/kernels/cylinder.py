"""Schaufler and Jensen's hit of a ray with surfels: the mean of those in a cylinder around it [2000; A §2].

Every surfel is a disc of radius r that both faces of count. The first disc that the ray o + s·d hits, at s_0, places
a cylinder of radius r and length 2r about the ray, its middle at s_0. Of the surfels in it those take part whose
planes the axis meets within it, at s_i, with weights w_i = r - (distance from the axis): the hit is at Σw_i s_i/Σw_i
with the normal Σw_i n_i/|Σw_i n_i|. The surface depends on the ray; on a plane it is exact.
"""

from __future__ import annotations

from math import inf, log, nan, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import records as r
from jaart.core.kernels.blocks import is_short
from jaart.core.kernels.empty_space import away
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import normal, point, surfels_near
from jaart.core.kernels.packet import is_bad
from jaart.core.kernels.place import centre_of, in_scene
from jaart.core.kernels.ray import no_hit, write_end
from jaart.core.kernels.records import Array, Cell, Cells, Near, Out, RayEnd, Sites, Vector
from jaart.core.kernels.traversal import advance, axes_of, cell_at, clip, inside
from jaart.core.kernels.unowned import unowned, unowned_cells
from jaart.core.kernels.vectors import along, dot, length, scaled

#: A disc is edge-on when |<d, n>| is not above this.
_PARALLEL = 1e-12
#: |Σwn| not above this share of Σw leaves no normal: opposite surfels cancel.
CANCELLED = 1e-8
_NOTHING = (nan, nan, nan)


class Mean(NamedTuple):
    """What a cylinder's surfels come to: Σw, Σw(s - s_0)/Σw, Σwp/Σw, Σwn/Σw and how many they are."""

    weight: float
    ahead: float
    centre: Vector
    n: Vector
    many: int


@kernel(STRICT)
def plane_s(base: Vector, d: Vector, p: Vector, n: Vector) -> float:
    """Where the line base + s·d meets a surfel's plane; NaN where it runs along it."""
    cosine = dot(d, n)
    return dot((p[0] - base[0], p[1] - base[1], p[2] - base[2]), n) / cosine if abs(cosine) > _PARALLEL else nan


@kernel(STRICT)
def first_disc(near: Near, base: Vector, d: Vector, low: float, radius: float) -> float:
    """The least s >= low at which the line base + s·d hits a disc; infinite when it hits none."""
    first, square = inf, radius * radius
    for i in range(near.size):
        p = point(near, i)
        s = plane_s(base, d, p, normal(near, i))
        x, y, z = base[0] + s * d[0] - p[0], base[1] + s * d[1] - p[1], base[2] + s * d[2] - p[2]
        if low <= s < first and x * x + y * y + z * z < square:
            first = s
    return first


@kernel(STRICT)
def share(p: Vector, n: Vector, x: Vector, d: Vector, radius: float) -> tuple[float, float]:
    """(w, s) of a surfel in the cylinder about the line x + s·d, its middle at x; w = 0 where it takes no part."""
    away = p[0] - x[0], p[1] - x[1], p[2] - x[2]
    foot, s = dot(away, d), plane_s(x, d, p, n)
    w = radius - length(along(away, d, -foot))
    return (w, s) if w > 0.0 and abs(foot) <= radius and abs(s) <= radius else (0.0, 0.0)


@kernel(STRICT)
def mean_of(near: Near, x: Vector, d: Vector, radius: float) -> Mean:
    """The mean of the surfels in the cylinder about the line x + s·d, its middle at x."""
    weight = ahead = cx = cy = cz = nx = ny = nz = 0.0
    many = 0
    for i in range(near.size):
        p, n = point(near, i), normal(near, i)
        w, s = share(p, n, x, d, radius)
        weight += w
        ahead += w * s
        cx, cy, cz = cx + w * p[0], cy + w * p[1], cz + w * p[2]
        nx, ny, nz = nx + w * n[0], ny + w * n[1], nz + w * n[2]
        many += 1 if w > 0.0 else 0
    return Mean(weight, ahead / weight, scaled((cx, cy, cz), 1.0 / weight), scaled((nx, ny, nz), 1.0 / weight), many)


@kernel(STRICT, entry=True)
def write_shares(sites: Sites, cell: Cell, x: Vector, d: Vector, radius: float, w: Array) -> None:
    """Write the weights, sum 1, of a cell's surfels in the cylinder whose middle is at x."""
    near, total = surfels_near(sites, cell), 0.0
    for i in range(near.size):
        w[i] = share(point(near, i), normal(near, i), x, d, radius)[0]
        total += w[i]
    for i in range(near.size):
        w[i] = w[i] / total


@kernel(STRICT)
def log_mean(rows: Array, cells: Cells, cell: Cell, t: float, x: Vector, m: Mean, n: Vector, state: int) -> int:
    """Write the one step that there is, from the first disc to the mean; returns the rows that it takes."""
    if rows.shape[0] > 0:
        to = rows[0]
        to[r.START], to[r.T], to[r.STEP], to[r.WEIGHT], to[r.END] = 0.0, t, m.ahead, log(m.weight), state
        to[r.X], to[r.Y], to[r.Z] = in_scene(cells.sites, cell, x)
        to[r.AX], to[r.AY], to[r.AZ] = in_scene(cells.sites, cell, m.centre)
        to[r.NX], to[r.NY], to[r.NZ] = n
        to[r.OFF] = length((m.centre[0] - x[0], m.centre[1] - x[1], m.centre[2] - x[2]))
        to[r.CELL_I], to[r.CELL_J], to[r.CELL_K] = cell
    return 1


@kernel(STRICT)
def hit_of(cells: Cells, cell: Cell, near: Near, t: float, x: Vector, d: Vector, radius: float, rows: Array) -> RayEnd:
    """The end of a ray whose first disc it hits at t, which is at x relative to the cell's centre.

    The energy is the distance of the hit from the first disc, off that from the mean of the points.
    """
    m = mean_of(near, x, d, radius)
    size = sqrt(dot(m.n, m.n))
    if not size > CANCELLED or t + m.ahead <= 0.0:  # the mean of what lies ahead may lie behind
        state = r.LEFT_TRUST if size > CANCELLED else r.UNDEFINED_NORMAL
        written = log_mean(rows, cells, cell, t, x, m, _NOTHING, state)
        return RayEnd(state, nan, _NOTHING, _NOTHING, nan, nan, 1, 1, m.many, 0, 0, nan, written, -1)
    n, hit = scaled(m.n, 1.0 / size), along(x, d, m.ahead)
    place = in_scene(cells.sites, cell, hit)
    written = log_mean(rows, cells, cell, t, x, m, n, r.CONVERGED)
    off = length((m.centre[0] - hit[0], m.centre[1] - hit[1], m.centre[2] - hit[2]))
    return RayEnd(r.CONVERGED, t + m.ahead, place, n, m.ahead, off, 1, 1, m.many, 0, 0, nan, written, -1)


@kernel(STRICT)
def cylinder_ray(cells: Cells, radius: float, o: Vector, d: Vector, rows: Array) -> RayEnd:
    """The hit of a ray, or why it has none.

    o, d: origin and unit direction, in cells; radius: of discs and cylinder. Every cell lists all surfels within √2
    radii of any of its points, so that the one in which the ray first hits a disc has the whole cylinder. Discs count
    where they are within the lattice.
    """
    if is_bad(o, d):
        return no_hit(r.BAD_RAY)
    shape = cells.empty.shape
    axes = axes_of(o, d, shape)
    enter, leave = clip(axes)
    t, end, visited = enter, no_hit(r.BACKGROUND), 0
    cell = cell_at(axes, t) if t <= leave else (-1, -1, -1)
    while inside(cell, shape):
        visited += 1
        free = away(cells.empty, cell) - cells.halo
        t_next, ahead = advance(axes, cell, max(free - 1, 0))
        near = surfels_near(cells.sites, cell)
        if near.size > 0:
            centre = centre_of(cells.sites, cell)
            base = along((o[0] - centre[0], o[1] - centre[1], o[2] - centre[2]), d, t)
            s = first_disc(near, base, d, enter - t, radius)
            if t + s <= min(t_next, leave):
                end = hit_of(cells, cell, near, t + s, along(base, d, s), d, radius, rows)
                break
        t, cell = t_next, ahead
        if not t < leave:  # a skipped block may reach past the lattice
            break
    return RayEnd(end.state, end.t, end.point, end.n, end.energy, end.off, end.iterations, end.evaluations, end.used,
                  visited, end.lowered, end.gap, end.rows, end.missing)


@kernel(STRICT, entry=True)
def cylinder_rays(cells: Cells, radius: float, origins: Array, directions: Array, pixels: NDArray[np.int64], out: Out,
                  rows: Array) -> tuple[int, int]:
    """Trace some of the rays and write each into its row of the columns; returns how many of them, before one for which
    the pool was short, and the rows of the log it wrote.

    origins, directions: (R, 3) in cells, directions of unit length; rows: the log of a single ray, (0, LOG_WIDTH) for
    none.
    """
    cells, log_rows, written = unowned_cells(cells), unowned(rows), 0
    for i in range(pixels.shape[0]):
        to = pixels[i]
        o = (origins[to, 0], origins[to, 1], origins[to, 2])
        d = (directions[to, 0], directions[to, 1], directions[to, 2])
        end = cylinder_ray(cells, radius, o, d, log_rows)
        if is_short(cells.sites.pool):
            return i, 0
        write_end(out, to, end)
        written = end.rows
    return pixels.shape[0], written
