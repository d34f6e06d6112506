"""The tangent surface f(x) = <n(x), a(x) - x> [T 2.15, A 5], interpreted from its sums."""

from __future__ import annotations

from math import nan, sqrt

from jaart.core.kernels.jit import kernel
from jaart.core.kernels.records import CONTINUE, UNDEFINED_NORMAL, Near, Vector
from jaart.core.kernels.sums import nearest, shifted_tangent_sums, square_distance, tangent_sums

#: Below this Σθ the sums are done again with shifted weights (a distance of about 12 h).
_FAINT = 1e-60
#: |Σθn| below this share of Σθ leaves no normal: opposite surfels cancel.
_CANCELLED = 1e-8

#: (state, f, normal, off-centre vector, Σ, shift)
Tangent = tuple[int, float, Vector, Vector, float, float]


@kernel()
def tangent(near: Near, x: Vector, h: float) -> Tangent:
    """f [T 2.15], the normal n(x) [T 2.13] and the off-centre vector a(x) - x [T 2.12] at x.

    near: at least one surfel; x: relative to the cell's centre; h: feature size. The state is CONTINUE, or
    UNDEFINED_NORMAL when the normals cancel (f and n are NaN then). log Σθ is shift + log Σ.
    """
    s, sx, sy, sz, mx, my, mz = tangent_sums(near, x, h)
    shift = 0.0
    if not s > _FAINT:
        s, sx, sy, sz, mx, my, mz = shifted_tangent_sums(near, x, h)
        shift = -square_distance(near, nearest(near, x, 1.0 / h), x, 1.0 / h)
    off = (sx / s, sy / s, sz / s)
    m = sqrt(mx * mx + my * my + mz * mz)
    if not m > _CANCELLED * s:
        return UNDEFINED_NORMAL, nan, (nan, nan, nan), off, s, shift
    n = (mx / m, my / m, mz / m)
    return CONTINUE, n[0] * off[0] + n[1] * off[1] + n[2] * off[2], n, off, s, shift
