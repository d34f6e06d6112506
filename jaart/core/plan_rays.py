"""The stages of a ray: what is summed at a point, how the surface is searched, what a hit must keep."""

from __future__ import annotations

import math
from collections.abc import Callable

from jaart.core import meaning
from jaart.core.assemble import bounds_of, goes_together, rule_of
from jaart.core.chosen import Chosen
from jaart.core.groups.search import searches
from jaart.core.groups.surface import FITTED, MESHES, evaluates
from jaart.core.kernels import records as r
from jaart.core.kernels.records import Bounds, Rule
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.stage import Stage, stage

#: Searches that go by the slope of f.
SLOPED = ("newton", "safe")
#: Energies that no normal of the average enters, unless they are emphasised by the angle.
BLIND = ("off_centre", "mahalanobis")
#: Each bound of a hit: its stage and setting, whether it asks for anything, and what it takes to know.
BOUNDS: tuple[tuple[str, str, Callable[[Bounds], bool], str], ...] = (
    ("off-centre bound", "max_off_centre", lambda b: b.off_centre < math.inf, "the off-centre value is known anyway"),
    ("weight bound", "min_weight", lambda b: b.log_weight > -math.inf, "the sum of weights is known anyway"),
    ("nearest bound", "max_nearest", lambda b: b.nearest < math.inf, "the nearest surfel of each hit is looked for"),
    ("angle bound", "max_angle", lambda b: b.angle < math.inf, "the angle of each hit is taken"),
    ("sampling bound", "min_gap", lambda b: b.gap > -math.inf, "a covariance and its eigenvalues for each hit"),
)


def ray_stages(scene: Scene, settings: Settings, values: Chosen) -> tuple[Stage, ...]:
    """What rays take, in the order of the computation."""
    rule = rule_of(scene, settings, values)
    return (_traversal(scene, settings, values), *_sums(settings, values, rule), *_fits(values, rule),
            *_search(scene, settings, values), *_bounds(settings, values))


def _traversal(scene: Scene, settings: Settings, values: Chosen) -> Stage:
    """How a ray comes from place to place."""
    if values.method in MESHES:
        return Stage("traversal", False, "the tree of the triangles takes its place", ("method",))
    if scene.kind == "cloud":
        return Stage("traversal", True, "the balls that the ray pierces, the nearest first")
    even = settings.traversal == "uniform" and values.method != "cylinder"
    return Stage("traversal", True, f"every {values.stride:g} cells, and what is empty at once" if even else
                 "each cell that the ray crosses, and what is empty at once", ("traversal", "step") if even else
                 ("traversal",))


def summed(settings: Settings, values: Chosen, rule: Rule) -> dict[str, bool]:
    """Which sums over the surfels an evaluation takes: weights, normals, covariance and gradient."""
    weighs = meaning.weighs(values)
    normal = weighs and not (_blind(settings, values) and values.method in MESHES)
    return {"weights": weighs,
            "normals": normal and (rule.normal == r.SURFEL or rule.oriented == 1),
            "covariance": normal and rule.normal != r.SURFEL,
            "gradient": searches(values) and (values.search in SLOPED or meaning.shows_gradient(settings))}


def _blind(settings: Settings, values: Chosen) -> bool:
    """Whether an energy is asked for that no normal enters, so that hits alone need one."""
    energy = settings.energy if values.method == "isosurface" else values.method
    asked = values.method == "isosurface" or (searches(values) and values.search == "minimise")
    return asked and energy in BLIND and not settings.emphasise


def _sums(settings: Settings, values: Chosen, rule: Rule) -> tuple[Stage, ...]:
    taken, nothing = summed(settings, values, rule), _unweighed(values)
    mahalanobis = "mahalanobis" in (values.method, settings.energy if values.method == "isosurface" else "")
    blind, normal = _blind(settings, values), ("method", "normal", "emphasise")
    unseen = nothing or ("the energy's level needs no normal" if blind and values.method in MESHES else "")
    where = ", where an energy is least" if blind else ""
    closed = "by differences" if values.method in FITTED else "in closed form"
    return (
        stage("weights and barycentre", taken["weights"], f"{values.weight}, h = {values.h:.4g}", nothing,
              "method", "weight", "h"),
        stage("sum of normals", taken["normals"],
              f"n(x) is the surfels' average{where}" if rule.normal == r.SURFEL
              else f"the eigenvector is turned to their side{where}",
              unseen or "n(x) comes from the points alone", *normal),
        stage("covariance and eigenvector", taken["covariance"], f"n(x) is the direction of least spread{where}",
              unseen or "n(x) is the average of the surfels' normals", *normal),
        stage("Mahalanobis sum", mahalanobis, "the mean distance to the surfels' planes is minimised",
              "no energy asks for it", "method", "energy", "mahalanobis_c"),
        stage("gradient of f", taken["gradient"], f"{_who(settings, values)} it, {closed}",
              "neither search nor shown normal takes it" if searches(values) else "no ray is searched",
              "method", "search", "shading_normal"))


def _unweighed(values: Chosen) -> str:
    """Why no point is evaluated; empty where one is."""
    if not evaluates(values):
        return "the mesh is that of the fill levels"
    return "" if meaning.weighs(values) else "the mean of a cylinder takes its place"


def _who(settings: Settings, values: Chosen) -> str:
    if values.search not in SLOPED:
        return "the shown normal takes"
    return f"{values.search}{' and the shown normal take' if meaning.shows_gradient(settings) else ' takes'}"


def _fits(values: Chosen, rule: Rule) -> tuple[Stage, ...]:
    return (
        stage("reference plane", values.method == "projection", "found by minimisation from the plane at x",
              "method is no projection", "method"),
        stage("polynomial fit", values.method in FITTED,
              f"of degree {rule.degree}{', over a patch of each surfel' if rule.patch > 0 else ''}",
              "the surface is no polynomial", "method", "degree", "patch"),
        stage("energy", values.search == "minimise" and searches(values),
              f"its least along the ray, below {values.level:.4g}", "no energy is minimised along a ray",
              "method", "search", "level", "emphasise"),
        stage("cylinder", values.method == "cylinder", f"the mean of the surfels within {values.h:.4g} of the ray",
              "method is no cylinder", "method"))


def _search(scene: Scene, settings: Settings, values: Chosen) -> tuple[Stage, ...]:
    kept = meaning.fits_centres(scene, settings, values) and searches(values)
    place = "ball" if scene.kind == "cloud" else "cell"
    guessed = f"where the ray meets what is kept at a {place}'s centre"
    why_not = "no ray is searched"
    if searches(values):
        why_not = "a search begins where the ray enters a cell"
    if meaning.stretches(values) and searches(values):
        why_not = "a place is searched from side to side"
    where = "from side to side of each place" if meaning.stretches(values) else "from a start in each place"
    abreast = goes_together(scene, settings, values)
    return (
        stage("centre fits", kept, f"kept for each {place} that a ray asks for", why_not, "method", "search",
              "traversal"),
        stage("first guess", kept, guessed, why_not, "method", "search", "traversal"),
        stage("search", searches(values), f"{values.search}, {where}",
              "triangles are hit at once" if values.method in MESHES else "discs are hit at once", "method", "search"),
        stage("rays side by side", abreast, "their steps are taken in vectors", _why_alone(scene, values),
              "method", "search", "normal", "weight", "neighbourhood", "traversal", "bail", "shading_normal",
              "min_weight", "max_nearest", "max_angle", "min_gap"),
        stage("proof of misses", settings.proof, "bounds of the weights", "none is asked for", "search", "proof"))


def _why_alone(scene: Scene, values: Chosen) -> str:
    """Why each ray is searched by itself."""
    if not searches(values):
        return "no ray is searched"
    return "balls are searched ray by ray" if scene.kind == "cloud" else "only the plain steps of the source do"


def _bounds(settings: Settings, values: Chosen) -> tuple[Stage, ...]:
    """Each bound that a hit must keep."""
    bounds, meant = bounds_of(settings, values), searches(values)
    why_not = "no bound" if meant else "meshes and discs have none"
    return tuple(stage(name, meant and asks(bounds), why, why_not, "method", setting)
                 for name, setting, asks, why in BOUNDS)
