"""The normal n(x), from the surfels' normals or from the spread of the points, and how it turns."""

from __future__ import annotations

from math import nan, sqrt

from jaart.core.kernels import records as r
from jaart.core.kernels.eigen import symmetric_eigen
from jaart.core.kernels.jit import kernel
from jaart.core.kernels.records import Array, Near, Rule, Vector
from jaart.core.kernels.sums import covariance_sums, normal_sums
from jaart.core.kernels.vectors import dot, scaled

#: |Σθn| below this share of Σθ leaves no normal: opposite surfels cancel.
CANCELLED = 1e-8
#: λ1 - λ0 below this share of λ2 leaves no normal: a line, a point or a ball of points.
_NO_GAP = 1e-8

#: (state, normal, turn): turn is what `gradients` needs to know of how the normal turns.
Normal = tuple[int, Vector, Vector]


@kernel()
def surfel_normal(near: Near, s: float, off: Vector, w: Array) -> Normal:
    """n(x) = Σθn / |Σθn| [T 2.13]; see `normal_of_sum`."""
    return normal_of_sum(normal_sums(near, w), s, off)


@kernel()
def normal_of_sum(total: Vector, s: float, off: Vector) -> Normal:
    """n = Σθn / |Σθn| [T 2.13]; turn = (c - <n, c>n)/|Σθ_N n|, c the off-centre vector."""
    m = scaled(total, 1.0 / s)
    size = sqrt(dot(m, m))
    if not size > CANCELLED:
        return r.UNDEFINED_NORMAL, (nan, nan, nan), (nan, nan, nan)
    n = scaled(m, 1.0 / size)
    f = dot(n, off)
    return r.CONTINUE, n, ((off[0] - f * n[0]) / size, (off[1] - f * n[1]) / size, (off[2] - f * n[2]) / size)


@kernel()
def covariance_normal(near: Near, x: Vector, rule: Rule, s: float, off: Vector, w: Array) -> Normal:
    """Unit eigenvector of the least eigenvalue of Σθ(p - z)(p - z)ᵀ, z = a(x) or x [T §2.3.3; A 8, 9].

    About a(x) it finds the same sheets without the ghosts that it finds about x. It points to the surfels' side
    where rule.oriented says so. turn = Σ_j u_j <u_j, c>/(λ0 - λ_j).
    """
    centre = off if rule.normal == r.COVARIANCE else (0.0, 0.0, 0.0)
    xx, xy, xz, yy, yz, zz = covariance_sums(near, (x[0] + centre[0], x[1] + centre[1], x[2] + centre[2]), w)
    e = symmetric_eigen(xx / s, xy / s, xz / s, yy / s, yz / s, zz / s)
    if not e.l1 - e.l0 > _NO_GAP * e.l2:
        return r.UNDEFINED_NORMAL, (nan, nan, nan), (nan, nan, nan)
    n = e.u0
    if rule.oriented == 1:
        side = dot(n, normal_sums(near, w))
        n = scaled(n, 1.0 if side >= 0.0 else -1.0)
    a, b = dot(e.u1, off) / (e.l0 - e.l1), dot(e.u2, off) / (e.l0 - e.l2)
    return r.CONTINUE, n, (a * e.u1[0] + b * e.u2[0], a * e.u1[1] + b * e.u2[1], a * e.u1[2] + b * e.u2[2])


@kernel()
def sampling_gap(near: Near, x: Vector, s: float, off: Vector, w: Array) -> float:
    """(λ1 - λ0)/λ2 of the covariance about a(x): 1 for a flat round sheet, 0 for a line or a ball [A Definition 2]."""
    xx, xy, xz, yy, yz, zz = covariance_sums(near, (x[0] + off[0], x[1] + off[1], x[2] + off[2]), w)
    e = symmetric_eigen(xx / s, xy / s, xz / s, yy / s, yz / s, zz / s)
    return (e.l1 - e.l0) / e.l2 if e.l2 > 0.0 else 0.0
