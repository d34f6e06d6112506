"""Weight functions θ(q) and what is made of them: relative to the largest, and normalised to a sum of 1.

q: distance of x and a point; h: feature size; both in scene units. Floats or mpmath numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import mpmath

from tests.oracle.vectors import Vector

#: Reach of the Wendland weight in h: it then is 1/2 at the same distance as the Gaussian, sqrt(ln 2) h.
WENDLAND_REACH = 2.653


def _exp(y: Any) -> Any:
    return mpmath.exp(y) if isinstance(y, mpmath.mpf) else math.exp(y)


def gaussian(q: Any, h: Any) -> Any:
    """exp(-q²/h²) [T 2.7, A §6]."""
    return _exp(-((q / h) * (q / h)))


def hat(q: Any, h: Any) -> Any:
    """max(0, 1 - q/h) [T §3.2.2]."""
    return max(0 * q, 1 - q / h)


def squared_hat(q: Any, h: Any) -> Any:
    """max(0, 1 - q²/h²) [T §3.2.2]."""
    return max(0 * q, 1 - (q / h) * (q / h))


def wendland(q: Any, h: Any) -> Any:
    """(1 - q/s)⁴(4q/s + 1) below s = 2.653 h, else 0 (Wendland 1995, C²)."""
    p = min(q / (WENDLAND_REACH * h), 1 + 0 * q)
    return (1 - p) ** 4 * (4 * p + 1)


WEIGHTS: dict[str, Callable[[Any, Any], Any]] = {
    "gaussian": gaussian, "hat": hat, "squared_hat": squared_hat, "wendland": wendland,
}


def slope(name: str, q: float, h: float) -> Any:
    """-θ'(q)/q, so that the gradient of θ(|p - x|) by x is slope·(p - x).

    The hat has no gradient at q = 0; 0 is given, the mean of all directions.
    """
    if name == "gaussian":
        return 2 / (h * h) * gaussian(q, h)
    if name == "hat":
        return 1 / (h * q) if 0 < q < h else 0.0
    if name == "squared_hat":
        return 2 / (h * h) if q < h else 0.0
    reach = WENDLAND_REACH * h
    return 20 * (1 - q / reach) ** 3 / (reach * reach) if q < reach else 0.0


def theta(name: str, x: Vector, points: Sequence[Vector], h: float) -> list[float]:
    """θ_i of every point as the formula stands; it may underflow."""
    return [WEIGHTS[name](math.dist(x, p), h) for p in points]


def squares(x: Vector, points: Sequence[Vector]) -> tuple[list[int], int]:
    """Whole numbers in the exact ratio of the |p_i - x|², and the number that stands for a square of length 1.

    Floats are whole numbers over powers of two, so over the largest of these all of them are whole.
    """
    ratios = [[c.as_integer_ratio() for c in v] for v in (x, *points)]
    unit = max(below for v in ratios for _, below in v)
    centre, *others = ([above * (unit // below) for above, below in v] for v in ratios)
    return [sum((a - b) ** 2 for a, b in zip(p, centre, strict=True)) for p in others], unit * unit


def relative(name: str, x: Vector, points: Sequence[Vector], h: float) -> list[float]:
    """θ_i / max θ; all 0 when no point is in the reach of a compact weight.

    The Gaussian's are exp(-(q_i² - q_0²)/h²), with the exact difference of squares: right to one rounding at any
    distance, and never all 0.
    """
    if len(points) == 0:
        return []
    if name == "gaussian":
        square, one = squares(x, points)
        above, below = h.as_integer_ratio()
        nearest, scale = min(square), one * above * above
        exponents = [(s - nearest) * below * below for s in square]
        # Dividing whole numbers rounds correctly; beyond 1000 there is nothing to tell.
        return [math.exp(-(e / scale)) if e < 1000 * scale else 0.0 for e in exponents]
    weights = theta(name, x, points, h)
    largest = max(weights)
    return [w / largest for w in weights] if largest > 0 else weights


def in_reach(name: str, x: Vector, points: Sequence[Vector], h: float) -> bool:
    """Whether any point has a positive weight: where none has, there is no surface."""
    return any(relative(name, x, points, h))


def normalised(name: str, x: Vector, points: Sequence[Vector], h: float) -> list[float]:
    """θ_N(x, p_i) = θ_i / Σθ_j; when all are 0 the nearest (by lower id) gets 1, the others 0 [T §2.3.6]."""
    weights = relative(name, x, points, h)
    total = math.fsum(weights)
    if total > 0:
        return [w / total for w in weights]
    square, _ = squares(x, points)
    nearest = square.index(min(square))
    return [float(i == nearest) for i in range(len(points))]


def log_sum(name: str, x: Vector, points: Sequence[Vector], h: float) -> float:
    """ln Σθ_i, the weights as they are (the bound `min_weight`); -inf when all are 0."""
    weights = relative(name, x, points, h)
    total = math.fsum(weights)
    if total <= 0:
        return -math.inf
    if name == "gaussian":
        square, one = squares(x, points)
        return math.log(total) - float(Fraction(min(square), one) / Fraction(h) ** 2)
    return math.log(math.fsum(theta(name, x, points, h)))
