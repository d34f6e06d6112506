"""The numbers of a picture that can be shown in false colour, and the limits of their scales."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jaart.core.errors import SettingsError
from jaart.core.records import STATUS_NAMES, Hits, Quality
from jaart.core.settings import Settings

Array = NDArray[np.float64]
Values = Callable[[Hits, Quality | None], Array]

#: Share of the values that a scale covers; the few above it are drawn as its end.
_COVERED = 98.0

#: Differences that are rounding errors: a scale does not stretch for them.
_SLACK = 1e-9


@dataclass(frozen=True)
class Map:
    """One number of each ray.

    name: as typed after --map; label: for people; unit: "" when it has none; values(hits, quality):
    (R,), NaN where a ray has none; zero: whether its scale begins at 0; whole: whole numbers.
    """

    name: str
    label: str
    unit: str
    values: Values
    zero: bool = True
    whole: bool = False


def _shaded(hits: Hits, quality: Quality | None) -> Array:
    """|<n, d>|: how directly each hit faces the viewer."""
    cosine: Array = np.einsum("ij,ij->i", hits.normal, hits.direction)
    return np.abs(cosine)


def _iterations(hits: Hits, quality: Quality | None) -> Array:
    return np.where(hits.evaluations > 0, hits.iterations, np.nan)


def _evaluations(hits: Hits, quality: Quality | None) -> Array:
    return np.where(hits.evaluations > 0, hits.evaluations, np.nan)


def _off_centre(hits: Hits, quality: Quality | None) -> Array:
    return np.where(hits.hit, hits.off_centre, np.nan)


def _depth(hits: Hits, quality: Quality | None) -> Array:
    return np.where(hits.hit, hits.t, np.nan)


def _sampling(hits: Hits, quality: Quality | None) -> Array:
    return np.where(hits.hit, hits.gap, np.nan)


def _lowered(hits: Hits, quality: Quality | None) -> Array:
    return np.where(hits.evaluations > 0, hits.lowered, np.nan)


def _status(hits: Hits, quality: Quality | None) -> Array:
    return hits.status.astype(np.float64)


def _distance_error(hits: Hits, quality: Quality | None) -> Array:
    return np.full(len(hits), np.nan) if quality is None else quality.distance


def _normal_error(hits: Hits, quality: Quality | None) -> Array:
    return np.full(len(hits), np.nan) if quality is None else quality.angle


#: Every map by name, in the order of a menu.
MAPS: dict[str, Map] = {m.name: m for m in (
    Map("shaded", "Shaded", "", _shaded),
    Map("iterations", "Iterations of the last start", "", _iterations, whole=True),
    Map("evaluations", "Evaluations of all starts", "", _evaluations, whole=True),
    Map("off_centre", "Off-centre value of hits", "cells", _off_centre),
    Map("sampling", "Sampling (λ1 - λ0)/λ2 of hits", "", _sampling),
    Map("lowered", "Evaluations with fewer degrees", "", _lowered, whole=True),
    Map("depth", "Depth", "cells", _depth, zero=False),
    Map("status", "How the ray ended", "", _status, whole=True),
    Map("distance_error", "Distance from the exact surface", "cells", _distance_error),
    Map("normal_error", "Angle to the exact normal", "degrees", _normal_error),
)}


def find(name: str) -> Map:
    """The map of a name. Raises SettingsError when there is none."""
    if name not in MAPS:
        raise SettingsError(f"no map is called {name!r}; there are {', '.join(MAPS)}")
    return MAPS[name]


def lacks(name: str, exact: bool, settings: Settings) -> str:
    """What a map needs and has not, in words; "" when it can be drawn. exact: whether the exact surface is known.

    Raises SettingsError for a name that does not exist.
    """
    find(name)
    if name.endswith("_error") and not exact:
        return "an exact surface, which nobody knows of this scene"
    if name == "sampling" and settings.min_gap == "none":
        return "min_gap, which has it measured; 0 refuses no hit"
    return ""


def unit(name: str, kind: str) -> str:
    """The unit of a map in a kind of scene (see KINDS): lengths count in cells of a lattice, in units of a cloud.

    Errors of a cloud count in its mean spacing.
    """
    about = find(name)
    if kind != "cloud" or about.unit != "cells":
        return about.unit
    return "spacings" if name.endswith("_error") else "units"


def scale(name: str, hits: Hits, quality: Quality | None = None) -> tuple[float, float]:
    """(low, high) of a map's colours: round numbers that cover all but the few highest values."""
    if name == "shaded":
        return 0.0, 1.0
    if name == "status":
        return 0.0, len(STATUS_NAMES) - 1.0
    about = find(name)
    return limits(about.values(hits, quality), zero=about.zero, whole=about.whole)


def limits(values: Array, *, zero: bool = True, whole: bool = False) -> tuple[float, float]:
    """Round limits of some numbers, NaN left out; (0, 1) without any.

    zero: begin at 0, else at a round number below the least; whole: end at a whole number.
    """
    finite = values[np.isfinite(values)]
    if not len(finite):
        return 0.0, 1.0
    high = float(np.percentile(finite, _COVERED, method="higher"))
    low = 0.0 if zero else float(finite.min())
    step = _step(high - low)
    step = max(1.0, step) if whole else step
    first, last = math.floor(low / step + _SLACK), math.ceil(high / step - _SLACK)
    return _plain(step * first), _plain(step * max(last, first + 1))


def _plain(number: float) -> float:
    """0.3 for 0.30000000000000004."""
    return float(f"{number:.12g}")


def _step(span: float) -> float:
    """A step of 1, 2 or 5 times a power of ten that divides a span into at least five; 1 for rounding errors."""
    if not span > _SLACK:
        return 1.0
    power = 10.0 ** math.floor(math.log10(span / 5))
    return max(s * power for s in (1.0, 2.0, 5.0) if s == 1.0 or s * power <= span / 5 * (1 + _SLACK))
