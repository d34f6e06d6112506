"""What the settings come to in a scene: lengths in its units, and a value for every `auto`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from jaart.core import extents, visible
from jaart.core.cloud import AUTO_H
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
_DIAGONAL = ", and half a cell's diagonal"


@dataclass(frozen=True)
class Chosen:
    """Settings with every word replaced; lengths in cells or cloud units.

    method, search, weight, normal, neighbourhood: as in the settings, none of them auto; h: feature size; radius:
    of the neighbourhood, infinite where k counts; trust: how far a search goes from its start; off_centre,
    nearest: bounds, infinite for none; level: of the energy or mesh; step: of march;
    stride: of the uniform traversal; tolerance: in h, or in radii where these are shorter.
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
    tolerance: float


#: A value, and in words where it comes from.
Explained = tuple[Any, str]
#: Where a value comes from that somebody set.
AS_SET = "as set"


def chosen(scene: Scene, settings: Settings) -> Chosen:
    """The values that a scene gives the settings.

    Raises SettingsError for a length out of its range, and for an h so small that no number of units is left.
    """
    return Chosen(**{name: value for name, (value, _) in explained(scene, settings).items()})


def explained(scene: Scene, settings: Settings) -> dict[str, Explained]:
    """The fields of Chosen, each with where its value comes from; see `chosen`."""
    lattice = scene.kind != "cloud"
    found = {"method": (settings.method, AS_SET), "weight": (settings.weight, AS_SET), "search": _search(settings),
             "normal": _normal(scene, settings), "neighbourhood": _neighbourhood(scene, settings),
             "h": _feature_size(scene, settings)}
    h = found["h"][0]
    found["radius"] = radius, _ = _radius(scene, settings, found["neighbourhood"][0], h)
    trust = (radius, "the radius") if math.isfinite(radius) else (LATTICE_RADIUS * h, f"{LATTICE_RADIUS:g} h")
    nearest = (math.inf, "no bound on a lattice") if lattice else (CLOUD_NEAREST * h, f"{CLOUD_NEAREST:g} h in a cloud")
    return found | {
        "trust": _or_length(scene, settings, "trust", trust), "level": _level(settings, h),
        "off_centre": _or_length(scene, settings, "max_off_centre", (OFF_CENTRE * h, "h")),
        "nearest": _or_length(scene, settings, "max_nearest", nearest), **_strides(settings, h, lattice),
        "tolerance": _tolerance(scene, settings, h, radius)}


def of_auto(scene: Scene, settings: Settings, name: str) -> str:
    """What a choice would come to in a scene, beside the other settings, were it left to the program."""
    left = settings.replace(**{name: "auto"})
    word: str = {"search": lambda: _search(left), "normal": lambda: _normal(scene, left),
                 "neighbourhood": lambda: _neighbourhood(scene, left)}[name]()[0]
    return word


def _strides(settings: Settings, h: float, lattice: bool) -> dict[str, Explained]:
    """The steps of march and of the uniform traversal."""
    if isinstance(settings.step, str):
        return {"step": (MARCH_STEP * h, f"{MARCH_STEP:g} h"), "stride": (STRIDE, f"{STRIDE:g} cell")}
    step = (settings.step, AS_SET) if lattice else (settings.step * h, f"{settings.step:g} h, as set")
    return {"step": step, "stride": (settings.step, AS_SET)}


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


def _or_length(scene: Scene, settings: Settings, name: str, otherwise: Explained) -> Explained:
    value = getattr(settings, name)
    if value == "none":
        return math.inf, "none, as set"
    return otherwise if isinstance(value, str) else (length(scene, settings, name), _as_set(value))


def _as_set(value: Length) -> str:
    """Where a length comes from that somebody set."""
    unit = {"": "", "d": "of the diagonal, ", "s": "of the spacing, "}[value.unit]
    return f"{value.value:g} {unit}{AS_SET}" if unit else AS_SET


def _feature_size(scene: Scene, settings: Settings) -> Explained:
    if settings.h == "auto" and scene.kind != "cloud":
        return LATTICE_H, f"{LATTICE_H:g} cells on a lattice"
    if settings.h == "auto":
        return extents.cloud_h(scene), f"{AUTO_H:g} times the edge of the square that a point has to itself"
    h, largest = length(scene, settings, "h"), extents.largest(scene, settings)
    if h < SMALLEST_H * largest:
        raise SettingsError(f"h = {settings.h}: too small for coordinates up to {largest:g}, "
                            f"expected at least {SMALLEST_H * largest:g}")
    assert isinstance(settings.h, Length)
    return h, _as_set(settings.h)


def _neighbourhood(scene: Scene, settings: Settings) -> Explained:
    if settings.neighbourhood != "auto":
        return settings.neighbourhood, AS_SET
    return ("ball", "a cloud has no cells") if scene.kind == "cloud" else ("cell_ball", "one list for each cell")


def counts_nearest(neighbourhood: str) -> bool:
    """Whether so many nearest surfels count, however far they are."""
    return neighbourhood.endswith("knn")


def _radius(scene: Scene, settings: Settings, neighbourhood: str, h: float) -> Explained:
    if counts_nearest(neighbourhood):
        return math.inf, "the k nearest count"
    if isinstance(settings.radius, Length):
        return length(scene, settings, "radius"), _as_set(settings.radius)
    ends = {"hat": 1.0, "squared_hat": 1.0, "wendland": WENDLAND_END}
    share = ends.get(settings.weight, LATTICE_RADIUS if scene.kind != "cloud" else CLOUD_RADIUS)
    if settings.weight in ends:
        cell = neighbourhood == "cell_ball"
        return share * h + HALF_DIAGONAL * cell, f"{share:.4g} h, where the weight ends" + _DIAGONAL * cell
    jumps = 0.0 if scene.kind == "cloud" else _without_jumps(settings, neighbourhood, h)
    if jumps > share * h:
        return jumps, "where f jumps by no more than the tolerance" + _DIAGONAL * (neighbourhood == "cell_ball")
    return share * h, f"{share:g} h{', as no more can be seen' if settings.tolerance == 'auto' else ''}"


def _without_jumps(settings: Settings, neighbourhood: str, h: float) -> float:
    """The radius at whose end f jumps by no more than the tolerance; 0 where that is not asked for."""
    fine = finite(settings.tolerance, COARSE)
    if fine >= COARSE or not PARAMETERS["tolerance"].matters(settings):
        return 0.0
    reach = h * math.sqrt(-math.log(NEGLIGIBLE * max(fine, float(np.finfo(np.float64).eps))))
    return reach + HALF_DIAGONAL if neighbourhood == "cell_ball" else reach


def _tolerance(scene: Scene, settings: Settings, h: float, radius: float) -> Explained:
    if isinstance(settings.tolerance, str):
        return visible.tolerance(scene, settings, h, min(h, radius))
    return settings.tolerance, AS_SET


def _search(settings: Settings) -> Explained:
    if settings.search != "auto":
        return settings.search, AS_SET
    return ("minimise", "for an energy") if settings.method in ENERGIES else ("iterate", "for what is no energy")


def _normal(scene: Scene, settings: Settings) -> Explained:
    if settings.normal != "auto":
        return settings.normal, AS_SET
    if scene.kind == "cloud" and scene.normals is None:
        return "covariance", "the points have no normals"
    return "surfel", "there are normals"


def _level(settings: Settings, h: float) -> Explained:
    return (_own_level(settings, h), "as the method needs it") if isinstance(settings.level, str) \
        else (settings.level, AS_SET)


def _own_level(settings: Settings, h: float) -> float:
    """The level of an energy or a mesh where nobody says: surfaces of even sampling have one without holes.

    On a flat dense sheet e_M is c·h², to which a distance of 0.375 h is added, the off-centre bound of [T 2.21].
    """
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


def arrival(chosen: Chosen) -> float:
    """How short a step ends a search."""
    return chosen.tolerance * unit_of(chosen)


def unit_of(chosen: Chosen) -> float:
    """The tolerance counts in h, but in radii where the radius is smaller, for what h does ends there."""
    return min(chosen.h, chosen.radius)


def tolerance_unit(chosen: Chosen) -> str:
    """The name of that."""
    return "h" if chosen.h <= chosen.radius else "radii"


def finite(value: Any, otherwise: float) -> float:
    """A number, or another one for a word."""
    return otherwise if isinstance(value, str) else float(np.float64(value))
