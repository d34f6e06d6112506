"""From the settings to what the kernels are handed: numbers in the place of names, addresses of kernels."""

from __future__ import annotations

import math
from typing import Any

from jaart.core.addresses import address_of
from jaart.core.chosen import Chosen, arrival, finite
from jaart.core.groups.surface import FITTED
from jaart.core.kernels import (
    accept,
    approach,
    call,
    centres,
    cylinder_search,
    first_guess,
    fitted,
    march,
    minimise,
    project,
    safe,
    stepping,
    tangent,
)
from jaart.core.kernels import records as r
from jaart.core.kernels.records import Bounds, Plan, Rule, Search
from jaart.core.meaning import fits_centres, oriented, shows_gradient
from jaart.core.scene import Scene
from jaart.core.settings import Settings

WEIGHTS = {"gaussian": r.GAUSSIAN, "hat": r.HAT, "squared_hat": r.SQUARED_HAT, "wendland": r.WENDLAND}
NORMALS = {"surfel": r.SURFEL, "covariance": r.COVARIANCE, "covariance_at_x": r.COVARIANCE_AT_X}
SEARCHES = {"iterate": r.ITERATE, "secant": r.SECANT, "newton": r.NEWTON, "minimise": r.MINIMISE, "march": r.MARCH,
            "safe": r.SAFE, "centres": r.CENTRES}
ENERGY_NUMBERS = {"tangent": r.TANGENT_STEP, "off_centre": r.OFF_CENTRE, "mahalanobis": r.MAHALANOBIS,
                  "angle": r.ANGLE}


def plan_of(scene: Scene, settings: Settings, values: Chosen) -> Plan:
    """All that rays need to know beside the surfels; its kernels are compiled or loaded on first use."""
    rule = rule_of(scene, settings, values)
    evaluate = address_of(evaluator(values), call.EVALUATE)
    meets = address_of(approach.approach, call.APPROACH) if rule.degree > 0 else 0
    how = Search(kind=SEARCHES[values.search], proof=int(settings.proof), evaluate=evaluate, approach=meets,
                 accept=address_of(accept.accept, call.ACCEPT), arrived=arrival(values),
                 by_value=int(values.method in FITTED), cap=settings.max_iterations, trust=values.trust,
                 growth=int(settings.bail == "growth"), step=values.step,
                 energy=ENERGY_NUMBERS.get(values.method, r.TANGENT_STEP), emphasise=int(settings.emphasise),
                 level=values.level, true_normal=int(shows_gradient(settings)))
    return Plan(rule, how, bounds_of(settings, values), address_of(searcher(scene, settings, values), call.SEARCH))


def rule_of(scene: Scene, settings: Settings, values: Chosen) -> Rule:
    """How a point is evaluated."""
    return Rule(weight=WEIGHTS[values.weight], normal=NORMALS[values.normal], h=values.h,
                reach=values.radius if values.neighbourhood == "ball" else math.inf,
                k=settings.k if values.neighbourhood == "knn" else 0,
                oriented=int(oriented(scene, settings, values)),
                degree=settings.degree if values.method in FITTED else 0,
                patch=_patch(scene, settings, values), c=settings.mahalanobis_c)


def _patch(scene: Scene, settings: Settings, values: Chosen) -> float:
    """Variance in h², along one direction, of the patch that a surfel stands for; a cloud's points are points."""
    if values.method != "polynomial" or scene.kind == "cloud":
        return 0.0
    return (settings.patch / values.h) ** 2 / 12


def bounds_of(settings: Settings, values: Chosen) -> Bounds:
    """What a hit must keep [T §2.5]."""
    return Bounds(off_centre=values.off_centre, log_weight=finite(settings.min_weight, -math.inf),
                  nearest=values.nearest, angle=finite(settings.max_angle, math.inf),
                  gap=finite(settings.min_gap, -math.inf))


def evaluator(values: Chosen) -> Any:
    """The kernel that evaluates the surface: only what a scene asks for is compiled or loaded."""
    if values.method == "polynomial":
        return fitted.polynomial
    if values.method == "projection":
        return project.projection
    return tangent.tangent_surfel if values.normal == "surfel" else tangent.tangent_covariance


def goes_together(scene: Scene, settings: Settings, values: Chosen) -> bool:
    """Whether rays search side by side: the plain iteration through the cells of a lattice.

    Tangent surface, surfels' normals and Gaussian weights of all that is gathered near a cell; of the bounds the one
    that is known anyway; hits show the averaged normal.
    """
    bounds = bounds_of(settings, values)
    plain = values.method == "tangent" and values.search == "iterate" and values.normal == "surfel"
    whole = values.weight == "gaussian" and values.neighbourhood in ("cell_ball", "cell_knn")
    return (scene.kind != "cloud" and plain and whole and settings.traversal == "exact" and settings.bail != "growth"
            and bounds == Bounds(bounds.off_centre, -math.inf, math.inf, math.inf, -math.inf)
            and not shows_gradient(settings))


def kernels_of(scene: Scene, settings: Settings, values: Chosen) -> tuple[Any, ...]:
    """The kernels that are called by address with these values."""
    fitted_ones = (approach.approach,) if values.method in FITTED else ()
    return evaluator(values), searcher(scene, settings, values), accept.accept, *fitted_ones


#: The kernel of each search.
SEARCHERS: dict[str, Any] = {
    "iterate": stepping.step_search, "secant": stepping.step_search, "newton": stepping.step_search,
    "march": march.march_search, "safe": safe.safe_search, "minimise": minimise.minimise_search,
    "centres": centres.centre_search,
}


def searcher(scene: Scene, settings: Settings, values: Chosen) -> Any:
    """The kernel that searches; a cylinder's is for clouds alone, lattices have a driver of their own."""
    if scene.kind != "cloud" and fits_centres(scene, settings, values):
        return first_guess.guessed_search
    if values.method == "cylinder":
        return cylinder_search.cylinder_search
    return SEARCHERS[values.search]
