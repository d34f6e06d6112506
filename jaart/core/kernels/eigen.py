"""Eigenvalues and eigenvectors of a symmetric 3×3 matrix: closed form for one, Jacobi for the other two.

The closed form is exact to rounding for the eigenvalue that stands apart, and only for it; its vector splits off
a 2×2 matrix, which one Jacobi rotation makes diagonal however close the other two are.
"""

from __future__ import annotations

from math import acos, cos, frexp, isfinite, ldexp, nan, sqrt
from typing import NamedTuple, TypeAlias

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Vector

#: Powers of two beyond which the scale itself would overflow.
_LARGEST_POWER = 1000
#: A matrix that differs by less from a multiple of the identity (of size 1) is one: squares would underflow.
_ISOTROPIC = 1e-100

#: xx, xy, xz, yy, yz, zz
Symmetric: TypeAlias = tuple[float, float, float, float, float, float]


class Eigen(NamedTuple):
    """Eigenvalues, ascending, and an orthonormal eigenvector of each."""

    l0: float
    l1: float
    l2: float
    u0: Vector
    u1: Vector
    u2: Vector


@kernel(STRICT)
def _dot(a: Vector, b: Vector) -> float:
    """<a, b>."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel(STRICT)
def _cross(a: Vector, b: Vector) -> Vector:
    """a × b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel(STRICT)
def _sum(a: Vector, s: float, b: Vector, t: float, c: Vector) -> Vector:
    """a + s·b + t·c."""
    return a[0] + s * b[0] + t * c[0], a[1] + s * b[1] + t * c[1], a[2] + s * b[2] + t * c[2]


@kernel(STRICT)
def _unit(a: Vector) -> Vector:
    """a/|a|."""
    per_length = 1.0 / sqrt(_dot(a, a))
    return a[0] * per_length, a[1] * per_length, a[2] * per_length


@kernel(STRICT)
def _times(m: Symmetric, a: Vector) -> Vector:
    """The matrix times a vector."""
    xx, xy, xz, yy, yz, zz = m
    return _dot((xx, xy, xz), a), _dot((xy, yy, yz), a), _dot((xz, yz, zz), a)


@kernel(STRICT)
def _separated(m: Symmetric) -> tuple[float, Vector]:
    """The eigenvalue farthest from the two others and its unit vector; trace 0, sum of squares 6.

    The eigenvalues are 2cos(φ + 2πk/3) with cos 3φ = det/2; those of -m if that is negative.
    """
    xx, xy, xz, yy, yz, zz = m
    half = 0.5 * _dot((xx, xy, xz), _cross((xy, yy, yz), (xz, yz, zz)))
    value = 2.0 * cos(acos(min(abs(half), 1.0)) / 3.0)
    if half < 0.0:
        value = -value
    a, b, c = (xx - value, xy, xz), (xy, yy - value, yz), (xz, yz, zz - value)
    best, other, third = _cross(a, b), _cross(b, c), _cross(c, a)
    if _dot(other, other) > _dot(best, best):
        best = other
    if _dot(third, third) > _dot(best, best):
        best = third
    return value, _unit(best)


@kernel(STRICT)
def _perpendicular(u: Vector) -> Vector:
    """A unit vector perpendicular to a unit vector, made of its two larger parts or of one of them."""
    if abs(u[0]) > abs(u[1]):
        return _unit((-u[2], 0.0, u[0]))
    return _unit((0.0, u[2], -u[1]))


@kernel(STRICT)
def _rotation(a: float, b: float, d: float) -> tuple[float, float, float]:
    """Cosine, sine and tangent of the Jacobi rotation that makes ((a, b), (b, d)) diagonal, at most 45°."""
    half = 0.5 * (d - a)
    root = sqrt(half * half + b * b)
    if root == 0.0:
        return 1.0, 0.0, 0.0
    t = b / (half + root if half >= 0.0 else half - root)
    c = 1.0 / sqrt(t * t + 1.0)
    return c, t * c, t


@kernel(STRICT)
def _of_traceless(m: Symmetric) -> Eigen:
    """Eigenvalues and vectors of a matrix of trace 0 and sum of squares 6."""
    value, u = _separated(m)
    v = _perpendicular(u)
    w = _cross(u, v)
    mv, mw = _times(m, v), _times(m, w)
    a, b, d = _dot(v, mv), _dot(v, mw), _dot(w, mw)
    c, s, t = _rotation(a, b, d)
    low, high = a - t * b, d + t * b
    v, w = (_sum((0.0, 0.0, 0.0), c, v, -s, w), _sum((0.0, 0.0, 0.0), s, v, c, w))
    # what rounding left between u and the others, to first order
    mu = _times(m, u)
    value = _dot(u, mu)
    p, q = _dot(v, mu) / (value - low), _dot(w, mu) / (value - high)
    u, v, w = _sum(u, p, v, q, w), _sum(v, -p, u, 0.0, u), _sum(w, -q, u, 0.0, u)
    if low > high:
        low, high, v, w = high, low, w, v
    if value > high:
        return Eigen(low, high, value, v, w, u)
    return Eigen(value, low, high, u, v, w)


@kernel(STRICT)
def _centred(x: float, y: float, z: float) -> tuple[float, float, float, float]:
    """The mean and what is left without it, twice: the first mean's rounding may outweigh nearly equal parts."""
    first = (x + y + z) / 3.0
    x, y, z = x - first, y - first, z - first
    second = (x + y + z) / 3.0
    return first + second, x - second, y - second, z - second


@kernel(STRICT)
def symmetric_eigen(xx: float, xy: float, xz: float, yy: float, yz: float, zz: float) -> Eigen:
    """Eigenvalues (ascending) and orthonormal eigenvectors of a symmetric 3×3 matrix A.

    Eigenvalues are right within a few eps·|A|, so the least of a singular matrix may come out just below 0, and
    vectors within a few eps·|A|/gap; the sign of a vector, and any basis where eigenvalues are equal, are
    arbitrary. All NaN when an entry is not finite. Scaling A by a power of two scales the result exactly.
    """
    if not (isfinite(xx) and isfinite(xy) and isfinite(xz) and isfinite(yy) and isfinite(yz) and isfinite(zz)):
        none = (nan, nan, nan)
        return Eigen(nan, nan, nan, none, none, none)
    largest = max(abs(xx), abs(xy), abs(xz), abs(yy), abs(yz), abs(zz))
    power = min(max(frexp(largest)[1], -_LARGEST_POWER), _LARGEST_POWER)
    down, up = ldexp(1.0, -power), ldexp(1.0, power)
    mean, x, y, z = _centred(xx * down, yy * down, zz * down)
    xy, xz, yz = xy * down, xz * down, yz * down
    size = sqrt((x * x + y * y + z * z + 2.0 * (xy * xy + xz * xz + yz * yz)) / 6.0)
    if size <= _ISOTROPIC:
        value = mean * up
        return Eigen(value, value, value, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    per = 1.0 / size
    e = _of_traceless((x * per, xy * per, xz * per, y * per, yz * per, z * per))
    return Eigen((mean + size * e.l0) * up, (mean + size * e.l1) * up, (mean + size * e.l2) * up, e.u0, e.u1, e.u2)
