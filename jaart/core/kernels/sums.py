"""Weighted sums over the surfels near x: only accumulated here, interpreted elsewhere.

Each takes the weights that `weigh` wrote down, so that a surface adds just the sums it uses.
"""

from __future__ import annotations

from jaart.core.kernels.jit import kernel
from jaart.core.kernels.near import normal, point
from jaart.core.kernels.records import Array, Near, Rule, Vector
from jaart.core.kernels.vectors import dot
from jaart.core.kernels.weigh import slope_factor, square_distance
from jaart.core.kernels.weights import exp_minus

#: The six different entries xx, xy, xz, yy, yz, zz of a symmetric matrix.
Symmetric = tuple[float, float, float, float, float, float]


@kernel()
def gaussian_sums(near: Near, x: Vector, h: float) -> tuple[float, Vector, Vector]:
    """Σθ, Σθ(p - x) and Σθn of all surfels with the Gaussian weight, in one pass that writes no weights down.

    It runs over whole vectors: what a place's columns are filled up with adds nothing.
    """
    per_h = 1.0 / h
    s = sx = sy = sz = mx = my = mz = 0.0
    for i in range(near.wide):
        p, n = point(near, i), normal(near, i)
        qx, qy, qz = p[0] - x[0], p[1] - x[1], p[2] - x[2]
        w = exp_minus(qx * per_h * (qx * per_h) + qy * per_h * (qy * per_h) + qz * per_h * (qz * per_h))
        s += w
        sx += w * qx
        sy += w * qy
        sz += w * qz
        mx += w * n[0]
        my += w * n[1]
        mz += w * n[2]
    return s, (sx, sy, sz), (mx, my, mz)


@kernel()
def offset_sums(near: Near, x: Vector, w: Array) -> Vector:
    """Σθ(p - x) [of T 2.12]."""
    sx = sy = sz = 0.0
    for i in range(near.size):
        p = point(near, i)
        sx += w[i] * (p[0] - x[0])
        sy += w[i] * (p[1] - x[1])
        sz += w[i] * (p[2] - x[2])
    return sx, sy, sz


@kernel()
def normal_sums(near: Near, w: Array) -> Vector:
    """Σθn [of T 2.13]."""
    mx = my = mz = 0.0
    for i in range(near.size):
        n = normal(near, i)
        mx += w[i] * n[0]
        my += w[i] * n[1]
        mz += w[i] * n[2]
    return mx, my, mz


@kernel()
def covariance_sums(near: Near, about: Vector, w: Array) -> Symmetric:
    """Σθ(p - about)(p - about)ᵀ [T §2.3.3; A 9]."""
    xx = xy = xz = yy = yz = zz = 0.0
    for i in range(near.size):
        p = point(near, i)
        bx, by, bz = p[0] - about[0], p[1] - about[1], p[2] - about[2]
        xx += w[i] * (bx * bx)
        xy += w[i] * (bx * by)
        xz += w[i] * (bx * bz)
        yy += w[i] * (by * by)
        yz += w[i] * (by * bz)
        zz += w[i] * (bz * bz)
    return xx, xy, xz, yy, yz, zz


@kernel()
def surfel_gradient_sums(near: Near, x: Vector, rule: Rule, n: Vector, off: Vector, turn: Vector,
                         w: Array) -> tuple[float, Vector]:
    """Σω b and Σω b (p - a), with b = <n, p - a> + <n_i, turn> and ∇θ_i = ω_i (p_i - x).

    n, off: normal and off-centre vector at x; turn: (off - f n)/|m|, how the normals' turning moves f.
    """
    per_h = 1.0 / rule.h
    s = sx = sy = sz = 0.0
    for i in range(near.size):
        p, own = point(near, i), normal(near, i)
        bx, by, bz = p[0] - x[0] - off[0], p[1] - x[1] - off[1], p[2] - x[2] - off[2]
        b = slope_factor(rule.weight, rule.h, square_distance(near, i, x, per_h), w[i])
        b *= n[0] * bx + n[1] * by + n[2] * bz + dot(own, turn)
        s += b
        sx += b * bx
        sy += b * by
        sz += b * bz
    return s, (sx, sy, sz)


@kernel()
def covariance_gradient_sums(near: Near, x: Vector, rule: Rule, n: Vector, off: Vector, centre: Vector, turn: Vector,
                             w: Array) -> tuple[float, Vector]:
    """Σω b and Σω b (p - a), with b = <n, p - a> + <turn, q><n, q>, q = p - x - centre, and ∇θ_i = ω_i (p_i - x).

    centre: what the covariance is taken about, from x on: off, or 0; turn: y of numerics, how the eigenvector
    turns.
    """
    per_h = 1.0 / rule.h
    s = sx = sy = sz = 0.0
    for i in range(near.size):
        p = point(near, i)
        gx, gy, gz = p[0] - x[0], p[1] - x[1], p[2] - x[2]
        bx, by, bz = gx - off[0], gy - off[1], gz - off[2]
        qx, qy, qz = gx - centre[0], gy - centre[1], gz - centre[2]
        b = slope_factor(rule.weight, rule.h, square_distance(near, i, x, per_h), w[i])
        b *= (n[0] * bx + n[1] * by + n[2] * bz
              + (turn[0] * qx + turn[1] * qy + turn[2] * qz) * (n[0] * qx + n[1] * qy + n[2] * qz))
        s += b
        sx += b * bx
        sy += b * by
        sz += b * bz
    return s, (sx, sy, sz)


@kernel()
def mahalanobis_sums(near: Near, x: Vector, c: float, w: Array) -> float:
    """Σθ·d_M with d_M = <q, n>² + c·|q - <q, n>n|² [T 2.17, 2.18]."""
    total = 0.0
    for i in range(near.size):
        p, n = point(near, i), normal(near, i)
        qx, qy, qz = p[0] - x[0], p[1] - x[1], p[2] - x[2]
        height = qx * n[0] + qy * n[1] + qz * n[2]
        across = qx * qx + qy * qy + qz * qz - height * height
        total += w[i] * (height * height + c * max(across, 0.0))
    return total
