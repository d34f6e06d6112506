"""The reference plane of the point-set surface by non-linear minimisation [Levin 2003; Alexa et al. 2003; T 2.11].

E(t, n) = Σ <n, p_i - q>² θ(|p_i - q|) over q = r + t·n: the weights move with the plane, so that no eigenvector is its
minimum. Newton's method with exact first and second derivatives by t and by two tilts of n, every length in h.
"""

from __future__ import annotations

from math import exp, inf, sqrt
from typing import NamedTuple

from jaart.core.kernels import records as r
from jaart.core.kernels.eigen import symmetric_eigen
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.near import point
from jaart.core.kernels.records import Array, Near, Rule, Vector
from jaart.core.kernels.vectors import along, dot, frame, scaled
from jaart.core.kernels.weigh import WENDLAND_END, slope_factor, weigh

#: Half the range of (t - t0)/h and of both tangents of the tilt.
_RANGE = 0.5
#: A plane that is driven this close to the end of the range lies beyond it.
_EDGE = 1e-3
#: The longest step.
_LONGEST = 0.25
#: Shorter steps are taken whatever E says: it is flat to rounding there.
_SURE = 1e-4
#: After a shorter step the next one would be below rounding.
_LAST = 1e-8
#: No plane takes more steps; most take four.
_MOST = 50


class Bowl(NamedTuple):
    """E, its gradient (t, u, v) and its second derivatives, about a plane; shift: of the weights."""

    e: float
    g: Vector
    tt: float
    tu: float
    tv: float
    uu: float
    uv: float
    vv: float
    weight: float
    shift: float


@kernel()
def bend_factor(weight: int, y: float, w: float) -> float:
    """4·d²θ/dy² of a surfel; y: q²/h²; w: θ itself."""
    if w == 0.0:
        return 0.0
    if weight == r.GAUSSIAN:
        return 4.0 * w
    if weight == r.SQUARED_HAT or not y > 0.0:
        return 0.0
    if weight == r.HAT:
        return 1.0 / (y * sqrt(y))
    u = 1.0 - sqrt(y) / WENDLAND_END
    return 60.0 * u * u / (WENDLAND_END * WENDLAND_END * WENDLAND_END * sqrt(y))


@kernel()
def bowl(near: Near, x: Vector, t: float, n: Vector, rule: Rule, w: Array) -> Bowl:
    """E and its derivatives at the plane through x + t·h·n with normal n, divided by h².

    n turns to (n + α·u + β·v)/|…|, (u, v) = frame(n). With b = p - q, s = <n, b>, ψ = -θ'/q and χ = 4·d²θ/d(q²)²:
    E_t = s³ψ - 2sθ, E_α = (2sθ + ts²ψ) b_u, E_tt = 2θ - 5s²ψ + s⁴χ, E_tα = (3s²ψ - 2stψ - 2θ + s³tχ) b_u,
    E_αβ = (2θ + 4stψ + s²t²χ) b_u b_v, less (s + t)s(2θ + stψ) where α = β, each summed over the surfels.
    """
    per_h, (u, v) = 1.0 / rule.h, frame(n)
    q = along(x, n, t * rule.h)
    weight, shift = weigh(near, q, rule, w)
    e = gt = gu = gv = tt = tu = tv = uu = uv = vv = 0.0
    for i in range(near.size):
        p = point(near, i)
        bx, by, bz = (p[0] - q[0]) * per_h, (p[1] - q[1]) * per_h, (p[2] - q[2]) * per_h
        s = bx * n[0] + by * n[1] + bz * n[2]
        bu = bx * u[0] + by * u[1] + bz * u[2]
        bv = bx * v[0] + by * v[1] + bz * v[2]
        y = bx * bx + by * by + bz * bz
        psi, chi = slope_factor(rule.weight, 1.0, y, w[i]), bend_factor(rule.weight, y, w[i])
        st = s * t
        e += s * s * w[i]
        gt += s * (s * s * psi - 2.0 * w[i])
        turn = s * (2.0 * w[i] + st * psi)
        gu += turn * bu
        gv += turn * bv
        tt += 2.0 * w[i] + s * s * (s * s * chi - 5.0 * psi)
        mixed = s * (3.0 * s - 2.0 * t) * psi - 2.0 * w[i] + s * s * st * chi
        tu += mixed * bu
        tv += mixed * bv
        both, back = 2.0 * w[i] + st * (4.0 * psi + st * chi), (s + t) * turn
        uu += both * bu * bu - back
        uv += both * bu * bv
        vv += both * bv * bv - back
    return Bowl(e, (gt, gu, gv), tt, tu, tv, uu, uv, vv, weight, shift)


@kernel(STRICT)
def downhill(b: Bowl) -> Vector:
    """Newton's step of (t, α, β), along every eigenvector to the side where E falls, no longer than `_LONGEST`."""
    e = symmetric_eigen(b.tt, b.tu, b.tv, b.uu, b.uv, b.vv)
    floor = 1e-12 * max(abs(e.l0), abs(e.l2))
    step = scaled(e.u0, -dot(e.u0, b.g) / max(abs(e.l0), floor))
    step = along(step, e.u1, -dot(e.u1, b.g) / max(abs(e.l1), floor))
    step = along(step, e.u2, -dot(e.u2, b.g) / max(abs(e.l2), floor))
    longest = largest(step)
    return scaled(step, _LONGEST / longest) if longest > _LONGEST else step


@kernel(STRICT)
def largest(a: Vector) -> float:
    """The largest of |a_k|."""
    return max(abs(a[0]), abs(a[1]), abs(a[2]))


@kernel(STRICT)
def tilted(n: Vector, step: Vector) -> Vector:
    """n turned by a step's two tangents."""
    u, v = frame(n)
    m = along(along(n, u, step[1]), v, step[2])
    return scaled(m, 1.0 / sqrt(dot(m, m)))


@kernel(STRICT)
def within(t: float, n: Vector, t0: float, n0: Vector) -> bool:
    """Whether a plane lies in the range about the start."""
    (u, v), cosine = frame(n0), dot(n, n0)
    return abs(t - t0) < _RANGE and abs(dot(n, u)) < _RANGE * cosine and abs(dot(n, v)) < _RANGE * cosine


@kernel(STRICT)
def reference_plane(near: Near, x: Vector, t0: float, n0: Vector, rule: Rule, w: Array) -> tuple[int, float, Vector]:
    """(state, t/h, n) of the minimum of E that is found downhill from (t0, n0), t0 in h.

    x: relative to the place's centre; w: (2·N,) for the weights. The state is UNDEFINED_NORMAL where E falls on to the
    end of the range, |t - t0| < h/2 and tangents < 1/2, and FEW_NEIGHBOURS where no surfel has weight at the start.
    """
    t, n, before = t0, n0, inf
    here = bowl(near, x, t, n, rule, w)
    if not here.weight > 0.0:
        return r.FEW_NEIGHBOURS, t, n
    first_shift, step = here.shift, downhill(here)
    for _ in range(_MOST):
        size = largest(step)
        t_next, n_next = t + step[0], tilted(n, step)
        if not within(t_next, n_next, t0, n0):
            if not size > _EDGE:
                return r.UNDEFINED_NORMAL, t, n
            step = scaled(step, 0.5)
            continue
        if size < _LAST or (size < _SURE and size > 0.5 * before):
            return r.CONTINUE, t_next, n_next
        there = bowl(near, x, t_next, n_next, rule, w)
        if size < _SURE or there.e * exp(there.shift - first_shift) <= here.e * exp(here.shift - first_shift):
            t, n, here, before = t_next, n_next, there, size
            step = downhill(here)
        else:
            step = scaled(step, 0.5)
    return r.CONTINUE, t, n
