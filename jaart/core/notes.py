"""What a person should know of a scene with these settings, a line each."""

from __future__ import annotations

import numpy as np

from jaart.core import cloud, extents, prepare
from jaart.core.chosen import Chosen, arrival, chosen, counts_nearest, explained, tolerance_unit
from jaart.core.cloud_surfels import Points
from jaart.core.collapse import collapsing
from jaart.core.groups.surface import evaluates
from jaart.core.records import STATUS, Hits
from jaart.core.scene import Scene
from jaart.core.settings import PARAMETERS, Settings
from jaart.core.surfels import Surfels


def notes(scene: Scene, settings: Settings) -> tuple[str, ...]:
    """What is no error, but not as a person may expect it: a line each, none where all is well.

    Of what rays need anyway nothing is made twice, and nothing else is made. Raises what rays raise: SettingsError
    for settings that make no sense in the scene.
    """
    values = chosen(scene, settings)
    return (*_points(scene, settings, values), *_small_solids(scene, settings), *collapsing(scene, settings, values),
            *_precision(scene, settings, values))


def _points(scene: Scene, settings: Settings, values: Chosen) -> tuple[str, ...]:
    """What there is to say of the surfels, where any are asked for."""
    if not evaluates(values):
        return ()
    found = prepare.points(scene, settings, values)
    return (*found.notes, *_neighbours(scene, settings, values, len(found)),
            *_feature_size(scene, settings, values, found))


def of_hits(scene: Scene, hits: Hits) -> tuple[str, ...]:
    """What a person should know of how the rays of a scene ended: a line each, none where all is well."""
    return (*_bad_rays(hits), *_without_normal(scene, hits))


def _bad_rays(hits: Hits) -> tuple[str, ...]:
    """Rays that are none."""
    bad = np.flatnonzero(hits.status == STATUS["bad_ray"])
    if not len(bad):
        return ()
    return (f"{len(bad)} of {len(hits)} rays {'is no ray' if len(bad) == 1 else 'are no rays'} (bad_ray), the first is "
            f"number {bad[0]}, counted from 0; expected finite numbers, directions of some length, and origins that "
            "are not so far that they have no precision",)


def _without_normal(scene: Scene, hits: Hits) -> tuple[str, ...]:
    """Most rays that came near end where no normal is defined."""
    counts = hits.counts()
    near = len(hits) - counts.get("background", 0) - counts.get("bad_ray", 0)
    without = counts.get("undefined_normal", 0)
    if 2 * without <= near:
        return ()
    return (f"no normal is defined for {without} of the {near} rays that came near: "
            f"{_why_no_normal(scene, hits.settings)}",)


def _why_no_normal(scene: Scene, settings: Settings) -> str:
    """What keeps a normal from being defined: no sheet of points, or too few of them within the radius."""
    origins = explained(scene, settings)
    (normal, _), (radius, origin) = origins["normal"], origins["radius"]
    if normal == "surfel" and (scene.kind != "cloud" or scene.normals is not None):
        return "normals that cancel each other out have no average"
    spacing = cloud.spacing(scene) if scene.kind == "cloud" else 1.0
    if radius < spacing:
        return (f"radius = {radius:.4g} ({origin}) holds too few points for a surface, as they lie {spacing:.4g} apart "
                "on average; expected a larger one")
    return "points along a line or in one place have no surface"


def _neighbours(scene: Scene, settings: Settings, values: Chosen, count: int) -> tuple[str, ...]:
    """Numbers of neighbours that are clipped to what there is."""
    said = []
    others = count - 1
    if scene.kind == "cloud" and others == 0:
        said.append("there is a single point: its ball has the radius h")
    elif scene.kind == "cloud" and settings.ball_k > others:
        said.append(f"ball_k = {settings.ball_k}: {_only(others, 'other point')}")
    if counts_nearest(values.neighbourhood) and PARAMETERS["k"].matters(settings) and settings.k > count > 0:
        said.append(f"k = {settings.k}: {_only(count, 'point' if scene.kind == 'cloud' else 'surfel')}")
    return tuple(said)


def _feature_size(scene: Scene, settings: Settings, values: Chosen, found: Surfels | Points) -> tuple[str, ...]:
    """An h beyond which there is nothing."""
    if not PARAMETERS["h"].matters(settings):
        return ()
    size = _longest(scene, values.h, found)
    if size == 0 or values.h <= size:
        return ()
    return (f"h = {values.h:.4g} is larger than all the points together, {size:.4g}: no surface can be expected, or a "
            "flat one through their middle",)


def _longest(scene: Scene, h: float, found: Surfels | Points) -> float:
    """The longest edge of the box around all points or the cells of all surfels; 0 where h is surely smaller."""
    if isinstance(found, Surfels):
        return 1.0 + float(np.ptp(found.cells, axis=0).max()) if h > 1 and len(found) else 0.0
    low, high = cloud.bounds(scene)
    return float((high - low).max())


def _small_solids(scene: Scene, settings: Settings) -> tuple[str, ...]:
    """Solids that a cell may hold whole."""
    if scene.model is None:
        return ()
    thickness = [solid.thickness * extents.raster(scene, settings) for solid in scene.model.solids]
    small = [t for t in thickness if t < 1]
    if not small:
        return ()
    one = len(small) == 1
    return (f"{len(small)} of {len(thickness)} solids {'is' if one else 'are'} thinner than a cell, {min(small):.2g}: "
            f"{'it has' if one else 'they have'} meaningful normals only about a corner that 8 cells share "
            "[T fig. 2.22]; expected a higher raster",)


def _precision(scene: Scene, settings: Settings, values: Chosen) -> tuple[str, ...]:
    """A tolerance below the distance of one coordinate to the next."""
    largest = float(np.abs(extents.bounds(scene, settings)).max())
    step, tolerance = float(np.spacing(largest)), arrival(values)
    if step <= tolerance or not PARAMETERS["tolerance"].matters(settings):
        return ()
    return (f"coordinates up to {largest:.4g} are exact to {step:.2g}, and hits no more than that: the tolerance is "
            f"{values.tolerance:g} {tolerance_unit(values)}, a length of {tolerance:.2g}",)


def _only(count: int, noun: str) -> str:
    return f"there is only 1 {noun}" if count == 1 else f"there are only {count} {noun}s"
