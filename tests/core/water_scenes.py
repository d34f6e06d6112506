"""Rays through an exact ball, and lights that tell what came of them."""

from __future__ import annotations

import numpy as np
from exact_rays import shooting_at
from numpy.typing import NDArray

from jaart.core.environment import Environment
from jaart.core.secondary import Tracer
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere

Array = NDArray[np.float64]
#: No highlights, so that only the way of the rays counts.
PLAIN = Settings(shading="water", specular=0.0)
BALL = Sphere((0.0, 0.0, 0.0), 2.0)


class White(Environment):
    """The same light from everywhere: what a pixel gets is the energy that arrived."""

    def colour(self, origin: Array, direction: Array) -> Array:
        return np.ones(origin.shape)


#: So wide that nothing is absorbed in the ball.
WIDE = (np.full(3, -1e15), np.full(3, 1e15))


def exact(ball: Sphere = BALL, near: float = 1e-6) -> Tracer:
    return Tracer(shooting_at(ball), 1e-13, near)
