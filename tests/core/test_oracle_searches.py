"""The oracle's searches, on functions whose roots and minima are known."""

from __future__ import annotations

import math

import mpmath
import pytest

from tests.oracle.searches import (
    bisect,
    derivative_of,
    first_root,
    first_sign_change,
    golden,
    march,
    minimum,
    minimum_by_derivative,
    sign_changes,
)


def test_roots_of_the_sine() -> None:
    found = sign_changes(math.sin, 1.0, 20.0, 100)
    assert found == pytest.approx([k * math.pi for k in range(1, 7)], rel=1e-15)
    assert first_sign_change(math.sin, 1.0, 20.0, 100) == found[0]
    assert first_sign_change(math.sin, 1.0, 3.0, 100) is None


def test_a_sample_of_zero_is_a_root_once() -> None:
    assert sign_changes(lambda t: t - 0.5, 0.0, 1.0, 2) == [0.5]
    assert sign_changes(lambda t: t, 0.0, 1.0, 4) == [0.0]
    assert sign_changes(lambda t: t - 1, 0.0, 1.0, 4) == [1.0]


def test_no_root_across_a_gap() -> None:
    def f(t: float) -> float | None:
        return None if 0.4 < t < 0.6 else t - 0.5

    assert sign_changes(f, 0.0, 1.0, 10) == []
    assert march(f, 0.0, 1.0, 0.1) is None
    # With samples on both sides of it only, the halving meets it.
    assert sign_changes(f, 0.0, 1.0, 3) == []


def test_bisection_to_the_last_bit_and_to_fifty_digits() -> None:
    assert bisect(lambda t: t * t - 2, 0.0, 2.0) == pytest.approx(math.sqrt(2), rel=2e-16)
    assert bisect(lambda t: t * t - 2, 0.0, 2.0, 0.1) == pytest.approx(math.sqrt(2), abs=0.05)
    with mpmath.workdps(50):
        root = bisect(lambda t: t * t - 2, mpmath.mpf(0), mpmath.mpf(2))
        assert abs(root - mpmath.sqrt(2)) < mpmath.mpf(10) ** -49


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-7])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_pair_of_roots_between_two_samples(gap: float, sign: int) -> None:
    def f(t: float) -> float:
        return sign * ((t - math.pi) ** 2 - gap * gap) * (10 - t)

    assert first_sign_change(f, 0.0, 8.0, 80) is None
    assert first_root(f, 0.0, 8.0, 80) == pytest.approx(math.pi - gap, abs=1e-12 / gap)
    assert first_root(f, 4.0, 12.0, 80) == pytest.approx(10.0, abs=1e-14)


def test_a_near_miss_is_none() -> None:
    assert first_root(lambda t: (t - math.pi) ** 2 + 1e-12, 0.0, 8.0, 80) is None
    assert first_root(lambda t: None if t < 5 else t - 4, 0.0, 8.0, 80) is None


def test_march_by_hand() -> None:
    # t² - 2 at 1.2 is -0.56, at 1.6 is 0.56: the line between them is 0 in the middle.
    hit = march(lambda t: t * t - 2, 0.0, 4.0, 0.4)
    assert hit is not None and hit.k == 3 and hit.t == pytest.approx(1.4, abs=1e-15)
    falling = march(lambda t: 2 - t * t, 0.0, 4.0, 0.4)
    assert falling is not None and falling.t == pytest.approx(1.4, abs=1e-15)


def test_march_is_exact_on_a_line_and_sees_the_last_part() -> None:
    hit = march(lambda t: 3 - 2 * t, 0.1, 1.52, 0.4)
    assert hit is not None and hit.t == pytest.approx(1.5, rel=1e-15) and hit.k == 3
    assert march(lambda t: 3 - 2 * t, 0.1, 1.48, 0.4) is None
    start = march(lambda t: t - 1, 1.0, 2.0, 0.25)
    assert start is not None and (start.t, start.k) == (1.0, 0)
    end = march(lambda t: t - 2, 1.0, 2.0, 0.25)
    assert end is not None and (end.t, end.k) == (2.0, 4)


def test_march_misses_a_pair_within_a_step() -> None:
    assert march(lambda t: (t - 1.5) ** 2 - 0.01, 0.0, 3.0, 1.0) is None


def test_golden_section() -> None:
    t, least = golden(lambda t: (t - 1.3) ** 2 + 2, 0.0, 4.0)
    assert t == pytest.approx(1.3, abs=1e-7) and least == pytest.approx(2.0, abs=1e-14)
    assert golden(lambda t: t, 1.0, 2.0) == (1.0, 1.0)
    assert golden(lambda t: -t, 1.0, 2.0) == (2.0, -2.0)


def test_minimum_finds_the_least_of_several() -> None:
    def e(t: float) -> float:
        return math.cos(t) + 0.01 * t

    expected = math.pi + math.asin(0.01) * -1
    t, least = minimum(e, 0.0, 20.0, 200)
    assert t == pytest.approx(expected, abs=1e-7) and least == e(t)
    exact, _ = minimum_by_derivative(e, lambda t: 0.01 - math.sin(t), 0.0, 20.0, 200)
    assert exact == pytest.approx(expected, rel=1e-15)


def test_a_minimum_at_an_end() -> None:
    assert minimum(lambda t: t * t, 1.0, 2.0, 10) == (1.0, 1.0)
    assert minimum_by_derivative(lambda t: t * t, lambda t: 2 * t, 1.0, 2.0, 10) == (1.0, 1.0)


def test_undefined_parts_are_not_the_least() -> None:
    def e(t: float) -> float | None:
        return None if t < 1 else t

    t, least = minimum(e, 0.0, 2.0, 10)
    assert t == pytest.approx(1.0, abs=1e-8) and least == t
    assert minimum(lambda t: None, 0.0, 2.0, 10) == (0.0, None)
    assert minimum_by_derivative(lambda t: None, lambda t: None, 0.0, 2.0, 10) == (0.0, None)


def test_derivative_in_fifty_digits_gives_all_digits_of_a_minimum() -> None:
    with mpmath.workdps(50):
        def e(t: mpmath.mpf) -> mpmath.mpf:
            return mpmath.cosh(t - mpmath.mpf("0.7"))

        slope = derivative_of(e, mpmath.mpf(10) ** -15)
        t, _ = minimum_by_derivative(e, slope, mpmath.mpf(0), mpmath.mpf(2), 20, mpmath.mpf(10) ** -25)
        assert abs(t - mpmath.mpf("0.7")) < mpmath.mpf(10) ** -24
