"""The step along a ray to the polynomial that was fitted at x."""

from __future__ import annotations

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.polynomial import ray_polynomial
from jaart.core.kernels.records import Array, Rule, Value, Vector
from jaart.core.kernels.roots import nearest_root
from jaart.core.kernels.vectors import dot, frame


@kernel(STRICT)
def approach(v: Value, d: Vector, slope: float, reach: float, rule: Rule, fit: Array) -> float:
    """Step along d to the plane H(x) [T 2.20], or to the polynomial where the ray meets it within reach."""
    if v.degree > 0:
        e1, e2 = frame(v.n)
        root = nearest_root(ray_polynomial(fit, (dot(d, e1), dot(d, e2), slope)), reach / rule.h)
        if root == root:
            return root * rule.h
    return v.f / slope
