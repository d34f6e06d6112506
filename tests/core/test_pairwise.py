"""A pairwise cover of method × weight × normal × neighbourhood × search: each is refused by name, or renders hits
that satisfy the slow oracle's equation for the surfels near the hit."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest

from jaart.core import meaning
from jaart.core.errors import SettingsError
from jaart.core.records import STATUS, Hits
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.trace import trace
from tests.core.cloud_scenes import CloudOracle, cloud, rays
from tests.core.oracle_scene import Oracle, face_distance, rays_of, scene_of
from tests.oracle.surfaces import polynomial_fit
from tests.oracle.vectors import Vector, along, dot, minus

CHOICES = {
    "method": ("tangent", "polynomial", "off_centre", "mahalanobis", "angle", "projection"),
    "search": ("iterate", "secant", "newton", "minimise", "march", "safe", "centres"),
    "weight": ("gaussian", "hat", "squared_hat", "wendland"),
    "normal": ("surfel", "covariance", "covariance_at_x"),
    "neighbourhood": ("cell_ball", "ball", "cell_knn", "knn"),
    "emphasise": (False, True),
}
#: The kinds of scenes.
SCENES: dict[str, Callable[[], Scene]] = {
    "lattice": lambda: scene_of("standard"),
    "cloud": lambda: cloud("bumpy", 300),
}
ENERGIES = ("off_centre", "mahalanobis", "angle")
#: What is refused: (setting that is named, method, search), whatever the others are.
REFUSED = {
    *(("search", method, search) for method in ENERGIES for search in CHOICES["search"] if search != "minimise"),
    ("search", "polynomial", "minimise"), ("search", "projection", "minimise"), ("search", "projection", "centres"),
}


def pairs(combination: dict[str, object]) -> set[tuple[tuple[str, object], ...]]:
    """All pairs of values in a combination."""
    return set(itertools.combinations(combination.items(), 2))


def cover(scene: str) -> list[dict[str, object]]:
    """Combinations in which every two values of two settings meet: greedily the one with the most new pairs."""
    every = [dict(zip(CHOICES, values, strict=True)) for values in itertools.product(*CHOICES.values())
             if refused(dict(zip(CHOICES, values, strict=True)), scene) is None]
    left = set().union(*(pairs(one) for one in every))
    of_each, found = [(one, pairs(one)) for one in every], []
    while left:
        best, its = max(of_each, key=lambda entry: len(entry[1] & left))
        found.append(best)
        left -= its
        of_each = [(one, two & left) for one, two in of_each if two & left]
    return found


def refused(one: dict[str, object], scene: str) -> str | None:
    """Which setting is named when a combination is refused, None when it is not."""
    if scene == "cloud" and one["neighbourhood"] in ("cell_ball", "cell_knn"):
        return "neighbourhood"
    for name, method, search in REFUSED:
        if (one["method"], one["search"]) == (method, search):
            return name
    if one["emphasise"] and (one["search"] != "minimise" or one["method"] == "angle"):
        return "emphasise"
    return None


def settings_of(one: dict[str, object], scene: str) -> Settings:
    """Settings at which every weight has enough surfels in reach."""
    wide = one["weight"] in ("hat", "squared_hat")
    units = ("s", "auto") if scene == "cloud" else ("", 2.0)
    return Settings(**one, h=f"{1.6 if wide else 0.8}{units[0]}", radius=units[1], k=24, degree=2,  # type: ignore[arg-type]
                    tolerance=1e-8, max_iterations=60, step=0.5)


def shot_at(scene: str) -> tuple[np.ndarray, np.ndarray]:
    """Rays through a scene."""
    return rays(40) if scene == "cloud" else rays_of(np.full(3, 12.0), 40)


COVERS = {scene: cover(scene) for scene in SCENES}


@pytest.mark.parametrize("scene", SCENES)
def test_just_what_makes_no_sense_is_refused_by_its_name(scene: str) -> None:
    for values in itertools.product(*CHOICES.values()):
        one = dict(zip(CHOICES, values, strict=True))
        name = refused(one, scene)
        if name is None:
            assert meaning.check(SCENES[scene](), settings_of(one, scene)).search == one["search"]
        else:
            with pytest.raises(SettingsError, match=f"^{name} = "):
                meaning.check(SCENES[scene](), settings_of(one, scene))


@pytest.mark.parametrize("scene", SCENES)
def test_every_pair_that_makes_sense_is_covered(scene: str) -> None:
    covered = set().union(*(pairs(one) for one in COVERS[scene]))
    for (a, xs), (b, ys) in itertools.combinations(CHOICES.items(), 2):
        for x, y in itertools.product(xs, ys):
            fits = any(refused(dict(zip(CHOICES, values, strict=True)), scene) is None
                       for values in itertools.product(*CHOICES.values())
                       if (a, x) in zip(CHOICES, values, strict=True) and (b, y) in zip(CHOICES, values, strict=True))
            assert (((a, x), (b, y)) in covered) == fits
    assert len(COVERS[scene]) < 60


def is_least(oracle: Oracle, hit: list[float], d: Vector) -> bool:
    """Whether the energy is below the level and least at a hit along the ray."""
    cell = oracle.cell_of(hit)
    e = oracle.energy(cell, hit, d)
    beside = [oracle.energy(cell, along(hit, d, s), d) for s in (-1e-3, 1e-3)]
    if e is None or None in beside:
        return False
    return e < oracle.values.level and all(e <= b + 1e-6 for b in beside if b is not None)


def is_met(oracle: Oracle, hits: Hits, i: int, scene: Scene) -> bool:
    """Whether a ray meets, at its hit, the plane or polynomial of the centre of the cell or ball it started in."""
    recorded = trace(scene, oracle.settings, hits.origin[i], hits.direction[i])
    hit_at = max(k for k, outcome in enumerate(recorded.outcome) if outcome == "converged")
    cell, v, hit = tuple(int(c) for c in recorded.step_cell[hit_at]), oracle.values, hits.point[i].tolist()
    centre = recorded.balls[cell[0], :3].tolist() if scene.kind == "cloud" else [c + 0.5 for c in cell]
    f, n = oracle.f(cell, centre), oracle.n(cell, centre)
    if f is None or n is None:
        return False
    if v.method == "tangent":
        return abs(dot(n, minus(hit, centre)) - f) < 1e-9
    fit = polynomial_fit(centre, *oracle.surfels(cell, centre), v.h, oracle.settings.degree, v.weight, v.normal)
    assert fit is not None
    away = minus(hit, centre)
    return abs(fit.height(dot(away, fit.u), dot(away, fit.v)) - dot(away, fit.n)) < 1e-8


def satisfied(oracle: Oracle, hits: Hits, i: int, scene: Scene) -> bool:
    """Whether a hit is what the method and the search mean, by the oracle."""
    hit, d, search = hits.point[i].tolist(), hits.direction[i].tolist(), oracle.values.search
    if search == "centres":
        return is_met(oracle, hits, i, scene)
    if search == "minimise":
        return is_least(oracle, hit, d)
    f = oracle.f(oracle.cell_of(hit), hit)
    if f is None:
        return False
    v = oracle.values
    known = 1e-3 if v.method == "projection" and v.neighbourhood in ("ball", "knn") else 1e-6  # of the foot, or of x
    if search != "march":
        return abs(f) < known
    return abs(abs(f) - hits.energy[i]) < known and abs(f) < 0.125 * min(v.h, 0.8)


@pytest.mark.parametrize(("scene", "one"), [(scene, one) for scene in SCENES for one in COVERS[scene]],
                         ids=lambda one: one if isinstance(one, str) else "-".join(str(v) for v in one.values()))
def test_every_hit_satisfies_the_oracles_equation(one: dict[str, object], scene: str) -> None:
    settings = settings_of(one, scene)
    hits = render(SCENES[scene](), settings, rays=shot_at(scene))
    oracle = (CloudOracle if scene == "cloud" else Oracle).of(SCENES[scene](), settings)
    assert np.isfinite(hits.point[hits.hit]).all()
    assert np.linalg.norm(hits.normal[hits.hit], axis=1) == pytest.approx(1.0, abs=1e-12)
    assert not hits.hit.any() or np.nanmax(hits.off_centre[hits.hit]) <= oracle.values.off_centre
    assert not (hits.status == STATUS["bad_ray"]).any()
    most = 4 if one["method"] == "projection" else 14
    inner = [i for i in np.flatnonzero(hits.hit)
             if scene == "cloud" or face_distance(hits.point[i].tolist()) > 2e-3][:most]
    wrong = [int(i) for i in inner if not satisfied(oracle, hits, i, SCENES[scene]())]
    # f jumps where another plane is nearer, and where a normal about x turns over, which a step of march may see
    jumps = one["method"] == "projection" or (scene, one["search"], one["normal"], one["method"]) == (
        "cloud", "march", "covariance_at_x", "polynomial")
    assert len(wrong) <= (1 if jumps else 0), wrong
    if one["normal"] != "covariance_at_x":
        assert hits.hit.sum() >= 5


@pytest.mark.parametrize("scene", SCENES)
def test_the_cover_renders_what_it_should(scene: str) -> None:
    """The scene's solids take up about this share of the rays, whatever the method."""
    shares = []
    for one in COVERS[scene]:
        if one["search"] in ("iterate", "safe") and one["normal"] == "surfel":
            shares.append(render(SCENES[scene](), settings_of(one, scene), rays=shot_at(scene)).hit.mean())
    assert shares and max(shares) - min(shares) < 0.25 and math.isfinite(sum(shares))
