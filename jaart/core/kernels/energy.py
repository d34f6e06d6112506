"""The energies that a search minimises, and how they change along a ray.

∂θ_i/∂d = ω_i <q_i, d> with q_i = p_i - x; ω_i is `slope_factor`.
"""

from __future__ import annotations

from math import nan

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.judge import angle_energy
from jaart.core.kernels.near import normal, point
from jaart.core.kernels.records import Array, Near, Rule, Value, Vector
from jaart.core.kernels.sums import mahalanobis_sums
from jaart.core.kernels.vectors import dot, length
from jaart.core.kernels.weigh import slope_factor, square_distance


@kernel(STRICT)
def plain_energy(kind: int, near: Near, x: Vector, d: Vector, v: Value, c: float, w: Array) -> float:
    """|e_ts| [T 2.20], |f|, e_oc [T 2.22], e_M [T 2.18] or e_angle [T 2.23] at x.

    v: the surface at x; w: the weights there; c: of e_M.
    """
    if kind == r.OFF_CENTRE:
        return length(v.off)
    if kind == r.MAHALANOBIS:
        return mahalanobis_sums(near, x, c, w) / v.weight
    if kind == r.ANGLE:
        return angle_energy(v.n, v.off)
    return abs(v.f) if kind == r.TANGENT else abs(v.f / dot(v.n, d))


@kernel(STRICT)
def energy(kind: int, emphasise: int, near: Near, x: Vector, d: Vector, v: Value, c: float, w: Array) -> float:
    """The energy, or its emphasised form 1 - (1 - e_angle)(1 - e) with e capped at 1 [T 2.24]."""
    e = plain_energy(kind, near, x, d, v, c, w)
    return 1.0 - (1.0 - angle_energy(v.n, v.off)) * (1.0 - min(e, 1.0)) if emphasise == 1 else e


@kernel(STRICT)
def has_slope(kind: int, emphasise: int) -> bool:
    """Whether `energy_slope` has a closed form; then the energy needs no normal either."""
    return emphasise == 0 and (kind == r.OFF_CENTRE or kind == r.MAHALANOBIS)


@kernel(STRICT)
def off_centre_slope(near: Near, x: Vector, d: Vector, rule: Rule, v: Value, w: Array) -> float:
    """∂|c|/∂d = <c, J_a d - d>/|c|, J_a d = Σω_i <q_i, d>(q_i - c)/Σθ."""
    per_h, c = 1.0 / rule.h, v.off
    s = 0.0
    for i in range(near.size):
        p = point(near, i)
        qx, qy, qz = p[0] - x[0], p[1] - x[1], p[2] - x[2]
        change = slope_factor(rule.weight, rule.h, square_distance(near, i, x, per_h), w[i])
        change *= qx * d[0] + qy * d[1] + qz * d[2]
        s += change * ((qx - c[0]) * c[0] + (qy - c[1]) * c[1] + (qz - c[2]) * c[2])
    size = length(c)
    return (s / v.weight - dot(c, d)) / size if size > 0.0 else 0.0


@kernel(STRICT)
def mahalanobis_slope(near: Near, x: Vector, d: Vector, rule: Rule, v: Value, e: float, w: Array) -> float:
    """∂e_M/∂d = Σ(ω_i <q_i, d>(D_i - e_M) + θ_i D_i')/Σθ.

    D_i = (1 - c)<q, n>² + c|q|², D_i' = -2(1 - c)<q, n><n, d> - 2c<q, d>.
    """
    per_h, c = 1.0 / rule.h, rule.c
    s = 0.0
    for i in range(near.size):
        p, n = point(near, i), normal(near, i)
        qx, qy, qz = p[0] - x[0], p[1] - x[1], p[2] - x[2]
        ahead = qx * d[0] + qy * d[1] + qz * d[2]
        height = qx * n[0] + qy * n[1] + qz * n[2]
        distance = (1.0 - c) * height * height + c * (qx * qx + qy * qy + qz * qz)
        change = slope_factor(rule.weight, rule.h, square_distance(near, i, x, per_h), w[i]) * ahead
        s += change * (distance - e)
        s -= 2.0 * w[i] * ((1.0 - c) * height * (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]) + c * ahead)
    return s / v.weight


@kernel(STRICT)
def energy_slope(kind: int, near: Near, x: Vector, d: Vector, rule: Rule, v: Value, e: float, w: Array) -> float:
    """∂e/∂d of e_oc or e_M, NaN for another energy; e: the energy at x."""
    if kind == r.OFF_CENTRE:
        return off_centre_slope(near, x, d, rule, v, w)
    if kind == r.MAHALANOBIS:
        return mahalanobis_slope(near, x, d, rule, v, e, w)
    return nan
