"""Adaptive Gauss-Lobatto quadrature of many integrals at a time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import Legendre, legendre
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.intp]

#: Points of the rule on each panel; it is exact for polynomials of degree 2 POINTS - 3.
POINTS = 7
#: The rule's end points are taken this share of a panel inside, where the integrand may jump at its ends.
INSIDE = 1e-9
#: A panel is halved so many times at most.
HALVINGS = 45
#: Legendre coefficients that fall by this factor over two degrees are those of a smooth integrand.
SMOOTH = 0.1


def _lobatto(points: int) -> tuple[Array, Array, Array]:
    """Nodes and weights on [0, 1], and the matrix that gives the Legendre coefficients of the values."""
    highest = Legendre.basis(points - 1)
    nodes = np.concatenate([[-1.0], highest.deriv().roots(), [1.0]])
    weights = 1 / (points * (points - 1) * highest(nodes) ** 2)
    inverse: Array = np.linalg.inv(legendre.legvander(nodes, points - 1))
    return np.clip((nodes + 1) / 2, INSIDE, 1 - INSIDE), weights, inverse


NODES, WEIGHTS, TO_LEGENDRE = _lobatto(POINTS)


def integrate(function: Callable[[Ints, Array], Array], owner: Ints, low: Array, high: Array, count: int,
              tolerance: float) -> Array:
    """Sums (count,) of the integrals from low to high (P,), each added to its owner (P,).

    function: takes owners and places (M,), gives values (M,); it may jump at low and high, elsewhere a
    panel is halved until its estimated error is below the tolerance.
    """
    total = np.zeros(count)
    for halved in range(HALVINGS + 1):
        if not len(owner):
            break
        width = high - low
        places = low[:, None] + width[:, None] * NODES
        values = function(np.repeat(owner, POINTS), places.ravel()).reshape(places.shape)
        good = (_error(values) * width <= tolerance) | (halved == HALVINGS)
        total += np.bincount(owner[good], (values @ WEIGHTS * width)[good], count)
        owner, low, high = owner[~good], low[~good], high[~good]
        middle = (low + high) / 2
        owner = np.concatenate([owner, owner])
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return total


def _error(values: Array) -> Array:
    """Estimated error of the rule for values (P, POINTS) on panels of width 1.

    The size of the two highest Legendre coefficients, less where they fall as those of a smooth function
    do: the ones that the rule leaves out continue the fall.
    """
    coefficients = np.abs(values @ TO_LEGENDRE[-4:].T)
    before, last = coefficients[:, :2].max(axis=1), coefficients[:, 2:].max(axis=1)
    ratio = last / np.maximum(before, np.finfo(float).tiny)
    error: Array = last * np.where(ratio < SMOOTH, ratio, 1.0)
    return error
