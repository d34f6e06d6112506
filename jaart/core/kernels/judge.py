"""What a hit must keep: boundary control [T §2.5]."""

from __future__ import annotations

from math import inf, log, nan

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.normals import sampling_gap
from jaart.core.kernels.records import Array, Bounds, Near, Value, Vector
from jaart.core.kernels.vectors import dot, length
from jaart.core.kernels.weigh import any_within


@kernel(STRICT)
def angle_energy(n: Vector, off: Vector) -> float:
    """e_angle = |<c/|c|, n>| [T 2.23]; 0 where x = a(x), by continuity along the surface."""
    size = length(off)
    return abs(dot(off, n)) / size if size > 0.0 else 0.0


@kernel(STRICT)
def judged(near: Near, x: Vector, v: Value, bounds: Bounds, w: Array) -> tuple[int, float]:
    """CONVERGED, or the state that names the first bound that a hit at x breaks; and (λ1 - λ0)/λ2 if it is bounded.

    w: the weights of the surfels at x.
    """
    if length(v.off) > bounds.off_centre:
        return r.BOUNDED, nan
    if bounds.log_weight > -inf and v.shift + log(v.weight) < bounds.log_weight:
        return r.BOUNDED_WEIGHT, nan
    if bounds.nearest < inf and not any_within(near, x, bounds.nearest):
        return r.BOUNDED_NEAREST, nan
    if bounds.angle < inf and angle_energy(v.n, v.off) > bounds.angle:
        return r.BOUNDED_ANGLE, nan
    if bounds.gap == -inf:
        return r.CONVERGED, nan
    gap = sampling_gap(near, x, v.weight, v.off, w)
    return (r.BOUNDED_GAP if gap < bounds.gap else r.CONVERGED), gap
