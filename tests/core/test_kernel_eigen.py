"""Eigenvalues and eigenvectors of symmetric 3×3 matrices against fifty digits and against LAPACK."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from jaart.core.kernels.eigen import Eigen, symmetric_eigen

Matrix = NDArray[np.float64]
EPS = np.finfo(float).eps

#: Spectra of the kinds that covariances of points have; the angle's bound is eps·|A|/gap of the least.
SPECTRA = {
    "well apart": (0, 1, 2), "plane": (0, 1, 1), "nearly round plane": (0, 1, 1 + 1e-10),
    "noisy plane": (1e-12, 0.5, 1), "graded": (1e-12, 1e-6, 1), "gap 1e-4": (0, 1e-4, 1), "gap 1e-8": (0, 1e-8, 1),
    "gap 1e-12": (0, 1e-12, 1), "indefinite": (-3, -1e-3, 2), "tiny": (1e-150, 2e-150, 4e-150),
    "large": (1e110, 2e110, 4e110), "huge": (1e300, 2e300, 5e300),
}


def eigen_of(matrix: Matrix) -> Eigen:
    """The kernel's answer for the upper triangle of a matrix."""
    return symmetric_eigen(*(float(matrix[i, j]) for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))))


def turned(spectrum: tuple[float, ...], rng: np.random.Generator) -> Matrix:
    """A symmetric matrix with these eigenvalues (to rounding) in random directions."""
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    matrix = (turn * np.array(spectrum, dtype=float)) @ turn.T
    return np.triu(matrix) + np.triu(matrix, 1).T


def check(matrix: Matrix) -> None:
    """Small residual, orthonormal vectors, ascending values."""
    found = eigen_of(matrix)
    size = np.abs(matrix).max()
    values, vectors = np.array(found[:3]), np.array(found[3:])
    assert values[0] <= values[1] <= values[2]
    assert np.abs(vectors @ vectors.T - np.eye(3)).max() <= 4e-15
    per = 1 / size if size > 0 else 1.0
    assert np.abs((matrix * per) @ vectors.T - vectors.T * (values * per)).max() <= 1e-14


@pytest.mark.parametrize("name", SPECTRA)
def test_the_least_vector_is_right_to_the_bound(name: str) -> None:
    rng, spectrum = np.random.default_rng(4), SPECTRA[name]
    with mpmath.workdps(50):
        for _ in range(12):
            matrix = turned(spectrum, rng)
            check(matrix)
            values, vectors = mpmath.eigsy(mpmath.matrix(matrix.tolist()))
            u, exact = eigen_of(matrix).u0, list(vectors[:, 0])
            across = [u[i - 2] * exact[i - 1] - u[i - 1] * exact[i - 2] for i in range(3)]
            size = max(abs(value) for value in values)
            assert mpmath.norm(across) <= 4 * EPS * size / (values[1] - values[0])


@pytest.mark.parametrize("name", SPECTRA)
def test_values_are_right_to_rounding(name: str) -> None:
    matrix = turned(SPECTRA[name], np.random.default_rng(8))
    with mpmath.workdps(50):
        exact = [float(value) for value in mpmath.eigsy(mpmath.matrix(matrix.tolist()), eigvals_only=True)]
    assert eigen_of(matrix)[:3] == pytest.approx(exact, rel=0, abs=4 * EPS * np.abs(exact).max())


def test_random_graded_matrices_of_every_size_against_lapack() -> None:
    rng = np.random.default_rng(9)
    for _ in range(3000):
        spectrum = rng.normal(size=3) * 10 ** rng.uniform(-12, 0, 3)
        matrix = turned(tuple(spectrum), rng) * 10 ** rng.uniform(-120, 120)
        check(matrix)
        matrix /= np.abs(matrix).max()
        values, vectors = np.linalg.eigh(matrix)
        for i, u in enumerate(eigen_of(matrix)[3:]):
            gap = min(abs(values[i] - values[j]) for j in range(3) if j != i)
            assert np.linalg.norm(np.cross(u, vectors[:, i])) <= 20 * EPS / gap


@given(st.lists(st.floats(-1e100, 1e100, allow_subnormal=False), min_size=6, max_size=6))
def test_any_finite_matrix(entries: list[float]) -> None:
    xx, xy, xz, yy, yz, zz = entries
    check(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))


@pytest.mark.parametrize("diagonal", [(0, 0, 0), (1, 1, 1), (2000, 1, 0), (0, 0, 5), (-1, 3, 3), (1, 1e-30, 0),
                                      (1.7e308, 1e308, 1e-308), (1e-320, 2e-320, 3e-320)])
def test_diagonal_matrices(diagonal: tuple[float, float, float]) -> None:
    found = symmetric_eigen(float(diagonal[0]), 0.0, 0.0, float(diagonal[1]), 0.0, float(diagonal[2]))
    assert found[:3] == pytest.approx(sorted(diagonal), rel=1e-15, abs=4 * EPS * max(map(abs, diagonal)))
    vectors = np.abs(found[3:])
    assert vectors @ vectors.T == pytest.approx(np.eye(3), abs=1e-15)
    assert ((vectors > 1 - 1e-15) | (vectors < 1e-15)).all()


def test_nearly_equal_values() -> None:
    """The mean's rounding is then of the size of what is left without it."""
    rng = np.random.default_rng(3)
    for power in range(4, 17):
        for _ in range(50):
            part = rng.normal(size=(3, 3))
            check(np.eye(3) + (part + part.T) * 10.0**-power)
    check(np.array([[3002399751580254.0, 0, 0], [0, 3002399751577857.0, 6], [0, 6, 3002399751582751.0]]))


def test_equal_values_come_out_equal() -> None:
    for size in (0.0, 1.0, 3.7e90, -1e-80):
        found = symmetric_eigen(size, 0.0, 0.0, size, 0.0, size)
        assert found.l0 == found.l1 == found.l2 == pytest.approx(size, rel=EPS)


def test_a_matrix_of_rank_one_gives_its_direction() -> None:
    rng = np.random.default_rng(2)
    for _ in range(200):
        a = rng.normal(size=3)
        check(np.outer(a, a))
        found = eigen_of(np.outer(a, a))
        assert found.l2 == pytest.approx(a @ a, rel=1e-15)
        assert np.linalg.norm(np.cross(found.u2, a)) <= 1e-15 * np.linalg.norm(a)
        assert (np.abs([found.l0, found.l1]) <= 1e-15 * (a @ a)).all()


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("place", range(6))
def test_what_is_not_finite_gives_nan(bad: float, place: int) -> None:
    entries = [2.0, 0.5, 0.25, 3.0, 0.125, 4.0]
    entries[place] = bad
    found = symmetric_eigen(*entries)
    assert np.isnan(found[:3]).all() and np.isnan(found[3:]).all()


def test_powers_of_two_scale_the_result_exactly() -> None:
    rng = np.random.default_rng(6)
    for power in (-900, -31, 5, 700):
        matrix = turned((0.1, 0.7, 1.3), rng)
        one, other = eigen_of(matrix), eigen_of(matrix * 2.0**power)
        assert other[:3] == tuple(value * 2.0**power for value in one[:3])
        assert other[3:] == one[3:]
