"""Roots of polynomials of degree 4 and less against fifty digits and against their own signs."""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core.kernels.roots import Quartic, first_root_above, nearest_root, roots_between

EPS = np.finfo(float).eps


def from_roots(*roots: float, factor: float = 1.0) -> Quartic:
    """The coefficients of factor·Π(s - root), each rounded once."""
    c = [Fraction(factor)]
    for root in roots:
        c = [(c[k - 1] if k else Fraction(0)) - Fraction(root) * (c[k] if k < len(c) else 0) for k in range(len(c) + 1)]
    w = [float(value) for value in c] + [0.0] * (5 - len(c))
    return w[0], w[1], w[2], w[3], w[4]


def exact_value(c: Quartic, s: float) -> Fraction:
    """p(s) without rounding."""
    return sum((Fraction(ck) * Fraction(s)**k for k, ck in enumerate(c)), Fraction(0))


def noise(c: Quartic, s: float) -> float:
    """What a few roundings, or an underflow, make of p near s."""
    return 1e-300 + 8 * EPS * sum(abs(ck) * abs(s)**k for k, ck in enumerate(c))


def exact_roots(c: Quartic) -> list[tuple[float, float]]:
    """The real roots in fifty digits, each with its condition Σ|c_k s^k| / |p'(s)|; p with simple roots."""
    found = []
    with mpmath.workdps(50):
        for start in np.roots(np.trim_zeros(c, "b")[::-1]):
            s = mpmath.mpmathify(complex(start))
            for _ in range(8):
                slope = sum(k * ck * s**(k - 1) for k, ck in enumerate(c) if k)
                s -= sum(ck * s**k for k, ck in enumerate(c)) / slope
            if abs(s.imag) <= 1e-30 * abs(s):
                found.append((float(s.real), float(sum(abs(ck * s**k) for k, ck in enumerate(c)) / abs(slope))))
    return sorted(found)


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_random_polynomials_against_fifty_digits(degree: int) -> None:
    rng = np.random.default_rng(degree)
    none = 0
    for _ in range(150):
        values = rng.normal(size=5) * 10 ** rng.uniform(-3, 1, 5)
        values[degree + 1:] = 0.0
        c: Quartic = tuple(values.tolist())  # type: ignore[assignment]
        reach = 10 ** rng.uniform(-1, 1.5)
        inside = [(s, condition) for s, condition in exact_roots(c) if abs(s) <= reach]
        found = [s for s in roots_between(c, -reach, reach) if not math.isnan(s)]
        assert len(found) == len(inside)
        for s, (root, condition) in zip(found, inside, strict=True):
            assert abs(s - root) <= 4 * EPS * (condition + abs(root))
        if not inside:
            none += 1
            assert math.isnan(nearest_root(c, reach)) and math.isnan(first_root_above(c, -reach, reach))
            continue
        root, condition = min(inside, key=lambda pair: abs(pair[0]))
        assert abs(nearest_root(c, reach) - root) <= 4 * EPS * (condition + abs(root))
        assert first_root_above(c, -reach, reach) == found[0]
    assert 10 < none < 140


@pytest.mark.parametrize(("roots", "nearest", "first"), [
    ((0.5,), 0.5, 0.5), ((-0.25, 0.5), -0.25, -0.25), ((-1.0, 0.5, 2.0), 0.5, -1.0),
    ((-1.5, -0.75, 0.5, 1.0), 0.5, -1.5), ((0.5, 3.0), 0.5, 0.5), ((-3.0, 2.0), 2.0, 2.0), ((-0.5, 0.5), -0.5, -0.5),
    ((0.0, 1.0), 0.0, 0.0), ((0.0, 0.0, 1.0), 0.0, 0.0), ((2.0, -2.0), -2.0, -2.0),
])
def test_chosen_roots_come_back(roots: tuple[float, ...], nearest: float, first: float) -> None:
    for factor in (1.0, -3.0, 2.0**-60, 2.0**60):
        c = from_roots(*roots, factor=factor)
        assert nearest_root(c, 2.0) == pytest.approx(nearest, abs=4e-16)
        assert first_root_above(c, -2.0, 2.0) == pytest.approx(first, abs=4e-16)


def test_lines_and_constants() -> None:
    assert nearest_root((3.0, -7.0, 0.0, 0.0, 0.0), 1.0) == 3 / 7
    assert first_root_above((3.0, -7.0, 0.0, 0.0, 0.0), 0.0, 1.0) == 3 / 7
    assert math.isnan(nearest_root((3.0, -1.0, 0.0, 0.0, 0.0), 2.9))
    assert math.isnan(nearest_root((3.0, 0.0, 0.0, 0.0, 0.0), 1e9))
    assert nearest_root((0.0, 0.0, 0.0, 0.0, 0.0), 1.0) == 0.0
    assert first_root_above((0.0, 0.0, 0.0, 0.0, 0.0), -1.0, 1.0) == -1.0


def test_a_quadratic_keeps_the_digits_of_its_small_root() -> None:
    assert nearest_root((1.0, -1e9, 1.0, 0.0, 0.0), 1.0) == pytest.approx(1e-9 * (1 + 1e-18), rel=4e-16)
    assert first_root_above((1.0, -1e9, 1.0, 0.0, 0.0), 0.0, 1.0) == pytest.approx(1e-9 * (1 + 1e-18), rel=4e-16)


def test_no_root_where_a_ray_passes_by() -> None:
    for gap in (1e-3, 1e-9, 1e-14):
        assert math.isnan(nearest_root((0.25 + gap, -1.0, 1.0, 0.0, 0.0), 3.0))
        assert math.isnan(nearest_root((0.25 + gap, -1.0, 1.0, 0.0, 1e-30), 3.0))
        near = nearest_root((0.25 - gap, -1.0, 1.0, 0.0, 0.0), 3.0)
        assert near == pytest.approx(0.5 - math.sqrt(gap), abs=4e-16 / math.sqrt(gap))


@pytest.mark.parametrize("roots", [(0.5, 0.5), (0.5, 0.5, 0.5), (0.5, 0.5, 0.5, 0.5), (0.5, 0.5, 1.0, 1.0)])
def test_multiple_roots_that_are_exact_are_found(roots: tuple[float, ...]) -> None:
    assert nearest_root(from_roots(*roots), 2.0) == pytest.approx(0.5, abs=1e-4)
    assert first_root_above(from_roots(*roots), -2.0, 2.0) == pytest.approx(0.5, abs=1e-4)


def test_what_is_not_a_number_gives_none() -> None:
    for k in range(5):
        c = [1.0, -2.0, 0.5, 0.25, 0.125]
        c[k] = math.nan
        assert math.isnan(nearest_root(tuple(c), 1.0))  # type: ignore[arg-type]
        assert math.isnan(first_root_above(tuple(c), 0.0, 1.0))  # type: ignore[arg-type]
    assert math.isnan(nearest_root((1.0, -2.0, 0.0, 0.0, 0.0), math.nan))


COEFFICIENTS = st.tuples(*[st.one_of(st.just(0.0), st.floats(-10, 10).filter(lambda x: abs(x) > 1e-12))] * 5)


@given(COEFFICIENTS, st.floats(0.01, 20))
def test_the_nearest_root_is_one_and_no_sign_changes_before_it(c: Quartic, reach: float) -> None:
    s = nearest_root(c, reach)
    limit = reach
    if not math.isnan(s):
        assert abs(s) <= reach
        assert abs(exact_value(c, s)) <= noise(c, s) + abs(s) * EPS * sum(
            k * abs(ck) * abs(s)**(k - 1) for k, ck in enumerate(c) if k)
        limit = abs(s) * (1 - 1e-6)
    samples = [float(x) for x in np.linspace(-limit, limit, 81)]
    surely = [exact_value(c, x) for x in samples if abs(exact_value(c, x)) > noise(c, x)]
    if limit > 0:
        assert all(value > 0 for value in surely) or all(value < 0 for value in surely)


@given(COEFFICIENTS, st.floats(-5, 5), st.floats(0.01, 10))
def test_no_sign_changes_before_the_first_root(c: Quartic, low: float, length: float) -> None:
    high = low + length
    s = first_root_above(c, low, high)
    end = high
    if not math.isnan(s):
        assert low <= s <= high
        assert abs(exact_value(c, s)) <= noise(c, s) + abs(s) * EPS * sum(
            k * abs(ck) * abs(s)**(k - 1) for k, ck in enumerate(c) if k)
        end = s - 1e-6 * (s - low)
    samples = [float(x) for x in np.linspace(low, end, 81)] if end > low else []
    surely = [exact_value(c, x) for x in samples if abs(exact_value(c, x)) > noise(c, x)]
    assert all(value > 0 for value in surely) or all(value < 0 for value in surely)
