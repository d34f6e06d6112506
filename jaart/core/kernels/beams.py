"""How far all rays of a block of pixels run through nothing: found once for the block, by the ray through its middle.

Around every point of that ray the distance field says how far no surfel counts. While the other rays of the block are
within that, none of them can meet anything.
"""

from __future__ import annotations

from math import floor, inf

from jaart.core.kernels.empty_space import away
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.pinhole import EDGE, View, ray_at
from jaart.core.kernels.records import Array, Empty, Vector
from jaart.core.kernels.vectors import along, length

#: A shorter step than this, in cells, leads to what is near; no block takes more steps.
_SHORTEST, _MOST = 0.5, 200
#: More than rounding moves a point, in cells, and as a share of its distance.
_SLACK, _SHARE = 1e-6, 1e-12


@kernel(STRICT)
def free_around(empty: Empty, p: Vector, near: int) -> float:
    """How far from a point, along each axis, no cell is within `near` cells of one with a surfel."""
    nx, ny, nz = empty.shape
    outside = max(max(max(-p[0], p[0] - nx), max(-p[1], p[1] - ny)), max(-p[2], p[2] - nz))
    cell = (_index(p[0], empty.shape[0]), _index(p[1], empty.shape[1]), _index(p[2], empty.shape[2]))
    return max(outside, float(away(empty, cell) - near - 1))


@kernel(STRICT)
def _index(x: float, n: int) -> int:
    """Index of the cell nearest to a coordinate."""
    return int(floor(min(max(x, 0.0), n - 1.0)))


@kernel(STRICT)
def width_of(view: View, x: Vector, y: Vector) -> tuple[float, float]:
    """How far the rays of a block are from the one through its middle: a + b·t.

    x, y: first, middle and last place of the block.
    """
    o, d = ray_at(view, x[1], y[1])
    a = b = 0.0
    for i in range(0, 3, 2):
        for j in range(0, 3, 2):
            p, e = ray_at(view, x[i], y[j])
            a, b = max(a, length(along(p, o, -1.0))), max(b, length(along(e, d, -1.0)))
    return a, b


@kernel(STRICT)
def empty_until(view: View, empty: Empty, near: int, x: Vector, y: Vector) -> float:
    """The t before which no ray of a block is within `near` cells of a cell with a surfel; inf: none ever is."""
    (o, d), (a, b) = ray_at(view, x[1], y[1]), width_of(view, x, y)
    nx, ny, nz = empty.shape
    half = (0.5 * nx, 0.5 * ny, 0.5 * nz)
    far, t = length(along(o, half, -1.0)) + length(half) + a, 0.0
    for _ in range(_MOST):
        free = free_around(empty, along(o, d, t), near)
        step = (free - a - t * b - _SLACK - t * _SHARE) / (1.0 + b)
        if step < _SHORTEST:
            return t
        t += step
        if t > far:
            return inf
    return t


@kernel(STRICT)
def _places(block: int, size: int) -> Vector:
    """First, middle and last pixel centre of a block along an edge of the picture."""
    first, last = block * EDGE + 0.5, min(block * EDGE + EDGE, size) - 0.5
    return first, 0.5 * (first + last), last


@kernel(STRICT, entry=True)
def write_blocks(view: View, empty: Empty, near: int, begin: int, end: int, blocks: Array) -> None:
    """Write `empty_until` of the rows begin … end of blocks (blocks down, blocks across)."""
    for j in range(begin, end):
        for i in range(blocks.shape[1]):
            blocks[j, i] = empty_until(view, empty, near, _places(i, view.width), _places(j, view.height))
