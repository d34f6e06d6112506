"""Polynomials over a plane: values, gradients, rays through them, and means over patches."""

from __future__ import annotations

import math

import numpy as np
import pytest

from jaart.core.kernels import polynomial
from tests.core.fit_calls import POWERS, g


def test_terms() -> None:
    assert [polynomial.terms(degree) for degree in range(5)] == [1, 3, 6, 10, 15]


def test_values_and_gradients() -> None:
    rng = np.random.default_rng(15)
    for _ in range(100):
        c, (u, v) = rng.normal(size=15), rng.uniform(-2, 2, 2).tolist()
        assert polynomial.value(c, u, v) == pytest.approx(g(c, u, v), abs=1e-12)
        by_u = math.fsum(ck * i * u**(i - 1) * v**j for ck, (i, j) in zip(c, POWERS, strict=True) if i)
        by_v = math.fsum(ck * j * u**i * v**(j - 1) for ck, (i, j) in zip(c, POWERS, strict=True) if j)
        assert polynomial.gradient(c, u, v) == pytest.approx((by_u, by_v), abs=1e-12)


def test_a_ray_through_the_origin() -> None:
    rng = np.random.default_rng(16)
    for _ in range(100):
        c, d = rng.normal(size=15), rng.normal(size=3)
        powers = polynomial.ray_polynomial(c, tuple(d.tolist()))
        for s in (-1.5, 0.0, 0.3, 2.0):
            assert math.fsum(p * s**k for k, p in enumerate(powers)) == pytest.approx(
                g(c, s * d[0], s * d[1]) - s * d[2], rel=1e-12, abs=1e-12)


def test_a_ray_past_the_origin() -> None:
    rng = np.random.default_rng(17)
    for _ in range(100):
        c, base, d = rng.normal(size=15), rng.normal(size=3), rng.normal(size=3)
        powers = polynomial.line_polynomial(c, tuple(base.tolist()), tuple(d.tolist()))
        for s in (-1.5, 0.0, 0.3, 2.0):
            x = base + s * d
            assert math.fsum(p * s**k for k, p in enumerate(powers)) == pytest.approx(
                g(c, x[0], x[1]) - x[2], rel=1e-11, abs=1e-11)
        assert polynomial.line_polynomial(c, (0.0, 0.0, 0.0), tuple(d.tolist())) == pytest.approx(
            polynomial.ray_polynomial(c, tuple(d.tolist())), rel=1e-12, abs=1e-12)


def test_a_ray_past_the_origin_of_a_quadratic() -> None:
    rng = np.random.default_rng(19)
    for _ in range(100):
        c, base, d = np.append(rng.normal(size=6), np.zeros(9)), tuple(rng.normal(size=3)), tuple(rng.normal(size=3))
        assert polynomial.line_quadratic(c, base, d) == pytest.approx(polynomial.line_polynomial(c, base, d),
                                                                      rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("patch", [0.0, 1 / 12, 0.13])
def test_means_are_turned_back_into_the_polynomial(patch: float) -> None:
    rng = np.random.default_rng(18)
    nodes, shares = np.polynomial.hermite_e.hermegauss(9)
    shares, steps = shares / shares.sum(), np.sqrt(patch) * nodes
    h, found, where = rng.normal(size=15), np.empty(15), rng.uniform(-2, 2, (40, 2)).tolist()
    means = [math.fsum(a * b * g(h, u + i, v + j) for a, i in zip(shares, steps, strict=True)
                       for b, j in zip(shares, steps, strict=True)) for u, v in where]
    found[:] = np.linalg.lstsq(np.array([[u**i * v**j for i, j in POWERS] for u, v in where]), means)[0]
    polynomial.of_means(found, patch)
    np.testing.assert_allclose(found, h, rtol=0, atol=1e-12)
