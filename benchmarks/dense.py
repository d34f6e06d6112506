"""A dense look at f along rays, its extrema refined: the truth that searches are held against.

It reads the very lists of surfels that the searches use, and is written down once more, literally and slowly: every
weight, every sum, every sample. f(x) = <n(x), a(x) - x> with the surfels' normals [T 2.12, 2.13, 2.15].
"""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numba
import numpy as np

from jaart.core import prepare
from jaart.core.kernels.weigh import WENDLAND_END
from jaart.core.places import listed_near
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings
from jaart.core.tracers import OnLattice

#: Between two samples, in h.
STEP = 0.05
#: A root is one where |f| comes down to this; a larger value is a jump of f over 0. In h.
SMALL = 1e-9
#: Samples are closer by as much at most.
FINEST = 1e-6
GOLDEN = 0.5 * (math.sqrt(5) - 1)


@numba.njit(nogil=True, error_model="numpy")
def value(table: Any, x: float, y: float, z: float, i: int, j: int,
          k: int) -> tuple[float, float, float, float, float]:
    """f, n and |a - x| at a point, with the surfels near cell (i, j, k); NaN where none counts."""
    first, columns, shape, h, gaussian, _ = table
    cell = (i * shape[1] + j) * shape[2] + k
    count, base = first[cell + 1] - first[cell], 6 * first[cell]
    x, y, z = x - i - 0.5, y - j - 0.5, z - k - 0.5
    nearest = np.inf
    for s in range(base, base + count):
        q = (columns[s] - x) ** 2 + (columns[s + count] - y) ** 2 + (columns[s + 2 * count] - z) ** 2
        nearest = min(nearest, q)
    total = ax = ay = az = nx = ny = nz = 0.0
    for s in range(base, base + count):
        qx, qy, qz = columns[s] - x, columns[s + count] - y, columns[s + 2 * count] - z
        square = qx * qx + qy * qy + qz * qz
        if gaussian:
            w = math.exp((nearest - square) / (h * h))
        else:
            r = math.sqrt(square) / (WENDLAND_END * h)
            w = (1 - r) ** 4 * (4 * r + 1) if r < 1 else 0.0
        total += w
        ax, ay, az = ax + w * qx, ay + w * qy, az + w * qz
        nx += w * columns[s + 3 * count]
        ny += w * columns[s + 4 * count]
        nz += w * columns[s + 5 * count]
    size = math.sqrt(nx * nx + ny * ny + nz * nz)
    if not (total > 0 and size > 1e-8 * total):
        return np.nan, np.nan, np.nan, np.nan, np.nan
    off = math.sqrt(ax * ax + ay * ay + az * az) / total
    return (nx * ax + ny * ay + nz * az) / (size * total), nx / size, ny / size, nz / size, off


@numba.njit(nogil=True, error_model="numpy")
def cell_of(shape: Any, x: Any) -> tuple[int, int, int]:
    """The cell that a point is in, the nearest of the lattice for one outside."""
    return (min(max(int(math.floor(x[0])), 0), shape[0] - 1), min(max(int(math.floor(x[1])), 0), shape[1] - 1),
            min(max(int(math.floor(x[2])), 0), shape[2] - 1))


@numba.njit(nogil=True, error_model="numpy")
def f_at(table: Any, o: Any, d: Any, t: float) -> float:
    """f at a distance along a ray, with the list of the cell it is in there."""
    x = (o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2])
    i, j, k = cell_of(table[2], x)
    return value(table, x[0], x[1], x[2], i, j, k)[0]


@numba.njit(nogil=True, error_model="numpy")
def ended(table: Any, o: Any, d: Any, low: float, high: float) -> float:
    """The last place with an f between one that has none and one that has, or the other way round."""
    there = not math.isnan(f_at(table, o, d, low))
    for _ in range(60):
        middle = 0.5 * (low + high)
        if math.isnan(f_at(table, o, d, middle)) != there:
            low = middle
        else:
            high = middle
    return low if there else high


@numba.njit(nogil=True, error_model="numpy")
def halved(table: Any, o: Any, d: Any, low: float, high: float) -> float:
    """Where f changes its sign between two places."""
    rising = f_at(table, o, d, low) < 0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if (f_at(table, o, d, middle) < 0) == rising:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@numba.njit(nogil=True, error_model="numpy")
def extremum(table: Any, o: Any, d: Any, low: float, high: float, sign: float) -> float:
    """Where sign·f is least between two places, by golden section; its value is right to rounding there."""
    a, b = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    fa, fb = sign * f_at(table, o, d, a), sign * f_at(table, o, d, b)
    for _ in range(50):
        if fa < fb:
            high, b, fb = b, a, fa
            a = high - GOLDEN * (high - low)
            fa = sign * f_at(table, o, d, a)
        else:
            low, a, fa = a, b, fb
            b = low + GOLDEN * (high - low)
            fb = sign * f_at(table, o, d, b)
    return a if fa < fb else b


@numba.njit(nogil=True, error_model="numpy")
def is_surface(table: Any, o: Any, d: Any, t: float) -> bool:
    """Whether a change of sign is a root, f falls along n there, and the barycentre is near enough [T 2.21]."""
    h, x = table[3], (o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2])
    i, j, k = cell_of(table[2], x)
    f, nx, ny, nz, off = value(table, x[0], x[1], x[2], i, j, k)
    e = 1e-5 * h
    above, ax, ay, az, _ = value(table, x[0] + e * nx, x[1] + e * ny, x[2] + e * nz, i, j, k)
    below, bx, by, bz, _ = value(table, x[0] - e * nx, x[1] - e * ny, x[2] - e * nz, i, j, k)
    above *= 1.0 if ax * nx + ay * ny + az * nz > 0 else -1.0
    below *= 1.0 if bx * nx + by * ny + bz * nz > 0 else -1.0
    return abs(f) < SMALL * h and above <= below and off <= table[5]


@numba.njit(nogil=True, error_model="numpy")
def looked_at(table: Any, o: Any, d: Any, t: float) -> tuple[float, float, float, float, float]:
    """f and n at a distance along a ray."""
    x = (o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2])
    i, j, k = cell_of(table[2], x)
    return value(table, x[0], x[1], x[2], i, j, k)


@numba.njit(nogil=True, error_model="numpy")
def jumps(a: Any, b: Any, wide: float, h: float) -> bool:
    """Whether f or its normal is another one at the next sample, and more samples are due between them."""
    return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0.7 or abs(b[0] - a[0]) > max(1.4 * wide, 0.05 * h)


@numba.njit(nogil=True, error_model="numpy")
def root_in(table: Any, o: Any, d: Any, low: float, high: float) -> float:
    """The root between two places where f has different signs, NaN where that is no surface."""
    root = halved(table, o, d, low, high)
    return root if is_surface(table, o, d, root) else np.nan


@numba.njit(nogil=True, error_model="numpy")
def between(table: Any, o: Any, d: Any, samples: Any) -> float:
    """The first root between the last two of three samples, or about a dip at the middle one; NaN for none."""
    (t0, before), (t1, last), (t2, f) = samples
    if t1 == t1 and (last == last) != (f == f):
        edge = ended(table, o, d, t1, t2)
        low, high, side = (edge, t2, f) if f == f else (t1, edge, last)
        if f_at(table, o, d, edge) * side <= 0:
            return root_in(table, o, d, low, high)
    if last * f <= 0:
        return root_in(table, o, d, t1, t2)
    if before * last > 0 and abs(last) <= abs(before) and abs(last) <= abs(f):
        sign = 1.0 if last > 0 else -1.0
        dip = extremum(table, o, d, t0, t2, sign)
        if sign * f_at(table, o, d, dip) < 0:
            root = root_in(table, o, d, t0, dip)
            return root if root == root else root_in(table, o, d, dip, t2)
    return np.nan


@numba.njit(nogil=True, error_model="numpy")
def first_surface(table: Any, o: Any, d: Any, step: float) -> float:
    """The first t of the surface on a ray, NaN for none. Samples are closer where f or the normal jumps."""
    shape, enter, leave = table[2], 0.0, np.inf
    for axis in (0, 1, 2):
        a, b = -o[axis] / d[axis], (shape[axis] - o[axis]) / d[axis]
        enter, leave = max(enter, min(a, b)), min(leave, max(a, b))
    if not leave > enter:
        return np.nan
    t0, t1, before, wide = np.nan, enter, np.nan, step
    last = looked_at(table, o, d, t1)
    while t1 < leave:
        t2 = min(t1 + wide, leave)
        now = looked_at(table, o, d, t2)
        if jumps(last, now, t2 - t1, table[3]) and wide > step * FINEST:
            wide *= 0.5
            continue
        root = between(table, o, d, ((t0, before), (t1, last[0]), (t2, now[0])))
        if root == root:
            return root
        t0, t1, before, last, wide = t1, t2, last[0], now, min(2.0 * wide, step)
    return np.nan


@numba.njit(nogil=True, error_model="numpy")
def first_surfaces(table: Any, origins: Array, directions: Array, step: float, found: Array) -> None:
    """The same for each of some rays (R, 3)."""
    for ray in range(len(found)):
        found[ray] = first_surface(table, origins[ray], directions[ray], step)


def looked(scene: Scene, settings: Settings, origins: Array, directions: Array, step: float = STEP) -> Array:
    """The first t (R,) of each ray in a lattice, NaN where it misses; step in h."""
    ready = prepare.prepared(scene, settings)
    assert isinstance(ready.tracer, OnLattice) and ready.values.weight in ("gaussian", "wendland")
    sites, h = ready.tracer.sites, ready.values.h
    first, _, columns = listed_near(sites, np.indices(sites.shape).reshape(3, -1).T)
    table = (first, columns, sites.shape, h, ready.values.weight == "gaussian", ready.values.off_centre)
    found = np.empty(len(origins))
    pieces = np.array_split(np.arange(len(origins)), 64)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda piece: first_surfaces(table, origins[piece[0]:piece[-1] + 1],
                                                   directions[piece[0]:piece[-1] + 1], step * h,
                                                   found[piece[0]:piece[-1] + 1]), [p for p in pieces if len(p)]))
    return found
