"""The compiled kernels against the slow oracle: every ray's end, every step, every energy."""

from __future__ import annotations

import math
from functools import cache
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from jaart.core import prepare
from jaart.core.records import STATUS_NAMES, Hits, Trace
from jaart.core.render import render
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings, preset
from jaart.core.shapes import Box, Sphere
from jaart.core.trace import trace
from tests import naive

Array = NDArray[np.float64]

#: A ray whose decisions all keep this distance from their thresholds must end the same.
UNDECIDED = 1e-9

STANDARD = preset("thesis").replace(subdivision=8)
SMALL = preset("thesis").replace(border="closed")
SETTINGS = {
    "standard": STANDARD,
    "standard, tight": STANDARD.replace(tolerance=1e-8, max_off_centre=1.5, trust=3, radius=3),
    "standard, growth": STANDARD.replace(bail="growth", tolerance=1e-3, max_iterations=6),
    "random": SMALL,
    "random, growth": SMALL.replace(bail="growth", h=0.6, radius=1.25, max_iterations=4),
    "random, sparse": SMALL.replace(radius=0.5, trust=9, max_off_centre=9),
}


@cache
def scene_of(name: str) -> Scene:
    """The standard model in 16³ cells, or noise in 7×5×6 of which a third is interface."""
    if name == "standard":
        solids = (Sphere((0.7, 0.7, 0.7), 0.25), Box((0.3, 0.5, 0.4), (0.2, 0.4, 0.3)))
        return Scene("standard", model=Model(solids, 16))
    rng = np.random.default_rng(11)
    levels = rng.uniform(0, 1, (7, 5, 6))
    levels[rng.uniform(size=levels.shape) < 0.7] = 0.0
    return Scene("random", levels=levels)


def rays_of(extent: tuple[float, float, float]) -> tuple[Array, Array]:
    """Rays of every kind: random, grazing, along axes in faces and edges, diagonal, from inside, beside."""
    rng = np.random.default_rng(5)
    size = np.array(extent)
    pairs: list[tuple[Array, Array]] = []
    for _ in range(20):  # from anywhere to anywhere
        target, eye = rng.uniform(0.1, 0.9, 3) * size, rng.normal(size=3)
        eye = target + eye / np.linalg.norm(eye) * 2.5 * size.max()
        pairs.append((eye, target - eye))
    for miss in np.linspace(-0.4, 0.4, 12):  # past the ball of the standard scene
        aside, towards = np.linalg.qr(rng.normal(size=(3, 2)))[0].T
        middle = 0.7 * size + (0.25 * size.min() + miss) * aside
        pairs.append((middle - 20 * towards, towards))
    for axis, sign in product(range(3), (-1.0, 1.0)):
        along = np.eye(3)[axis] * sign
        through = rng.uniform(0.2, 0.8, 3) * size
        for whole in ((), ((axis + 1) % 3,), ((axis + 1) % 3, (axis + 2) % 3)):  # in a cell, a face, an edge
            point = through.copy()
            point[list(whole)] = np.floor(point[list(whole)])
            pairs.append((point - along * 2 * size.max(), along))
    for signs in product((-1.0, 1.0), repeat=3):  # through corners
        pairs.append((np.floor(size * 0.6) - 40 * np.array(signs), np.array(signs)))
    for _ in range(8):
        pairs.append((rng.uniform(0.2, 0.8, 3) * size, rng.normal(size=3)))
    pairs.append((-size, np.array([1.0, -1.0, 0.0])))
    origins, directions = (np.array(a) for a in zip(*pairs, strict=True))
    return origins, directions


def oracle_of(scene: Scene, settings: Settings) -> naive.Search:
    """The oracle on the scene's surfels."""
    surfels = prepare.surfels(scene, settings)
    nx, ny, nz = (int(n) for n in prepare.extent(scene, settings))
    trust = settings.radius if isinstance(settings.trust, str) else settings.trust
    rules = naive.Rules(settings.h.value, settings.radius.value, settings.tolerance, settings.max_iterations,
                        trust.value, settings.max_off_centre.value, settings.bail == "growth")
    cells = {(int(i), int(j), int(k)) for i, j, k in surfels.cells}
    return naive.Search(surfels.points.tolist(), surfels.normal.tolist(), cells, (nx, ny, nz), rules)


@cache
def both(name: str) -> tuple[Hits, list[naive.End]]:
    """The same rays by the kernels and by the oracle."""
    scene, settings = scene_of(name.split(",")[0]), SETTINGS[name]
    hits = render(scene, settings, rays=rays_of(prepare.extent(scene, settings)))
    oracle = oracle_of(scene, settings)
    return hits, [oracle.run(o, d) for o, d in zip(hits.origin.tolist(), hits.direction.tolist(), strict=True)]


@cache
def traces(name: str) -> list[Trace]:
    """The same rays, recorded."""
    hits, _ = both(name)
    return [trace(scene_of(name.split(",")[0]), SETTINGS[name], o, d)
            for o, d in zip(hits.origin, hits.direction, strict=True)]


def decided(end: naive.End) -> bool:
    """Whether no decision of the ray was a close one."""
    return end.margin > UNDECIDED


@pytest.mark.parametrize("name", SETTINGS)
def test_every_ray_ends_as_the_oracle_says(name: str) -> None:
    hits, ends = both(name)
    names = [trace_.status for trace_ in traces(name)]
    for i, end in enumerate(ends):
        if decided(end):
            evaluations = end.evaluations
            assert (names[i], hits.evaluations[i], hits.iterations[i]) == (
                end.status, sum(evaluations), evaluations[-1] if evaluations else 0), f"ray {i}"
            assert hits.neighbours[i] == sum(len(step.neighbours) for steps in end.starts for step in steps)
        assert hits.t[i] == pytest.approx(end.t if end.t is not None else math.nan, abs=1e-12, nan_ok=True) or (
            not decided(end)), f"ray {i}"
    close = [i for i, end in enumerate(ends) if not decided(end)]
    assert len(close) <= 2, f"rays {close} are too close to call; choose others"


@pytest.mark.parametrize("name", SETTINGS)
def test_points_and_normals_are_the_oracles(name: str) -> None:
    hits, ends = both(name)
    found = [i for i, end in enumerate(ends) if end.t is not None and decided(end)]
    assert len(found) >= 5
    for i in found:
        end = ends[i]
        assert hits.point[i] == pytest.approx(naive.along(hits.origin[i].tolist(), hits.direction[i].tolist(),
                                                          end.t or 0.0), abs=1e-12)
        assert hits.normal[i] == pytest.approx(end.normal, abs=1e-12)


@pytest.mark.parametrize("name", SETTINGS)
def test_every_search_takes_the_oracles_steps(name: str) -> None:
    """Loose in t: grazing rays multiply the last bits' difference from step to step."""
    _, ends = both(name)
    for recorded, end in zip(traces(name), ends, strict=True):
        if not decided(end):
            continue
        steps = [(number, step) for number, start in enumerate(end.starts) for step in start if step.neighbours]
        assert recorded.steps == len(steps)
        for s, (number, step) in enumerate(steps):
            assert (recorded.start[s], tuple(recorded.step_cell[s])) == (number, step.cell)
            assert sorted(recorded.neighbours[s]) == step.neighbours
            assert recorded.t_query[s] == pytest.approx(step.t, abs=1e-7)


@pytest.mark.parametrize("name", SETTINGS)
def test_every_step_is_what_the_formulas_give_at_its_query(name: str) -> None:
    scene, settings = scene_of(name.split(",")[0]), SETTINGS[name]
    oracle = oracle_of(scene, settings)
    for recorded in traces(name):
        d = recorded.direction.tolist()
        for s in range(recorded.steps):
            near, x = recorded.neighbours[s], recorded.query[s].tolist()
            cloud = naive.Cloud([oracle.points[i] for i in near], [oracle.normals[i] for i in near], settings.h.value)
            assert x == pytest.approx(naive.along(recorded.origin.tolist(), d, recorded.t_query[s]), abs=1e-12)
            assert recorded.barycentre[s] == pytest.approx(cloud.barycentre(x), abs=1e-12)
            assert recorded.off_centre[s] == pytest.approx(cloud.off_centre(x), abs=1e-12)
            if recorded.outcome[s] == "undefined_normal":
                continue
            assert recorded.step_normal[s] == pytest.approx(cloud.normal(x), abs=1e-12)
            slope = abs(naive.dot(cloud.normal(x), d))
            if recorded.outcome[s] == "parallel":
                assert slope < 1e-11
                continue
            step = cloud.tangent_step(x, d)
            assert recorded.energy[s] == pytest.approx(step, abs=1e-13 * (1 + abs(step)) / slope)
            assert recorded.t_next[s] == recorded.t_query[s] + recorded.energy[s]
            if s + 1 < recorded.steps and recorded.start[s] == recorded.start[s + 1]:
                assert recorded.t_query[s + 1] == pytest.approx(recorded.t_next[s], abs=1e-12)


def test_weights_and_their_sum_are_the_oracles() -> None:
    points = prepare.surfels(scene_of("standard"), STANDARD).points.tolist()
    for recorded in traces("standard"):
        for s in range(recorded.steps):
            ids = recorded.neighbours[s]
            weights = [naive.gaussian(math.dist(points[i], recorded.query[s]), 0.8) for i in ids]
            assert recorded.weight_sum[s] == pytest.approx(sum(weights), rel=1e-12)
            assert recorded.weights[s] == pytest.approx(np.array(weights) / sum(weights), abs=1e-13)


@pytest.mark.parametrize("name", SETTINGS)
def test_the_recorded_ray_and_the_fast_one_are_the_same_bits(name: str) -> None:
    hits, _ = both(name)
    for i, recorded in enumerate(traces(name)):
        assert recorded.status == STATUS_NAMES[hits.status[i]]
        assert recorded.steps == hits.evaluations[i]
        for a, b in ((recorded.t, hits.t[i]), (recorded.point, hits.point[i]), (recorded.normal, hits.normal[i])):
            assert np.float64(a).tobytes() == b.tobytes(), f"ray {i}"
        if recorded.steps:
            assert (recorded.start == recorded.start[-1]).sum() == hits.iterations[i] or hits.iterations[i] == 0
        if recorded.hit:
            assert abs(recorded.energy[-1]).tobytes() == hits.energy[i].tobytes()
            assert recorded.off_centre[-1].tobytes() == hits.off_centre[i].tobytes()


def test_threads_change_no_bit() -> None:
    scene = scene_of("standard")
    one, four = (render(scene, STANDARD, size=(90, 70), threads=n) for n in (1, 4))
    for name, value in vars(one).items():
        if isinstance(value, np.ndarray):
            assert value.tobytes() == getattr(four, name).tobytes(), name


@pytest.mark.parametrize("name", ["standard", "random"])
def test_energies_along_rays_are_the_oracles(name: str) -> None:
    scene, settings = scene_of(name), SETTINGS[name]
    oracle = oracle_of(scene, settings)
    known = 0
    for recorded in traces(name)[::6]:
        curves = recorded.curves
        each = len(curves.t) // max(1, len(recorded.cells))
        for s in range(0, len(curves.t), 7):
            cell = tuple(int(c) for c in recorded.cells[s // each])
            near = naive.cell_ball(cell, oracle.points, settings.radius.value)  # type: ignore[arg-type]
            found = (curves.tangent[s], curves.off_centre[s], curves.mahalanobis[s])
            if not near:
                assert np.isnan(found).all()
                continue
            cloud = naive.Cloud([oracle.points[i] for i in near], [oracle.normals[i] for i in near], settings.h.value)
            x = naive.along(recorded.origin.tolist(), recorded.direction.tolist(), curves.t[s])
            slope = naive.dot(cloud.normal(x), recorded.direction.tolist())
            if abs(slope) < 1e-12:
                continue
            assert found[1] == pytest.approx(cloud.off_centre(x), rel=1e-10, abs=1e-12)
            assert found[2] == pytest.approx(cloud.mahalanobis(x, settings.mahalanobis_c), rel=1e-10, abs=1e-12)
            step = cloud.tangent_step(x, recorded.direction.tolist())
            assert found[0] == pytest.approx(step, rel=1e-10, abs=1e-11 / abs(slope))
            known += 1
    assert known > 40
