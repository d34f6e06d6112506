"""Random clouds and lattices with rays into them, settings to try, and how far two sets of hits may differ."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from jaart.core.chosen import chosen
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.samples import standard_bumps
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from tests.core.cloud_scenes import unit

Array = NDArray[np.float64]
Rays = tuple[Array, Array]

#: Cells of the lattices: searches stay clear of the border, in whose place another lattice has other cells.
SHAPE = (25, 24, 26)
MIDDLE = np.array(SHAPE) / 2
#: What every ray has one of; all but `cells`, which counts the empty cells on the way, and `point` hold no place.
COLUMNS = ("status", "t", "normal", "energy", "off_centre", "iterations", "evaluations", "neighbours", "lowered", "gap")
#: Searches that look at all of a stretch, so that no chaos of a step decides how a miss ends. A projection begins
#: with an iteration of its own at every point.
THOROUGH = ("safe", "march", "minimise", "centres")
#: A tolerance at which a search ends at rounding, and a loose one.
TIGHT, LOOSE = 1e-10, 0.125

WAYS = (*(("tangent", s) for s in ("iterate", "secant", "newton", "safe", "march", "minimise", "centres")),
        *(("polynomial", s) for s in ("iterate", "secant", "newton", "safe", "march", "centres")),
        *(("projection", s) for s in ("iterate", "secant", "safe")),
        *((energy, "minimise") for energy in ("off_centre", "mahalanobis", "angle")), ("cylinder", "auto"))


@dataclass(frozen=True)
class Setup:
    """A scene's numbers, and rays into it."""

    scene: Scene
    rays: Rays


def hits(setup: Setup, settings: Settings, **more: Any) -> Hits:
    """Where the rays meet the scene."""
    return render(setup.scene, settings, rays=setup.rays, **more)


def dyadic(values: Array) -> Array:
    """Numbers on a grid of 2^-30, to which whole numbers can be added without rounding."""
    return np.round(values * 2.0**30) / 2.0**30


def cloud(seed: int, bare: bool = False, count: int = 250) -> Setup:
    """Points at random on a bumpy sphere about the origin, with rays from all around at it."""
    rng = np.random.default_rng(seed)
    towards, surface = unit(rng.normal(size=(count, 3))), standard_bumps()
    points = dyadic(surface.points_along(towards))
    eyes, targets = dyadic(3 * unit(rng.normal(size=(30, 3)))), rng.uniform(-0.9, 0.9, (30, 3))
    scene = Scene("cloud", points=points, normals=None if bare else surface.exact_normal(points))
    return Setup(scene, (eyes, unit(targets - eyes)))


def lattice(seed: int, spacing: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> Setup:
    """A dented ball of about 3 cells in the middle of a lattice, with rays from all around at it."""
    rng = np.random.default_rng(seed)
    away = np.moveaxis(np.indices(SHAPE) + 0.5, 0, -1) - MIDDLE - rng.uniform(-0.5, 0.5, 3)
    far = np.linalg.norm(away, axis=-1)
    dents = sum(np.cos(3 * (away @ axis) / np.maximum(far, 1e-9)) for axis in unit(rng.normal(size=(4, 3))))
    eyes = dyadic(MIDDLE + 24 * unit(rng.normal(size=(30, 3))))
    targets = MIDDLE + rng.uniform(-3, 3, (30, 3))
    return Setup(Scene("lattice", levels=np.clip(3.7 + 0.3 * dents - far, 0, 1), spacing=spacing),
                 (eyes, unit(targets - eyes)))


SEEDS = st.integers(0, 10**6)


@st.composite
def cloud_settings(draw: st.DrawFn, tolerance: float) -> Settings:
    """Settings that make sense in every cloud here.

    A projection's plane through few nearest points may be another one by rounding: it has balls alone.
    """
    common = _common(draw, tolerance)
    near = ("ball",) if common.method == "projection" else ("ball", "knn")
    return common.replace(neighbourhood=draw(st.sampled_from(near)), k=draw(st.integers(8, 24)),
                          h=draw(st.sampled_from(("auto", "3s", "0.08d"))), ball_k=draw(st.sampled_from((6, 12))))


@st.composite
def lattice_settings(draw: st.DrawFn, tolerance: float) -> Settings:
    """Settings that make sense in every lattice here."""
    return _common(draw, tolerance).replace(
        neighbourhood=draw(st.sampled_from(("cell_ball", "ball"))), placement=draw(st.sampled_from(("box", "exact"))),
        gradient=draw(st.sampled_from(("central", "youngs", "smooth"))))


def _common(draw: st.DrawFn, tolerance: float) -> Settings:
    method, search = draw(st.sampled_from(WAYS))
    return Settings(method=method, search=search, degree=draw(st.integers(0, 3)), tolerance=tolerance,
                    max_iterations=60, weight=draw(st.sampled_from(("gaussian", "wendland"))),
                    normal=draw(st.sampled_from(("surfel", "covariance"))),
                    shading_normal=draw(st.sampled_from(("average", "gradient"))))


def same_bits(one: Hits, other: Hits, *names: str) -> None:
    """Fail where two sets of hits differ in a bit of some columns, all of COLUMNS when none are named."""
    for name in names or COLUMNS:
        assert np.array_equal(getattr(one, name), getattr(other, name), equal_nan=True), name


def same_but_for_rounding(one: Hits, other: Hits, setup: Setup, blur: float = 0.0) -> None:
    """Fail where hits of the same surface, computed with other roundings, differ by more than these explain.

    blur: by how much coordinates may have been moved, on top of their rounding.
    """
    settings = one.settings
    assert settings.tolerance == TIGHT
    assert np.array_equal(one.hit, other.hit)
    if settings.search in THOROUGH and settings.method != "projection":
        arrived = np.where(one.hit, 0, one.status), np.where(other.hit, 0, other.status)
        assert np.array_equal(*arrived)
    apart, turned = np.abs(one.t - other.t)[one.hit], np.linalg.norm(one.normal - other.normal, axis=1)[one.hit]
    assert (apart <= bound(one, setup, blur)).all(), (apart / bound(one, setup, blur)).max()
    h = chosen(setup.scene, settings).h
    assert (turned <= 10 * TIGHT + 10 * bound(one, setup, blur) / h).all(), turned.max()


def bound(found: Hits, setup: Setup, blur: float) -> Array:
    """How far apart in t two roundings of the same hits may be.

    t itself is rounded to an ulp by each, and f to some ulps of h, which a slanting ray sees 1/cos longer. A least
    value has no sign to bisect, and a projection's f ends an iteration of its own: their searches end within the
    tolerance.
    """
    h = chosen(setup.scene, found.settings).h
    cosine = np.abs((found.normal * found.direction).sum(axis=1))[found.hit]
    within = found.settings.search == "minimise" or found.settings.method == "projection"
    slack = 4 * TIGHT * h if within else 0.0
    return 4 * np.spacing(found.t[found.hit]) + (64 * np.spacing(h) + 16 * blur) / cosine + slack
