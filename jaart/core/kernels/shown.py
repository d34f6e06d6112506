"""The normal that a hit shows: the averaged one, the fitted polynomial's, or the surface's own."""

from __future__ import annotations

from math import sqrt

from jaart.core.kernels import records as r
from jaart.core.kernels.call import evaluate_at
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.polynomial import gradient
from jaart.core.kernels.records import Array, Near, Rule, Search, Value, Vector
from jaart.core.kernels.vectors import along, dot, frame, scaled

#: Half the width of a central difference, in h: its error and that of rounding are both about 1e-10.
_WIDTH = 1e-5


@kernel(STRICT)
def like(n: Vector, other: Vector) -> float:
    """1, or -1 where two normals point to opposite sides."""
    return 1.0 if dot(n, other) >= 0.0 else -1.0


@kernel(STRICT)
def difference(near: Near, x: Vector, d: Vector, rule: Rule, how: Search, n: Vector, work: Array,
               fit: Array) -> float:
    """∂f/∂d at x by a central difference; n: the normal at x, whose side f is counted from."""
    width = _WIDTH * rule.h
    a = evaluate_at(how.evaluate, near, along(x, d, width), rule, r.QUICK, work, fit)
    b = evaluate_at(how.evaluate, near, along(x, d, -width), rule, r.QUICK, work, fit)
    return (a.f * like(a.n, n) - b.f * like(b.n, n)) / (2.0 * width)


@kernel(STRICT)
def fitted_normal(v: Value, to: Vector, rule: Rule, fit: Array) -> Vector:
    """Unit normal of the polynomial fitted at x, above the point x + to."""
    if v.degree == 0:
        return v.n
    e1, e2 = frame(v.n)
    gu, gv = gradient(fit, dot(to, e1) / rule.h, dot(to, e2) / rule.h)
    raw = along(along(v.n, e1, -gu), e2, -gv)
    return scaled(raw, 1.0 / sqrt(dot(raw, raw)))


@kernel(STRICT)
def true_normal(near: Near, x: Vector, rule: Rule, how: Search, otherwise: Vector, work: Array,
                fit: Array) -> tuple[int, Vector]:
    """-∇f/|∇f| at x on the side of n(x), and how many evaluations it took.

    Closed form where there is one, else by central differences. otherwise: given where f has no gradient at x, as
    a hit's last step may lead into a cell without surfels.
    """
    v = evaluate_at(how.evaluate, near, x, rule, r.WITH_GRADIENT, work, fit)
    g, evaluations = v.gradient, 1
    if g[0] != g[0] and v.state == r.CONTINUE:
        g = (difference(near, x, (1.0, 0.0, 0.0), rule, how, v.n, work, fit),
             difference(near, x, (0.0, 1.0, 0.0), rule, how, v.n, work, fit),
             difference(near, x, (0.0, 0.0, 1.0), rule, how, v.n, work, fit))
        evaluations = 7
    size = sqrt(dot(g, g))
    return evaluations, (scaled(g, -like(scaled(g, -1.0), v.n) / size) if size > 0.0 else otherwise)
