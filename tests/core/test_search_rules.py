"""What every search keeps to on lattices: bounds, even steps, caps, true normals, a log that is whole."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from jaart.core import prepare
from jaart.core.records import STATUS, STATUS_NAMES, Trace
from jaart.core.render import render
from tests.core.oracle_scene import Oracle, face_distance, scene_of, stretches
from tests.core.search_rays import TIGHT, H, rays, rendered, traced
from tests.oracle.gradients import tangent_gradient
from tests.oracle.normals import covariance, offset
from tests.oracle.vectors import along, dot
from tests.oracle.weights import log_sum

BOUNDS = {
    "max_off_centre": ("bounded", 0.05), "min_weight": ("bounded_weight", 1.2), "max_nearest": ("bounded_nearest", 0.2),
    "max_angle": ("bounded_angle", 1e-12), "min_gap": ("bounded_gap", 0.9),
}


def bounded_value(oracle: Oracle, recorded: Trace, bound: str) -> float:
    """What a bound is about, at the last step of a ray."""
    cell, x = tuple(int(c) for c in recorded.step_cell[-1]), recorded.query[-1].tolist()
    points, normals = oracle.surfels(cell, x)
    if bound == "min_weight":
        return -log_sum("gaussian", x, points, H)
    if bound == "max_nearest":
        return min(math.dist(x, p) for p in points)
    if bound == "min_gap":
        gap = covariance(x, points, normals, H).gap
        assert gap is not None
        return -gap
    off = offset(x, points, H)
    assert off is not None
    if bound == "max_off_centre":
        return math.hypot(*off)
    n = oracle.n(cell, x)
    assert n is not None
    return abs(dot(off, n)) / math.hypot(*off)


@pytest.mark.parametrize("method", ["tangent", "polynomial"])
@pytest.mark.parametrize("search", ["iterate", "newton", "safe", "march", "centres"])
@pytest.mark.parametrize("bound", BOUNDS)
def test_every_bound_refuses_hits_by_its_name(bound: str, search: str, method: str) -> None:
    name, tight = BOUNDS[bound]
    settings = TIGHT.replace(search=search, method=method, tolerance=1e-3)
    free, oracle = rendered("standard", settings, 30)
    bounded = settings.replace(**{bound: tight})
    hits = render(scene_of("standard"), bounded, rays=(free.origin, free.direction))
    named = 0
    for i in np.flatnonzero(free.hit):
        recorded = traced("standard", bounded, free, i)
        named += name in recorded.outcome
        others = {state for state, _ in BOUNDS.values()} - {name}
        assert not others & set(recorded.outcome)
        if hits.hit[i] and search not in ("centres", "march"):
            limit = tight if bound.startswith("max") else -tight
            assert bounded_value(oracle, recorded, bound) <= limit + 1e-3, i
    assert named > 0, STATUS_NAMES


def test_a_loose_bound_refuses_nothing() -> None:
    free = render(scene_of("standard"), TIGHT, rays=rays("standard", 30))
    loose = TIGHT.replace(max_off_centre=50, min_weight=-1000, max_nearest=50, max_angle=1, min_gap=0)
    assert render(scene_of("standard"), loose, rays=rays("standard", 30)).t.tobytes() == free.t.tobytes()


@pytest.mark.parametrize("search", ["iterate", "secant", "safe"])
def test_uniform_traversal_starts_by_even_steps(search: str) -> None:
    settings = TIGHT.replace(search=search, traversal="uniform", step=1.5)
    exact = render(scene_of("standard"), TIGHT.replace(search=search), rays=rays("standard", 45))
    hits, oracle = rendered("standard", settings, 45)
    assert 10 < hits.hit.sum() <= exact.hit.sum() and hits.cells.sum() < 0.9 * exact.cells.sum()
    for i in range(0, len(hits), 3):
        recorded = traced("standard", settings, hits, i)
        parts = stretches(oracle, hits.origin[i].tolist(), hits.direction[i].tolist())
        for number in set(recorded.start.tolist()):
            at = recorded.t_query[list(recorded.start).index(number)]
            steps = (at - parts[0].enter) / 1.5
            assert steps == pytest.approx(round(steps), abs=1e-9)
        if recorded.hit and hits.status[i] == STATUS["converged"]:
            f = oracle.f(tuple(int(c) for c in recorded.step_cell[-1]), recorded.point.tolist())
            assert f is not None and abs(f) < 1e-9


@pytest.mark.parametrize("search", ["iterate", "secant", "newton"])
def test_growth_gives_up_as_soon_as_f_grows(search: str) -> None:
    settings = TIGHT.replace(search=search, bail="growth", tolerance=1e-6)
    hits, oracle = rendered("standard", settings, 30)
    given_up = 0
    for i in range(len(hits)):
        recorded = traced("standard", settings, hits, i)
        sizes: dict[int, list[float]] = {}
        for s in range(recorded.steps):
            f = oracle.f(tuple(int(c) for c in recorded.step_cell[s]), recorded.query[s].tolist())
            sizes.setdefault(int(recorded.start[s]), []).append(math.inf if f is None else abs(f))
        ends = {int(n): recorded.outcome[s] for s, n in enumerate(recorded.start)}
        for number, found in sizes.items():
            grows = [b > a + 1e-12 for a, b in itertools.pairwise(found)]
            assert not any(grows[:-1])
            if ends[number] == "cap" and len(found) < 100:
                assert found[-1] > found[-2]
                given_up += 1
    assert given_up > 3


@pytest.mark.parametrize("search", ["iterate", "secant", "newton"])
@pytest.mark.parametrize("cap", [1, 2, 3])
def test_no_start_takes_more_steps_than_its_cap(search: str, cap: int) -> None:
    settings = TIGHT.replace(search=search, max_iterations=cap)
    hits, _ = rendered("standard", settings, 30)
    assert (hits.iterations <= cap).all() and (hits.status == STATUS["cap"]).any()
    for i in np.flatnonzero(hits.status == STATUS["cap"])[:5]:
        recorded = traced("standard", settings, hits, i)
        assert max(np.bincount(recorded.start)) <= cap and recorded.outcome[-1] == "cap"


@pytest.mark.parametrize("search", ["iterate", "newton", "safe"])
@pytest.mark.parametrize("normal", ["surfel", "covariance"])
def test_true_normals_are_the_oracles_gradients(search: str, normal: str) -> None:
    settings = TIGHT.replace(search=search, normal=normal, shading_normal="gradient")
    hits, oracle = rendered("standard", settings, 20)
    compared = 0
    for i in np.flatnonzero(hits.hit):
        x = hits.point[i].tolist()
        if face_distance(x) < 1e-7 or compared == 12:
            continue
        cell = oracle.cell_of(x)
        points, normals = oracle.surfels(cell, x)
        gradient = tangent_gradient(x, points, normals, H, "gaussian", normal)
        n = oracle.n(cell, x)
        assert gradient is not None and n is not None
        size = math.copysign(math.hypot(*gradient), -dot(gradient, n))
        assert hits.normal[i] == pytest.approx([-g / abs(size) * math.copysign(1, size) for g in gradient], abs=1e-7)
        compared += 1
    assert compared >= 10


@pytest.mark.parametrize("search", ["iterate", "safe"])
def test_true_normals_of_polynomials_are_differences_of_the_oracle(search: str) -> None:
    settings = TIGHT.replace(method="polynomial", search=search, shading_normal="gradient")
    hits, oracle = rendered("standard", settings, 20)
    compared = 0
    for i in np.flatnonzero(hits.hit):
        x, width = hits.point[i].tolist(), 1e-4
        if face_distance(x) < 1e-3 or compared == 8:
            continue
        cell, axes = oracle.cell_of(x), np.eye(3).tolist()
        if len({fit_degree(oracle, cell, along(x, a, s)) for a in axes for s in (-width, width)}) > 1:
            continue  # f jumps where the degree changes
        slopes = [(oracle.f(cell, along(x, a, width)) - oracle.f(cell, along(x, a, -width))) / (2 * width)  # type: ignore
                  for a in axes]
        assert hits.normal[i] == pytest.approx([-s / math.hypot(*slopes) for s in slopes], abs=1e-5)
        compared += 1
    assert compared >= 5


def fit_degree(oracle: Oracle, cell: tuple[int, int, int], x: list[float]) -> int:
    """The degree that the oracle's fit has at x."""
    from tests.oracle.surfaces import polynomial_fit

    found = polynomial_fit(x, *oracle.surfels(cell, x), H, 2)
    return -1 if found is None else found.degree


@pytest.mark.parametrize("search", ["iterate", "secant", "newton", "safe", "march", "minimise", "centres"])
@pytest.mark.parametrize("weight", ["hat", "gaussian"])
def test_a_traced_ray_is_the_rendered_one_for_every_search(search: str, weight: str) -> None:
    """Compact weights leave looks where no surfel counts; they are in the log, too."""
    settings = TIGHT.replace(search=search, weight=weight, h=1.0, radius=2.0)
    hits, _ = rendered("standard", settings, 12)
    for i in range(len(hits)):
        recorded = traced("standard", settings, hits, i)
        assert recorded.status == STATUS_NAMES[hits.status[i]]
        assert np.float64(recorded.t).tobytes() == hits.t[i].tobytes()
        assert np.isfinite(recorded.t_query).all() and np.isfinite(recorded.query).all()
        assert ((recorded.step_cell >= 0) & (recorded.step_cell < 12)).all()
        assert [len(n) for n in recorded.neighbours] == [len(w) for w in recorded.weights]


def test_rays_that_hit_nothing_are_background_in_every_search() -> None:
    origins, directions = np.array([[6.0, 6.0, 30.0], [0.2, 0.2, 30.0]]), np.array([[0.0, 0, 1], [0.0, 0, -1]])
    for search in ("iterate", "safe", "march", "minimise"):
        hits = render(scene_of("standard"), TIGHT.replace(search=search), rays=(origins, directions))
        assert not hits.hit.any() and hits.status[0] == STATUS["background"]
        assert np.isnan(hits.point).all() and np.isnan(hits.normal).all()


def test_skipped_cells_change_no_hit_of_a_search_in_stretches() -> None:
    settings = TIGHT.replace(search="safe", radius=2.0)
    ready = prepare.prepared(scene_of("standard"), settings)
    hits = render(scene_of("standard"), settings, rays=rays("standard", 30))
    assert int(ready.tracer.cells.halo) >= 1  # type: ignore[attr-defined]
    oracle = Oracle.of(scene_of("standard"), settings)
    for o, d, cells in zip(hits.origin.tolist(), hits.direction.tolist(), hits.cells, strict=True):
        assert cells <= len(stretches(oracle, o, d))
