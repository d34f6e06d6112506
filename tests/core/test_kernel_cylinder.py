"""The mean of the surfels in a cylinder around the ray: the kernel against the slow oracle, and pictures of it."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from jaart.core import prepare
from jaart.core.camera import Camera
from jaart.core.cell_table import cell_table
from jaart.core.chosen import chosen
from jaart.core.cylinder import CylinderTracer, with_reach
from jaart.core.io import load
from jaart.core.kernels import records as r
from jaart.core.quality import quality
from jaart.core.records import STATUS_NAMES
from jaart.core.render import render, unit
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.surfels import Surfels
from jaart.core.tiles import columns_for
from jaart.core.trace import trace
from tests.oracle.cylinder import CylinderHit, cylinder_hit
from tests.oracle.samples import spiral, tilted_plane

Array = NDArray[np.float64]

SHAPE = (7, 6, 8)
SIZE = np.array(SHAPE, float)
TILTED = [2 / 7, -3 / 7, 6 / 7]


@cache
def points_of(name: str) -> tuple[Array, Array]:
    """60 surfels or more within the lattice."""
    rng = np.random.default_rng(7)
    if name == "plane":
        points, normals = tilted_plane(TILTED, (SIZE / 2).tolist(), count=60)
    elif name == "sphere":
        points, normals = spiral(2.0, 150, (3.5, 3.0, 4.0))
    elif name == "noisy":
        points, normals = spiral(2.0, 60, (3.5, 3.0, 4.0))
        points = (np.array(points) + rng.normal(0, 0.2, (60, 3))).tolist()
        normals = unit(np.array(normals) + rng.normal(0, 0.3, (60, 3))).tolist()
    else:
        points = (rng.uniform(0, 1, (60, 3)) * SIZE).tolist()
        normals = unit(rng.normal(size=(60, 3))).tolist()
    return np.array(points), np.array(normals)


@cache
def cells_of(name: str, radius: float) -> r.Cells:
    points, normals = points_of(name)
    index = np.floor(points).astype(np.int32)
    found = Surfels(index, points - index - 0.5, normals)
    values = chosen(Scene("test", levels=np.zeros(SHAPE)), Settings().replace(h=radius))
    return cell_table(found, SHAPE, with_reach(values), 1)


def trace_all(cells: r.Cells, radius: float, origin: Array, direction: Array, pixels: np.ndarray, out: r.Out) -> None:
    tracer = CylinderTracer(lambda: cells, None, radius)  # type: ignore[arg-type]
    tracer.trace(origin, direction, pixels, out)


@cache
def rays(count: int) -> tuple[Array, Array]:
    """Rays from around the lattice and from within it, and some along its axes and in faces between its cells."""
    rng = np.random.default_rng(3)
    target, eye = rng.uniform(0.2, 0.8, (count, 3)) * SIZE, unit(rng.normal(size=(count, 3))) * 14
    eye[::5] = rng.uniform(-0.5, 0.5, (len(eye[::5]), 3))
    origin, direction = target + eye, unit(-eye)
    for i, axis in enumerate((0, 1, 2, 0, 1, 2)):
        direction[i] = np.eye(3)[axis] * (1 if i < 3 else -1)
        beside = np.array([3.0, 3.0, 4.0]) + 0.25 * (i % 2)
        origin[i] = np.where(np.arange(3) == axis, -20.0 * direction[i, axis], beside)
    return origin, direction


def spans(origin: Array, direction: Array) -> tuple[float, float]:
    """Where a ray enters and leaves the lattice; the first beyond the second when it never does."""
    low, high = 0.0, np.inf
    for o, d, n in zip(origin, direction, SHAPE, strict=True):
        if d == 0:
            low = low if 0 <= o <= n else np.inf
            continue
        a, b = sorted((-o / d, (n - o) / d))
        low, high = max(low, a), min(high, b)
    return low, high


def expected(name: str, origin: Array, direction: Array, radius: float) -> CylinderHit:
    """The oracle's hit, of discs that the ray meets within the lattice."""
    points, normals = points_of(name)
    enter, leave = spans(origin, direction)
    if not enter <= leave:
        return CylinderHit("background")
    found = cylinder_hit(origin.tolist(), direction.tolist(), points.tolist(), normals.tolist(), radius, enter)
    return CylinderHit("background") if found.first is None or found.first > leave else found


NAMES = {"hit": r.CONVERGED, "background": r.BACKGROUND, "undefined_normal": r.UNDEFINED_NORMAL}


@pytest.mark.parametrize("radius", [0.4, 0.8, 1.6])
@pytest.mark.parametrize("name", ["plane", "sphere", "noisy", "random"])
def test_it_is_what_the_oracle_says(name: str, radius: float) -> None:
    origin, direction = rays(150)
    out = columns_for(150)
    trace_all(cells_of(name, radius), radius, origin, direction, np.arange(150), out)
    hits = 0
    for i in range(150):
        found = expected(name, origin[i], direction[i], radius)
        if found.t is not None and found.t <= 0:  # the mean lies behind the origin
            assert out.status[i] == r.LEFT_TRUST and np.isnan(out.t[i])
            continue
        assert out.status[i] == NAMES[found.status], i
        if found.t is None:
            assert np.isnan(out.t[i]) and np.isnan(out.normal[i]).all()
            continue
        hits += 1
        assert out.t[i] == pytest.approx(found.t, abs=1e-11)
        assert out.normal[i] == pytest.approx(found.normal, abs=1e-11)
        assert out.point[i] == pytest.approx(origin[i] + found.t * direction[i], abs=1e-11)
        assert found.ids is not None and found.first is not None
        assert out.neighbours[i] == len(found.ids)
        assert out.energy[i] == pytest.approx(abs(found.t - found.first), abs=1e-11)
        assert (out.iterations[i], out.evaluations[i]) == (1, 1)
    assert hits > 15
    assert hits < 150


def test_a_plane_is_exact_from_any_direction() -> None:
    origin, direction = rays(150)
    out = columns_for(150)
    trace_all(cells_of("plane", 1.6), 1.6, origin, direction, np.arange(150), out)
    hit = out.status == r.CONVERGED
    assert hit.sum() > 40
    assert (out.point[hit] - SIZE / 2) @ np.array(TILTED) == pytest.approx(0.0, abs=1e-12)
    assert out.normal[hit] == pytest.approx(np.tile(TILTED, (hit.sum(), 1)), abs=1e-12)


def test_opposite_surfels_have_no_normal_and_bad_rays_no_meaning() -> None:
    values = chosen(Scene("test", levels=np.zeros((3, 3, 3))), Settings().replace(h=0.5))
    found = Surfels(np.array([[1, 1, 1], [1, 1, 1]], np.int32), np.array([[0, 0, 0], [0, 0, -0.25]]),
                    np.array([[0.0, 0, 1], [0, 0, -1]]))
    origin = np.array([[1.5, 1.5, 9.0], [1.5, 1.5, np.nan], [1.5, 1.5, 9.0]])
    direction = np.array([[0, 0, -1.0], [0, 0, -1.0], [0, 0, 1.0]])
    out = columns_for(3)
    cells = cell_table(found, (3, 3, 3), with_reach(values), 1)
    trace_all(cells, 0.5, origin, direction, np.arange(3), out)
    assert out.status.tolist() == [r.UNDEFINED_NORMAL, r.BAD_RAY, r.BACKGROUND]
    assert np.isnan(out.t).all() and np.isnan(out.point).all()


@pytest.fixture(scope="module")
def standard() -> Scene:
    return load("standard")


SHARP = Settings(method="cylinder", raster=32, placement="exact", gradient="smooth")


def test_a_picture_shows_the_solids(standard: Scene) -> None:
    hits = render(standard, SHARP, size=(96, 96))
    q = quality(hits, standard)
    assert q is not None and q.relevant > 900
    assert q.false_hit + q.false_miss + q.distance_miss < 0.1 * q.relevant
    assert np.nanmedian(q.distance) < 0.04
    assert np.nanmedian(q.angle) < 5
    assert set(np.unique(hits.status)) <= {r.CONVERGED, r.BACKGROUND}


def test_every_ray_of_a_picture_is_the_oracles(standard: Scene) -> None:
    settings = SHARP.replace(raster=16, h=1.0)
    found = prepare.surfels(standard, settings)
    hits = render(standard, settings, Camera.fit(prepare.extent(standard, settings), size=(8, 8)), (8, 8))
    points, normals = found.points.tolist(), found.normal.tolist()
    for i in range(64):
        one = cylinder_hit(hits.origin[i].tolist(), hits.direction[i].tolist(), points, normals, 1.0)
        assert hits.status[i] == NAMES[one.status]
        if one.t is not None:
            assert hits.t[i] == pytest.approx(one.t, abs=1e-11)
    assert hits.hit.sum() > 5


def test_a_traced_ray_has_one_step_and_the_cylinders_weights(standard: Scene) -> None:
    settings = SHARP.replace(raster=16)
    hits = render(standard, settings, size=(24, 24))
    found = prepare.surfels(standard, settings)
    for i in np.flatnonzero(hits.hit)[::9]:
        followed = trace(standard, settings, hits.origin[i], hits.direction[i])
        one = cylinder_hit(hits.origin[i].tolist(), hits.direction[i].tolist(), found.points.tolist(),
                           found.normal.tolist(), 0.8)
        assert followed.status == STATUS_NAMES[hits.status[i]] and followed.t == hits.t[i]
        assert len(followed.query) == 1 and followed.outcome == ("converged",)
        assert followed.t_query[0] == pytest.approx(one.first, abs=1e-11)
        assert followed.next_point[0] == pytest.approx(hits.point[i], abs=1e-11)
        assert followed.neighbours[0].tolist() == one.ids
        assert followed.weights[0].sum() == pytest.approx(1.0, abs=1e-14)
        assert followed.step_normal[0] == pytest.approx(one.normal, abs=1e-11)
    miss = np.flatnonzero(~hits.hit)[0]
    assert len(trace(standard, settings, hits.origin[miss], hits.direction[miss]).query) == 0


@pytest.mark.parametrize("radius", [0.5, 1.0])
@pytest.mark.parametrize("name", ["plane", "sphere", "noisy", "random"])
def test_a_cloud_gives_what_the_oracle_does(name: str, radius: float) -> None:
    points, normals = points_of(name)
    rng = np.random.default_rng(3)
    origins = SIZE / 2 + 12 * unit(rng.normal(size=(120, 3)))
    directions = unit(rng.uniform(0.2, 0.8, (120, 3)) * SIZE - origins)
    hits = render(Scene("cloud", points=points, normals=normals), Settings().replace(method="cylinder", h=radius),
                  rays=(origins, directions))
    names = {"hit": "converged", "undefined_normal": "undefined_normal", "background": "background"}
    for i in range(120):
        exact = cylinder_hit(origins[i].tolist(), hits.direction[i].tolist(), points.tolist(), normals.tolist(), radius)
        assert STATUS_NAMES[hits.status[i]] == names[exact.status]
        if exact.status == "hit":
            np.testing.assert_allclose(hits.t[i], exact.t, rtol=0, atol=1e-11)
            np.testing.assert_allclose(hits.normal[i], exact.normal, rtol=0, atol=1e-11)
    assert hits.hit.sum() > 10
