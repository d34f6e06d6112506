"""Weighted sums over the surfels near x: only accumulated here, interpreted elsewhere."""

from __future__ import annotations

import numpy as np

from jaart.core.kernels.jit import kernel
from jaart.core.kernels.near import normal, point
from jaart.core.kernels.records import Near, Unsigned, Vector
from jaart.core.kernels.weights import exp_minus

_FIRST: Unsigned = np.uint64(0)

Sums = tuple[float, float, float, float, float, float, float]


@kernel()
def tangent_sums(near: Near, x: Vector, h: float) -> Sums:
    """Σθ, Σθ(p - x) and Σθn over all surfels [sums of T 2.12, 2.13].

    x: the query relative to the cell's centre; h: feature size.
    """
    per_h = 1.0 / h
    s = sx = sy = sz = mx = my = mz = 0.0
    for i in range(near.size):
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
    return s, sx, sy, sz, mx, my, mz


@kernel()
def square_distance(near: Near, i: Unsigned, x: Vector, per_h: float) -> float:
    """|p_i - x|²/h²."""
    p = point(near, i)
    qx, qy, qz = (p[0] - x[0]) * per_h, (p[1] - x[1]) * per_h, (p[2] - x[2]) * per_h
    return qx * qx + qy * qy + qz * qz


@kernel()
def nearest(near: Near, x: Vector, per_h: float) -> Unsigned:
    """Number of the surfel nearest to x."""
    found, least = _FIRST, square_distance(near, _FIRST, x, per_h)
    for i in range(near.size):
        square = square_distance(near, i, x, per_h)
        if square < least:
            found, least = i, square
    return found


@kernel()
def shifted_weight(near: Near, i: Unsigned, nearest_one: Unsigned, x: Vector, per_h: float) -> float:
    """θ_i / θ_nearest, 0 where it would underflow.

    The exponent (|q_i|² - |q_0|²)/h² is taken as (q_i - q_0)·(q_i + q_0)/h², in which nothing cancels.
    """
    p, p0 = point(near, i), point(near, nearest_one)
    e = ((p[0] - p0[0]) * per_h) * (((p[0] - x[0]) + (p0[0] - x[0])) * per_h)
    e += ((p[1] - p0[1]) * per_h) * (((p[1] - x[1]) + (p0[1] - x[1])) * per_h)
    e += ((p[2] - p0[2]) * per_h) * (((p[2] - x[2]) + (p0[2] - x[2])) * per_h)
    return exp_minus(max(e, 0.0)) if e < 700.0 else 0.0


@kernel()
def shifted_tangent_sums(near: Near, x: Vector, h: float) -> Sums:
    """The sums of `tangent_sums` with every weight divided by the nearest surfel's.

    Far away all weights underflow; their ratios do not. In the limit the nearest gets 1 and the
    others 0 [T §2.3.6].
    """
    per_h = 1.0 / h
    nearest_one = nearest(near, x, per_h)
    s = sx = sy = sz = mx = my = mz = 0.0
    for i in range(near.size):
        w = shifted_weight(near, i, nearest_one, x, per_h)
        p, n = point(near, i), normal(near, i)
        s += w
        sx += w * (p[0] - x[0])
        sy += w * (p[1] - x[1])
        sz += w * (p[2] - x[2])
        mx += w * n[0]
        my += w * n[1]
        mz += w * n[2]
    return s, sx, sy, sz, mx, my, mz


@kernel()
def mahalanobis_sums(near: Near, x: Vector, h: float, c: float) -> tuple[float, float]:
    """Σθ and Σθ·d_M with d_M = <q, n>² + c·|q - <q, n>n|² [T 2.17, 2.18], weights divided by the largest."""
    per_h = 1.0 / h
    nearest_one = nearest(near, x, per_h)
    s = total = 0.0
    for i in range(near.size):
        w = shifted_weight(near, i, nearest_one, x, per_h)
        p, n = point(near, i), normal(near, i)
        qx, qy, qz = p[0] - x[0], p[1] - x[1], p[2] - x[2]
        along = qx * n[0] + qy * n[1] + qz * n[2]
        across = qx * qx + qy * qy + qz * qz - along * along
        s += w
        total += w * (along * along + c * max(across, 0.0))
    return s, total
