"""Mirrored and refracted rays against Snell's and Fresnel's laws, at the critical angle and far from length 1."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from jaart.core.optics import dots, fresnel, reflect, refract, split, unit

Array = NDArray[np.float64]
IOR = 1.33
UP = np.array([[0.0, 0.0, 1.0]])


def falling(angle: float) -> Array:
    """A ray that comes down in the plane of x and z, so many radians off the normal UP."""
    return np.array([[math.sin(angle), 0.0, -math.cos(angle)]])


def turned(seed: int, count: int) -> tuple[Array, Array]:
    """Random pairs of orthogonal unit vectors."""
    random = np.random.default_rng(seed)
    a, b = unit(random.normal(size=(count, 3))), random.normal(size=(count, 3))
    return a, unit(b - dots(a, b)[:, None] * a)


def length(vectors: Array) -> Array:
    return np.sqrt(dots(vectors, vectors))


def test_a_mirrored_ray_by_hand() -> None:
    for side in (UP, -UP, 1.001 * UP):
        assert np.allclose(reflect(np.array([[0.6, 0.0, -0.8]]), side), [[0.6, 0.0, 0.8]], rtol=0, atol=2e-16)


@given(st.floats(0, math.pi / 2), st.sampled_from([1 / IOR, IOR, 1.0, 1 / 2.4, 2.4]))
def test_snell_holds_until_all_is_mirrored(angle: float, eta: float) -> None:
    t, total = refract(falling(angle), UP, eta)
    sine = eta * math.sin(angle)
    assert total[0] or length(t) == pytest.approx(1, abs=4e-16)
    if sine < 1 - 1e-14:
        assert t[0, 0] == pytest.approx(sine, abs=4e-16) and t[0, 1] == 0 and t[0, 2] < 0
        assert not total[0] or angle > math.pi / 2 - 1e-8
    elif sine > 1 + 1e-14:
        assert total[0] and np.allclose(t, reflect(falling(angle), UP), atol=1e-15)


def test_the_side_of_the_normal_does_not_matter() -> None:
    n, across = turned(1, 500)
    i = unit(across - 0.7 * n)
    for a, b in zip(split(i, n, 1 / IOR), split(i, -n, 1 / IOR), strict=True):
        assert np.array_equal(a, b)


@pytest.mark.parametrize("ulps", [-3, -1, 0, 1, 3])
def test_exactly_critical_rays_are_rays(ulps: int) -> None:
    n, across = turned(2, 1000)
    sine = 1 / IOR
    for _ in range(abs(ulps)):
        sine = np.nextafter(sine, math.copysign(2.0, ulps))
    i = sine * across - math.sqrt((1 - sine) * (1 + sine)) * n
    both = split(i, n, IOR)
    assert np.abs(length(both.refracted) - 1).max() < 4e-16
    assert np.abs(length(both.reflected) - 1).max() < 4e-16
    through = both.reflectance < 1
    assert (np.abs(dots(both.refracted, n))[through] < 1e-7).all()
    assert (both.reflectance > 1 - 1e-6).all() and (both.reflectance <= 1).all()


@pytest.mark.parametrize("beyond", [1e-12, 1e-8, 1e-4, 0.5])
def test_beyond_the_critical_angle_all_is_mirrored(beyond: float) -> None:
    ray = falling(math.asin(1 / IOR) + beyond)
    both = split(ray, UP, IOR)
    assert both.reflectance[0] == 1 and np.array_equal(both.refracted, reflect(ray, UP))


def test_normals_that_are_a_little_long_add_up_to_nothing() -> None:
    n, across = turned(3, 200)
    i = unit(across - n)
    for bounce in range(200):
        n = unit(n + 0.3 * np.roll(n, bounce % 3, axis=1)) * (1 + 1e-8)
        i = split(i, n, IOR if bounce % 2 else 1 / IOR).refracted
        assert np.abs(length(i) - 1).max() < 4e-16
    exact, long = split(i, unit(n), 1 / IOR), split(i, unit(n) * (1 + 1e-8), 1 / IOR)
    assert np.allclose(exact.refracted, long.refracted, rtol=0, atol=4e-16)


def test_the_way_back_is_the_way_there() -> None:
    n, across = turned(4, 1000)
    i = unit(across * np.linspace(0, 20, 1000)[:, None] - n)
    there = split(i, n, 1 / IOR)
    back = split(-there.refracted, n, IOR)
    assert np.allclose(back.refracted, -i, atol=1e-13)
    assert np.allclose(back.reflectance, there.reflectance, atol=1e-13)


def test_fresnel_where_it_is_known() -> None:
    def share(angle: float, eta: float) -> float:
        return float(split(falling(angle), UP, eta).reflectance[0])

    assert share(0, 1 / IOR) == pytest.approx(((IOR - 1) / (IOR + 1)) ** 2, rel=1e-13)
    assert share(0, IOR) == pytest.approx(((IOR - 1) / (IOR + 1)) ** 2, rel=1e-13)
    brewster = math.atan(IOR)  # nothing of the light along the plane is mirrored, of the rest cos²(2 θ)
    assert share(brewster, 1 / IOR) == pytest.approx(0.5 * math.cos(2 * brewster) ** 2, rel=1e-13)
    assert share(math.pi / 2, 1 / IOR) == pytest.approx(1, abs=1e-12)
    assert share(math.radians(80), IOR) == 1
    assert share(0.5, 1.0) == pytest.approx(0, abs=1e-30)
    assert fresnel(np.zeros(1), np.zeros(1), 1.0).tolist() == [1.0]


@given(st.floats(0, math.pi / 2), st.floats(1, 4), st.booleans())
def test_the_share_rises_to_one_and_stays_within(angle: float, ior: float, leaving: bool) -> None:
    eta = ior if leaving else 1 / ior
    less, more = (split(falling(a), UP, eta).reflectance[0] for a in (angle, math.pi / 2))
    assert 0 <= less <= 1 and more == pytest.approx(1, abs=1e-6)


def test_straight_rays_and_an_index_of_one_go_straight_on() -> None:
    n, across = turned(5, 100)
    i = unit(across - 0.1 * n)
    assert np.allclose(split(i, n, 1.0).refracted, i, atol=4e-16)
    assert np.allclose(split(-n, n, 1 / IOR).refracted, -n, atol=4e-16)
    assert np.allclose(split(-n, n, 1 / IOR).reflected, n, atol=4e-16)


def test_unit_vectors_of_any_length() -> None:
    vectors = np.array([[3.0, 0, 4], [3e-310, 0, 4e-310], [3e300, 0, 4e300], [0, 0, 0]])
    assert np.allclose(unit(vectors), [[0.6, 0, 0.8]] * 3 + [[0, 0, 0]], atol=1e-12)
    assert unit(np.empty((0, 3))).shape == (0, 3)
