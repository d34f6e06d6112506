"""Which energy a search looks at, and its value at each look [T §2.4.4]."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.groups.search import STRETCHES
from jaart.core.groups.surface import ENERGIES
from jaart.core.records import Trace

Array = NDArray[np.float64]

#: Names of the energies in figures.
SIGNS = {"tangent": "e_ts", "off_centre": "e_oc", "mahalanobis": "e_M", "angle": "e_angle"}


def energy_name(trace: Trace) -> str:
    """The energy whose minimum or zero is searched."""
    return trace.settings.method if trace.settings.method in ENERGIES else "tangent"


def minimises(trace: Trace) -> bool:
    """Whether a least energy is searched, which counts below a level."""
    return trace.settings.method in ENERGIES or (trace.settings.search == "minimise" and bool(trace.steps))


def looks(trace: Trace) -> bool:
    """Whether the steps are looks at places of the ray, and not each the way to the next."""
    return minimises(trace) or trace.settings.search in STRETCHES


def at_steps(trace: Trace) -> Array:
    """The searched energy (S,) at each step, NaN where it is not defined."""
    name = energy_name(trace)
    if name == "tangent":
        return trace.energy
    if name == "off_centre":
        return trace.off_centre
    if name == "mahalanobis":
        return _interpolated(trace, trace.curves.mahalanobis)
    to_barycentre = trace.barycentre - trace.query
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine: Array = np.abs((to_barycentre * trace.step_normal).sum(axis=1)) / np.linalg.norm(to_barycentre, axis=1)
    return cosine


def _interpolated(trace: Trace, values: Array) -> Array:
    known = np.isfinite(values)
    order = np.argsort(trace.curves.t[known], kind="stable")
    if not known.any():
        return np.full(trace.steps, np.nan)
    result: Array = np.interp(trace.t_query, trace.curves.t[known][order], values[known][order])
    return result
