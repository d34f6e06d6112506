"""What a hit must keep: boundary control [T §2.5]."""

from __future__ import annotations

from math import inf, log

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.normals import sampling_gap
from jaart.core.kernels.records import Array, Bounds, Near, Value, Vector
from jaart.core.kernels.vectors import dot, length
from jaart.core.kernels.weigh import nearest_distance


@kernel(STRICT)
def angle_energy(n: Vector, off: Vector) -> float:
    """e_angle = |<c/|c|, n>| [T 2.23]; 0 where x = a(x), by continuity along the surface."""
    size = length(off)
    return abs(dot(off, n)) / size if size > 0.0 else 0.0


@kernel(STRICT)
def judged(near: Near, x: Vector, v: Value, bounds: Bounds, w: Array) -> int:
    """CONVERGED, or the state that names the first bound that a hit at x breaks.

    w: the weights of the surfels at x.
    """
    if length(v.off) > bounds.off_centre:
        return r.BOUNDED
    if bounds.log_weight > -inf and v.shift + log(v.weight) < bounds.log_weight:
        return r.BOUNDED_WEIGHT
    if bounds.nearest < inf and nearest_distance(near, x) > bounds.nearest:
        return r.BOUNDED_NEAREST
    if bounds.angle < inf and angle_energy(v.n, v.off) > bounds.angle:
        return r.BOUNDED_ANGLE
    if bounds.gap > 0.0 and sampling_gap(near, x, v.weight, v.off, w) < bounds.gap:
        return r.BOUNDED_GAP
    return r.CONVERGED
