"""Every search on lattices, against the slow oracle on each cell's own list of surfels."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from jaart.core.assemble import ENERGY_NUMBERS
from jaart.core.records import STATUS
from jaart.core.render import render
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from tests.core.exact_slopes import exact_slope
from tests.core.oracle_scene import Oracle, Stretch, face_distance, scene_of, stretches
from tests.core.search_rays import TIGHT, H, rendered, traced
from tests.oracle import searches
from tests.oracle.vectors import along


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
        assert recorded.step_normal[-1] == pytest.approx(hits.normal[i], abs=1e-6)
    assert roots >= (25 if name == "standard" else 8)


def oracle_roots(oracle: Oracle, part: Stretch, o: list[float], d: list[float], count: int = 14) -> list[float]:
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
        jump = before is not None and first is not None and before * first < 0
        if jump and min(abs(before), abs(first)) < 0.1 * H and oracle.is_sheet(part.cell, x):
            return part.enter
        for t in oracle_roots(oracle, part, o, d):
            if oracle.is_sheet(part.cell, along(o, d, t)) and abs(f(t)) < 1e-9:
                return t
        before = f(part.leave)
    return None


@pytest.mark.parametrize("normal", ["surfel", "covariance"])
def test_the_safe_search_finds_the_first_hit_and_nothing_else(normal: str) -> None:
    settings = TIGHT.replace(search="safe", normal=normal, max_off_centre=0.3)
    hits, oracle = rendered("standard", settings, 18)
    wrong, found = [], 0
    for i, (o, d) in enumerate(zip(hits.origin.tolist(), hits.direction.tolist(), strict=True)):
        truth = first_hit(oracle, o, d)
        found += truth is not None
        if (truth is None) != (not hits.hit[i]) or (truth is not None and abs(truth - hits.t[i]) > 1e-6):
            wrong.append((i, truth, hits.t[i]))
    assert wrong == []
    assert 12 <= found <= len(hits) - 5


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
                truth = part.enter if min(abs(before), abs(first)) < 0.1 * H else math.nan
            else:
                found = searches.march(f, part.enter, part.leave, (part.leave - part.enter) / count)
                truth = None if found is None else found.t
            if truth is not None:
                if math.isnan(truth) or not oracle.is_sheet(part.cell, along(o, d, truth)):
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
        another = abs(t - hits.t[i]) > 0.05  # minimum of the same cell
        assert another or e <= least + (1e-5 if rough else 1e-9)
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


def test_the_safe_search_finds_a_dip_where_f_bends_both_ways() -> None:
    """Between two looks f rises past 0 and falls again, though its tangents there meet before 0."""
    scene = Scene("sphere", model=Model((Sphere((0.5, 0.5, 0.5), 0.25),), 16))
    settings = Settings(search="safe", tolerance=1e-12).replace(h=0.8, radius=6)
    origin = np.array([[5.579041547445668, 3.823303218621547, -0.5461696047859405]])
    direction = np.array([[0.2832769997872082, 0.02918364838706245, 0.9585939995943946]])
    hits = render(scene, settings, rays=(origin, direction))
    assert hits.hit[0] and hits.t[0] == pytest.approx(9.25744907, abs=1e-7)
