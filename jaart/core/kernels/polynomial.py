"""Heights over a plane as a polynomial g(u, v) of degree 0 to 4 [A 10]: its values, and where rays meet it.

Monomials go by degree, in each by falling powers of u: 1; u, v; u², uv, v²; u³, u²v, uv², v³; u⁴, …, v⁴. So a lower
degree has the leading coefficients. u, v and heights are in feature sizes h, which keeps every monomial near 1.
"""

from __future__ import annotations

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Vector
from jaart.core.kernels.roots import Quartic


@kernel()
def terms(degree: int) -> int:
    """Number of coefficients of a degree: 1, 3, 6, 10, 15."""
    return (degree + 1) * (degree + 2) // 2


@kernel(STRICT)
def of_means(c: Array, patch: float) -> None:
    """Turn a polynomial of means over patches into the one whose means they are, in place.

    patch: variance m of a patch along u and along v. A mean over a Gaussian patch is exp(m/2·Δ)g, up to the third
    degree over any that is even; back leads exp(-m/2·Δ), which ends with Δ² for the fourth degree.
    """
    if patch == 0.0:
        return
    by_uu, by_uv, by_vv = 12.0 * c[10] + 2.0 * c[12], 6.0 * (c[11] + c[13]), 2.0 * c[12] + 12.0 * c[14]  # Δg's
    half = 0.5 * patch
    c[0] += half * (half * (by_uu + by_vv) - 2.0 * (c[3] + c[5]))
    c[1] -= half * (6.0 * c[6] + 2.0 * c[8])
    c[2] -= half * (2.0 * c[7] + 6.0 * c[9])
    c[3] -= half * by_uu
    c[4] -= half * by_uv
    c[5] -= half * by_vv


@kernel(STRICT)
def value(c: Array, u: float, v: float) -> float:
    """g(u, v) of the 15 coefficients."""
    g = c[10]
    g = g * u + (c[6] + v * c[11])
    g = g * u + (c[3] + v * (c[7] + v * c[12]))
    g = g * u + (c[1] + v * (c[4] + v * (c[8] + v * c[13])))
    return g * u + (c[0] + v * (c[2] + v * (c[5] + v * (c[9] + v * c[14]))))


@kernel(STRICT)
def gradient(c: Array, u: float, v: float) -> tuple[float, float]:
    """(∂g/∂u, ∂g/∂v) at (u, v)."""
    gu = 4.0 * c[10]
    gu = gu * u + 3.0 * (c[6] + v * c[11])
    gu = gu * u + 2.0 * (c[3] + v * (c[7] + v * c[12]))
    gu = gu * u + (c[1] + v * (c[4] + v * (c[8] + v * c[13])))
    gv = c[11]
    gv = gv * u + (c[7] + v * 2.0 * c[12])
    gv = gv * u + (c[4] + v * (2.0 * c[8] + v * 3.0 * c[13]))
    gv = gv * u + (c[2] + v * (2.0 * c[5] + v * (3.0 * c[9] + v * 4.0 * c[14])))
    return gu, gv


@kernel(STRICT)
def ray_polynomial(c: Array, d: Vector) -> Quartic:
    """g(s·d_u, s·d_v) - s·d_n by powers of s: its roots are where the ray s·d from the origin meets g.

    d: direction in the frame (u, v, n).
    """
    u, v, n = d
    uu, uv, vv = u * u, u * v, v * v
    third = u * (uu * c[6] + vv * c[8]) + v * (uu * c[7] + vv * c[9])
    fourth = uu * (uu * c[10] + uv * c[11] + vv * c[12]) + vv * (uv * c[13] + vv * c[14])
    return c[0], u * c[1] + v * c[2] - n, uu * c[3] + uv * c[4] + vv * c[5], third, fourth


@kernel(STRICT)
def _times_line(p: Quartic, a: float, b: float, plus: float) -> Quartic:
    """plus + p(s)·(a + b·s), for a product of degree 4 at most."""
    return plus + p[0] * a, p[0] * b + p[1] * a, p[1] * b + p[2] * a, p[2] * b + p[3] * a, p[3] * b + p[4] * a


@kernel(STRICT)
def _plus(p: Quartic, q: Quartic) -> Quartic:
    """p + q."""
    return p[0] + q[0], p[1] + q[1], p[2] + q[2], p[3] + q[3], p[4] + q[4]


@kernel(STRICT)
def line_polynomial(c: Array, base: Vector, d: Vector) -> Quartic:
    """g - n along the line base + s·d by powers of s, for a ray that passes by the frame's origin.

    base, d: a point of the ray and its direction in the frame (u, v, n).
    """
    a, b = base[1], d[1]
    of_v = _times_line((c[14], 0.0, 0.0, 0.0, 0.0), a, b, c[9])
    g0 = _times_line(_times_line(_times_line(of_v, a, b, c[5]), a, b, c[2]), a, b, c[0])
    of_v = _times_line((c[13], 0.0, 0.0, 0.0, 0.0), a, b, c[8])
    g1 = _times_line(_times_line(of_v, a, b, c[4]), a, b, c[1])
    g2 = _times_line(_times_line((c[12], 0.0, 0.0, 0.0, 0.0), a, b, c[7]), a, b, c[3])
    g3 = _times_line((c[11], 0.0, 0.0, 0.0, 0.0), a, b, c[6])
    a, b = base[0], d[0]
    g = _plus(g3, _times_line((c[10], 0.0, 0.0, 0.0, 0.0), a, b, 0.0))
    g = _plus(g2, _times_line(g, a, b, 0.0))
    g = _plus(g1, _times_line(g, a, b, 0.0))
    g = _plus(g0, _times_line(g, a, b, -base[2]))
    return g[0], g[1] - d[2], g[2], g[3], g[4]


@kernel(STRICT)
def line_quadratic(c: Array, base: Vector, d: Vector) -> Quartic:
    """`line_polynomial` of a polynomial of degree 2 or less, in a quarter of the operations."""
    (u, v, n), (a, b, _) = base, d
    value = c[0] + u * (c[1] + u * c[3] + v * c[4]) + v * (c[2] + v * c[5]) - n
    slope = a * (c[1] + 2.0 * (u * c[3]) + v * c[4]) + b * (c[2] + u * c[4] + 2.0 * (v * c[5])) - d[2]
    return value, slope, a * (a * c[3] + b * c[4]) + b * (b * c[5]), 0.0, 0.0
