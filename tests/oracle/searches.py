"""The plain way to a root or a minimum of a function along a ray: look everywhere, then halve.

A function of t may return None where it is undefined; t and the values may be floats or mpmath numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

Function = Callable[[Any], Any]


def samples(f: Function, start: Any, stop: Any, count: int) -> list[tuple[Any, Any]]:
    """(t, f(t)) at count + 1 evenly spread t, both ends included."""
    places = [start + (stop - start) * k / count for k in range(count)] + [stop]
    return [(t, f(t)) for t in places]


def bisect(f: Function, low: Any, high: Any, tolerance: Any = 0) -> Any:
    """The root of f between two places where its signs differ, by halving.

    Ends when the bracket is not longer than the tolerance or no number lies between; None when f is undefined
    within the bracket.
    """
    below = f(low)
    if below == 0:
        return low
    while abs(high - low) > tolerance:
        middle = low + (high - low) / 2
        if middle in (low, high):
            break
        value = f(middle)
        if value is None:
            return None
        if value == 0:
            return middle
        low, high = (middle, high) if (value > 0) == (below > 0) else (low, middle)
    return low + (high - low) / 2


def sign_changes(f: Function, start: Any, stop: Any, count: int, tolerance: Any = 0) -> list[Any]:
    """Every root that a scan of count intervals tells by a change of sign, or by a value of exactly 0, in order.

    A pair of roots within one interval is missed, and so is one where f touches 0.
    """
    found: list[Any] = []
    before: tuple[Any, Any] = (start, None)
    for t, value in samples(f, start, stop, count):
        if value is not None and value == 0:
            found.append(t)
        elif value and before[1] and (value > 0) != (before[1] > 0):
            root = bisect(f, before[0], t, tolerance)
            found += [] if root is None else [root]
        before = (t, value)
    return found


def first_sign_change(f: Function, start: Any, stop: Any, count: int, tolerance: Any = 0) -> Any:
    """The first of `sign_changes`, None without one: the truth for march, safe, secant and newton."""
    return next(iter(sign_changes(f, start, stop, count, tolerance)), None)


def first_root(f: Function, start: Any, stop: Any, count: int, tolerance: Any = 0) -> Any:
    """As `first_sign_change`, but a pair of roots within one interval is found, too.

    Wherever |f| dips between samples of one sign, its least value is sought; if that has the other sign, the first
    root lies before it.
    """
    scan = samples(f, start, stop, count)
    before: Any = None
    for k, (t, value) in enumerate(scan):
        if value is not None and value == 0:
            return t
        if value is not None and before is not None and (value > 0) != (before > 0):
            return bisect(f, scan[k - 1][0], t, tolerance)
        after = scan[k + 1][1] if k + 1 < len(scan) else None
        if value and before and after and abs(value) <= abs(before) and abs(value) <= abs(after):
            low, high, sign = scan[k - 1][0], scan[k + 1][0], 1 if value > 0 else -1
            dip, least = golden(_turned(f, sign), low, high)
            if least is not None and least <= 0 and after * sign > 0:
                return bisect(f, low, dip, tolerance)
        before = value
    return None


def _turned(f: Function, sign: int) -> Function:
    def turned(t: Any) -> Any:
        value = f(t)
        return None if value is None else sign * value

    return turned


@dataclass
class Marched:
    """The hit of a march: t by linear interpolation between samples k and k + 1 (k itself when f is 0 there)."""

    t: Any
    k: int


def march(f: Function, start: Any, stop: Any, step: Any) -> Marched | None:
    """Uniform steps, a sign change, linear interpolation (Wald & Seidel) [T §2.3.5].

    Samples at t_k = start + k·step while t_k < stop, and one at stop. The first k with f_k = 0 is a hit at t_k; the
    first with f_k and f_{k+1} of opposite signs one at t_k + (t_{k+1} - t_k)·f_k/(f_k - f_{k+1}). Either direction
    of the change counts. A sample where f is undefined ends its interval and the next.
    """
    t, value, k = start, f(start), 0
    while True:
        if value is not None and value == 0:
            return Marched(t, k)
        if t >= stop:
            return None
        following = min(start + (k + 1) * step, stop)
        after = f(following)
        if value and after and (value > 0) != (after > 0):
            return Marched(t + (following - t) * value / (value - after), k)
        t, value, k = following, after, k + 1


def golden(e: Function, low: Any, high: Any, tolerance: Any = None) -> tuple[Any, Any]:
    """(t, e(t)) of the least value between two places with one minimum, by golden section; the ends count, too.

    With floats t is good to about 1e-8 of the scale over which e changes, for e is flat there; with mpmath numbers to
    half its digits. An undefined value counts as larger than any other.
    """
    ratio = (math.sqrt(5) - 1) / 2
    ends = [(low, e(low)), (high, e(high))]
    limit = tolerance if tolerance is not None else 1e-9 * abs(high - low)
    while abs(high - low) > limit:
        left, right = high - ratio * (high - low), low + ratio * (high - low)
        if left in (low, high) or right in (low, high):
            break
        low, high = (low, right) if _height(e(left)) <= _height(e(right)) else (left, high)
    middle = low + (high - low) / 2
    return min([(middle, e(middle)), *ends], key=lambda place: _height(place[1]))


def _height(value: Any) -> Any:
    return math.inf if value is None else value


def minimum(e: Function, start: Any, stop: Any, count: int, tolerance: Any = None) -> tuple[Any, Any]:
    """(t, e(t)) of the least value on a segment, its ends included: dense scan, then golden section about the least.

    (start, None) when e is undefined at every sample.
    """
    scan = samples(e, start, stop, count)
    k = min(range(len(scan)), key=lambda i: _height(scan[i][1]))
    if scan[k][1] is None:
        return start, None
    low, high = scan[max(k - 1, 0)][0], scan[min(k + 1, count)][0]
    return min([golden(e, low, high, tolerance), scan[k]], key=lambda place: _height(place[1]))


def minimum_by_derivative(e: Function, derivative: Function, start: Any, stop: Any, count: int,
                          tolerance: Any = 0) -> tuple[Any, Any]:
    """(t, e(t)) of the least value on a segment: every root of e' from - to + by halving, and the ends.

    Good to all digits, where values alone give half of them. (start, None) when e is undefined at all of them.
    """
    places = [start, stop, *sign_changes(derivative, start, stop, count, tolerance)]
    best = min(((t, e(t)) for t in places), key=lambda place: _height(place[1]))
    return best if best[1] is not None else (start, None)


def derivative_of(e: Function, step: Any) -> Function:
    """e' by central differences; exact enough when e takes mpmath numbers and the step is an mpmath number."""
    return lambda t: (e(t + step) - e(t - step)) / (2 * step)
