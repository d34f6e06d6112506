"""What the settings come to in a scene: lengths in its units, and a value for every `auto`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from jaart.core import extents
from jaart.core.errors import SettingsError
from jaart.core.groups.surface import ENERGIES
from jaart.core.kernels.weigh import WENDLAND_END
from jaart.core.parameter import Length
from jaart.core.scene import Scene
from jaart.core.settings import PARAMETERS, Settings

#: A smaller h, as a share of the largest coordinate, is no length any more: its square underflows.
SMALLEST_H = 1e-100
#: h of a lattice where nobody says, in cells [T §3.1.3].
LATTICE_H = 0.8
#: Radius of a lattice's neighbourhood where nobody says, in h: 2.5 cells at h = 0.8, where a polynomial's errors end.
LATTICE_RADIUS = 3.125
#: With a finer tolerance, in h, the radius of a lattice's neighbourhood grows: f jumps by as much where it ends there.
COARSE = 0.01
#: Where surfels weigh less than this share of the tolerance, f jumps by no more than the tolerance.
NEGLIGIBLE = 0.1
#: Radius of a cloud's neighbourhood where nobody says, in h: farther surfels weigh less than 1e-7.
CLOUD_RADIUS = 4.0
#: Off-centre bound where nobody says, in h: at the edge of an even sheet it is 0.56 h, where points are uneven more.
OFF_CENTRE = 1.0
#: Distance to the nearest point up to which a cloud has a surface where nobody says, in h.
CLOUD_NEAREST = 1.5
#: Steps of march, in h, and of the uniform traversal, in cells, where nobody says.
MARCH_STEP, STRIDE = 0.25, 1.0
#: Distance from a surface up to which an energy's minimum is one, in h: 0.3 cells at h = 0.8 [T 2.21].
NEAR = 0.375
#: Half the thickness of an isosurface's shell, in samples of its energy.
SHELL = 0.55
#: Half the diagonal of a cell: as far as a point in it may be from its centre.
HALF_DIAGONAL = math.sqrt(3) / 2


@dataclass(frozen=True)
class Chosen:
    """Settings with every word replaced; lengths in cells or cloud units.

    method, search, weight, normal, neighbourhood: as in the settings, none of them auto; h: feature size; radius:
    of the neighbourhood, infinite where k counts; trust: how far a search goes from its start; off_centre,
    nearest: bounds, infinite for none; level: of the energy or mesh; step: of march;
    stride: of the uniform traversal.
    """

    method: str
    search: str
    weight: str
    normal: str
    neighbourhood: str
    h: float
    radius: float
    trust: float
    off_centre: float
    nearest: float
    level: float
    step: float
    stride: float


def chosen(scene: Scene, settings: Settings) -> Chosen:
    """The values that a scene gives the settings.

    Raises SettingsError for a length out of its range, and for an h so small that no number of units is left.
    """
    h = _feature_size(scene, settings)
    neighbourhood = _neighbourhood(scene, settings)
    radius = _radius(scene, settings, neighbourhood, h)
    search = _search(settings)
    lattice = scene.kind != "cloud"
    trust = radius if math.isfinite(radius) else LATTICE_RADIUS * h
    return Chosen(
        method=settings.method, search=search, weight=settings.weight, normal=_normal(scene, settings),
        neighbourhood=neighbourhood, h=h, radius=radius, trust=_or_length(scene, settings, "trust", trust),
        off_centre=_or_length(scene, settings, "max_off_centre", OFF_CENTRE * h),
        nearest=_or_length(scene, settings, "max_nearest", math.inf if lattice else CLOUD_NEAREST * h),
        level=_level(settings, h),
        step=MARCH_STEP * h if isinstance(settings.step, str) else settings.step * (1.0 if lattice else h),
        stride=STRIDE if isinstance(settings.step, str) else settings.step)


def length(scene: Scene, settings: Settings, name: str) -> float:
    """A setting's length in cells or cloud units: a share of the diagonal ("d"), of the spacing ("s"), or as it is.

    Raises SettingsError where a share comes to no length that the setting may have.
    """
    value: Length = getattr(settings, name)
    if not value.unit:
        return value.value
    resolved = value.resolve(extents.diagonal(scene, settings), extents.spacing(scene) if value.unit == "s" else 1.0)
    # a cloud's units are its own, however large it is in them
    PARAMETERS[name].check(Length(resolved if scene.kind != "cloud" else min(resolved, 1.0)))
    return resolved


def _or_length(scene: Scene, settings: Settings, name: str, otherwise: float) -> float:
    value = getattr(settings, name)
    if value == "none":
        return math.inf
    return otherwise if isinstance(value, str) else length(scene, settings, name)


def _feature_size(scene: Scene, settings: Settings) -> float:
    if settings.h == "auto":
        return LATTICE_H if scene.kind != "cloud" else extents.cloud_h(scene)
    h, largest = length(scene, settings, "h"), extents.largest(scene, settings)
    if h < SMALLEST_H * largest:
        raise SettingsError(f"h = {settings.h}: too small for coordinates up to {largest:g}, "
                            f"expected at least {SMALLEST_H * largest:g}")
    return h


def _neighbourhood(scene: Scene, settings: Settings) -> str:
    if settings.neighbourhood != "auto":
        return settings.neighbourhood
    return "ball" if scene.kind == "cloud" else "cell_ball"


def _radius(scene: Scene, settings: Settings, neighbourhood: str, h: float) -> float:
    if neighbourhood.endswith("knn"):
        return math.inf
    if settings.radius != "auto":
        return length(scene, settings, "radius")
    ends = {"hat": 1.0, "squared_hat": 1.0, "wendland": WENDLAND_END}
    reach = ends.get(settings.weight, LATTICE_RADIUS if scene.kind != "cloud" else CLOUD_RADIUS) * h
    if settings.weight in ends:
        return reach + HALF_DIAGONAL if neighbourhood == "cell_ball" else reach
    return reach if scene.kind == "cloud" else max(reach, _without_jumps(settings, neighbourhood, h))


def _without_jumps(settings: Settings, neighbourhood: str, h: float) -> float:
    """The radius at whose end f jumps by no more than the tolerance; 0 where that is not asked for."""
    if settings.tolerance >= COARSE or not PARAMETERS["tolerance"].matters(settings):
        return 0.0
    reach = h * math.sqrt(-math.log(NEGLIGIBLE * max(settings.tolerance, float(np.finfo(np.float64).eps))))
    return reach + HALF_DIAGONAL if neighbourhood == "cell_ball" else reach


def _search(settings: Settings) -> str:
    if settings.search != "auto":
        return settings.search
    return "minimise" if settings.method in ENERGIES else "iterate"


def _normal(scene: Scene, settings: Settings) -> str:
    if settings.normal != "auto":
        return settings.normal
    return "covariance" if scene.kind == "cloud" and scene.normals is None else "surfel"


def _level(settings: Settings, h: float) -> float:
    """The level of an energy or a mesh: as set, else so that surfaces of even sampling have one without holes.

    On a flat dense sheet e_M is c·h², to which a distance of 0.375 h is added, the off-centre bound of [T 2.21].
    """
    if not isinstance(settings.level, str):
        return settings.level
    if settings.method == "fill_level":
        return 0.5
    name = settings.energy if settings.method == "isosurface" else settings.method
    if settings.method == "isosurface":
        return _shell_level(settings, name, h)
    near = NEAR * h
    levels: dict[str, Any] = {"tangent": near, "off_centre": near, "mahalanobis": settings.mahalanobis_c * h * h
                              + near * near, "angle": 0.5}
    level = float(levels.get(name, near))
    return min(1.0, level) if settings.emphasise else level


def _shell_level(settings: Settings, energy: str, h: float) -> float:
    """The level of an isosurface: the lowest whose shell, half a sample thick or more, has no holes."""
    if settings.emphasise or energy == "angle":
        return 0.9
    half = SHELL / settings.subdivide
    return {"tangent": half, "off_centre": math.hypot(half, 0.25 * h),
            "mahalanobis": 2 * settings.mahalanobis_c * h * h + half * half}[energy]


def arrival(settings: Settings, chosen: Chosen) -> float:
    """How short a step ends a search: the tolerance counts in h, but in radii where the radius is smaller, for what
    h does ends there.
    """
    return settings.tolerance * min(chosen.h, chosen.radius)


def finite(value: Any, otherwise: float) -> float:
    """A number, or another one for a word."""
    return otherwise if isinstance(value, str) else float(np.float64(value))
