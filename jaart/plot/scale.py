"""How large things are around a ray: cells in a lattice, balls in a cloud, and lengths as text."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from jaart.core.records import Trace

Array = NDArray[np.float64]

#: Why a ray can take no step, by the state that it ends in.
_UNABLE = {"undefined_normal": "the normal is undefined", "few_neighbours": "no surfel is near"}


def is_cloud(trace: Trace) -> bool:
    """Whether the ray goes through a cloud, and so through balls instead of cells."""
    from jaart.core.cloud_surfels import Points

    return isinstance(trace.surfels, Points)


def unit(trace: Trace) -> str:
    """What lengths count in."""
    return "units" if is_cloud(trace) else "cells"


def size(trace: Trace) -> float:
    """The length that drawings are scaled by: a cell, or the radius of the usual ball that the ray pierces."""
    if not is_cloud(trace):
        return 1.0
    radius = float(np.median(trace.balls[:, 3])) if len(trace.balls) else 0.0
    return radius or float(np.linalg.norm(trace.high - trace.low)) / 100 or 1.0


def text(trace: Trace, length: float, places: int = 4, sign: str = "") -> str:
    """A length with so many places in a lattice; in a cloud with nearly as many digits below the balls' size."""
    if is_cloud(trace):
        places = max(0, places - 1 - math.floor(math.log10(size(trace))))
    return f"{length:{sign}.{places}f}"


def step_text(trace: Trace, length: float, places: int = 4, sign: str = "") -> str:
    """The length of a step: as `text`, but with digits that count however short it is in a cloud."""
    return f"{length:{sign}.3g}" if is_cloud(trace) else text(trace, length, places, sign)


def own_ball(trace: Trace, step: int) -> NDArray[np.bool_]:
    """Which of a cloud's balls (B,) the search of a step is in: one, or none where the ray does not pierce it."""
    own: NDArray[np.bool_] = np.arange(len(trace.balls)) == trace.step_cell[step, 0]
    return own


def stretches(trace: Trace) -> Array:
    """Where the ray enters and leaves each cell or ball (N, 2), t along it."""
    if not is_cloud(trace):
        return np.stack([trace.borders[:-1], trace.borders[1:]], axis=1)
    to_ball = trace.balls[:, :3] - trace.origin
    foot = to_ball @ trace.direction
    aside = np.linalg.norm(to_ball - foot[:, None] * trace.direction, axis=1)
    half = np.sqrt(np.maximum((trace.balls[:, 3] - aside) * (trace.balls[:, 3] + aside), 0.0))
    return np.stack([np.maximum(foot - half, 0.0), foot + half], axis=1)


def no_steps(trace: Trace) -> str:
    """Why a ray has no step to show, in lines."""
    if trace.hit:
        return "This surface is hit at once:\nno step is taken."
    count, none = len(trace.balls) or int(trace.with_surfel.sum()), "no step was taken."
    passed = f"pierces {_some(count, 'ball')}" if is_cloud(trace) else f"crosses {_some(count, 'cell')} with a surfel"
    near = bool(np.isfinite(trace.curves.tangent).any())
    if trace.status in _UNABLE:
        return (f"This ray {passed},\n{'but' if count else 'and'} {_UNABLE[trace.status]} "
                f"{'in places' if near else 'there'}:\n{none}")
    return f"This ray {'misses the surface' if near or count else passed}:\n{none}"


def _some(count: int, thing: str) -> str:
    return f"{count or 'no'} {thing}{'' if count <= 1 else 's'}"
