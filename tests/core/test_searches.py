"""Every search on lattices, against the slow oracle on each cell's own list of surfels."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from jaart.core import prepare
from jaart.core.assemble import ENERGY_NUMBERS
from jaart.core.records import STATUS, STATUS_NAMES, Hits, Trace
from jaart.core.render import render
from jaart.core.settings import Settings
from jaart.core.trace import trace
from tests.core.exact_slopes import exact_slope
from tests.core.oracle_scene import Array, Oracle, Stretch, face_distance, grazing_rays, rays_of, scene_of, stretches
from tests.oracle import searches
from tests.oracle.gradients import tangent_gradient
from tests.oracle.normals import covariance, offset
from tests.oracle.vectors import along, dot
from tests.oracle.weights import log_sum

TIGHT = Settings(tolerance=1e-10, max_iterations=100, max_off_centre="none", border="closed", radius=2.5)
H = 0.8


def rays(name: str, count: int = 60) -> tuple[Array, Array]:
    """Rays through a scene, grazing ones included."""
    if name == "standard":
        return tuple(np.concatenate(pair) for pair in zip(rays_of(np.full(3, 12.0), count), grazing_rays(24),
                                                          strict=True))  # type: ignore[return-value]
    return rays_of(np.array([7.0, 5.0, 6.0]), count)


def rendered(name: str, settings: Settings, count: int = 60) -> tuple[Hits, Oracle]:
    """The hits of those rays, and the oracle."""
    return render(scene_of(name), settings, rays=rays(name, count)), Oracle.of(scene_of(name), settings)


def traced(name: str, settings: Settings, hits: Hits, i: int) -> Trace:
    """One of the rays with its steps."""
    return trace(scene_of(name), settings, hits.origin[i], hits.direction[i])


@pytest.mark.parametrize(("search", "normal", "name"), [
    *itertools.product(["iterate", "secant", "newton", "safe"], ["surfel", "covariance"], ["standard"]),
    ("iterate", "covariance_at_x", "standard"), ("secant", "covariance_at_x", "standard"),
    *itertools.product(["iterate", "secant", "newton", "safe"], ["surfel"], ["random"])])
def test_hits_are_roots_of_the_oracles_f(search: str, normal: str, name: str) -> None:
    settings = TIGHT.replace(search=search, normal=normal)
    hits, oracle = rendered(name, settings)
    roots = 0
    for i in np.flatnonzero(hits.hit):
        recorded = traced(name, settings, hits, i)
        assert recorded.t == hits.t[i]
        cell = tuple(int(c) for c in recorded.step_cell[-1])
        x = recorded.point.tolist()
        assert sorted(recorded.neighbours[-1]) == oracle.near(cell, x)
        f = oracle.f(cell, x)
        assert f is not None
        if search == "safe" and hits.status[i] == STATUS["floor"]:
            jump = oracle.f(oracle.cell_of(along(x, recorded.direction.tolist(), -1e-6)), x)
            assert jump is not None and jump * f <= 0 and face_distance(x) < 1e-9
            continue
        roots += 1
        assert abs(f) <= 1e-9 * H, i
        assert recorded.step_normal[-1] == pytest.approx(hits.normal[i], abs=1e-9)
    assert roots >= (25 if name == "standard" else 8)


def oracle_roots(oracle: Oracle, part: Stretch, o: list[float], d: list[float], count: int = 20) -> list[float]:
    """Every root of f in a cell, pairs within one interval of the scan included."""
    f = part.along(oracle.f, o, d)
    scan, found = searches.samples(f, part.enter, part.leave, count), []
    for k, ((low, a), (high, b)) in enumerate(itertools.pairwise(scan)):
        if a is None or b is None:
            continue
        after = scan[k + 2][1] if k + 2 < len(scan) else None
        if (a > 0) != (b > 0):
            found.append(searches.bisect(f, low, high, 1e-13))
        elif after is not None and (after > 0) == (a > 0) and abs(b) <= min(abs(a), abs(after)):
            sign, last = 1 if a > 0 else -1, scan[k + 2][0]
            dip, least = searches.golden(lambda t, f=f, sign=sign: sign * f(t), low, last)
            if least < 0:
                found += [searches.bisect(f, low, dip, 1e-13), searches.bisect(f, dip, last, 1e-13)]
    return sorted(found)


def first_hit(oracle: Oracle, o: list[float], d: list[float]) -> float | None:
    """The truth of the first hit: the first root with the right sense, or jump over 0 at a face."""
    before: float | None = None
    for part in stretches(oracle, o, d):
        if not oracle.near(part.cell, along(o, d, part.enter)):
            before = None
            continue
        f = part.along(oracle.f, o, d)
        first = f(part.enter)
        x = along(o, d, part.enter)
        if before is not None and first is not None and before * first < 0 and oracle.is_sheet(part.cell, x):
            return part.enter
        for t in oracle_roots(oracle, part, o, d):
            if oracle.is_sheet(part.cell, along(o, d, t)) and abs(f(t)) < 1e-9:
                return t
        before = f(part.leave)
    return None


@pytest.mark.parametrize("normal", ["surfel", "covariance"])
def test_the_safe_search_finds_the_first_hit_and_nothing_else(normal: str) -> None:
    settings = TIGHT.replace(search="safe", normal=normal, max_off_centre=0.3)
    hits, oracle = rendered("standard", settings, 30)
    wrong, found = [], 0
    for i, (o, d) in enumerate(zip(hits.origin.tolist(), hits.direction.tolist(), strict=True)):
        truth = first_hit(oracle, o, d)
        found += truth is not None
        if (truth is None) != (not hits.hit[i]) or (truth is not None and abs(truth - hits.t[i]) > 1e-6):
            wrong.append((i, truth, hits.t[i]))
    assert wrong == []
    assert 20 <= found <= len(hits) - 5


def test_the_safe_search_finds_both_walls_of_a_thin_dip() -> None:
    """A ray that only just enters the ball: two roots closer than a step."""
    settings = TIGHT.replace(search="safe", radius=5)
    oracle, rng = Oracle.of(scene_of("standard"), settings), np.random.default_rng(9)
    aside, towards = np.linalg.qr(rng.normal(size=(3, 2)))[0].T
    low, high, dips = 2.0, 3.2, 0
    for _ in range(40):  # the silhouette by halving
        middle = 0.5 * (low + high)
        hit = render(scene_of("standard"), settings,
                     rays=((8.4 + middle * aside - 20 * towards)[None], towards[None])).hit[0]
        low, high = (middle, high) if hit else (low, middle)
    for depth in (1e-2, 1e-4, 1e-6):
        o = (8.4 + (low - depth) * aside - 20 * towards).tolist()
        hits = render(scene_of("standard"), settings, rays=(np.array([o]), towards[None]))
        truth = first_hit(oracle, o, towards.tolist())
        assert truth is not None and hits.hit[0]
        assert hits.t[0] == pytest.approx(truth, abs=1e-5)
        dips += 1
        out = (8.4 + (low + depth) * aside - 20 * towards)[None]
        assert not render(scene_of("standard"), settings, rays=(out, towards[None])).hit[0]
    assert dips == 3


@pytest.mark.parametrize("step", [0.5, 0.3])
def test_march_is_the_oracles(step: float) -> None:
    settings = TIGHT.replace(search="march", step=step)
    hits, oracle = rendered("standard", settings, 40)
    compared = 0
    for i, (o, d) in enumerate(zip(hits.origin.tolist(), hits.direction.tolist(), strict=True)):
        truth, before = None, None
        for part in stretches(oracle, o, d):
            if not oracle.near(part.cell, along(o, d, part.enter)):
                before = None
                continue
            f = part.along(oracle.f, o, d)
            count = max(math.ceil((part.leave - part.enter) / step), 1)
            first = f(part.enter)
            if before is not None and first is not None and before * first < 0:
                truth = part.enter
            else:
                found = searches.march(f, part.enter, part.leave, (part.leave - part.enter) / count)
                truth = None if found is None else found.t
            if truth is not None:
                if not oracle.is_sheet(part.cell, along(o, d, truth)):
                    truth = math.nan  # a change of sign between two sheets: not compared
                break
            before = f(part.leave)
        if truth is not None and math.isnan(truth):
            continue
        compared += 1
        assert (truth is not None) == hits.hit[i], i
        if truth is not None:
            assert hits.t[i] == pytest.approx(truth, abs=1e-9)
    assert compared > 0.8 * len(hits) and hits.hit.sum() > 20


@pytest.mark.parametrize(("method", "emphasise"), [("off_centre", False), ("mahalanobis", False), ("tangent", False),
                                                   ("angle", False), ("off_centre", True), ("mahalanobis", True)])
def test_minimised_energies_are_least_and_below_the_level(method: str, emphasise: bool) -> None:
    settings = TIGHT.replace(method=method, search="minimise", emphasise=emphasise, normal="surfel", step=1.0)
    hits, oracle = rendered("standard", settings, 50)
    inner = 0
    for i in np.flatnonzero(hits.hit):
        o, d, x = hits.origin[i].tolist(), hits.direction[i].tolist(), hits.point[i].tolist()
        if face_distance(x) < 1e-6:
            continue  # least at a border, where it jumps
        cell = oracle.cell_of(x)
        e = oracle.energy(cell, x, d)
        assert e is not None and e < oracle.values.level
        assert e == pytest.approx(hits.energy[i], abs=1e-9)
        part = next(s for s in stretches(oracle, o, d) if s.cell == cell)
        for away in (-1e-3, -1e-5, 1e-5, 1e-3):
            beside = oracle.energy(cell, along(x, d, away), d)
            assert beside is not None and e <= beside + 1e-12
        t, least = searches.minimum(lambda t, cell=cell, o=o, d=d: oracle.energy(cell, along(o, d, t), d),
                                    part.enter, part.leave, 24)
        rough = emphasise or method == "angle"  # a kink with unequal sides, found by differences
        assert e <= least + (1e-5 if rough else 1e-9) or abs(t - hits.t[i]) > 0.05  # another minimum of the same cell, farther away
        inner += 1
        if not emphasise and method in ("off_centre", "mahalanobis") and inner <= 8:
            points, normals = oracle.surfels(cell, x)
            slope = exact_slope(ENERGY_NUMBERS[method], "gaussian", x, d, points, normals, H, 0.25)
            assert abs(slope) <= 2e-10
    assert inner >= 20


def test_minimise_takes_the_first_minimum() -> None:
    settings = TIGHT.replace(method="off_centre", search="minimise")
    hits, oracle = rendered("standard", settings, 30)
    for i in np.flatnonzero(hits.hit)[:16]:
        o, d = hits.origin[i].tolist(), hits.direction[i].tolist()
        for part in stretches(oracle, o, d):
            if part.leave >= hits.t[i] or not oracle.near(part.cell, along(o, d, part.enter)):
                continue
            t, least = searches.minimum(lambda t, part=part, o=o, d=d: oracle.energy(part.cell, along(o, d, t), d),
                                        part.enter, part.leave, 16)
            inside = part.enter + 1e-6 < t < part.leave - 1e-6
            assert not (inside and least < oracle.values.level), (i, part)


BOUNDS = {
    "max_off_centre": ("bounded", 0.05), "min_weight": ("bounded_weight", 1.2), "max_nearest": ("bounded_nearest", 0.2),
    "max_angle": ("bounded_angle", 1e-12), "min_gap": ("bounded_gap", 0.5),
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
    exact = render(scene_of("standard"), TIGHT.replace(search=search), rays=rays("standard", 30))
    hits, oracle = rendered("standard", settings, 30)
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
