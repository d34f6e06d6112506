"""Fill level <-> plane against exact rational arithmetic, for normals of every kind."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core import plic

RNG = np.random.default_rng(6)
LEVELS = [1e-300, 1e-30, 1e-9, 0.01, 0.1, 1 / 6, 0.3, 0.5, 0.6, 5 / 6, 0.99, 1 - 1e-9, 1 - 1e-16]
Rational = tuple[Fraction, ...]


def exact_volume(distance: float | Fraction, normal: np.ndarray) -> Fraction:
    """The volume by inclusion and exclusion of the corners, in rational numbers; a component of 0 is an axis less."""
    sizes = [Fraction(abs(float(c))) for c in normal if c]
    alpha = Fraction(distance) + sum(sizes) / 2
    total, scale = Fraction(0), Fraction(1)
    for chosen in itertools.product((0, 1), repeat=len(sizes)):
        left = alpha - sum((m for m, c in zip(sizes, chosen, strict=True) if c), Fraction(0))
        total += (-1) ** sum(chosen) * max(left, Fraction(0)) ** len(sizes)
    for number, m in enumerate(sizes, 1):
        scale *= number * m
    return total / scale


def exact_centre(alpha: Fraction, m: Rational) -> Rational:
    """Centre of the polygon m·x = alpha in the unit cube, m ascending: the unit square clipped by a strip."""
    polygon: list[Rational] = [(Fraction(x), Fraction(y)) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    for sign, bound in ((1, alpha), (-1, m[2] - alpha)):
        polygon = clipped(polygon, [bound - sign * (m[0] * x + m[1] * y) for x, y in polygon])
    area, x, y = Fraction(0), Fraction(0), Fraction(0)
    for (ax, ay), (bx, by) in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        cross = ax * by - bx * ay
        area, x, y = area + cross / 2, x + (ax + bx) * cross / 6, y + (ay + by) * cross / 6
    x, y = x / area, y / area
    return x, y, (alpha - m[0] * x - m[1] * y) / m[2]


def clipped(polygon: list[Rational], inside: list[Fraction]) -> list[Rational]:
    """The polygon where a linear function, given at its corners, is not negative."""
    kept = []
    for a, b, at_a, at_b in zip(polygon, polygon[1:] + polygon[:1], inside, inside[1:] + inside[:1], strict=True):
        if at_a >= 0:
            kept.append(a)
        if (at_a < 0) != (at_b < 0):
            share = at_a / (at_a - at_b)
            kept.append(tuple(p + share * (q - p) for p, q in zip(a, b, strict=True)))
    return kept


def unit(vectors: np.ndarray) -> np.ndarray:
    """The vectors (N, 3) at length 1, whatever size their components have."""
    vectors = np.asarray(vectors, dtype=np.float64)
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def normals() -> np.ndarray:
    """Random, aligned, nearly aligned, edge, diagonal, and those at which two of the formulas meet."""
    tiny = [0.0, 1e-300, 1e-160, 1e-80, 1e-20, 1e-16, 1e-12, 1e-5]
    nearly = [(a, b, 1.0) for a in tiny for b in tiny]
    edges = [(a, 1.0, b) for a in tiny for b in (1.0, 1 - 1e-15, 0.5)]
    meeting = [(1, 1, 1), (1, 1, 2), (1, 2, 3), (0.3, 0.7, 1), (1, 1e-8, 1 + 1e-8), (1, 3, 4 - 1e-15)]
    sets = unit(np.array(nearly + edges + meeting)), unit(RNG.normal(size=(60, 3)))
    every = np.concatenate(sets)
    signs = RNG.choice([-1.0, 1.0], size=every.shape)
    return np.array([RNG.permutation(n) for n in every]) * signs


def test_the_plane_cuts_its_volume() -> None:
    """The exact volume takes the level on between v - 1e-15 and v + 1e-15: v is that close to the exact plane."""
    every, near = normals(), Fraction(1, 10**15)
    level = RNG.choice(LEVELS, size=len(every))
    for n, wanted, v in zip(every, level, plic.distance(level, every), strict=True):
        below, above = exact_volume(Fraction(v) - near, n), exact_volume(Fraction(v) + near, n)
        assert below <= Fraction(wanted) <= above, (n, wanted)


def test_the_volume_below_a_plane() -> None:
    every = normals()
    reach = np.abs(every).sum(axis=1) / 2
    v = reach * RNG.choice([-1, -1 + 1e-12, -0.9, -0.5, -0.1, 0, 1e-17, 0.2, 0.7, 1 - 1e-9, 1], size=len(every))
    for n, distance, found in zip(every, v, plic.volume(v, every), strict=True):
        assert abs(Fraction(found) - exact_volume(distance, n)) <= Fraction(1, 10**15), (n, distance)


@pytest.mark.parametrize("level", LEVELS)
def test_there_and_back(level: float) -> None:
    every = normals()
    back = plic.volume(plic.distance(np.full(len(every), level), every), every)
    assert np.abs(back - level).max() <= 1e-15


def test_there_and_back_in_bulk() -> None:
    every, level = unit(RNG.normal(size=(100_000, 3))), RNG.uniform(size=100_000)
    assert np.abs(plic.volume(plic.distance(level, every), every) - level).max() <= 1e-15


component = st.one_of(st.floats(-1, 1), st.sampled_from([0.0, 1e-300, -1e-16, 1e-8, 1.0]))


@given(n=st.tuples(component, component, component).filter(lambda n: max(map(abs, n)) > 1e-3),
       level=st.integers(0, 2**20).map(lambda k: k / 2**20))
def test_laws_of_any_plane(n: tuple[float, float, float], level: float) -> None:
    """Full and empty exchanged, axes exchanged or mirrored: the same plane; and it never touches from afar."""
    normal, wanted = unit(np.array([n])), np.array([level])
    v = plic.distance(wanted, normal)
    assert np.array_equal(plic.distance(wanted, -normal), v)
    assert plic.distance(wanted, normal[:, ::-1]) == pytest.approx(v, abs=1e-15)
    assert plic.distance(1 - wanted, normal) == pytest.approx(-v, abs=1e-15)
    assert abs(v[0]) <= np.abs(normal).sum() / 2 + 1e-16
    centre = plic.centroid(wanted, normal)
    assert (np.abs(centre) <= 0.5).all()
    assert (centre * normal).sum() == pytest.approx(v[0], abs=1e-15)


def test_the_centre_of_the_polygon() -> None:
    """alpha is exact here and the level made from it, so that what is compared is the centre alone."""
    for normal in normals():
        m = tuple(sorted(Fraction(abs(float(c))) for c in normal))
        for share in (1e-12, 0.01, 0.15, 0.3, 0.41, 0.49):
            alpha = Fraction(share) * sum(m, Fraction(0))
            level = float(exact_volume(alpha - sum(m, Fraction(0)) / 2, normal))
            order = np.argsort(np.abs(normal), kind="stable")
            expected = np.array([float(c - Fraction(1, 2)) for c in exact_centre(alpha, m)])
            for full in (False, True):
                if level < 1e-290 or (full and level < 1e-3):
                    continue  # the level is rounded too much to tell
                found = plic.centroid(np.array([1 - level if full else level]), normal[None])[0]
                sides = np.where(normal < 0, -1, 1)[order] * (-1 if full else 1)
                assert found[order] * sides == pytest.approx(expected, abs=2e-15), (normal, share, full)


@pytest.mark.parametrize(("normal", "touched"), [
    ((1, 0, 0), (0.5, 0, 0)), ((0, -1, 0), (0, -0.5, 0)), ((1, 0, -1), (0.5, 0, -0.5)),
    ((1, 2, 3), (0.5, 0.5, 0.5)), ((-1, 1e-300, 1), (-0.5, 0.5, 0.5))])
def test_a_full_cell_touches_its_plane(normal: tuple[float, ...], touched: tuple[float, ...]) -> None:
    n = unit(np.array([normal]))
    assert np.array_equal(plic.centroid(np.ones(1), n)[0], touched)
    assert np.array_equal(plic.centroid(np.zeros(1), n)[0], np.negative(touched))
    assert plic.distance(np.ones(1), n) == pytest.approx(np.abs(n).sum() / 2, abs=1e-16)
    assert np.array_equal(plic.volume(np.array([2.0, -2.0]), np.repeat(n, 2, axis=0)), [1, 0])


def test_nothing_of_nothing() -> None:
    none, vectors = np.empty(0), np.empty((0, 3))
    assert plic.distance(none, vectors).shape == plic.volume(none, vectors).shape == (0,)
    assert plic.centroid(none, vectors).shape == (0, 3)
